//! Whether other values of the controls, far from their own, make the Hamiltonian less.
//!
//! The slope of the Hamiltonian is 0 on a plateau, at a local maximum, and at a local minimum that
//! is not the least; an optimum has the least (Pontryagin's principle). So all of its values at a
//! ladder of values of each control are compared, everything else held, with the multipliers of the
//! solution: one evaluation of the right side for each. Values that a path constraint excludes do
//! not count.

mod together;

use super::hamiltonian::Hamiltonian;
use super::lagrangian::Lagrangian;
use super::minimum::variables;
use crate::nlp::Solution;
use crate::problem::{Bounds, Columns};
use crate::transcribe::TranscribedNlp;

/// A smaller part of the size of the Hamiltonian is no gain: it is known on the grid only.
const GAIN: f64 = 1e-2;
/// So many values between the bounds.
const BETWEEN: usize = 8;
/// Powers of ten of the unit of the control, to both sides of 0.
const DECADES: std::ops::RangeInclusive<i32> = -2..=4;
/// On each decade.
const EACH: [f64; 3] = [1.0, 2.0, 5.0];

/// What is better elsewhere.
pub(crate) struct Elsewhere {
    /// For each control the part of the time on which another value is better.
    pub(crate) parts: Vec<f64>,
    /// The variables of the solution, with the best values of all controls where there are better
    /// ones.
    pub(crate) v: Vec<f64>,
}

impl Elsewhere {
    /// Of a problem without surfaces: the gradient through a thin layer says too little of what
    /// comes after it.
    pub(crate) fn new(
        nlp: &TranscribedNlp,
        solution: &Solution,
        (duration, hamiltonian): (f64, &Hamiltonian),
    ) -> Self {
        let problem = nlp.problem();
        let lagrangian = Lagrangian::new(problem, nlp, solution);
        let own: Vec<f64> = hamiltonian.values.iter().map(|it| it * problem.sense).collect();
        let least = hamiltonian.noise.max(GAIN * hamiltonian.size);
        let search = Search { lagrangian, own, violation: Vec::new(), duration, least };
        let search = Search { violation: search.violation(&solution.v), ..search };
        let alone: Vec<Best> = (0..problem.layout.u).map(|control| search.best(control)).collect();
        let together = search.together(&alone);
        let (mut v, mut parts) = (solution.v.clone(), Vec::new());
        for (control, (alone, together)) in alone.iter().zip(&together).enumerate() {
            let best: Best = alone.iter().zip(together).map(|(one, all)| one.or(*all)).collect();
            parts.push(search.part(&best));
            for (k, at) in variables(nlp, control) {
                v[at] = best[k].map_or(v[at], |it| it.0);
            }
        }
        Elsewhere { parts, v }
    }
}

/// For each interval the value of a control that gains most, and what it gains; nothing where none
/// does.
type Best = Vec<Option<(f64, f64)>>;

/// What others are compared with.
struct Search<'a> {
    lagrangian: Lagrangian<'a>,
    /// The Hamiltonian of the minimisation problem, and by how much path constraints are violated,
    /// on each interval.
    own: Vec<f64>,
    violation: Vec<f64>,
    duration: f64,
    /// Less is no gain.
    least: f64,
}

impl Search<'_> {
    fn best(&self, control: usize) -> Best {
        let mut best = vec![None; self.own.len()];
        let it = &self.lagrangian.problem.controls[control];
        for value in ladder(it.bounds, it.unit) {
            let mut v = self.lagrangian.solution.v.clone();
            self.set(control, value, &mut v);
            for (best, gain) in best.iter_mut().zip(self.gains(&v)) {
                let before = best.map_or(self.least, |(_, gain)| gain);
                if gain > before {
                    *best = Some((value, gain));
                }
            }
        }
        best
    }

    /// A control has this value at all times.
    fn set(&self, control: usize, value: f64, v: &mut [f64]) {
        variables(self.lagrangian.nlp, control).for_each(|(_, at)| v[at] = value);
    }

    /// What other controls gain on each interval; nothing where they are not allowed.
    fn gains(&self, v: &[f64]) -> Vec<f64> {
        let problem = self.lagrangian.problem;
        let (values, _) = self.lagrangian.at(v).hamiltonian(self.duration);
        let violation = self.violation(v).into_iter().zip(&self.violation);
        let is_allowed = violation.map(|(violation, own)| violation <= *own);
        let gains = self.own.iter().zip(values).map(|(own, other)| own - problem.sense * other);
        gains
            .zip(is_allowed)
            .map(|(gain, is_allowed)| if is_allowed { gain } else { 0.0 })
            .collect()
    }

    /// By how much path constraints are violated on each interval.
    fn violation(&self, v: &[f64]) -> Vec<f64> {
        let Lagrangian { problem, nlp, .. } = self.lagrangian;
        let (lagrangian, path) = (self.lagrangian.at(v), &*problem.path);
        let mut most = vec![0.0_f64; nlp.chain().intervals];
        for point in nlp.interval().path.iter().filter(|_| path.outputs() > 0) {
            let points = lagrangian.points_at(path, point);
            let mut values = Columns::new(path.outputs(), points.count());
            path.value(&points, &lagrangian.parameters, &mut values);
            for (row, bounds) in problem.path_bounds.iter().enumerate() {
                let each = most.iter_mut().zip(values.column(row));
                each.for_each(|(most, value)| *most = most.max(bounds.violation(*value)));
            }
        }
        most
    }

    /// The part of the time on which something is better.
    fn part(&self, best: &Best) -> f64 {
        let part = |k: usize| self.lagrangian.nlp.mesh().relative(k) / best.len() as f64;
        let better = best.iter().enumerate().filter(|(_, best)| best.is_some());
        better.map(|(k, _)| part(k)).fold(0.0, |sum: f64, part| (sum + part).min(1.0))
    }
}

/// Values of a control: between its bounds, and of all sizes where these are wide.
fn ladder(Bounds { lower, upper }: Bounds, unit: f64) -> Vec<f64> {
    let width = upper - lower;
    let count = if width.is_finite() && width > 0.0 { BETWEEN } else { 0 };
    let between = (0..=count).map(|at| lower + width * at as f64 / BETWEEN as f64);
    let sizes = DECADES.flat_map(|decade| EACH.map(|it| it * unit * 10_f64.powi(decade)));
    let both = sizes.flat_map(|size| [-size, size]);
    let all = between.filter(|_| count > 0).chain([0.0]).chain(both);
    all.filter(|value| (lower..=upper).contains(value)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_of_all_sizes_are_tried_between_the_bounds() {
        let ladder = |lower, upper| ladder(Bounds { lower, upper }, 10.0);
        let narrow = ladder(-1.0, 3.0);
        assert!(narrow.iter().all(|it| (-1.0..=3.0).contains(it)));
        assert!([-1.0, 3.0, 1.0, 0.0, 0.1].iter().all(|it| narrow.contains(it)), "{narrow:?}");
        let wide = ladder(0.0, 1e8);
        assert!([0.0, 1e8, 10.0, 50.0].iter().all(|it| wide.contains(it)), "{wide:?}");
        assert!(ladder(f64::NEG_INFINITY, f64::INFINITY).contains(&-1000.0));
    }
}
