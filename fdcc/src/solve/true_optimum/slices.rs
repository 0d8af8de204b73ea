//! What belongs to one phase of a model, in a chain in which each of its phases is a chain.
//!
//! The links within the phases come before those that were written, in the order of the phases.

use fdcc_compiler::Model;
use fdcc_runtime::problem::Chain;
use fdcc_runtime::solve::ChainOutcome;
use std::ops::Range;

/// Places in the chain of all phases.
pub(crate) struct Slice {
    pub phases: Range<usize>,
    pub links: Range<usize>,
}

/// Of each phase of a model, of which the chain has so many; `written` is how many links the model
/// has that is `divided`.
pub(crate) fn slices(
    (divided, written): (&Model, usize),
    chain: &Chain,
    counts: impl Iterator<Item = usize>,
) -> Vec<Slice> {
    let links = &divided.links[..divided.links.len() - written];
    let told = links.iter().filter(|it| it.objective.is_some() || !it.rows.is_empty()).count();
    let (mut phase, mut link) = (0, 0);
    let slice = |count: usize| {
        let phases = phase..phase + count;
        let is_own =
            |at: &usize| chain.links[*at].ends.iter().all(|end| phases.contains(&end.phase()));
        let links = link..link + (link..told).take_while(is_own).count();
        (phase, link) = (phases.end, links.end);
        Slice { phases, links }
    };
    counts.map(slice).collect()
}

impl Slice {
    /// Its phases and links; the unknowns are those of all.
    pub fn chain(&self, chain: &Chain) -> Chain {
        Chain {
            phases: chain.phases[self.phases.clone()].to_vec(),
            links: chain.links[self.links.clone()].to_vec(),
            name: chain.name.clone(),
            unknowns: chain.unknowns.clone(),
        }
    }

    /// Its part of an outcome, with the multipliers of its links.
    pub fn outcome(&self, chain: &Chain, outcome: &ChainOutcome) -> ChainOutcome {
        // All phases together have as many phases times as many numbers.
        let mut solution = outcome.solution.without_vectors();
        solution.multipliers.constraints = self.multipliers(chain, outcome);
        ChainOutcome {
            solution,
            phases: outcome.phases[self.phases.clone()].to_vec(),
            sigma: outcome.sigma.clone(),
            limiting: outcome.limiting.clone(),
            attempts: outcome.attempts.clone(),
            ..*outcome
        }
    }

    /// Those of its links; the links of all phases come last.
    fn multipliers(&self, chain: &Chain, outcome: &ChainOutcome) -> Vec<f64> {
        let count = |links: Range<usize>| -> usize {
            chain.links[links].iter().map(|it| it.bounds.len()).sum()
        };
        let rows = &outcome.solution.multipliers.constraints;
        let behind = count(self.links.start..chain.links.len());
        let first = rows.len() - behind;
        rows[first..first + count(self.links.clone())].to_vec()
    }
}
