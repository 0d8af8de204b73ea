//! Conditions at the first time, where the start is chosen.
//!
//! Bounds of states, path conditions and sides of surfaces hold at the nodes of the collocation,
//! which say nothing of the first time. What is held or on an arc from the first time on begins
//! there.

use super::independent::Independent;
use super::{Arc, Mode, Modes};
use crate::expressions::graph::ExprId;
use crate::model::{Constraint, Model, Place, Range, Symbol};

impl Modes<'_> {
    /// Those of the first phase; none of what is given at the start.
    pub(super) fn starts(&mut self) -> Vec<Constraint> {
        let mut known = Independent::default();
        let mut rows = self.surfaces_at_start(&mut known);
        rows.extend(self.limits_at_start(&mut known));
        rows
    }

    fn surfaces_at_start(&mut self, known: &mut Independent) -> Vec<Constraint> {
        let (model, phases) = (self.between.division.model, self.phases);
        let mut rows = Vec::new();
        for (switch, mode) in model.switches().iter().zip(&phases[0].modes) {
            let range = match mode {
                Mode::Held => self.between.division.exactly_zero(),
                Mode::Above => self.between.division.not_below(),
                Mode::Below => self.between.division.not_above(),
            };
            let is_held = *mode == Mode::Held;
            for surface in &model.surfaces[switch.surfaces.clone()] {
                let is_asked = (is_held || !switch.is_ball) && self.is_chosen(surface.psi);
                let is_told = is_asked && !self.is_linked_to_zero(surface.psi);
                if is_told && (!is_held || known.add(self, surface.psi)) {
                    rows.push(self.at_start(&surface.place, surface.psi, range));
                }
            }
        }
        rows
    }

    fn limits_at_start(&mut self, known: &mut Independent) -> Vec<Constraint> {
        let first = &self.phases[0];
        let moving = self.moving(first);
        let states = self.all_bounds_of_states();
        let mut rows = Vec::new();
        for (row, arc) in states.iter().chain(&moving.path).zip(&first.contacts) {
            let range = self.between.division.exactly_zero();
            let (values, range) = match self.rates_of(row, *arc, &moving) {
                Some(rates) => (rates[..rates.len() - 1].to_vec(), range),
                None if self.is_linked_to_bound(row) => continue,
                None if self.is_of_states(row.value) => (vec![row.value], row.range),
                None => continue,
            };
            for value in values {
                let is_told = self.is_chosen(value) && !self.is_linked_to_zero(value);
                if is_told && (*arc == Arc::Free || known.add(self, value)) {
                    rows.push(self.at_start(&row.place, value, range));
                }
            }
        }
        rows
    }

    /// Whether links say that it is 0 at the first time.
    fn is_linked_to_zero(&mut self, value: ExprId) -> bool {
        let (division, linked) = (&self.between.division, &mut self.linked);
        let own = (&division.graph, &division.symbols[..]);
        linked.as_mut().is_some_and(|it| it.is_zero(own, value))
    }

    /// Whether links put it on one of its bounds.
    fn is_linked_to_bound(&mut self, row: &Constraint) -> bool {
        [row.range.lower, row.range.upper].into_iter().any(|bound| {
            let gap = self.between.division.graph.sub(row.value, bound);
            self.is_linked_to_zero(gap)
        })
    }

    /// Whether it reads a state whose start is chosen.
    fn is_chosen(&self, value: ExprId) -> bool {
        let division = &self.between.division;
        let is_chosen = |at: &u32| match division.symbols[*at as usize] {
            Symbol::State(state) => self.has_open_start(state),
            _ => false,
        };
        division.graph.inputs_of(&[value]).iter().any(is_chosen)
    }

    fn has_open_start(&self, state: usize) -> bool {
        let model = self.between.division.model;
        model.states[state].start.is_none_or(|start| self.reads_unknown(start))
    }

    /// What the jumps until the beginning of phase `j` assign to a state.
    fn resets_until(&self, j: usize, state: usize) -> Vec<ExprId> {
        let jumps = (0..j).filter(|at| self.phases[at + 1].jump.is_some());
        let resets = jumps.flat_map(|at| &self.between.jump(at).resets);
        resets.filter(|it| it.0 == state).map(|it| it.1).collect()
    }

    /// Whether it reads an unknown, or a control, as a reset may.
    fn reads_chosen(&self, value: ExprId) -> bool {
        let symbols = &self.between.division.symbols;
        let inputs = self.between.division.graph.inputs_of(&[value]);
        let is_control = |at: &u32| matches!(symbols[*at as usize], Symbol::Control(_));
        self.reads_unknown(value) || inputs.iter().any(is_control)
    }

    fn reads_unknown(&self, value: ExprId) -> bool {
        let symbols = &self.between.division.symbols;
        let inputs = self.between.division.graph.inputs_of(&[value]);
        inputs.iter().any(|at| matches!(symbols[*at as usize], Symbol::Free(_)))
    }

    /// Whether unknowns or starts that are chosen move a value of phase `j` on which no control
    /// acts there: along the motion, or where jumps before it reset what it depends on.
    pub(super) fn is_open(&self, j: usize, moving: &Model, value: ExprId) -> bool {
        let ends = moving.interval.iter().any(|it| self.reads_unknown(*it));
        let (mut seen, mut all) = (Vec::new(), vec![value]);
        while let Some(next) = all.pop() {
            if ends || self.reads_chosen(next) {
                return true;
            }
            for at in self.between.division.graph.inputs_of(&[next]) {
                let Symbol::State(state) = self.between.division.symbols[at as usize] else {
                    continue;
                };
                if self.has_open_start(state) {
                    return true;
                }
                if !seen.contains(&state) {
                    seen.push(state);
                    all.push(moving.states[state].rate);
                    all.extend(self.resets_until(j, state));
                }
            }
        }
        false
    }

    pub(super) fn is_of_states(&self, value: ExprId) -> bool {
        let division = &self.between.division;
        let is_control = |at: &u32| matches!(division.symbols[*at as usize], Symbol::Control(_));
        !division.graph.inputs_of(&[value]).iter().any(is_control)
    }

    fn at_start(&mut self, place: &Place, value: ExprId, range: Range) -> Constraint {
        let value = self.between.division.at_own_start(value);
        let place = Place { name: format!("{} at the start", place.name), ..place.clone() };
        Constraint { place, value, range }
    }
}
