//! Path constraints of the phases: what is written, and that no other jump happens on the way.
//!
//! Until a `falling` jump happens `psi >= 0`, until a `rising` one `psi <= 0`; the other way round
//! where the state begins beyond the surface, until it crosses that. On the surface itself, at the
//! end of a phase, such a condition holds by what ends the phase, and would be told twice: there it
//! gives way.

use super::MultiPhase;
use super::hold::approach;
use crate::expressions::graph::derivative::derivative;
use crate::expressions::graph::{ExprId, Graph};
use crate::model::{Constraint, Jump, Place, Range, Symbol};
use fdcc_grammar::ast::Direction;

impl MultiPhase<'_> {
    /// The bounds of a state at all times; none where they are a path constraint.
    pub(super) fn range_of(&mut self, state: usize) -> Range {
        let range = self.division.model.states[state].range;
        if !self.bounds_switching_function(state) {
            return range;
        }
        let [lower, upper] =
            [f64::NEG_INFINITY, f64::INFINITY].map(|it| self.division.graph.number(it));
        Range { lower, upper }
    }

    /// What is written, then what the jumps add; and which of these rows give way at the end of the
    /// phase.
    pub(super) fn path(&mut self, j: usize) -> (Vec<Constraint>, Vec<usize>) {
        let mut rows = self.division.model.path.clone();
        rows.extend(self.bounds());
        rows.extend(self.sides(j));
        let half_open = (0..rows.len()).filter(|at| self.ends_on(j, rows[*at].value)).collect();
        for row in &mut rows {
            self.give_way(j, row);
        }
        (rows, half_open)
    }

    /// Makes a row say nothing where a held surface says the same.
    pub(super) fn give_way(&mut self, j: usize, row: &mut Constraint) {
        if self.is_held(j, row) {
            row.value = within(&mut self.division.graph, row.range);
        }
    }

    /// Bounds of states that are functions of a surface.
    fn bounds(&mut self) -> Vec<Constraint> {
        let mut rows = Vec::new();
        for (index, state) in self.division.model.states.iter().enumerate() {
            if self.bounds_switching_function(index) {
                let value = self.division.graph.input(self.division.input_of_state(index));
                rows.push(Constraint { place: state.place.clone(), value, range: state.range });
            }
        }
        rows
    }

    /// Whether a state is the function of a surface where a jump happens.
    fn bounds_switching_function(&self, state: usize) -> bool {
        let input = self.division.input_of_state(state);
        let is_it = |jump: &usize| {
            let psi = self.whole().surfaces[self.whole().jumps[*jump].surface].psi;
            self.whole().graph.inputs_of(&[psi]) == [input]
        };
        self.sequence.iter().any(is_it)
    }

    /// On which sides of the surfaces a phase stays.
    pub(super) fn sides(&mut self, j: usize) -> Vec<Constraint> {
        let whole = self.whole();
        let mut rows = Vec::new();
        let own = &whole.jumps[..self.jumps.begins.len()];
        for (index, jump) in own.iter().enumerate() {
            if !self.may_happen(j, index) {
                continue;
            }
            if has_both(own, jump) {
                rows.extend(self.side_of_both(j, index));
                continue;
            }
            let range = match (self.is_not_yet_before(j, index), jump.direction) {
                (false, _) if self.is_beyond(j, index) => continue,
                (true, _) if self.is_moved(j, index) => continue,
                (false, Direction::Falling) | (true, Direction::Rising) => {
                    self.division.not_below()
                }
                (false, Direction::Rising) | (true, Direction::Falling) => {
                    self.division.not_above()
                }
            };
            rows.push(Constraint {
                place: jump.place.clone(),
                value: whole.surfaces[jump.surface].psi,
                range,
            });
        }
        rows.retain(|row| !self.is_written(row));
        rows
    }

    /// That a jump does not happen whose surface has jumps in both directions, where the one before
    /// or the one behind tells on which side the state is.
    fn side_of_both(&mut self, j: usize, index: usize) -> Option<Constraint> {
        let jump = &self.whole().jumps[index];
        let range = match (jump.direction, self.is_above(j, index)?) {
            (Direction::Falling, true) => self.division.not_below(),
            (Direction::Rising, false) => self.division.not_above(),
            _ => return None,
        };
        let value = self.whole().surfaces[jump.surface].psi;
        Some(Constraint { place: jump.place.clone(), value, range })
    }

    /// Whether the function of the surface of a jump is above 0 in a phase: until a falling one,
    /// and behind one at which the state turns back.
    fn is_above(&self, j: usize, index: usize) -> Option<bool> {
        if self.is_moved(j, index) {
            return None;
        }
        let surface = self.whole().jumps[index].surface;
        let is_there = |at: &&usize| self.whole().jumps[**at].surface == surface;
        let falls = |at: usize| self.whole().jumps[at].direction == Direction::Falling;
        let (before, behind) = self.sequence.split_at(self.count_before(j));
        if let Some(next) = behind.iter().find(is_there) {
            return Some(falls(*next));
        }
        let last = *before.iter().rev().find(is_there)?;
        let turns = self.jumps.turns.get(last).copied().flatten()?;
        Some(falls(last) == turns)
    }

    /// Whether a path constraint of the model, or the bounds of a state, say the same.
    fn is_written(&self, row: &Constraint) -> bool {
        let model = self.division.model;
        let number = |id| self.division.graph.as_number(id).unwrap_or(f64::NAN);
        let within = |range: Range| {
            number(range.lower) >= number(row.range.lower)
                && number(range.upper) <= number(row.range.upper)
        };
        let is_state = |at: &usize| {
            let input = self.division.input_of_state(*at);
            self.division.graph.clone().input(input) == row.value
        };
        let mut states = (0..model.states.len()).filter(is_state);
        let mut rows = model.path.iter().filter(|it| it.value == row.value);
        states.any(|at| within(model.states[at].range)) || rows.any(|it| within(it.range))
    }

    /// Whether a jump has not yet happened as often as it may.
    fn may_happen(&self, j: usize, index: usize) -> bool {
        let before =
            self.sequence[..self.count_before(j)].iter().filter(|it| **it == index).count();
        self.jumps.limits[index].is_none_or(|limit| before < limit)
    }

    /// Whether the state began beyond the surface, and has not come back through it.
    fn is_not_yet_before(&self, j: usize, index: usize) -> bool {
        let crossing = index + self.jumps.begins.len();
        match self.sequence.iter().position(|it| *it == index || *it == crossing) {
            Some(first) => self.sequence[first] == crossing && self.count_before(j) <= first,
            None => self.jumps.begins[index].is_beyond(),
        }
    }

    /// Whether an earlier jump may have moved the state through the surface.
    fn is_moved(&self, j: usize, index: usize) -> bool {
        let read = self
            .whole()
            .graph
            .inputs_of(&[self.whole().surfaces[self.whole().jumps[index].surface].psi]);
        let earlier = &self.sequence[..self.count_before(j)];
        let resets = earlier.iter().flat_map(|it| &self.whole().jumps[*it].resets);
        resets.map(|reset| self.division.input_of_state(reset.0)).any(|state| read.contains(&state))
    }

    /// Whether the state went through the surface at an earlier jump.
    fn is_beyond(&mut self, j: usize, index: usize) -> bool {
        self.sequence[..self.count_before(j)].contains(&index)
            && !self.turns(&self.whole().jumps[index])
    }

    /// Whether a jump changes the speed at which its surface is approached.
    fn turns(&mut self, jump: &Jump) -> bool {
        let rate = self.approach_of(jump);
        let resets: Vec<(u32, ExprId)> = jump
            .resets
            .iter()
            .map(|&(state, value)| (self.division.input_of_state(state), value))
            .collect();
        let reset = |input: u32| resets.iter().find(|it| it.0 == input).map(|it| it.1);
        self.division.graph.substitute(&[rate], &reset)[0] != rate
    }

    fn approach_of(&mut self, jump: &Jump) -> ExprId {
        let psi = self.whole().surfaces[jump.surface].psi;
        approach(self.division.model, &mut self.division.graph, psi)
    }

    /// That a phase comes to its end in the direction of the jump, or two jumps could be one upon
    /// the other. Nothing is said where the speed depends on a control: at the end there is none.
    pub(super) fn direction(&mut self, j: usize) -> Option<Constraint> {
        let jump = self.jump(j);
        let rate = self.approach_of(jump);
        let is_of_state = |at: &u32| {
            !matches!(
                self.division.model.symbols[*at as usize],
                Symbol::Control(_) | Symbol::Selector(_)
            )
        };
        if !self.division.graph.inputs_of(&[rate]).iter().all(is_of_state) {
            return None;
        }
        let range = match jump.direction {
            Direction::Falling => self.division.not_above(),
            Direction::Rising => self.division.not_below(),
        };
        let place =
            Place { name: format!("direction of {}", jump.place.name), span: jump.place.span };
        Some(Constraint { place, value: self.division.at_end(j, rate), range })
    }

    /// Whether the surface on which a phase ends says what a value is there.
    fn ends_on(&mut self, j: usize, value: ExprId) -> bool {
        let psi = |at: &usize| self.whole().surfaces[self.whole().jumps[*at].surface].psi;
        match self.events.get(j).and_then(Option::as_ref).map(psi) {
            Some(psi) => self.is_switching_function(psi, value),
            None => false,
        }
    }

    /// Whether a value is known where the function of a surface is 0: both depend on one state
    /// only, or their slopes are in proportion.
    pub(super) fn is_switching_function(&mut self, psi: ExprId, value: ExprId) -> bool {
        let varies = |symbol: &Symbol| !matches!(symbol, Symbol::Param(_) | Symbol::Free(_));
        let moving = |graph: &Graph, of: ExprId| -> Vec<u32> {
            let inputs = graph.inputs_of(&[of]).into_iter();
            inputs.filter(|at| varies(&self.division.model.symbols[*at as usize])).collect()
        };
        let inputs = moving(&self.division.graph, psi);
        if moving(&self.division.graph, value) != inputs {
            return false;
        }
        let mut slopes = |of: ExprId| -> Vec<ExprId> {
            inputs.iter().map(|at| derivative(&mut self.division.graph, of, *at)).collect()
        };
        let (own, its) = (slopes(value), slopes(psi));
        let opposite: Vec<ExprId> =
            its.iter().map(|slope| self.division.graph.neg(*slope)).collect();
        inputs.len() == 1
            || own == its
            || own == opposite
            || in_proportion(&self.division.graph, &own, &its)
    }
}

/// Whether slopes are numbers, and one list a multiple of the other.
fn in_proportion(graph: &Graph, own: &[ExprId], its: &[ExprId]) -> bool {
    let numbers =
        |of: &[ExprId]| of.iter().map(|id| graph.as_number(*id)).collect::<Option<Vec<f64>>>();
    let (Some(own), Some(its)) = (numbers(own), numbers(its)) else { return false };
    own.iter().zip(&its).all(|(a, b)| (a * its[0] - b * own[0]).abs() <= 1e-12 * (a * its[0]).abs())
}

/// Whether a surface is the place of jumps in both directions.
pub(super) fn has_both(jumps: &[Jump], jump: &Jump) -> bool {
    jumps.iter().any(|it| it.surface == jump.surface && it.direction != jump.direction)
}

/// A number between bounds.
fn within(graph: &mut Graph, range: Range) -> ExprId {
    let is_infinite = |graph: &Graph, bound| graph.as_number(bound).is_some_and(f64::is_infinite);
    let one = graph.number(1.0);
    match (is_infinite(graph, range.lower), is_infinite(graph, range.upper)) {
        (true, true) => one,
        (false, true) => graph.add(range.lower, one),
        (true, false) => graph.sub(range.upper, one),
        (false, false) => {
            let sum = graph.add(range.lower, range.upper);
            graph.scale(0.5, sum)
        }
    }
}
