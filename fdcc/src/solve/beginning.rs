//! Where a solve begins that starts at an earlier solution.

use super::Solution;
use crate::record::Record;
use crate::warm_start::from_record;
use fdcc_compiler::is_kink;
use fdcc_runtime::nlp::Start;
use fdcc_runtime::problem::{Chain, Problem};
use fdcc_runtime::solve::warm_start::{again, one_interval_later};

impl Solution {
    /// Where another solve begins that starts at this one: with all multipliers if the grid is the
    /// same.
    pub(super) fn as_start(&self, chain: &Chain) -> Start {
        match self.has_grid_of(chain) {
            true => again(chain, &self.outcome.solution, self.chosen_widths()),
            false => {
                let mut controls = chain.phases.iter().flat_map(|it| &it.controls);
                let has_kinks = controls.any(|it| is_kink(&it.name));
                let record = self.record();
                // Nodes of controls have to be those of all controls.
                let nodes = record.nodes.clone().filter(|_| !has_kinks);
                from_record(&Record { nodes, ..record }, chain)
            }
        }
    }

    /// The same for a solve one interval later.
    pub(super) fn as_later_start(&self, chain: &Chain) -> Start {
        let is_uniform = chain.phases.len() == 1 && chain.method().grid.times().is_empty();
        match self.has_grid_of(chain) && is_uniform {
            true => one_interval_later(chain, &self.outcome.solution, self.chosen_widths()),
            false => self.as_start(chain),
        }
    }

    fn has_grid_of(&self, chain: &Chain) -> bool {
        let shape = |problem: &Problem| {
            let method = &problem.method;
            let sizes = [problem.controls.len(), problem.unknowns.len(), problem.path_bounds.len()];
            let grid = method.grid.times().to_vec();
            (method.intervals(), method.scheme, method.controls, grid, sizes)
        };
        let own: Vec<&Problem> = match (&self.whole, &self.between_jumps) {
            (Some(whole), _) => whole.chain.phases.iter().collect(),
            (None, Some(between)) => between.chain.phases.iter().collect(),
            (None, None) => vec![&self.problem],
        };
        own.into_iter().map(shape).eq(chain.phases.iter().map(shape))
    }

    fn chosen_widths(&self) -> &[f64] {
        if self.has_chosen_widths() { &self.outcome.sigma } else { &[] }
    }
}
