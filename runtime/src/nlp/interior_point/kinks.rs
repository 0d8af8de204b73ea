//! Leaving a kink that derivatives do not see: at 0 that of `abs` is 0, and of two pieces that meet
//! one is taken.
//!
//! A point on such a kink may seem stationary. The gradients of the Lagrangian at two points beside
//! it, one on each side, tell them apart: where they differ by more than any curvature makes them,
//! the way along their difference, in the null space of the rows, is tried.

use super::algorithm::Algorithm;
use super::iterate::{SearchDirection, Slopes};
use super::tuning::kinks::{BESIDE, DIFFERENT, LONG_STEPS, SHORT_STEPS};
use super::tuning::saddle::GOLDEN;
use crate::nlp::Nlp;
use crate::nlp::assessment::Assessment;

impl Algorithm {
    /// A point (one value per variable) near the iterate, to which the Lagrangian falls by what
    /// counts though the iterate is on a kink of it.
    pub(super) fn descent_from_kink(
        &mut self,
        nlp: &mut dyn Nlp,
        found: &Assessment,
    ) -> Option<Vec<f64>> {
        if !nlp.has_kinks() {
            return None;
        }
        let sizes = self.own_sizes(nlp);
        let difference = self.difference_of_gradients(nlp, &sizes)?;
        let worth: f64 = difference.iter().zip(&sizes).map(|(d, size)| (d * size).abs()).sum();
        if worth <= DIFFERENT * found.size {
            return None;
        }
        let least = self.least_curvature(nlp, found);
        self.factor_at_iterate(least);
        let mut step = SearchDirection::new(&self.formulation);
        step.y[..difference.len()].copy_from_slice(&difference);
        let Algorithm { formulation, slopes, kkt, .. } = self;
        kkt.inverse_iteration(formulation, slopes, &mut step)?;
        self.stretch(&sizes, &mut step);
        let counts = found.least_gain(self.options.tol).max(f64::EPSILON);
        let near = self.descent_along(nlp, &mut step, &SHORT_STEPS, counts)?;
        Some(self.farther(nlp, &step).unwrap_or(near))
    }

    /// The farthest point along a step as long as the Lagrangian falls, though rows do not follow:
    /// an attempt that begins too near is led back.
    fn farther(&mut self, nlp: &mut dyn Nlp, step: &SearchDirection) -> Option<Vec<f64>> {
        let (mut farthest, mut lagrangian) = (None, f64::INFINITY);
        for part in LONG_STEPS {
            let alpha = part.min(self.barrier.longest_steps(&self.formulation, &self.at, step).0);
            let (y, values) = self.moved(nlp, step, alpha)?;
            let next = self.barrier_lagrangian(&values);
            if next >= lagrangian {
                break;
            }
            (farthest, lagrangian) = (Some(y[..self.formulation.variables].to_vec()), next);
        }
        farthest
    }

    /// Of the gradients of the Lagrangian beside the iterate, by a small part of the size of each
    /// variable; nothing where one of them is not finite.
    fn difference_of_gradients(&mut self, nlp: &mut dyn Nlp, sizes: &[f64]) -> Option<Vec<f64>> {
        let sign = |i: usize| if (i as f64 * GOLDEN).fract() < 0.5 { -1.0 } else { 1.0 };
        let mut gradient = |side: f64| {
            let mut at = self.at.clone();
            let moved = at.y.iter_mut().zip(sizes).enumerate();
            moved.for_each(|(i, (y, size))| *y += side * sign(i) * BESIDE * size);
            let mut slopes = Slopes::new(nlp, &self.formulation);
            let is_finite = slopes.evaluate(nlp, &self.formulation, &at, &mut self.counts);
            is_finite.then_some(slopes.lagrangian)
        };
        let [before, after] = [gradient(-1.0)?, gradient(1.0)?];
        let variables = before.iter().zip(&after).take(sizes.len());
        Some(variables.map(|(a, b)| b - a).collect())
    }
}
