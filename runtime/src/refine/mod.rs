//! `N = auto`: solve, estimate the error of each step, divide the intervals where it is large, and solve again from there.
//!
//! The error of a step is the difference between its end and that of an accurate integration of the same smoothed system from
//! the same state with the same control ([`estimate`]). With an error `e_k ~ C_k h_k^(p+1)` for a scheme of order `p`, dividing interval
//! `k` into `m_k` parts leaves `e_k / m_k^p`; the sum of all is at the tolerance with the fewest intervals where `m_k` is in proportion to
//! `e_k^(1/(p+1))`.

mod carry;
mod estimate;

use crate::homotopy::{self, Outcome, Refusal, Watch};
use crate::nlp::{Start, Status};
use crate::problem::Problem;
use crate::transcribe::TranscribedNlp;
use carry::carried;
use estimate::step_errors;

/// More intervals than this are not tried.
const MOST: usize = 20_000;
const MOST_ROUNDS: usize = 12;
/// Of what the tolerance allows, so much is planned for.
const PLANNED: f64 = 0.7;
/// An interval is divided into no more parts at a time: far from the limit errors fall in other ways.
const MOST_PARTS: f64 = 4.0;

/// A solution and the grid that it was found on.
pub struct Refined {
    /// The problem on its last grid.
    pub problem: Problem,
    /// Its solution.
    pub outcome: Outcome,
    /// The sum of the errors of all steps, if they were asked for.
    pub error: Option<f64>,
}

/// Solves a problem, on a grid of our own choice where it asks for that.
pub fn solve(problem: &Problem, start: Option<Start>, watch: &mut Watch) -> Result<Refined, Refusal> {
    let mut problem = problem.clone();
    if !problem.method.is_refined {
        let outcome = homotopy::solve(&problem, start, watch)?;
        return Ok(Refined { problem, outcome, error: None });
    }
    let mut outcome = homotopy::solve(&problem, start, watch)?;
    let mut error = None;
    for _ in 0..MOST_ROUNDS {
        if !is_good(&outcome) {
            break;
        }
        let errors = step_errors(&problem, &outcome);
        let sum = errors.iter().sum();
        error = Some(sum);
        let parts = parts(&errors, problem.method.scheme.order(), problem.method.tolerance);
        let intervals: usize = parts.iter().sum();
        if sum <= problem.method.tolerance || intervals > MOST {
            break;
        }
        let finer = divided(&problem, &parts);
        let next = again(&problem, &outcome, &finer, &parts, watch)?;
        // A finer grid that cannot be solved is no reason to lose the answer on this one.
        if !is_good(&next) {
            break;
        }
        (problem, outcome) = (finer, next);
    }
    Ok(Refined { problem, outcome, error })
}

fn is_good(outcome: &Outcome) -> bool {
    matches!(outcome.solution.status, Status::Solved | Status::Acceptable)
}

/// The solution on a finer grid, from that on the grid before and with its widths.
fn again(
    problem: &Problem,
    outcome: &Outcome,
    finer: &Problem,
    parts: &[usize],
    watch: &mut Watch,
) -> Result<Outcome, Refusal> {
    let (from, to) = (TranscribedNlp::new(problem), TranscribedNlp::new(finer));
    let start = carried(&from, &outcome.solution, &to, parts);
    homotopy::solve_near(finer, start, outcome, watch)
}

/// Into how many parts each interval is divided.
fn parts(errors: &[f64], order: usize, tolerance: f64) -> Vec<usize> {
    let (p, q) = (order as f64, 1.0 / (order as f64 + 1.0));
    let shares: f64 = errors.iter().map(|error| error.powf(q)).sum();
    let factor = (shares / (PLANNED * tolerance)).powf(1.0 / p);
    let parts = errors.iter().map(|error| (factor * error.powf(q)).ceil().clamp(1.0, MOST_PARTS) as usize);
    parts.collect()
}

fn divided(problem: &Problem, parts: &[usize]) -> Problem {
    let mut finer = problem.clone();
    let method = &mut finer.method;
    let uniform = |k: usize| k as f64 / parts.len() as f64;
    let point = |k: usize| problem.method.mesh.get(k).copied().unwrap_or_else(|| uniform(k));
    method.mesh = Vec::new();
    for (k, parts) in parts.iter().enumerate() {
        let length = (point(k + 1) - point(k)) / *parts as f64;
        method.mesh.extend((0..*parts).map(|part| point(k) + part as f64 * length));
    }
    method.intervals = method.mesh.len();
    method.mesh.push(1.0);
    finer
}

#[cfg(test)]
mod tests {
    use super::parts;

    #[test]
    fn equal_errors_are_divided_equally_and_none_not_at_all() {
        assert_eq!(parts(&[1e-3; 10], 1, 5e-3 / 0.7), [2; 10]);
        assert_eq!(parts(&[0.0, 1.0], 2, 1e-6), [1, 4]);
        assert_eq!(parts(&[1e-9; 4], 4, 1e-3), [1; 4]);
    }

    /// What is left of the sum is what was planned, where nothing is cut.
    #[test]
    fn the_sum_that_is_left_is_what_was_planned() {
        let errors: Vec<f64> = (1..=40).map(|k| 1e-3 * f64::from(k * k)).collect();
        let tolerance = 0.05 * errors.iter().sum::<f64>();
        let parts = parts(&errors, 2, tolerance);
        let left: f64 = errors.iter().zip(&parts).map(|(error, parts)| error / (parts * parts) as f64).sum();
        assert!(parts.iter().all(|parts| *parts <= 4) && left < 1.6 * tolerance, "{parts:?} {left}");
    }
}
