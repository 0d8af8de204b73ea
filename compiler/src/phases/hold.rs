//! `then hold SURFACE`: after its last jump the state rests on the surface.
//!
//! The state that the jump resets and that moves the surface begins so that `psi' = 0`, and stands
//! still from then on. That keeps the surface held where `psi'` depends on no other state, no
//! control and no time; another way to hold one is not solved yet. A later jump that resets what
//! `psi` or `psi'` depends on takes the state off, and it is free again.

use super::MultiPhase;
use crate::expressions::graph::derivative::derivative;
use crate::expressions::graph::{ExprId, Graph};
use crate::model::{Constraint, Jump, Model, Symbol};

/// A surface that is held.
#[derive(Clone, Copy)]
pub(super) struct Held {
    /// So many jumps are before the first phase in which it is.
    pub from: usize,
    /// So many are before the first in which it is no longer: one of them has taken the state off.
    pub until: usize,
    /// The state that stands still.
    pub state: usize,
    /// `psi'` over that state.
    pub approach: ExprId,
    /// The function of the surface.
    pub psi: ExprId,
}

impl Held {
    /// What is held after one of the jumps that happen.
    pub fn new(
        model: &Model,
        graph: &mut Graph,
        sequence: &[usize],
        limits: &[Option<usize>],
    ) -> Option<Held> {
        let is_last = |j: usize| {
            limits[sequence[j]]
                == Some(sequence[..=j].iter().filter(|it| **it == sequence[j]).count())
        };
        let last = (0..sequence.len())
            .find(|&j| is_last(j) && model.jumps[sequence[j]].then_hold.is_some())?;
        let jump = &model.jumps[sequence[last]];
        let (state, approach) = rest(model, graph, jump)?;
        let psi = model.surfaces[jump.surface].psi;
        let reads = graph.inputs_of(&[approach, psi]);
        let is_read = |(state, _): &(usize, ExprId)| {
            model.input_of(Symbol::State(*state)).is_some_and(|it| reads.contains(&it))
        };
        let takes_off = |k: &usize| model.jumps[sequence[*k]].resets.iter().any(is_read);
        let until = (last + 1..sequence.len()).find(takes_off).map_or(usize::MAX, |k| k + 1);
        Some(Held { from: last + 1, until, state, approach, psi })
    }

    /// Whether it is after so many jumps.
    fn is_after(&self, jumps: usize) -> bool {
        (self.from..self.until).contains(&jumps)
    }
}

/// The state that has to stand still after the last of a jump, and the speed at which the surface
/// moves with it; nothing where that is not enough to hold the surface.
pub(super) fn rest(model: &Model, graph: &mut Graph, jump: &Jump) -> Option<(usize, ExprId)> {
    let (surface, [(state, _)]) = (jump.then_hold?, jump.resets.as_slice()) else { return None };
    let approach = approach(model, graph, model.surfaces[surface].psi);
    let reads = graph.inputs_of(&[approach]);
    let moves =
        |at: &u32| !matches!(model.symbols[*at as usize], Symbol::Param(_) | Symbol::Free(_));
    let moving: Vec<Symbol> =
        reads.iter().filter(|at| moves(at)).map(|at| model.symbols[*at as usize]).collect();
    (surface == jump.surface && moving == [Symbol::State(*state)]).then_some((*state, approach))
}

/// `psi_t + psi_x f`: the speed at which a surface is approached.
pub(super) fn approach(model: &Model, graph: &mut Graph, psi: ExprId) -> ExprId {
    let mut terms = Vec::new();
    terms.extend(model.input_of(Symbol::Time).map(|time| derivative(graph, psi, time)));
    for (index, state) in model.states.iter().enumerate() {
        let input = model.input_of(Symbol::State(index)).expect("each state is a symbol");
        let slope = derivative(graph, psi, input);
        terms.push(graph.mul(slope, state.rate));
    }
    graph.sum(&terms)
}

impl MultiPhase<'_> {
    /// Whether a state stands still in a phase.
    pub(super) fn is_still(&self, j: usize, state: usize) -> bool {
        self.held.is_some_and(|held| held.is_after(self.count_before(j)) && state == held.state)
    }

    /// `psi'` at the start of the phase from which on the surface is held, where the state begins
    /// that stands still.
    pub(super) fn at_rest(&mut self, j: usize, state: usize) -> Option<ExprId> {
        let held = self.held.filter(|it| it.from == self.count_before(j) && it.state == state)?;
        let (input, start) = (
            self.division.input_of_state(state),
            self.division.of_phase(j, Symbol::AtStart(state)),
        );
        Some(
            self.division.graph.substitute(&[held.approach], &|at| (at == input).then_some(start))
                [0],
        )
    }

    /// Whether a constraint says of a held surface what is so anyway.
    pub(super) fn is_held(&mut self, j: usize, row: &Constraint) -> bool {
        let Some(held) = self.held.filter(|it| it.is_after(self.count_before(j))) else {
            return false;
        };
        self.is_switching_function(held.psi, row.value)
    }
}
