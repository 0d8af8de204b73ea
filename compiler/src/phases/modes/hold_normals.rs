//! What held surfaces do to the gradient of what is still to come.
//!
//! On a hold any sum of the normals `d = dpsi/dx` may be added to a costate. Which sum is the
//! gradient, for disturbances that leave the surface, too, says that it does not matter on which
//! side the state is (`docs/method/costate.md`):
//!
//! ```text
//! dL/ds + lambda . df/ds = 0      for each selector s that is held
//! ```

use super::Point;
use super::hamiltonian::weights;
use crate::expressions::graph::derivative::derivative;
use crate::expressions::graph::{ExprId, Graph, evaluate};
use crate::lower::objective::integrals_in_states;
use crate::model::numbers::{Numbers, numbers};
use crate::model::{Model, Symbol};

/// Some surfaces that are held together.
pub struct HoldNormals<'m> {
    pub(super) model: &'m Model,
    pub(super) graph: Graph,
    numbers: Numbers,
    /// For each surface `dpsi/dx`, then `df/ds`, then `dL/ds`, then the last of each integral that
    /// became a state.
    all: Vec<ExprId>,
    /// So many integrals became states.
    integrals: usize,
    pub(super) surfaces: Vec<usize>,
}

/// The same at a point.
#[derive(Clone, Debug)]
pub struct NormalsAt {
    /// `dpsi/dx`: for each surface one per state.
    pub normals: Vec<Vec<f64>>,
    /// `df/ds`: for each surface one per state.
    pub directions: Vec<Vec<f64>>,
    /// `dL/ds`: one for each surface.
    pub costs: Vec<f64>,
}

impl<'m> HoldNormals<'m> {
    /// Of these surfaces; nothing where the numbers of the model are not known. `model` is what
    /// holds between jumps.
    pub fn new(model: &'m Model, surfaces: &[usize]) -> Option<Self> {
        let mut graph = model.graph.clone();
        let (weights, in_states) = (weights(model, &mut graph), integrals_in_states(model));
        let mut all = Vec::new();
        for at in surfaces {
            let psi = model.surfaces[*at].psi;
            let inputs = (0..model.states.len()).map(Symbol::State);
            all.extend(inputs.map(|it| slope(model, &mut graph, psi, it)));
            let selector = Symbol::Selector(*at);
            let rates = model.states.iter();
            all.extend(rates.map(|it| slope(model, &mut graph, it.rate, selector)));
            let costs = weights.iter().map(|(integral, weight)| {
                let integrand = model.integrals[*integral].integrand;
                let cost = slope(model, &mut graph, integrand, selector);
                graph.mul(*weight, cost)
            });
            let costs: Vec<ExprId> = costs.collect();
            all.push(graph.sum(&costs));
            let integrands = in_states.iter().map(|it| model.integrals[*it].integrand);
            all.extend(integrands.map(|it| slope(model, &mut graph, it, selector)));
        }
        let numbers = numbers(model).ok()?;
        Some(HoldNormals {
            model,
            graph,
            numbers,
            all,
            integrals: in_states.len(),
            surfaces: surfaces.to_vec(),
        })
    }

    /// At a point with these controls and selectors, one for each surface of the model.
    pub fn at(&self, point: &Point, controls: &[f64], selectors: &[f64]) -> NormalsAt {
        let inputs = self.inputs(point, controls, selectors);
        let values = evaluate(&self.graph, &self.all, &inputs, &[]);
        let states = self.model.states.len();
        let size = 2 * states + 1 + self.integrals;
        let of_surfaces = || values.chunks(size).take(self.surfaces.len());
        let cost = |own: &[f64]| {
            let of_states = own[2 * states + 1..].iter().zip(&point.integrals);
            own[2 * states] + of_states.map(|(slope, factor)| slope * factor).sum::<f64>()
        };
        NormalsAt {
            normals: of_surfaces().map(|it| it[..states].to_vec()).collect(),
            directions: of_surfaces().map(|it| it[states..2 * states].to_vec()).collect(),
            costs: of_surfaces().map(cost).collect(),
        }
    }

    /// One for each symbol of the model.
    pub(super) fn inputs(&self, point: &Point, controls: &[f64], selectors: &[f64]) -> Vec<f64> {
        let given = |all: &[f64], at: usize| all.get(at).copied().unwrap_or(f64::NAN);
        let input = |(symbol, own): (&Symbol, &f64)| match *symbol {
            Symbol::Time => point.time,
            Symbol::State(at) | Symbol::AtEnd(at) => given(&point.states, at),
            Symbol::Free(at) => given(&point.unknowns, at),
            Symbol::Control(at) => given(controls, at),
            Symbol::Selector(at) => given(selectors, at),
            _ => *own,
        };
        self.model.symbols.iter().zip(self.numbers.inputs()).map(input).collect()
    }
}

pub(super) fn slope(model: &Model, graph: &mut Graph, value: ExprId, by: Symbol) -> ExprId {
    match model.input_of(by) {
        Some(input) => derivative(graph, value, input),
        None => graph.number(0.0),
    }
}
