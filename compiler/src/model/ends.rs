//! Which controls conditions at the ends of time read, and links.

use super::{Model, Symbol};
use crate::expressions::graph::ExprId;

impl Model {
    /// Whether a condition at the ends, or the objective, reads the first value of a control, and
    /// whether one reads the last.
    pub fn conditions_read(&self, control: usize) -> [bool; 2] {
        let rows = self.boundary.iter().map(|it| it.value);
        let values: Vec<ExprId> = rows.chain(self.objective.iter().map(|it| it.1)).collect();
        let read = self.graph.inputs_of(&values);
        let reads = |symbol| read.iter().any(|at| self.symbols[*at as usize] == symbol);
        [Symbol::ControlAtStart(control), Symbol::ControlAtEnd(control)].map(reads)
    }

    /// The same of the links of a model with phases, for a control of one of them.
    pub fn links_read(&self, phase: usize, control: usize) -> [bool; 2] {
        let of_link = |link: &super::Link| -> Vec<ExprId> {
            link.rows.iter().map(|it| it.value).chain(link.objective).collect()
        };
        let values: Vec<ExprId> = self.links.iter().flat_map(of_link).collect();
        let read = self.graph.inputs_of(&values);
        let symbols = &self.phases[phase].model.symbols;
        let reads = |symbol| {
            read.iter().any(|at| match self.symbols[*at as usize] {
                Symbol::OfPhase { phase: own, input } => {
                    own == phase && symbols[input as usize] == symbol
                }
                _ => false,
            })
        };
        [Symbol::ControlAtStart(control), Symbol::ControlAtEnd(control)].map(reads)
    }
}
