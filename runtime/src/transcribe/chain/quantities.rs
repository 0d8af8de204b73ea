//! Which variables and constraints of a chain are one quantity of the model at different times.

use super::ChainNlp;
use crate::nlp::{Nlp, Quantities};

impl ChainNlp<'_> {
    /// Signals of all phases, then unknowns; conditions of all phases, then those of the links.
    pub(super) fn all_quantities(&self) -> Quantities {
        let each: Vec<_> = self.parts.iter().map(|part| part.nlp.quantities()).collect();
        let stepped = each.iter().map(|of| of.stepped).sum();
        let (mut variables, mut constraints, mut units) = (Vec::new(), Vec::new(), Vec::new());
        let (mut signals, mut conditions) = (0, stepped);
        for (part, of) in self.parts.iter().zip(&each) {
            variables
                .extend(of.variables[..part.shape.variables.len()].iter().map(|it| it + signals));
            let own = |it: &usize| match it.checked_sub(of.stepped) {
                Some(condition) => condition + conditions,
                None => it + signals,
            };
            constraints.extend(of.constraints.iter().map(own));
            let last = of.constraints.iter().max().map_or(0, |last| last + 1);
            (signals, conditions) =
                (signals + of.stepped, conditions + last.saturating_sub(of.stepped));
            units.extend_from_slice(&of.units[..of.stepped]);
        }
        variables.extend((0..self.chain.unknowns.len()).map(|unknown| stepped + unknown));
        constraints.extend((0..self.shape.links).map(|row| conditions + row));
        let first = &self.chain.phases[0].parameters;
        units.extend(self.chain.unknowns.iter().map(|it| first[it.parameter].unit));
        Quantities { variables, constraints, stepped, units }
    }
}
