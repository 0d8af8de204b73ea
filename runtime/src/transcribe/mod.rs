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
mod quantities;
mod sampled;
pub(crate) mod tableau;
mod tables;

use crate::linalg::{Stages, Triplets};
use crate::nlp::{Derivatives, NO_OBJECTIVE, Nlp, Place, Quantities, objective_unit};
use crate::problem::{Bounds, Columns, Degree, Measurements, Origin, Problem};
use assembly::{Builder, Repeated};
use boundary::Ends;
use interval::{Interval, Node, Point};
use measured::Measured;
use mesh::Mesh;
use sampled::{Matrices, Sampled, Target};

/// The NLP of a problem on a grid.
pub struct TranscribedNlp<'p> {
    problem: &'p Problem,
    /// See [`Nlp::objective_unit`]; nothing as long as nobody asks.
    objective_unit: Option<f64>,
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
        self.terms_of_rows(sum, parameters, v).iter().sum()
    }

    /// What it adds up.
    pub(crate) fn terms_of_rows(
        &self,
        sum: &Measurements,
        parameters: &[f64],
        v: &[f64],
    ) -> Vec<f64> {
        let (jacobian, hessian) = (Builder::default(), Builder::default());
        let mesh = self.mesh.clone();
        let mut unused = Matrices { stages: self.stages, mesh, jacobian, hessian };
        let mut measured = Measured::new(self.problem, sum, &self.interval, &mut unused);
        measured.load(&self.interval, &self.mesh, parameters, v);
        measured.terms(parameters).to_vec()
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

impl Nlp for TranscribedNlp<'_> {
    fn variable_bounds(&self) -> &[Bounds] {
        &self.variable_bounds
    }
    fn constraint_bounds(&self) -> &[Bounds] {
        &self.constraint_bounds
    }
    fn jacobian_structure(&self) -> &Triplets {
        &self.jacobian
    }
    fn hessian_structure(&self) -> &Triplets {
        &self.hessian
    }
    fn stages(&self) -> Option<Stages> {
        Some(self.stages)
    }
    fn quantities(&self) -> Quantities {
        self.all_quantities()
    }
    /// The unit is at most 1, and takes time to find out.
    fn objective_size(&mut self, terms: f64) -> f64 {
        if terms >= NO_OBJECTIVE { terms } else { terms.max(NO_OBJECTIVE * self.objective_unit()) }
    }
    fn objective_unit(&mut self) -> f64 {
        if self.objective_unit.is_none() {
            let guess = self.guess();
            self.objective_unit = Some(objective_unit(self, &guess));
        }
        self.objective_unit.unwrap_or(1.0)
    }

    fn values(&mut self, v: &[f64], rows: &mut [f64]) -> f64 {
        self.load(v);
        let stages = self.stages;
        let step = stages.variable_step();
        rows.fill(0.0);
        for link in &self.interval.links {
            let rows =
                rows[link.row..].iter_mut().step_by(stages.row_step()).take(stages.intervals);
            rows.zip(v[link.place..].iter().step_by(step))
                .for_each(|(row, x)| *row += link.value * x);
        }
        let mut objective = self.ends.values(stages, &self.parameters, rows);
        for sampled in self.nodes.iter_mut().chain(&mut self.path) {
            objective += sampled.add_values(stages, &self.parameters, rows);
        }
        for measured in &mut self.measured {
            objective += measured.add_values(&self.parameters, rows);
        }
        objective
    }

    fn derivatives(&mut self, v: &[f64], weight: f64, multipliers: &[f64], out: &mut Derivatives) {
        self.load(v);
        let Derivatives { gradient, jacobian, hessian } = out;
        gradient.fill(0.0);
        for (place, value) in &self.constant {
            jacobian[*place..][..self.stages.intervals].fill(*value);
        }
        for sampled in self.nodes.iter_mut().chain(&mut self.path) {
            sampled.differentiate(self.stages, &self.parameters, weight, multipliers);
            sampled.scatter(gradient, jacobian, hessian);
        }
        for measured in &mut self.measured {
            measured.differentiate(&self.parameters, weight, multipliers);
            measured.scatter(gradient, jacobian, hessian);
        }
        self.ends.differentiate(self.stages, &self.parameters, weight, multipliers);
        self.ends.scatter(gradient, jacobian, hessian);
    }

    fn is_linear(&self, row: usize) -> bool {
        let problem = self.problem;
        if let Some(i) = row.checked_sub(self.stages.coupling().start) {
            return problem.boundary.degree(i + 1) == Degree::Affine;
        }
        let path = (row % self.stages.row_step()).checked_sub(self.stages.defect_rows());
        let is_affine = |i| problem.path.degree(i) == Degree::Affine;
        path.is_some_and(|row| is_affine(row % problem.path_bounds.len()))
    }

    fn constraint_place(&self, row: usize) -> Place {
        let stages = self.stages;
        if let Some(i) = row.checked_sub(stages.coupling().start) {
            return Place { origin: self.problem.boundary.origin(i + 1), ..Place::default() };
        }
        let (k, i) = (row / stages.row_step(), row % stages.row_step());
        let origin = match i.checked_sub(stages.defect_rows()) {
            Some(row) => self.problem.path.origin(row % self.problem.path_bounds.len()),
            None => self.defect_origin(i),
        };
        Place { origin, grid_point: Some(k + 1), ..Place::default() }
    }

    fn not_finite(&mut self, v: &[f64]) -> Option<Place> {
        self.load(v);
        let (stages, rows) = (self.stages, self.constraint_bounds.len());
        for node in &mut self.nodes {
            if let Some((output, k)) = node.not_finite(stages, &self.parameters, rows) {
                return Some(Place {
                    origin: self.problem.dynamics.origin(output),
                    grid_point: Some(k),
                    ..Place::default()
                });
            }
        }
        for path in &mut self.path {
            if let Some((output, k)) = path.not_finite(stages, &self.parameters, rows) {
                return Some(Place {
                    origin: self.problem.path.origin(output),
                    grid_point: Some(k + 1),
                    ..Place::default()
                });
            }
        }
        for measured in &mut self.measured {
            if let Some(k) = measured.not_finite(&self.parameters) {
                let origin = measured.origin();
                return Some(Place { origin, grid_point: Some(k), ..Place::default() });
            }
        }
        let output = self.ends.not_finite(stages, &self.parameters, rows)?;
        Some(Place { origin: self.problem.boundary.origin(output), ..Place::default() })
    }
}
