//! Phases as what stands outside of them reads them: each is resolved before, as a model by
//! itself.

mod distribute;
mod integrals;
mod links;
mod sums;

pub(crate) use distribute::distribute;
pub(crate) use links::in_order;

use super::elaborator::Elaborator;
use super::elaborator::value::{Parts, Reads, Traits, Value};
use crate::expressions::graph::ExprId;
use crate::model::phases::moved;
use crate::model::{Free, Param, Place, Symbol};
use crate::syntax::scope;
use fdcc_grammar::Span;
use fdcc_grammar::ast::{Ident, Item};
use std::collections::HashMap;

impl<'a> Elaborator<'a> {
    /// The phase of a name, as a place among those that have been resolved.
    fn phase_named(&self, name: &str) -> Option<usize> {
        self.phases.iter().position(|phase| phase.name.name == name)
    }

    /// `coast.h`: a name of a phase. Within a phase nothing is known of the others.
    pub fn of_phase(
        &mut self,
        phase: &str,
        items: &'a [Item],
        part: &'a Ident,
        span: Span,
    ) -> Value {
        let own: Vec<&Ident> = items.iter().filter_map(scope::declared).collect();
        let Some(at) = self.phase_named(phase) else {
            if !own.iter().any(|it| it.name == part.name) {
                return self.no_part(Value::default(), part, &own);
            }
            let foreign = Traits { reads: Reads::FOREIGN, ..Traits::default() };
            return self.admit(&format!("{phase}.{}", part.name), Value::unknown(foreign), span);
        };
        let Some(named) = self.phases[at].names.get(part.name.as_str()) else {
            return self.no_part(Value::default(), part, &own);
        };
        let (mut value, parts_of) = (named.value.clone(), named.parts_of);
        value.parts = Parts::from_list(&self.import(at, value.parts.as_slice()));
        value.traits.reads = value.traits.reads.or(Reads::PHASE);
        value.traits = value.traits.used_at(span);
        value.named = parts_of.map(|item| self.name_from(item));
        self.admit(&format!("{phase}.{}", part.name), value, span)
    }

    /// Symbols for the parameters and unknowns of all phases; and states that stand outside of all
    /// phases begin with the first one and end with the last.
    pub fn adopt_phases(&mut self) {
        let outer = [self.model.params.len(), self.model.frees.len()];
        for phase in 0..self.phases.len() {
            let first = [self.model.params.len(), self.model.frees.len()];
            let meaning = &mut self.phases[phase].meaning;
            for symbol in &mut meaning.symbols {
                match symbol {
                    Symbol::Param(at) if *at >= outer[0] => *at = *at - outer[0] + first[0],
                    Symbol::Free(at) if *at >= outer[1] => *at = *at - outer[1] + first[1],
                    _ => {}
                }
            }
            let params = meaning.model.params.split_off(outer[0]);
            let frees = meaning.model.frees.split_off(outer[1]);
            self.param_values.extend(meaning.param_values.split_off(outer[0]));
            params.into_iter().for_each(|param| self.adopt_param(phase, param));
            frees.into_iter().for_each(|free| self.adopt_free(phase, free));
        }
        let Some(last) = self.phases.len().checked_sub(1) else { return };
        for (end, phase) in [0, last].into_iter().enumerate() {
            let shared = self.model.states.len();
            let Elaborator { at_ends, interval, .. } = &self.phases[phase].meaning;
            let (states, time) = (at_ends[end][..shared].to_vec(), interval[end]);
            self.at_ends[end] = self.import(phase, &states);
            self.interval[end] = self.import(phase, &[time])[0];
        }
    }

    fn adopt_param(&mut self, phase: usize, param: Param) {
        let place = self.prefixed(phase, param.place);
        self.symbol(Symbol::Param(self.model.params.len()));
        self.model.params.push(Param { place, ..param });
    }

    fn adopt_free(&mut self, phase: usize, free: Free) {
        let place = self.prefixed(phase, free.place);
        self.symbol(Symbol::Free(self.model.frees.len()));
        self.model.frees.push(Free { place, ..free });
    }

    fn prefixed(&self, phase: usize, place: Place) -> Place {
        Place { name: format!("{}.{}", self.phases[phase].name.name, place.name), ..place }
    }

    /// Values, bounds and guesses of what has been adopted, once all symbols are there.
    pub fn adopt_values(&mut self, outer: [usize; 2]) {
        let [mut param, mut free] = outer;
        for phase in 0..self.phases.len() {
            let prefix = format!("{}.", self.phases[phase].name.name);
            let order = self.phases[phase].meaning.model.param_order.clone();
            let own = order.into_iter().filter(|at| *at >= outer[0]);
            let first = param;
            self.model.param_order.extend(own.map(|at| at - outer[0] + first));
            let is_own = |place: &Place| place.name.starts_with(&prefix);
            while self.model.params.get(param).is_some_and(|it| is_own(&it.place)) {
                let Param { value, range, .. } = self.model.params[param].clone();
                let mut take = |id| self.import(phase, &[id])[0];
                let (value, range) = (value.map(&mut take), moved(range, &mut take));
                (self.model.params[param].value, self.model.params[param].range) = (value, range);
                param += 1;
            }
            while self.model.frees.get(free).is_some_and(|it| is_own(&it.place)) {
                let Free { guess, range, .. } = self.model.frees[free].clone();
                let mut take = |id| self.import(phase, &[id])[0];
                let (guess, range) = (guess.map(&mut take), moved(range, &mut take));
                (self.model.frees[free].guess, self.model.frees[free].range) = (guess, range);
                free += 1;
            }
            for (free, guess) in std::mem::take(&mut self.phases[phase].meaning.guessed) {
                if free < outer[1] {
                    self.model.frees[free].guess = Some(self.import(phase, &[guess])[0]);
                }
            }
        }
    }

    /// States and times of phases, and what each is at an end of its phase.
    pub fn ends_of_phases(&mut self, parts: &[ExprId], at_end: bool) -> HashMap<u32, ExprId> {
        let mut ends = HashMap::new();
        for read in self.graph.inputs_of(parts) {
            let Symbol::OfPhase { phase, input } = self.symbols[read as usize] else { continue };
            let meaning = &self.phases[phase].meaning;
            let end = match meaning.symbols[input as usize] {
                Symbol::State(at) => meaning.at_ends[at_end as usize][at],
                Symbol::Time => meaning.interval[at_end as usize],
                _ => continue,
            };
            ends.insert(read, self.import(phase, &[end])[0]);
        }
        ends
    }
}
