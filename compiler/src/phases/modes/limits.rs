//! States and path conditions at their bounds: boundary arcs and touch points.
//!
//! With `c` what is bounded, less its bound, and `q` the first derivative along the motion on which
//! a control acts (Bryson & Ho, *Applied Optimal Control*, 1975, section 3.11):
//!
//! ```text
//! arc       c = c' = ... = c^(q-1) = 0 where it begins,   c^(q) = 0 along it
//! touch     c = 0, and c' = 0 for q >= 2 or where no control acts, where it happens
//! ```
//!
//! Elsewhere the bounds hold at the nodes. States are bounded by path conditions, too, which say
//! nothing of the ends of phases: there the equations above may say it.

use super::{Arc, Modes, PhaseOfModes};
use crate::expressions::graph::{ExprId, Graph};
use crate::model::{Constraint, Model, Place, Range, State, Symbol};
use crate::phases::hold::approach;

/// What is bounded at all times: a state, or a path condition.
#[derive(Clone, Debug)]
pub struct Limit {
    /// The state; else it is the next path condition.
    pub state: Option<usize>,
    /// The first derivative along the motion on which a control acts; nothing where none does.
    pub order: Option<usize>,
}

/// What is bounded at all times in a model: states that have a bound, then path conditions. As path
/// conditions of a phase of given modes, these stand first, those of states last.
pub fn limits(model: &Model) -> Vec<Limit> {
    let mut graph = model.graph.clone();
    let mut limit = |state: Option<usize>, value| Limit {
        state,
        order: rates(model, &mut graph, value).map(|it| it.len() - 1),
    };
    let input = |state: usize| model.input_of(Symbol::State(state)).expect("it is a symbol");
    let mut all = Vec::new();
    for state in bounded_states(model) {
        let value = model.graph.clone().input(input(state));
        all.push(limit(Some(state), value));
    }
    all.extend(model.path.iter().map(|row| limit(None, row.value)));
    all
}

pub(super) fn bounded_states(model: &Model) -> Vec<usize> {
    let is_infinite = |bound| model.graph.as_number(bound).is_some_and(f64::is_infinite);
    let is_bounded = |state: &State| {
        let Range { lower, upper } = state.range;
        !is_infinite(lower) || !is_infinite(upper)
    };
    (0..model.states.len()).filter(|at| is_bounded(&model.states[*at])).collect()
}

/// A value and its derivatives along the motion, up to the first on which a control acts; nothing
/// where none does.
pub(super) fn rates(model: &Model, graph: &mut Graph, value: ExprId) -> Option<Vec<ExprId>> {
    let mut all = vec![value];
    for _ in 0..=model.states.len() {
        let last = all[all.len() - 1];
        let is_control = |at: &u32| matches!(model.symbols[*at as usize], Symbol::Control(_));
        if graph.inputs_of(&[last]).iter().any(is_control) {
            return Some(all);
        }
        all.push(approach(model, graph, last));
    }
    None
}

/// A value and its derivatives of a touch: up to the first on which a control acts, or to the first
/// one where only unknowns and starts move it.
fn rates_of_touch(model: &Model, graph: &mut Graph, value: ExprId) -> Vec<ExprId> {
    rates(model, graph, value).unwrap_or_else(|| {
        let rate = approach(model, graph, value);
        vec![value, rate, approach(model, graph, rate)]
    })
}

impl Modes<'_> {
    pub(super) fn unbounded(&mut self) -> Range {
        let [lower, upper] =
            [f64::NEG_INFINITY, f64::INFINITY].map(|it| self.between.division.graph.number(it));
        Range { lower, upper }
    }

    /// Adds what bounds states, and puts arcs in the place of path conditions. `moving` has the
    /// equations of the phase.
    pub(super) fn limit(&mut self, of: &PhaseOfModes, moving: &Model, rows: &mut Vec<Constraint>) {
        let states = self.all_bounds_of_states();
        for (at, row) in states.iter().enumerate() {
            rows.push(self.on_arc(row, of.contacts[at], moving));
        }
        for (at, arc) in of.contacts[states.len()..].iter().enumerate() {
            rows[at] = self.on_arc(&rows[at].clone(), *arc, moving);
        }
    }

    fn on_arc(&mut self, row: &Constraint, arc: Arc, moving: &Model) -> Constraint {
        let Some(rates) = self.rates_of(row, arc, moving) else { return row.clone() };
        let value = rates[rates.len() - 1];
        Constraint { value, range: self.between.division.exactly_zero(), ..row.clone() }
    }

    /// `c`, `c'` and so on to `c^(q)`; nothing off the bounds.
    pub(super) fn rates_of(
        &mut self,
        row: &Constraint,
        arc: Arc,
        moving: &Model,
    ) -> Option<Vec<ExprId>> {
        let gap = self.gap(row, arc)?;
        rates(moving, &mut self.between.division.graph, gap)
    }

    /// `c`; nothing off the bounds.
    fn gap(&mut self, row: &Constraint, arc: Arc) -> Option<ExprId> {
        let graph = &mut self.between.division.graph;
        match arc {
            Arc::Lower => Some(graph.sub(row.value, row.range.lower)),
            Arc::Upper => Some(graph.sub(row.value, row.range.upper)),
            Arc::Free => None,
        }
    }

    fn rates_of_touch(
        &mut self,
        row: &Constraint,
        touched: Arc,
        moving: &Model,
    ) -> Option<Vec<ExprId>> {
        let gap = self.gap(row, touched)?;
        Some(rates_of_touch(moving, &mut self.between.division.graph, gap))
    }

    /// What holds where phase `j + 1` begins: arcs that begin, and touches.
    pub(super) fn entries(&mut self, j: usize) -> Vec<Constraint> {
        let phases = self.phases;
        let (before, after) = (&phases[j], &phases[j + 1]);
        let mut rows = Vec::new();
        let moving = self.moving(after);
        let mut known = self.zero_between(j);
        let states = self.all_bounds_of_states();
        for (at, row) in states.iter().chain(&moving.path).enumerate() {
            let is_moved = self.is_moved(j, row.value);
            let is_new = before.contacts[at] != after.contacts[at] || is_moved;
            let (rates, most) = match (after.contacts[at], after.touches[at]) {
                (Arc::Free, touched) => (self.rates_of_touch(row, touched, &moving), 2),
                (arc, _) if is_new => (self.rates_of(row, arc, &moving), usize::MAX),
                _ => continue,
            };
            let Some(rates) = rates else { continue };
            let given = (rates.len() - 1).min(most);
            for rate in &rates[..given] {
                // A surface that is reached there may say the same.
                if !known.add(self, *rate) {
                    continue;
                }
                let value = match is_moved {
                    true => self.between.division.at_start(j + 1, *rate),
                    false => self.between.division.at_end(j, *rate),
                };
                let place = Place { name: format!("{} reached", row.place.name), ..row.place };
                rows.push(Constraint { place, value, range: self.between.division.exactly_zero() });
            }
        }
        rows
    }

    /// As path conditions.
    pub(super) fn all_bounds_of_states(&mut self) -> Vec<Constraint> {
        let model = self.between.division.model;
        let of = |at: usize| {
            let state = &model.states[at];
            let value = self.between.division.graph.input(self.between.division.input_of_state(at));
            Constraint { place: state.place.clone(), value, range: state.range }
        };
        bounded_states(model).into_iter().map(of).collect()
    }

    /// The model with the equations and path conditions of a phase.
    pub(super) fn moving(&mut self, of: &PhaseOfModes) -> Model {
        let model = self.between.division.model;
        let meanings = self.selectors(of);
        let mut moving = model.clone();
        for state in &mut moving.states {
            state.rate = self.with_selectors(state.rate, &meanings);
        }
        for row in &mut moving.path {
            row.value = self.with_selectors(row.value, &meanings);
        }
        moving
    }
}
