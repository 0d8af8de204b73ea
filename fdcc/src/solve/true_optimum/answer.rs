//! A located optimum as one trajectory, in the words of the model.

use super::Located;
use fdcc_compiler::Mode;
use fdcc_runtime::problem::Problem;
use fdcc_runtime::solution::modes::{self, Span};
use fdcc_runtime::solution::phases::located;
use fdcc_runtime::solve::Outcome;

impl Located {
    /// All phases one after the other; `between` is the smoothed problem.
    pub fn whole(&self, between: &Problem) -> Outcome {
        let modes = (0..between.surfaces.len()).map(|surface| self.spans(surface)).collect();
        located(between, &self.chain, &self.outcome, modes)
    }

    /// What a surface does from when to when.
    fn spans(&self, surface: usize) -> Vec<Span> {
        let mut spans: Vec<Span> = Vec::new();
        for (phase, pair) in self.structure.phases.iter().zip(self.structure.times.windows(2)) {
            let mode = match phase.modes[surface] {
                Mode::Below => modes::Mode::Below,
                Mode::Held => modes::Mode::Held,
                Mode::Above => modes::Mode::Above,
            };
            match spans.last_mut().filter(|it| it.mode == mode) {
                Some(span) => span.to = pair[1],
                None => spans.push(Span { mode, from: pair[0], to: pair[1] }),
            }
        }
        spans
    }
}
