//! Whether the multipliers of a chain are the only ones.

use crate::nlp::other_multipliers::other_multipliers;
use crate::problem::Chain;
use crate::solution::ChainOutcome;
use crate::transcribe::chain::{ChainNlp, own_multipliers};

/// The same optimum with other multipliers, which meet the optimality conditions as well; nothing
/// where they are unique. What depends on which they are, the optimum does not tell.
pub fn with_other_multipliers(chain: &Chain, outcome: &ChainOutcome) -> Option<ChainOutcome> {
    let mut nlp = ChainNlp::new(chain);
    nlp.set_widths(&outcome.sigma);
    let multipliers = other_multipliers(&mut nlp, &outcome.solution)?;
    let mut other = outcome.clone();
    for (own, phase) in other.phases.iter_mut().zip(&nlp.shape().phases) {
        own.solution.multipliers = own_multipliers(phase, &multipliers);
    }
    other.solution.multipliers = multipliers;
    Some(other)
}
