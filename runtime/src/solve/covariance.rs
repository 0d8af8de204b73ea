//! How far the unknowns of a chain can change.

use super::tuning::covariance::LEAST;
use crate::nlp::Covariance;
use crate::nlp::covariance::covariance;
use crate::problem::{Chain, Unknown};
use crate::solution::ChainOutcome;
use crate::transcribe::chain::ChainNlp;

/// The inverse of the Hessian of the Lagrangian of the minimisation problem over all unknowns, with
/// everything else following, where the objective is about `unit` times a number of order 1; none
/// where the answer is no minimum.
pub fn covariance_of_chain(chain: &Chain, outcome: &ChainOutcome, unit: f64) -> Option<Covariance> {
    let mut nlp = ChainNlp::new(chain);
    nlp.set_widths(&outcome.sigma);
    let [first, last] = nlp.shape().unknowns;
    let values = outcome.solution.v[first..last].iter();
    let size = |(value, unknown): (&f64, &Unknown)| {
        let width = unknown.bounds.upper - unknown.bounds.lower;
        let least = if width.is_finite() { LEAST * width } else { 0.0 };
        match value.abs().max(least) {
            size if size > 0.0 => size,
            _ => 1.0,
        }
    };
    let sizes: Vec<f64> = values.zip(&chain.unknowns).map(size).collect();
    covariance(&mut nlp, &outcome.solution, first..last, (&sizes, unit))
}
