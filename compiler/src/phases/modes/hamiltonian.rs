//! The least Hamiltonian over all controls, and selectors of holds, at one point of a trajectory.
//!
//! ```text
//! min over u, s of  L(t, x, u, s) + p . f(t, x, u, s)      with the conditions that read u or s
//! ```
//!
//! As a model it has one interval of length 1 in which nothing moves.

use super::{Mode, Modes, PhaseOfModes, prepared, refuse};
use crate::expressions::graph::derivative::derivative;
use crate::expressions::graph::{ExprId, Graph};
use crate::lower::objective::integrals_in_states;
use crate::model::{Constraint, Control, Integral, Model, Range, Symbol};
use crate::phases::division::{Division, divide};
use crate::phases::hold::approach;
use crate::phases::shares::is_given;
use crate::phases::{Jumps, MultiPhase};
use fdcc_grammar::Diagnostic;
use fdcc_runtime::problem::{ControlShape, Grid, Method, Order, Scheme};

/// A point of a trajectory.
#[derive(Clone, Debug)]
pub struct Point {
    /// Real time.
    pub time: f64,
    /// One per state of the model.
    pub states: Vec<f64>,
    /// One per state: the derivative by it of the objective of the model, as written.
    pub costates: Vec<f64>,
    /// One per integral that became a state, behind those of the model: the derivative by it.
    pub integrals: Vec<f64>,
    /// One per `free`.
    pub unknowns: Vec<f64>,
}

/// A model whose objective is the Hamiltonian of the model, as written, at a point of a phase;
/// where that leaves the surfaces of some [`Model::switches`], with controls that lead to its
/// sides.
///
/// # Errors
///
/// What cannot be divided into phases of given modes.
pub fn hamiltonian(
    model: &Model,
    of: &PhaseOfModes,
    point: &Point,
    leaving: &[usize],
) -> Result<Model, Vec<Diagnostic>> {
    refuse(model)?;
    let (jumps, mut whole) = (Jumps::new(model)?, prepared(model));
    let times = divide(&mut whole, Vec::new());
    let between = MultiPhase::new(&jumps, Division::new(&whole, times), &[]);
    let phases = std::slice::from_ref(of);
    Ok(Modes { between, phases, linked: None }.into_hamiltonian(point, leaving))
}

impl Modes<'_> {
    fn into_hamiltonian(mut self, point: &Point, leaving: &[usize]) -> Model {
        let model = self.between.division.model;
        let of = &self.phases[0];
        let meanings = self.selectors(of);
        let moving = self.moving(of);
        let controls = self.controls(of);
        let mut terms = self.running_costs(&meanings, &point.integrals);
        let rows = self.path(0, &moving.states, &meanings);
        let graph = &mut self.between.division.graph;
        for (state, costate) in moving.states.iter().zip(&point.costates) {
            terms.push(graph.scale(*costate, state.rate));
        }
        let value = graph.sum(&terms);
        let reads = |graph: &Graph, id: ExprId| {
            let is_control = |at: &u32| matches!(model.symbols[*at as usize], Symbol::Control(_));
            graph.inputs_of(&[id]).iter().any(is_control)
        };
        let mut rows: Vec<Constraint> =
            rows.into_iter().filter(|it| reads(graph, it.value)).collect();
        rows.extend(leaving.iter().flat_map(|at| self.departure(*at, &moving)));
        self.at_point(point, value, rows, controls)
    }

    /// That `psi'` leads to the side of a surface that the phase is on.
    fn departure(&mut self, switch: usize, moving: &Model) -> Option<Constraint> {
        let model = self.between.division.model;
        let range = match self.phases[0].modes[switch] {
            Mode::Above => self.between.division.not_below(),
            Mode::Below => self.between.division.not_above(),
            Mode::Held => return None,
        };
        let surface = &model.surfaces[model.switches()[switch].surfaces.start];
        let value = approach(moving, &mut self.between.division.graph, surface.psi);
        Some(Constraint { place: surface.place.clone(), value, range })
    }

    /// What each unit of time adds to the objective by each integral; `of_states` are the
    /// derivatives by those that became states.
    pub(super) fn running_costs(&mut self, meanings: &[ExprId], of_states: &[f64]) -> Vec<ExprId> {
        let model = self.between.division.model;
        let mut factors = weights(model, &mut self.between.division.graph);
        for (at, factor) in integrals_in_states(model).into_iter().zip(of_states) {
            factors.push((at, self.between.division.graph.number(*factor)));
        }
        let term = |(at, factor): (usize, ExprId)| {
            let integrand = self.with_selectors(model.integrals[at].integrand, meanings);
            self.between.division.graph.mul(factor, integrand)
        };
        factors.into_iter().map(term).collect()
    }

    /// Nothing but the controls is open any more.
    fn at_point(
        self,
        point: &Point,
        value: ExprId,
        rows: Vec<Constraint>,
        controls: Vec<Control>,
    ) -> Model {
        let Division { model, graph, symbols, .. } = self.between.division;
        let mut frozen = Frozen { model, graph, point };
        let value = frozen.value(value);
        let path = rows.into_iter().map(|row| frozen.row(row)).collect();
        let of_control = |it: Control| {
            let range = frozen.range(it.range);
            Control { range, guess: None, ..it }
        };
        let controls = controls.into_iter().map(of_control).collect();
        let sums = Vec::new();
        let own = Model { graph: frozen.graph, symbols, path, controls, sums, ..model.clone() };
        resting(own, value)
    }
}

/// Each integral of the objective whose derivative depends on parameters alone, with that.
pub(super) fn weights(model: &Model, graph: &mut Graph) -> Vec<(usize, ExprId)> {
    let Some((_, value)) = model.objective else { return Vec::new() };
    let mut all = Vec::new();
    for at in 0..model.integrals.len() {
        let Some(input) = model.input_of(Symbol::Integral(at)) else { continue };
        let weight = derivative(graph, value, input);
        if is_given(model, graph, weight) {
            all.push((at, weight));
        }
    }
    all
}

/// A model whose time, states and unknowns are numbers.
struct Frozen<'m> {
    model: &'m Model,
    graph: Graph,
    point: &'m Point,
}

impl Frozen<'_> {
    fn row(&mut self, row: Constraint) -> Constraint {
        Constraint { value: self.value(row.value), range: self.range(row.range), ..row }
    }

    fn range(&mut self, range: Range) -> Range {
        Range { lower: self.value(range.lower), upper: self.value(range.upper) }
    }

    fn value(&mut self, id: ExprId) -> ExprId {
        let mut numbers = Vec::new();
        for input in self.graph.inputs_of(&[id]) {
            let number = match self.model.symbols[input as usize] {
                Symbol::Time => self.point.time,
                Symbol::State(at) => self.point.states[at],
                Symbol::Free(at) => self.point.unknowns[at],
                _ => continue,
            };
            numbers.push((input, self.graph.number(number)));
        }
        let number = |at: u32| numbers.iter().find(|it| it.0 == at).map(|it| it.1);
        self.graph.substitute(&[id], &number)[0]
    }
}

/// A model of one interval of length 1 whose objective is the integral of a value, and whose states
/// rest.
fn resting(model: Model, value: ExprId) -> Model {
    let mut own = Model {
        frees: Vec::new(),
        surfaces: Vec::new(),
        balls: Vec::new(),
        half_open: Vec::new(),
        boundary: Vec::new(),
        report: Vec::new(),
        expectations: Vec::new(),
        simulated: Vec::new(),
        metric: Vec::new(),
        ..model
    };
    let [zero, one] = [0.0, 1.0].map(|it| own.graph.number(it));
    let [lower, upper] = [f64::NEG_INFINITY, f64::INFINITY].map(|it| own.graph.number(it));
    own.interval = [zero, one];
    for state in &mut own.states {
        let range = Range { lower, upper };
        (state.range, state.start_range, state.rate) = (range, None, zero);
        (state.start, state.guess) = (Some(zero), Some(zero));
    }
    let place = own.objective.take().map(|it| it.0).unwrap_or_default();
    let integral = Integral { place: place.clone(), integrand: value, is_linked: false };
    own.integrals = vec![integral];
    let sum = own.symbols_mut().input(Symbol::Integral(0));
    own.objective = Some((place, own.graph.input(sum)));
    own.method = Method {
        scheme: Scheme::Euler,
        order: Order::Fixed,
        controls: ControlShape::Constant,
        grid: Grid::Uniform(1),
        steps: 1,
        lagged: Vec::new(),
        sigma: None,
        continuation: Vec::new(),
        ..own.method
    };
    own
}
