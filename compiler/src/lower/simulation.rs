//! The functions of the true system, in real time and with selectors as inputs.
//!
//! ```text
//! flow      f(t, x, u, p, s), then the integrands
//! rates     psi' = psi_t + psi_x f(t, x, u, p, s)
//! switching psi(t, x, p, s)
//! resets    r(t, x, p), a block for each jump
//! objective M(x(start), x(end), p)
//! guess     of states, then controls, at (tau, p)
//! interval  t0(p), tf(p)
//! start     x(start)(p)
//! kinks     e(t, x, u, p) of abs(e), a - b of min(a, b) and max(a, b) in the flow, then in psi
//! fixed     e(p) of those that parameters alone move
//! ```
//!
//! Every integral of the model is one more state, so the objective is a function of both ends. A
//! simulation needs few derivatives, sensitivities need all of them, up to the second.

use super::derived::write_out;
use super::enclosures::{Watched, enclosures};
use super::function::{Order, VectorFunction};
use super::guess;
use super::inputs::{self, Inputs, Sizes};
use super::kinks::{Kinks, Of, take_out};
use super::objective::Hidden;
use super::problem::{controls, parameters, states, surfaces};
use super::{interval, origin, smoothed};
use crate::expressions::graph::derivative::derivative;
use crate::expressions::graph::{ExprId, Graph};
use crate::model::guess::fixed_by_a_row;
use crate::model::numbers::Numbers;
use crate::model::{Ball, Jump, Model, Symbol};
use fdcc_grammar::ast::Direction;
use fdcc_runtime::problem::{Function, Layout, Origin};
use fdcc_runtime::simulate::{self, Enclosures};
use std::sync::Arc;

/// What a system is compiled for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Purpose {
    /// Events, sliding and resets.
    Simulation,
    /// Derivatives by everything, too.
    Sensitivities,
    /// The same, with the selectors smoothed as a solve smooths them; without surfaces.
    Smoothed,
}

/// The functions of a system, still expressions, in the order of the list above.
pub(crate) struct Simulated {
    /// In that order.
    pub functions: Vec<VectorFunction>,
    enclosures: Enclosures,
    layout: Layout,
    hidden: Vec<Hidden>,
    surfaces: usize,
    kinks_of_flow: usize,
}

/// Lowers a model.
pub(crate) fn simulation(model: &Model, purpose: Purpose) -> (Graph, Simulated) {
    let mut graph = model.graph.clone();
    let hidden: Vec<Hidden> = (0..model.integrals.len()).map(Hidden::Integral).collect();
    let sizes = Sizes::new(model, hidden.len());
    let surfaces = if purpose == Purpose::Smoothed { 0 } else { model.surfaces.len() };
    let layout = Layout { s: surfaces, ..sizes.flow() };
    let mut over = OverTime { model, graph: &mut graph, sizes: &sizes, layout, purpose, surfaces };
    let (mut flow, mut switching) = (over.flow(), over.switching());
    if purpose != Purpose::Simulation {
        // The kinks of computed parameters are those of what they are computed from.
        write_out(model, over.graph, &mut flow);
        write_out(model, over.graph, &mut switching);
    }
    let ([kinks, fixed_kinks], kinks_of_flow) = over.kinks(&mut flow, &mut switching);
    let path = over.path();
    let rates = over.rates(&flow, &switching);
    let mut functions = vec![
        flow,
        rates,
        switching,
        over.resets(),
        over.objective(&hidden),
        guess::lower(model, over.graph, &sizes),
        interval(model, over.graph, &sizes),
        over.start(),
        kinks,
        fixed_kinks,
    ];
    let layout = over.layout;
    if purpose != Purpose::Simulation {
        functions.iter_mut().for_each(|function| differentiable(model, &mut graph, function));
    }
    let [flow, rates, switching, _, _, guess, _, _, kinks, _] = functions.as_slice() else {
        unreachable!("a system has ten functions")
    };
    let enclosures = enclosures(
        &mut graph,
        &layout,
        &Watched { flow, switching, kinks, rates, path: &path, guess },
    );
    (graph, Simulated { functions, enclosures, layout, hidden, surfaces, kinks_of_flow })
}

/// By all inputs, to the second order.
fn differentiable(model: &Model, graph: &mut Graph, function: &mut VectorFunction) {
    write_out(model, graph, function);
    function.by = (0..function.layout.inputs() as u32).collect();
    function.order = Order::Second;
}

/// A model on its way to functions of real time.
struct OverTime<'m> {
    model: &'m Model,
    graph: &'m mut Graph,
    sizes: &'m Sizes,
    layout: Layout,
    purpose: Purpose,
    surfaces: usize,
}

impl OverTime<'_> {
    fn inputs(&mut self) -> Inputs {
        let mut inputs = inputs::of_flow(self.model, self.graph, &self.layout);
        if self.purpose == Purpose::Smoothed {
            inputs.smooth_selectors(self.model, self.graph, &self.layout);
        }
        inputs
    }

    /// A function whose outputs are given over the symbols of the model.
    fn function(
        &mut self,
        name: &str,
        outputs: impl Iterator<Item = (ExprId, Origin)>,
        by: impl Iterator<Item = usize>,
    ) -> VectorFunction {
        let (outputs, origins): (Vec<ExprId>, Vec<Origin>) = outputs.unzip();
        let outputs = self.inputs().apply(self.graph, &outputs);
        self.over_inputs(name, outputs, origins, by)
    }

    fn over_inputs(
        &self,
        name: &str,
        outputs: Vec<ExprId>,
        origins: Vec<Origin>,
        by: impl Iterator<Item = usize>,
    ) -> VectorFunction {
        let by = by.map(|at| at as u32).collect();
        VectorFunction {
            name: name.into(),
            layout: self.layout,
            outputs,
            origins,
            by,
            order: Order::First,
        }
    }

    fn flow(&mut self) -> VectorFunction {
        let model = self.model;
        let rates = model.states.iter().map(|state| (state.rate, origin(&state.equation)));
        let integrals =
            model.integrals.iter().map(|integral| (integral.integrand, origin(&integral.place)));
        let layout = self.layout;
        let mut flow = self.function(
            "flow",
            rates.chain(integrals),
            layout.states().chain(layout.selectors()),
        );
        if self.purpose == Purpose::Smoothed {
            flow.outputs = smoothed(model, self.graph, &flow.outputs, self.sizes, &layout);
        }
        flow
    }

    fn switching(&mut self) -> VectorFunction {
        let model = self.model;
        let surfaces = model.surfaces.iter().take(self.surfaces);
        let psis = surfaces.map(|surface| (surface.psi, origin(&surface.place)));
        self.function("switching", psis, 0..self.layout.states().end)
    }

    /// The path conditions, as they are written.
    fn path(&mut self) -> VectorFunction {
        let model = self.model;
        self.function("path", model.path.iter().map(|row| (row.value, origin(&row.place))), 0..0)
    }

    /// Gives the kinks of the flow and of the surfaces selectors, but for those of parameters
    /// alone, which follow; where a solve smooths, the knots of the kernel. How many are those of
    /// the flow, which come first.
    fn kinks(
        &mut self,
        flow: &mut VectorFunction,
        switching: &mut VectorFunction,
    ) -> ([VectorFunction; 2], usize) {
        let psis = switching.outputs.clone();
        let is_alone = |at: usize| self.model.balls.iter().all(|ball| !ball.surfaces.contains(&at));
        let psis = psis.into_iter().enumerate().map(|(at, psi)| is_alone(at).then_some(psi));
        let (psis, mut kinks) = (psis.collect::<Vec<Option<ExprId>>>(), Kinks::default());
        take_out(self.graph, flow, Of::Flow, &psis, &mut kinks);
        let of_flow = kinks.crossed.values.len();
        take_out(self.graph, switching, Of::Surfaces, &psis, &mut kinks);
        let Kinks { crossed, of_parameters } = kinks;
        self.layout.s += crossed.values.len();
        (flow.layout, switching.layout) = (self.layout, self.layout);
        let by = 0..self.layout.controls().end;
        let functions = [
            self.over_inputs("kinks", crossed.values, crossed.origins, by),
            self.over_inputs("fixed_kinks", of_parameters.values, of_parameters.origins, 0..0),
        ];
        (functions, of_flow)
    }

    /// `psi'` along the flow.
    fn rates(&mut self, flow: &VectorFunction, switching: &VectorFunction) -> VectorFunction {
        let rates = switching.outputs.iter().map(|&psi| {
            let mut terms = vec![derivative(self.graph, psi, 0)];
            for (at, &rate) in self.layout.states().zip(&flow.outputs) {
                let slope = derivative(self.graph, psi, at as u32);
                terms.push(self.graph.mul(slope, rate));
            }
            self.graph.sum(&terms)
        });
        let rates = rates.collect();
        let by = self.layout.states().chain(self.layout.selectors());
        self.over_inputs("rates", rates, switching.origins.clone(), by)
    }

    /// What a jump does not name stays as it is.
    fn resets(&mut self) -> VectorFunction {
        let inputs = self.inputs();
        let same: Vec<ExprId> =
            self.layout.states().map(|at| self.graph.input(at as u32)).collect();
        let mut outputs = Vec::new();
        for jump in &self.model.jumps {
            let values: Vec<ExprId> = jump.resets.iter().map(|reset| reset.1).collect();
            let mut after = same.clone();
            for (value, reset) in inputs.apply(self.graph, &values).into_iter().zip(&jump.resets) {
                after[reset.0] = value;
            }
            outputs.extend(after);
        }
        let jumps = self.model.jumps.iter();
        let origins = jumps.flat_map(|jump| vec![origin(&jump.place); self.layout.x]).collect();
        self.over_inputs("resets", outputs, origins, 0..self.layout.states().end)
    }

    fn objective(&mut self, hidden: &[Hidden]) -> VectorFunction {
        let layout = self.sizes.ends();
        let inputs = inputs::at_ends(self.model, self.graph, &layout, hidden);
        let objective = self.model.objective.as_ref();
        let (outputs, origins): (Vec<ExprId>, Vec<Origin>) =
            objective.map(|(place, value)| (*value, origin(place))).into_iter().unzip();
        let outputs = inputs.apply(self.graph, &outputs);
        VectorFunction { layout, ..self.over_inputs("objective", outputs, origins, 0..0) }
    }

    /// What is declared, else what a condition such as `start x == 1` gives, else the guess; 0 for
    /// integrals.
    fn start(&mut self) -> VectorFunction {
        let layout = Layout { p: self.sizes.parameters, ..Layout::default() };
        let inputs = inputs::of_parameters(self.model, self.graph, &layout);
        let mut outputs = guess::at_start(self.model, self.graph, self.sizes);
        for (index, state) in self.model.states.iter().enumerate() {
            let row = fixed_by_a_row(self.model, self.graph, Symbol::AtStart(index));
            if let Some(value) = state.start.or(row) {
                outputs[index] = inputs.apply(self.graph, &[value])[0];
            }
        }
        let places = self.model.states.iter().map(|state| origin(&state.place));
        let integrals = self.model.integrals.iter().map(|integral| origin(&integral.place));
        let origins = places.chain(integrals).collect();
        VectorFunction { layout, ..self.over_inputs("start", outputs, origins, 0..0) }
    }
}

/// Puts together what the simulator needs. `functions` are those of [`Simulated`], compiled.
pub(crate) fn system(
    model: &Model,
    simulated: &Simulated,
    numbers: &Numbers,
    functions: Vec<Arc<dyn Function>>,
) -> simulate::System {
    type All = [Arc<dyn Function>; 10];
    let all: All =
        functions.try_into().unwrap_or_else(|_| unreachable!("a system has ten functions"));
    let [flow, rates, switching, resets, objective, guess, interval, start, kinks, fixed_kinks] =
        all;
    let first_sigma = model.params.len() + model.frees.len();
    let parameters = parameters(model, simulated.layout.p, numbers);
    let values: Vec<f64> = parameters.iter().map(|parameter| parameter.value).collect();
    simulate::System {
        name: model.name.clone(),
        layout: simulated.layout,
        states: states(model, &simulated.hidden, numbers),
        controls: controls(model, numbers),
        surfaces: surfaces(model, first_sigma).into_iter().take(simulated.surfaces).collect(),
        balls: model.balls.iter().filter(|_| simulated.surfaces > 0).map(ball).collect(),
        jumps: model.jumps.iter().map(|jump| lowered(model, numbers, jump)).collect(),
        interval: model.interval.map(|end| numbers.value(model, end)),
        start: simulate::value(&*start, &[], &values),
        parameters,
        flow,
        rates,
        switching,
        resets,
        objective,
        guess,
        kinks,
        kinks_of_flow: simulated.kinks_of_flow,
        fixed_kinks,
        enclosures: simulated.enclosures.clone(),
        interval_of: interval,
        start_of: start,
    }
}

fn ball(ball: &Ball) -> simulate::Ball {
    simulate::Ball { name: ball.place.name.clone(), surfaces: ball.surfaces.clone() }
}

fn lowered(model: &Model, numbers: &Numbers, jump: &Jump) -> simulate::Jump {
    simulate::Jump {
        name: jump.place.name.clone(),
        origin: origin(&jump.place),
        surface: jump.surface,
        is_falling: jump.direction == Direction::Falling,
        at_most: jump.at_most.map(|limit| numbers.value(model, limit)),
        then_hold: jump.then_hold,
        resets: jump.resets.iter().map(|reset| reset.0).collect(),
    }
}
