//! How parameters move held surfaces where a hold begins at the first time or lasts until the last.
//!
//! Neither `psi = 0` at a given start nor a condition at the end that a hold implies is a row of
//! the chain, so that its multipliers say nothing of them.

use super::Point;
use super::hold_normals::{HoldNormals, slope};
use crate::expressions::graph::{ExprId, Graph, evaluate};
use crate::model::{Constraint, Model, Symbol};

/// The derivatives of a function of the state.
#[derive(Clone, Debug)]
pub struct Slopes {
    /// One per state.
    pub by_state: Vec<f64>,
    /// One per parameter, those of parameters included that are computed from others.
    pub by_parameters: Vec<f64>,
}

impl HoldNormals<'_> {
    /// The derivatives of `psi` at the first time by each parameter, one list for each surface. A
    /// start that is chosen does not move.
    pub fn starts_by_parameters(&self, point: &Point) -> Vec<Vec<f64>> {
        let mut graph = self.graph.clone();
        let given = |at: u32| match self.model.symbols[at as usize] {
            Symbol::State(state) => self.model.states[state].start,
            Symbol::Time => Some(self.model.interval[0]),
            _ => None,
        };
        let started = graph.substitute(&self.psi(), &given);
        started.into_iter().map(|it| self.by_parameters(&mut graph, it, point)).collect()
    }

    /// Whether `psi` at the first time is given, for each surface; else it is a row of the chain,
    /// or links say it.
    pub fn are_starts_given(&self) -> Vec<bool> {
        let is_unknown = |at: &u32| matches!(self.model.symbols[*at as usize], Symbol::Free(_));
        let is_given = |at: u32| match self.model.symbols[at as usize] {
            Symbol::State(state) => self.model.states[state]
                .start
                .is_some_and(|start| !self.graph.inputs_of(&[start]).iter().any(is_unknown)),
            _ => true,
        };
        let psi = self.psi().into_iter();
        psi.map(|it| self.graph.inputs_of(&[it]).into_iter().all(is_given)).collect()
    }

    /// The derivatives of `psi`, one for each surface.
    pub fn slopes(&self, point: &Point) -> Vec<Slopes> {
        let mut graph = self.graph.clone();
        let psi = self.psi().into_iter();
        psi.map(|it| self.slopes_of(&mut graph, it, Symbol::State, point)).collect()
    }

    /// The derivatives of the gap of each equation of the state at the last time.
    pub fn slopes_of_ends(&self, point: &Point) -> Vec<Slopes> {
        let mut graph = self.graph.clone();
        let rows = self.model.boundary.iter().filter(|it| is_of_end(self.model, it));
        let gaps: Vec<ExprId> = rows.map(|it| graph.sub(it.value, it.range.lower)).collect();
        gaps.into_iter().map(|it| self.slopes_of(&mut graph, it, Symbol::AtEnd, point)).collect()
    }

    fn psi(&self) -> Vec<ExprId> {
        self.surfaces.iter().map(|at| self.model.surfaces[*at].psi).collect()
    }

    fn slopes_of(
        &self,
        graph: &mut Graph,
        value: ExprId,
        state: fn(usize) -> Symbol,
        point: &Point,
    ) -> Slopes {
        let states = 0..self.model.states.len();
        let by_state = states.map(|at| self.slope_at(graph, value, state(at), point));
        let by_state = by_state.collect();
        Slopes { by_state, by_parameters: self.by_parameters(graph, value, point) }
    }

    fn by_parameters(&self, graph: &mut Graph, value: ExprId, point: &Point) -> Vec<f64> {
        let params = &self.model.params;
        let by = |graph: &mut Graph, value: ExprId, at: usize| {
            self.slope_at(graph, value, Symbol::Param(at), point)
        };
        let mut all: Vec<f64> = (0..params.len()).map(|at| by(graph, value, at)).collect();
        for &computed in self.model.param_order.iter().rev() {
            let Some(own) = params[computed].value else { continue };
            for at in 0..all.len() {
                let more = all[computed] * by(graph, own, at);
                all[at] += more;
            }
        }
        all
    }

    fn slope_at(&self, graph: &mut Graph, value: ExprId, by: Symbol, point: &Point) -> f64 {
        let slope = slope(self.model, graph, value, by);
        evaluate(graph, &[slope], &self.inputs(point, &[], &[]), &[])[0]
    }
}

/// Whether it is an equation of the state at the last time alone.
pub(super) fn is_of_end(model: &Model, row: &Constraint) -> bool {
    let read = model.graph.inputs_of(&[row.value, row.range.lower]);
    let is_of_end = |at: &u32| {
        let symbol = model.symbols[*at as usize];
        matches!(symbol, Symbol::AtEnd(_) | Symbol::Param(_) | Symbol::Free(_))
    };
    row.range.lower == row.range.upper && read.iter().all(is_of_end)
}
