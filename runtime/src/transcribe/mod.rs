//! From an optimal control problem to a nonlinear program that is a chain of stages.
//!
//! ```text
//! variables   x_0 u_0 y_0  x_1 u_1 y_1  ...  x_N   unknowns
//! constraints defects_0 path_1   defects_1 path_2  ...  defects_{N-1} path_N   boundary conditions
//! ```
//!
//! What stands in one interval is the scheme's business: [`interval`]. Path constraints hold at
//! every grid point after the start, and at the nodes of a collocation scheme. Start values that
//! are numbers are fixed variables.

mod assembly;
mod boundary;
mod bounds;
pub mod chain;
pub(crate) mod collocation;
mod guess;
pub(crate) mod interval;
mod measured;
pub(crate) mod mesh;
mod nlp;
mod quantities;
mod sampled;
pub(crate) mod tableau;
mod tables;

use crate::linalg::{Stages, Triplets};
use crate::nlp::Quantities;
use crate::problem::{Bounds, Columns, Measurements, Origin, Problem};
use assembly::{Builder, Repeated};
use boundary::Ends;
use interval::{Interval, Node, Point};
use measured::Measured;
use mesh::Mesh;
use sampled::{Matrices, Sampled, Target};
use std::cell::OnceCell;
use std::sync::Arc;

/// The NLP of a problem on a grid.
pub struct TranscribedNlp<'p> {
    problem: &'p Problem,
    /// See [`Nlp::objective_unit`](crate::nlp::Nlp::objective_unit); nothing as long as nobody
    /// asks.
    objective_unit: Option<f64>,
    /// The same of [`Nlp::quantities`](crate::nlp::Nlp::quantities).
    quantities: OnceCell<Arc<Quantities>>,
    stages: Stages,
    interval: Interval,
    mesh: Mesh,
    variable_bounds: Vec<Bounds>,
    constraint_bounds: Vec<Bounds>,
    jacobian: Triplets,
    hessian: Triplets,
    /// Values of the Jacobian that never change, such as those of `x_{k+1} - x_k`: the first of
    /// each family.
    constant: Vec<(usize, f64)>,
    /// The right side, once per node of the scheme.
    nodes: Vec<Sampled>,
    /// The path constraints, once per point of an interval.
    path: Vec<Sampled>,
    /// Sums over rows of measured data.
    measured: Vec<Measured<'p>>,
    ends: Ends,
    /// All of `p`, unknowns included.
    parameters: Vec<f64>,
}

impl<'p> TranscribedNlp<'p> {
    /// Transcribes with the problem's own method.
    pub fn new(problem: &'p Problem) -> Self {
        let interval = Interval::new(&problem.method, &problem.layout);
        let stages = stages(problem, &interval);
        let mesh = Mesh::new(&problem.method);
        let (jacobian, hessian) = (Builder::default(), Builder::default());
        let mut matrices = Matrices { stages, mesh: mesh.clone(), jacobian, hessian };
        let constant = constant(&interval, &mut matrices);
        let nodes = nodes(problem, &interval, &mut matrices);
        let path = path(problem, &interval, &mut matrices);
        let measured = problem.measurements.iter();
        let measured: Vec<Measured> =
            measured.map(|it| Measured::new(problem, it, &interval, &mut matrices)).collect();
        let Matrices { mut jacobian, mut hessian, .. } = matrices;
        let ends = Ends::new(problem, stages, &mut jacobian, &mut hessian);
        TranscribedNlp {
            problem,
            objective_unit: None,
            quantities: OnceCell::new(),
            stages,
            variable_bounds: bounds::of_variables(problem, stages, &interval),
            constraint_bounds: bounds::of_rows(problem, stages),
            interval,
            mesh,
            jacobian: jacobian.finish(),
            hessian: hessian.finish(),
            constant,
            nodes,
            path,
            measured,
            ends,
            parameters: problem.parameters.iter().map(|parameter| parameter.value).collect(),
        }
    }

    /// What is transcribed.
    pub(crate) fn problem(&self) -> &'p Problem {
        self.problem
    }

    /// Sizes of the chain.
    pub fn chain(&self) -> Stages {
        self.stages
    }

    /// The grid.
    pub(crate) fn mesh(&self) -> &Mesh {
        &self.mesh
    }

    /// What stands in one interval.
    pub(crate) fn interval(&self) -> &Interval {
        &self.interval
    }

    /// Changes entries of `p` (smoothing widths) without transcribing again.
    pub fn set_parameter(&mut self, index: usize, value: f64) {
        self.parameters[index] = value;
    }

    /// The current `p`, with the unknowns as in `v`.
    pub fn parameters_at(&self, v: &[f64]) -> Vec<f64> {
        let mut parameters = self.parameters.clone();
        let globals = &v[self.stages.globals()];
        for (unknown, value) in self.problem.unknowns.iter().zip(globals) {
            parameters[unknown.parameter] = *value;
        }
        parameters
    }

    /// The gradient of the objective, with each `x_k` counting only in the interval that begins at
    /// it, and `x_N` only in the Mayer objective. Belongs to the point of the last call of
    /// `derivatives`.
    pub(crate) fn gradient_from_here_on(&self) -> Vec<f64> {
        let mut gradient = vec![0.0; self.stages.variables()];
        self.nodes.iter().for_each(|node| node.add_own_gradient(self.stages, &mut gradient));
        self.measured.iter().for_each(|it| it.add_own_gradient(&mut gradient));
        self.ends.add_last_gradient(self.stages, &mut gradient);
        gradient
    }

    /// The points of the rows of each sum at `v`, and what its term counts there in the Lagrangian.
    pub(crate) fn rows(&mut self, v: &[f64], multipliers: &[f64]) -> Vec<(Columns, Vec<f64>)> {
        self.load(v);
        let of = |it: &Measured| (it.points().clone(), it.weights(1.0, multipliers));
        self.measured.iter().map(of).collect()
    }

    /// What a sum over rows is at `v`.
    pub(crate) fn sum_over_rows(&self, sum: &Measurements, parameters: &[f64], v: &[f64]) -> f64 {
        self.terms_of_rows(sum, parameters, v).iter().map(|it| it.1).sum()
    }

    /// What it adds up in the time of the problem, each term with the number of its row.
    pub(crate) fn terms_of_rows(
        &self,
        sum: &Measurements,
        parameters: &[f64],
        v: &[f64],
    ) -> Vec<(usize, f64)> {
        let (jacobian, hessian) = (Builder::default(), Builder::default());
        let mesh = self.mesh.clone();
        let mut unused = Matrices { stages: self.stages, mesh, jacobian, hessian };
        let mut measured = Measured::new(self.problem, sum, &self.interval, &mut unused);
        measured.load(&self.interval, &self.mesh, parameters, v);
        measured.terms(parameters)
    }

    /// Whether a row is a step of a differential equation.
    pub fn is_defect(&self, row: usize) -> bool {
        row < self.stages.coupling().start
            && row % self.stages.row_step() < self.stages.defect_rows()
    }

    /// A step of an equation, or a control that goes on into the next interval.
    fn defect_origin(&self, row: usize) -> Origin {
        let Problem { layout, dynamics, controls, .. } = self.problem;
        let handed_on = self.stages.states - layout.x;
        match row.checked_sub(self.stages.defect_rows() - handed_on) {
            Some(control) => controls[control].origin.clone(),
            None => dynamics.origin(row % layout.x),
        }
    }

    fn load(&mut self, v: &[f64]) {
        for (unknown, variable) in self.problem.unknowns.iter().zip(self.stages.globals()) {
            self.parameters[unknown.parameter] = v[variable];
        }
        self.nodes
            .iter_mut()
            .chain(&mut self.path)
            .for_each(|sampled| sampled.load(self.stages, v));
        let (interval, mesh) = (&self.interval, &self.mesh);
        self.measured.iter_mut().for_each(|it| it.load(interval, mesh, &self.parameters, v));
        self.ends.load(self.stages, v);
    }
}

/// How many numbers the optimiser chooses, counted without transcribing.
pub fn unknowns(problem: &Problem) -> usize {
    let interval = Interval::new(&problem.method, &problem.layout);
    let in_all = problem.method.intervals().saturating_mul(interval.slots.len());
    in_all.saturating_add(interval.carried + problem.unknowns.len())
}

/// How many path conditions it has to meet, and functions of surfaces it looks at, in all intervals
/// together, counted without transcribing.
pub fn conditions(problem: &Problem) -> usize {
    let interval = Interval::new(&problem.method, &problem.layout);
    let in_each = problem.path_bounds.len().saturating_mul(interval.path.len());
    problem.method.intervals().saturating_mul(in_each.saturating_add(problem.surfaces.len()))
}

/// The chain of the NLP of a problem, without transcribing it.
pub(crate) fn chain_of(problem: &Problem) -> Stages {
    stages(problem, &Interval::new(&problem.method, &problem.layout))
}

fn stages(problem: &Problem, interval: &Interval) -> Stages {
    Stages {
        intervals: problem.method.intervals(),
        states: interval.carried,
        controls: interval.chosen,
        inner: interval.inner(),
        globals: problem.unknowns.len(),
        local_constraints: problem.path_bounds.len() * interval.path.len(),
        coupling_constraints: problem.boundary_bounds.len(),
    }
}

/// The right side, once per node.
fn nodes(problem: &Problem, interval: &Interval, matrices: &mut Matrices) -> Vec<Sampled> {
    let sampled = |node: &Node| {
        let targets = dynamics_targets(problem, matrices.stages, node);
        let sampled =
            Sampled::new(problem, &problem.dynamics, node.point.clone(), targets, matrices);
        sampled.per_length(&matrices.mesh)
    };
    interval.nodes.iter().map(sampled).collect()
}

/// The path constraints, once per point at which they hold.
fn path(problem: &Problem, interval: &Interval, matrices: &mut Matrices) -> Vec<Sampled> {
    let rows = problem.path_bounds.len();
    let sampled = |(at, point): (usize, &Point)| {
        let first = matrices.stages.defect_rows() + at * rows;
        let targets = (first..first + rows).map(|row| Target::Row(row, 1.0)).collect();
        let sampled = Sampled::new(problem, &problem.path, point.clone(), targets, matrices);
        if point.time == 1.0 { sampled.half_open(problem) } else { sampled }
    };
    interval.path.iter().enumerate().map(sampled).collect()
}

/// Outputs of the right side go to the rows of their node; the integrand goes to the objective with
/// `b/N`.
fn dynamics_targets(problem: &Problem, stages: Stages, node: &Node) -> Vec<Target> {
    let scale = |factor: f64| factor / stages.intervals as f64;
    let rows = node.row..node.row + problem.layout.x;
    let defects = rows.map(|row| Target::Row(row, -scale(node.factor)));
    defects.chain(problem.running_cost.then_some(Target::Objective(scale(node.weight)))).collect()
}

fn constant(interval: &Interval, matrices: &mut Matrices) -> Vec<(usize, f64)> {
    let stages = matrices.stages;
    let (row_step, step) = (stages.row_step(), stages.variable_step());
    let places = interval.links.iter().map(|link| {
        let (row, column) =
            (Repeated { first: link.row, step: row_step }, Repeated { first: link.place, step });
        (matrices.jacobian.place(row, column, stages.intervals).first, link.value)
    });
    places.collect()
}
