//! How far the unknowns of a chain can change.

use super::tuning::covariance::LEAST;
use crate::nlp::Covariance;
use crate::nlp::covariance::{covariance, size_of};
use crate::problem::{Chain, Parameter, Unknown};
use crate::solution::ChainOutcome;
use crate::transcribe::chain::ChainNlp;

/// The inverse of the Hessian of the Lagrangian of the minimisation problem over all unknowns, with
/// everything else following, where the objective is about `unit` times a number of order 1; none
/// where the answer is no minimum in what no bound holds.
pub fn covariance_of_chain(chain: &Chain, outcome: &ChainOutcome, unit: f64) -> Option<Covariance> {
    let mut nlp = ChainNlp::new(chain);
    nlp.set_widths(&outcome.sigma);
    let [first, last] = nlp.shape().unknowns;
    let values = outcome.solution.v[first..last].iter();
    let sizes: Vec<f64> =
        values.zip(&chain.unknowns).map(|(value, it)| size(chain, *value, it)).collect();
    covariance(&mut nlp, &outcome.solution, first..last, (&sizes, unit))
}

/// How large an unknown may be taken to be, also where it is 0 or almost 0 at a bound.
fn size(chain: &Chain, value: f64, unknown: &Unknown) -> f64 {
    let own = size_of(value, &unknown.bounds);
    if (unknown.bounds.upper - unknown.bounds.lower).is_finite() && own > 0.0 {
        return own;
    }
    let Parameter { value: guess, unit, .. } = &chain.phases[0].parameters[unknown.parameter];
    own.max(LEAST * if *guess == 0.0 { *unit } else { guess.abs() })
}
