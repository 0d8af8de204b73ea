//! Local rows in a solve: they are taken out of the right side before the recursion, and have their
//! multipliers afterwards.

use super::recursion::Recursion;

impl Recursion {
    /// `a += J' diag(1/d) b`
    pub(super) fn remove_local_constraints(&self, a: &mut [f64], b: &[f64]) {
        for k in 0..self.stages.intervals {
            let (values, weights) = self.factors.local(k);
            let b = &b[self.stages.local(k)];
            for (entry, value) in self.assembly.local_entries.iter().zip(values) {
                a[entry.variable + k * entry.step] += weights[entry.row] * b[entry.row] * value;
            }
        }
    }

    /// `lambda = (J v - b) / d`, in the place of `b`.
    pub(super) fn local_multipliers(&self, v: &[f64], b: &mut [f64]) {
        for k in 0..self.stages.intervals {
            let (values, weights) = self.factors.local(k);
            let multipliers = &mut b[self.stages.local(k)];
            multipliers.iter_mut().for_each(|value| *value = -*value);
            for (entry, value) in self.assembly.local_entries.iter().zip(values) {
                multipliers[entry.row] += value * v[entry.variable + k * entry.step];
            }
            multipliers.iter_mut().zip(weights).for_each(|(value, weight)| *value *= weight);
        }
    }
}
