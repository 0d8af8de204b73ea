//! Where the symbols of a model stand among the inputs of its functions.
//!
//! `p = [params | unknowns | sigma(switch)... | sigma(abs)]`, a width for each surface or `Dir`;
//! the last only where `abs`, `min` and `max` are smoothed and there is no surface to share a width
//! with.

use super::kernel;
use super::objective::Hidden;
use crate::expressions::graph::{ExprId, Graph};
use crate::expressions::kernels;
use crate::expressions::polynomial::difference;
use crate::model::{Model, Symbol};
use fdcc_runtime::problem::Layout;

/// The sizes of a problem.
pub(crate) struct Sizes {
    /// States, hidden ones included.
    pub states: usize,
    /// Controls.
    pub controls: usize,
    /// Length of `p`.
    pub parameters: usize,
    /// Surfaces.
    pub surfaces: usize,
    /// The entry of `p` with the width for `abs`, `min` and `max`.
    pub sigma_of_abs: Option<usize>,
}

impl Sizes {
    pub fn new(model: &Model, hidden: usize) -> Self {
        let chosen = model.params.len() + model.frees.len();
        let switches = model.switches().len();
        let sigmas = if switches == 0 { model.smooth as usize } else { switches };
        Sizes {
            states: model.states.len() + hidden,
            controls: model.controls.len(),
            parameters: chosen + sigmas,
            surfaces: model.surfaces.len(),
            sigma_of_abs: (sigmas > 0).then_some(chosen),
        }
    }

    /// `[t | x | u | p]`.
    pub fn grid(&self) -> Layout {
        Layout { t: 1, x: self.states, u: self.controls, p: self.parameters, s: 0 }
    }
    /// `[t | x | u | p | s]`.
    pub fn flow(&self) -> Layout {
        Layout { s: self.surfaces, ..self.grid() }
    }
    /// `[x(start), x(end) | p]`.
    pub fn ends(&self) -> Layout {
        Layout { t: 0, x: 2 * self.states, u: 0, p: self.parameters, s: 0 }
    }
    /// `[t | p]`.
    pub fn curve(&self) -> Layout {
        Layout { t: 1, p: self.parameters, ..Layout::default() }
    }
}

/// The expression that replaces each symbol.
pub(crate) struct Inputs {
    by_symbol: Vec<Option<ExprId>>,
    /// `tf - t0` over the parameters.
    pub duration: ExprId,
}

impl Inputs {
    /// Replaces the symbols in some expressions.
    pub fn apply(&self, graph: &mut Graph, roots: &[ExprId]) -> Vec<ExprId> {
        graph.substitute(roots, &|symbol| self.by_symbol[symbol as usize])
    }

    /// Gives one symbol another place.
    pub fn replace(&mut self, model: &Model, wanted: Symbol, place: ExprId) {
        self.set(model, |symbol| (symbol == wanted).then_some(place));
    }

    /// Selectors as smoothed steps of their surfaces.
    pub fn smooth_selectors(&mut self, model: &Model, graph: &mut Graph, layout: &Layout) {
        let psis: Vec<ExprId> = model.surfaces.iter().map(|surface| surface.psi).collect();
        let psis = self.apply(graph, &psis);
        let first_sigma = layout.parameters().start + model.params.len() + model.frees.len();
        let mut steps = psis.clone();
        for (at, switch) in model.switches().into_iter().enumerate() {
            let sigma = graph.input((first_sigma + at) as u32);
            let psi = &psis[switch.surfaces.clone()];
            let smoothed = match switch.is_ball {
                true => kernels::direction(graph, kernel(model), psi, sigma),
                false => vec![kernels::step(graph, kernel(model), psi[0], sigma)],
            };
            steps[switch.surfaces].copy_from_slice(&smoothed);
        }
        self.set(model, |symbol| match symbol {
            Symbol::Selector(index) => steps.get(index).copied(),
            _ => None,
        });
    }

    /// Gives those symbols another place for which there is one.
    pub fn set(&mut self, model: &Model, choose: impl Fn(Symbol) -> Option<ExprId>) {
        for (slot, &symbol) in self.by_symbol.iter_mut().zip(&model.symbols) {
            *slot = choose(symbol).or(*slot);
        }
    }
}

/// Parameters only; time is out of reach.
pub(crate) fn of_parameters(model: &Model, graph: &mut Graph, layout: &Layout) -> Inputs {
    let first = layout.parameters().start;
    let place = |symbol: &Symbol| match symbol {
        Symbol::Param(index) => Some(first + index),
        Symbol::Free(index) => Some(first + model.params.len() + index),
        _ => None,
    };
    let by_symbol =
        model.symbols.iter().map(|symbol| place(symbol).map(|at| graph.input(at as u32))).collect();
    let mut inputs = Inputs { by_symbol, duration: model.interval[1] };
    let ends = inputs.apply(graph, &model.interval);
    inputs.duration = difference(graph, ends[1], ends[0]);
    inputs
}

/// Parameters, and time as `t0 + tau D`.
pub(crate) fn of_curve(model: &Model, graph: &mut Graph, layout: &Layout) -> Inputs {
    let mut inputs = of_parameters(model, graph, layout);
    let first = inputs.apply(graph, &model.interval[..1])[0];
    let tau = graph.input(0);
    let passed = graph.mul(tau, inputs.duration);
    let time = graph.add(first, passed);
    inputs.set(model, |symbol| (symbol == Symbol::Time).then_some(time));
    inputs
}

/// Normalised time, states, controls and parameters; smoothed selectors.
pub(crate) fn over_grid(model: &Model, graph: &mut Graph, sizes: &Sizes) -> Inputs {
    let layout = sizes.grid();
    let mut inputs = of_curve(model, graph, &layout);
    place_signals(model, graph, &layout, &mut inputs);
    inputs.smooth_selectors(model, graph, &layout);
    inputs
}

/// Real time, states, controls, parameters and as many selectors as the layout has.
pub(crate) fn of_flow(model: &Model, graph: &mut Graph, layout: &Layout) -> Inputs {
    let mut inputs = of_parameters(model, graph, layout);
    place_signals(model, graph, layout, &mut inputs);
    let time = graph.input(0);
    let selectors: Vec<ExprId> = layout.selectors().map(|at| graph.input(at as u32)).collect();
    inputs.set(model, |symbol| match symbol {
        Symbol::Time => Some(time),
        Symbol::Selector(index) => selectors.get(index).copied(),
        _ => None,
    });
    inputs
}

fn place_signals(model: &Model, graph: &mut Graph, layout: &Layout, inputs: &mut Inputs) {
    let states: Vec<ExprId> = layout.states().map(|at| graph.input(at as u32)).collect();
    let controls: Vec<ExprId> = layout.controls().map(|at| graph.input(at as u32)).collect();
    inputs.set(model, |symbol| match symbol {
        Symbol::State(index) => Some(states[index]),
        // A phase has no more than its own.
        Symbol::Control(index) => controls.get(index).copied(),
        _ => None,
    });
}

/// States at both ends and parameters; integrals are hidden states at the end.
pub(crate) fn at_ends(
    model: &Model,
    graph: &mut Graph,
    layout: &Layout,
    hidden: &[Hidden],
) -> Inputs {
    let mut inputs = of_parameters(model, graph, layout);
    let states = layout.x / 2;
    let ends: Vec<ExprId> = layout.states().map(|at| graph.input(at as u32)).collect();
    inputs.set(model, |symbol| match symbol {
        Symbol::AtStart(index) => Some(ends[index]),
        Symbol::AtEnd(index) => Some(ends[states + index]),
        symbol => {
            let at = hidden.iter().position(|it| it.symbol() == symbol)?;
            Some(ends[states + model.states.len() + at])
        }
    });
    inputs
}

/// The inputs that the optimiser chooses: states, controls and unknowns.
pub(crate) fn solved_for(model: &Model, layout: &Layout) -> Vec<u32> {
    let first = layout.parameters().start + model.params.len();
    let unknowns = first..first + model.frees.len();
    layout.states().chain(layout.controls()).chain(unknowns).map(|at| at as u32).collect()
}
