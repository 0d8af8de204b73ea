//! From a [`Model`] to the vector functions of a [`Problem`](fdcc_runtime::problem::Problem), over
//! one graph.
//!
//! ```text
//! flow      f(t, x, u, p, s)                                 real time, selectors s as inputs
//! dynamics  D f(t0 + tau D, x, u, p, s = Sgn_sigma(psi))     D = tf - t0, tau in [0, 1]
//!           D * running cost                                 behind it
//! path, switching, report                                    over tau as well
//! boundary  Mayer objective, conditions at [x(start), x(end)]
//! ```

mod boundary;
mod by_parameters;
mod composed;
mod derived;
mod enclosures;
mod expectations;
mod first_points;
mod function;
mod guess;
mod inputs;
mod kinks;
mod links;
mod links_by_parameters;
mod measured;
pub(crate) mod objective;
mod problem;
mod residuals;
mod simulation;
mod sudden;

pub(crate) use by_parameters::by_parameters;
pub use expectations::Expected;
pub(crate) use expectations::{LoweredExpectations, expectations};
pub(crate) use expectations::{expectations_of_phases, integrands, sums};
pub use function::{Order, VectorFunction};
pub(crate) use links::{LoweredLink, links};
pub(crate) use links_by_parameters::links_by_parameters;
pub use objective::Hidden;
pub use problem::problem;
pub(crate) use problem::unknowns;
pub(crate) use residuals::squares;
pub(crate) use simulation::{Purpose, simulation, system};

use crate::expressions::graph::{ExprId, Graph};
use crate::expressions::kernels;
use crate::model::{Model, Place, Switch};
use fdcc_runtime::problem::{Layout, Origin};
use inputs::Sizes;
pub use measured::Measured;
use objective::Objective;

/// All functions of a problem, still expressions.
pub struct LoweredProblem {
    /// The expressions.
    pub graph: Graph,
    /// The right side in real time with selectors as inputs; not compiled for solving.
    pub flow: VectorFunction,
    /// See [`Problem::dynamics`](fdcc_runtime::problem::Problem::dynamics).
    pub dynamics: VectorFunction,
    /// Path constraints.
    pub path: VectorFunction,
    /// Mayer objective and boundary conditions.
    pub boundary: VectorFunction,
    /// Guess of states and controls.
    pub guess: VectorFunction,
    /// First and last time.
    pub interval: VectorFunction,
    /// The functions of the surfaces.
    pub switching: VectorFunction,
    /// What is reported.
    pub report: VectorFunction,
    /// Whether the last output of `dynamics` is the integrand of the objective.
    pub running_cost: bool,
    /// The integrals and sums that became states.
    pub hidden: Vec<Hidden>,
    /// The terms of sums over rows of measured data.
    pub measured: Vec<Measured>,
    /// The bounds of the outputs of `boundary` but the first.
    pub(crate) boundary_rows: Vec<boundary::Condition>,
}

/// Lowers a model.
pub fn lower(model: &Model) -> LoweredProblem {
    let mut graph = model.graph.clone();
    let objective = objective::split(model, &mut graph);
    let sizes = Sizes::new(model, objective.hidden.len());
    let flow = flow(model, &mut graph, &sizes, &objective);
    let over_grid =
        OverGrid { model, sizes: &sizes, inputs: inputs::over_grid(model, &mut graph, &sizes) };
    let mut dynamics = over_grid.dynamics(&mut graph, &objective);
    let measured = measured::lower(model, &mut graph, &sizes, &objective, &dynamics);
    dynamics.outputs =
        composed::compose(&mut graph, &model.method, &dynamics.layout, dynamics.outputs);
    let path = over_grid.function(
        &mut graph,
        "path",
        model.path.iter().map(|row| (row.value, origin(&row.place))),
        true,
    );
    let switching: Vec<_> =
        model.switches().iter().map(|it| (size(&mut graph, model, it), origin(it.place))).collect();
    let switching = over_grid.function(&mut graph, "switching", switching.into_iter(), false);
    let report = model.report.iter().map(|report| (report.value, origin(&report.place)));
    let report = over_grid.function(&mut graph, "report", report, false);
    let (boundary, boundary_rows) = boundary::lower(model, &mut graph, &sizes, &objective);
    let guess = guess::lower(model, &mut graph, &sizes);
    let interval = interval(model, &mut graph, &sizes);
    let running_cost = objective.running.is_some();
    let hidden = objective.hidden;
    LoweredProblem {
        graph,
        flow,
        dynamics,
        path,
        boundary,
        guess,
        interval,
        switching,
        report,
        running_cost,
        hidden,
        measured,
        boundary_rows,
    }
}

impl LoweredProblem {
    /// The functions that a problem compiles, in the order in which [`problem()`] takes them back.
    pub fn functions(&self) -> Vec<&VectorFunction> {
        let mut all = vec![
            &self.dynamics,
            &self.path,
            &self.boundary,
            &self.guess,
            &self.interval,
            &self.switching,
            &self.report,
        ];
        all.extend(self.measured.iter().map(|it| &it.term));
        all
    }
}

/// `psi` of a surface, `|psi|` of a ball.
fn size(graph: &mut Graph, model: &Model, switch: &Switch) -> ExprId {
    let psis: Vec<ExprId> =
        model.surfaces[switch.surfaces.clone()].iter().map(|it| it.psi).collect();
    if !switch.is_ball {
        return psis[0];
    }
    let squares: Vec<ExprId> = psis.iter().map(|&psi| graph.square(psi)).collect();
    let sum = graph.sum(&squares);
    graph.sqrt(sum)
}

/// Functions over normalised time, states, controls and parameters.
struct OverGrid<'m> {
    model: &'m Model,
    sizes: &'m Sizes,
    inputs: inputs::Inputs,
}

impl OverGrid<'_> {
    /// A function whose outputs are given over the symbols of the model.
    fn function(
        &self,
        graph: &mut Graph,
        name: &str,
        outputs: impl Iterator<Item = (ExprId, Origin)>,
        is_solved: bool,
    ) -> VectorFunction {
        let (outputs, origins): (Vec<ExprId>, Vec<Origin>) = outputs.unzip();
        let outputs = self.inputs.apply(graph, &outputs);
        let layout = self.sizes.grid();
        let by = if is_solved { inputs::solved_for(self.model, &layout) } else { Vec::new() };
        let outputs = if is_solved {
            smoothed(self.model, graph, &outputs, self.sizes, &layout)
        } else {
            outputs
        };
        VectorFunction { name: name.into(), layout, outputs, origins, by, order: Order::Second }
    }

    /// The rates, not yet as the increments of a composed scheme.
    fn dynamics(&self, graph: &mut Graph, objective: &Objective) -> VectorFunction {
        let zero = graph.number(0.0);
        let outputs = rates(self.model, zero, objective);
        let mut function = self.function(graph, "dynamics", outputs.into_iter(), true);
        let outputs =
            function.outputs.iter().map(|&output| graph.mul(self.inputs.duration, output));
        let rates: Vec<ExprId> = outputs.collect();
        function.outputs = rates;
        function
    }
}

/// Right sides: of the states, of the integrals that became states, of the running cost.
fn rates(model: &Model, zero: ExprId, objective: &Objective) -> Vec<(ExprId, Origin)> {
    let states = model.states.iter().map(|state| (state.rate, origin(&state.equation)));
    let hidden = |it: &Hidden| {
        let rate = match it {
            Hidden::Integral(at) => model.integrals[*at].integrand,
            Hidden::Sum(_) => zero,
        };
        (rate, origin(it.place(model)))
    };
    let running = objective.running.map(|cost| (cost, objective.origin.clone()));
    states.chain(objective.hidden.iter().map(hidden)).chain(running).collect()
}

fn flow(model: &Model, graph: &mut Graph, sizes: &Sizes, objective: &Objective) -> VectorFunction {
    let layout = sizes.flow();
    let inputs = inputs::of_flow(model, graph, &layout);
    let zero = graph.number(0.0);
    let (outputs, origins): (Vec<ExprId>, Vec<Origin>) =
        rates(model, zero, objective).into_iter().unzip();
    let outputs = inputs.apply(graph, &outputs);
    VectorFunction {
        name: "flow".into(),
        layout,
        outputs,
        origins,
        by: Vec::new(),
        order: Order::Second,
    }
}

fn interval(model: &Model, graph: &mut Graph, sizes: &Sizes) -> VectorFunction {
    let layout = Layout { p: sizes.parameters, ..Layout::default() };
    let inputs = inputs::of_parameters(model, graph, &layout);
    let outputs = inputs.apply(graph, &model.interval);
    let origins = ["t0", "tf"].map(|label| Origin { label: label.into(), span: (0, 0) }).to_vec();
    VectorFunction {
        name: "interval".into(),
        layout,
        outputs,
        origins,
        by: Vec::new(),
        order: Order::Second,
    }
}

/// The outputs with `abs`, `min` and `max` rounded, where smoothing is on.
fn smoothed(
    model: &Model,
    graph: &mut Graph,
    outputs: &[ExprId],
    sizes: &Sizes,
    layout: &Layout,
) -> Vec<ExprId> {
    match sizes.sigma_of_abs {
        Some(at) => {
            let sigma = graph.input((layout.parameters().start + at) as u32);
            kernels::smooth_nonsmooth(graph, outputs, kernel(model), sigma)
        }
        None => outputs.to_vec(),
    }
}

/// The kernel that the model asks for.
fn kernel(model: &Model) -> &'static kernels::Kernel {
    kernels::find(&model.method.kernel).expect("settings take only kernels of the table")
}

/// A place in the text as the runtime wants it.
fn origin(place: &Place) -> Origin {
    Origin { label: place.name.as_str().into(), span: (place.span.start, place.span.end) }
}
