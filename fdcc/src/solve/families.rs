//! With several starts: what is certified near each of the answers that they found.

use super::found::Found;
use super::report::{Ended, Options};
use super::tuning::families::{MOST_FAMILIES, SAME};
use super::{Solution, located};
use crate::model::Model;

/// Starts that lead to one optimum of the system that was written.
///
/// ```
/// let text = "time t in [0, 2]\nstate x start 0\nstate v start 0\ncontrol u in [-9, 9]
/// surface slip = v\ndynamics { x' = v  v' in u - Sgn(slip) }
/// end x == 1\nend v == 0\nminimize integral(u^2)";
/// let options = fdcc::Options { starts: 3, ..fdcc::Options::default() };
/// let solution = fdcc::Model::from_text("slide", text)?.solve(&options)?;
/// let starts: usize = solution.families.iter().map(|it| it.starts).sum();
/// assert!(starts <= 3 && solution.families.iter().any(|it| it.is_certified));
/// # Ok::<(), fdcc::Error>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Family {
    /// The objective as the model writes it, in SI: of the smoothed answer where nothing is
    /// certified.
    pub objective: f64,
    /// Whether it is that of a certified optimum.
    pub is_certified: bool,
    /// How many starts lead there.
    pub starts: usize,
}

/// The best certified answer near one of those that were found, `first` the best of them; the
/// answer near that where none is certified.
pub(super) fn best(model: &Model, first: Found, others: Vec<Found>, options: &Options) -> Solution {
    let starts = first.starts.clone();
    let kept = [&first].into_iter().chain(others.iter().take(MOST_FAMILIES - 1));
    let objectives = kept.map(|it| it.problem.sense * it.outcome.solution.objective);
    let counts = counts(&starts, &objectives.collect::<Vec<_>>());
    let mut all = vec![located::solution(model, first, options)];
    if all[0].certificate.is_none() || starts.is_empty() {
        return all.remove(0);
    }
    for other in others.into_iter().take(MOST_FAMILIES - 1) {
        all.push(located::solution(model, other, options));
    }
    let families = families(&all, &counts);
    let worth = |it: &Solution| it.problem.sense * it.objective();
    let certified = (0..all.len()).filter(|at| all[*at].is_certified());
    let best = certified.min_by(|a, b| worth(&all[*a]).total_cmp(&worth(&all[*b]))).unwrap_or(0);
    let mut best = all.swap_remove(best);
    (best.starts, best.families) = (starts, families);
    best
}

/// How many starts lead to each of some objectives; each to the first that is its own.
fn counts(starts: &[Ended], objectives: &[f64]) -> Vec<usize> {
    let mut counts = vec![0; objectives.len()];
    for start in starts.iter().filter(|it| it.is_solved) {
        let own = objectives.iter().position(|it| is_same(start.objective, *it));
        own.into_iter().for_each(|at| counts[at] += 1);
    }
    counts
}

/// One for each optimum, in the order in which they were found.
fn families(all: &[Solution], counts: &[usize]) -> Vec<Family> {
    let mut families: Vec<Family> = Vec::new();
    for (solution, starts) in all.iter().zip(counts) {
        let (objective, is_certified) = (solution.objective(), solution.is_certified());
        let known = families
            .iter_mut()
            .find(|it| it.is_certified == is_certified && is_same(it.objective, objective));
        match known {
            Some(family) => family.starts += starts,
            None => families.push(Family { objective, is_certified, starts: *starts }),
        }
    }
    families
}

/// Whether two objectives are those of one optimum.
pub(super) fn is_same(a: f64, b: f64) -> bool {
    (a - b).abs() <= SAME * a.abs().max(b.abs())
}
