//! From an optimal control problem to a nonlinear programme that is a chain of stages.
//!
//! ```text
//! variables   x_0 u_0  x_1 u_1  ...  x_N   unknowns
//! rows        defects_0 path_1   defects_1 path_2   ...   defects_{N-1} path_N   boundary conditions
//! ```
//!
//! A control is constant on its interval; path constraints hold at every grid point after the start, with the
//! control of the interval that ends there. Start values that are numbers are fixed variables.

mod assembly;
mod boundary;
mod sampled;
pub(crate) mod tableau;
mod tables;

use crate::linalg::{Stages, Triplets};
use crate::nlp::{Derivatives, Nlp, Place};
use crate::problem::{Bounds, Columns, Problem};
use assembly::{Builder, Repeated};
use boundary::Ends;
use sampled::{Matrices, Sampled, Target};

/// The programme of a problem on a uniform grid.
pub struct TranscribedNlp<'p> {
    problem: &'p Problem,
    stages: Stages,
    variable_bounds: Vec<Bounds>,
    row_bounds: Vec<Bounds>,
    jacobian: Triplets,
    hessian: Triplets,
    /// Values of the Jacobian that never change: `x_{k+1} - x_k`.
    constant: Vec<(usize, f64)>,
    /// The right side, once per node of the scheme; then the path constraints.
    nodes: Vec<Sampled>,
    path: Sampled,
    ends: Ends,
    /// All of `p`, unknowns included.
    parameters: Vec<f64>,
}

impl<'p> TranscribedNlp<'p> {
    /// Transcribes with the problem's own method.
    pub fn new(problem: &'p Problem) -> Self {
        let stages = stages(problem);
        let mut matrices = Matrices { stages, jacobian: Builder::default(), hessian: Builder::default() };
        let constant = state_differences(&mut matrices);
        let nodes = tableau::nodes(&problem.method, stages.states).into_iter().map(|node| {
            let targets = dynamics_targets(problem, stages, node.weight);
            Sampled::new(problem, &problem.dynamics, node.time, node.blend, targets, &mut matrices)
        });
        let nodes = nodes.collect();
        let targets = (0..stages.local_rows).map(|i| Target::Row(stages.states + i, 1.0)).collect();
        let path =
            Sampled::new(problem, &problem.path, 1.0, vec![1.0; stages.states], targets, &mut matrices);
        let Matrices { mut jacobian, mut hessian, .. } = matrices;
        let ends = Ends::new(problem, stages, &mut jacobian, &mut hessian);
        TranscribedNlp {
            problem,
            stages,
            variable_bounds: variable_bounds(problem, stages),
            row_bounds: row_bounds(problem, stages),
            jacobian: jacobian.finish(),
            hessian: hessian.finish(),
            constant,
            nodes,
            path,
            ends,
            parameters: problem.parameters.iter().map(|parameter| parameter.value).collect(),
        }
    }

    /// Sizes of the chain.
    pub fn chain(&self) -> Stages {
        self.stages
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

    /// The model's guess on the grid; running integrals are those of the guess.
    pub fn guess(&mut self) -> Vec<f64> {
        let mut v = self.guessed();
        let hidden: Vec<usize> = (0..self.stages.states).filter(|&i| self.problem.states[i].hidden).collect();
        if !hidden.is_empty() {
            let mut rows = vec![0.0; self.row_bounds.len()];
            self.values(&v, &mut rows);
            for k in 0..self.stages.intervals {
                for &i in &hidden {
                    let defect = rows[self.stages.defects(k).start + i];
                    let next =
                        v[self.stages.state(k).start + i] - if defect.is_finite() { defect } else { 0.0 };
                    v[self.stages.state(k + 1).start + i] = next;
                }
            }
        }
        v
    }

    fn guessed(&self) -> Vec<f64> {
        let (stages, problem) = (self.stages, self.problem);
        let mut points = Columns::new(problem.guess.layout().point_inputs(), stages.intervals + 1);
        for (k, tau) in points.column_mut(0).iter_mut().enumerate() {
            *tau = k as f64 / stages.intervals as f64;
        }
        let mut values = Columns::new(problem.guess.outputs(), stages.intervals + 1);
        problem.guess.value(&points, &self.parameters, &mut values);
        let mut v = vec![0.0; stages.variables()];
        for k in 0..=stages.intervals {
            let end = if k < stages.intervals { stages.control(k).end } else { stages.state(k).end };
            for (column, variable) in (stages.state(k).start..end).enumerate() {
                let value = values.column(column)[k];
                v[variable] = if value.is_finite() { value } else { 0.0 };
            }
        }
        for (variable, unknown) in stages.globals().zip(&problem.unknowns) {
            v[variable] = self.parameters[unknown.parameter];
        }
        v
    }

    /// The gradient of the objective, with each `x_k` counting only in the interval that begins at it, and `x_N` only
    /// in the Mayer objective. Belongs to the point of the last call of `derivatives`.
    pub(crate) fn gradient_from_here_on(&self) -> Vec<f64> {
        let mut gradient = vec![0.0; self.stages.variables()];
        self.nodes.iter().for_each(|node| node.add_own_gradient(self.stages, &mut gradient));
        self.ends.add_last_gradient(self.stages, &mut gradient);
        gradient
    }

    /// Whether a row is a step of a differential equation.
    pub fn is_defect(&self, row: usize) -> bool {
        row < self.stages.coupling().start && row % self.stages.row_step() < self.stages.states
    }

    /// The largest absolute value of each switching function along `v`.
    pub fn guard_sizes(&self, v: &[f64]) -> Vec<f64> {
        let guards = crate::trajectory::guards(self.problem, self.stages, v, &self.parameters_at(v));
        guards.iter().map(|psi| psi.iter().fold(0.0, |a: f64, value| a.max(value.abs()))).collect()
    }

    fn load(&mut self, v: &[f64]) {
        for (unknown, variable) in self.problem.unknowns.iter().zip(self.stages.globals()) {
            self.parameters[unknown.parameter] = v[variable];
        }
        self.nodes.iter_mut().for_each(|node| node.load(self.stages, v));
        self.path.load(self.stages, v);
        self.ends.load(self.stages, v);
    }
}

fn stages(problem: &Problem) -> Stages {
    Stages {
        intervals: problem.method.intervals,
        states: problem.layout.x,
        controls: problem.layout.u,
        inner: 0,
        globals: problem.unknowns.len(),
        local_rows: problem.path_bounds.len(),
        coupling_rows: problem.boundary_bounds.len(),
    }
}

/// Outputs of the right side go to the defects with `-b/N`; the integrand goes to the objective with `b/N`.
fn dynamics_targets(problem: &Problem, stages: Stages, weight: f64) -> Vec<Target> {
    let h = weight / stages.intervals as f64;
    let defects = (0..stages.states).map(|row| Target::Row(row, -h));
    defects.chain(problem.running_cost.then_some(Target::Objective(h))).collect()
}

fn state_differences(matrices: &mut Matrices) -> Vec<(usize, f64)> {
    let stages = matrices.stages;
    let (row_step, step) = (stages.row_step(), stages.variable_step());
    let mut constant = Vec::new();
    for state in 0..stages.states {
        for (first, value) in [(state, -1.0), (step + state, 1.0)] {
            let row = Repeated { first: state, step: row_step };
            let place = matrices.jacobian.place(row, Repeated { first, step }, stages.intervals);
            constant.push((place, value));
        }
    }
    constant
}

fn variable_bounds(problem: &Problem, stages: Stages) -> Vec<Bounds> {
    let mut bounds = vec![Bounds::FREE; stages.variables()];
    for k in 0..=stages.intervals {
        for (variable, state) in stages.state(k).zip(&problem.states) {
            bounds[variable] = state.bounds;
        }
    }
    for k in 0..stages.intervals {
        for (variable, control) in stages.control(k).zip(&problem.controls) {
            bounds[variable] = control.bounds;
        }
    }
    for (variable, start) in stages.state(0).zip(&problem.start) {
        if let Some(value) = start {
            bounds[variable] = Bounds::fixed(*value);
        }
    }
    for (variable, unknown) in stages.globals().zip(&problem.unknowns) {
        bounds[variable] = unknown.bounds;
    }
    for (variable, value) in boundary::given_at_the_end(problem, stages) {
        // On its bound the state would have no interior.
        if bounds[variable].violation(value) == 0.0 {
            bounds[variable] = Bounds::FREE;
        }
    }
    bounds
}

fn row_bounds(problem: &Problem, stages: Stages) -> Vec<Bounds> {
    let mut bounds = vec![Bounds::fixed(0.0); stages.rows()];
    for k in 0..stages.intervals {
        bounds[stages.local(k)].copy_from_slice(&problem.path_bounds);
    }
    bounds[stages.coupling()].copy_from_slice(&problem.boundary_bounds);
    bounds
}

impl Nlp for TranscribedNlp<'_> {
    fn variable_bounds(&self) -> &[Bounds] {
        &self.variable_bounds
    }
    fn row_bounds(&self) -> &[Bounds] {
        &self.row_bounds
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

    fn values(&mut self, v: &[f64], rows: &mut [f64]) -> f64 {
        self.load(v);
        let stages = self.stages;
        let step = stages.variable_step();
        rows.fill(0.0);
        for k in 0..stages.intervals {
            let here = stages.state(k).start;
            for (i, row) in stages.defects(k).enumerate() {
                rows[row] = v[here + step + i] - v[here + i];
            }
        }
        let mut objective = self.ends.values(stages, &self.parameters, rows);
        for sampled in self.nodes.iter_mut().chain([&mut self.path]) {
            objective += sampled.add_values(stages, &self.parameters, rows);
        }
        objective
    }

    fn derivatives(&mut self, v: &[f64], weight: f64, multipliers: &[f64], out: &mut Derivatives) {
        self.load(v);
        let Derivatives { gradient, jacobian, hessian } = out;
        gradient.fill(0.0);
        jacobian.fill(0.0);
        hessian.fill(0.0);
        for (place, value) in &self.constant {
            jacobian[*place..][..self.stages.intervals].fill(*value);
        }
        for sampled in self.nodes.iter_mut().chain([&mut self.path]) {
            sampled.differentiate(self.stages, &self.parameters, weight, multipliers);
            sampled.scatter(gradient, jacobian, hessian);
        }
        self.ends.differentiate(self.stages, &self.parameters, weight, multipliers);
        self.ends.scatter(gradient, jacobian, hessian);
    }

    fn row_place(&self, row: usize) -> Place {
        let stages = self.stages;
        if let Some(i) = row.checked_sub(stages.coupling().start) {
            return Place { origin: self.problem.boundary.origin(i + 1), grid_point: None };
        }
        let (k, i) = (row / stages.row_step(), row % stages.row_step());
        let origin = match i.checked_sub(stages.states) {
            None => self.problem.dynamics.origin(i),
            Some(path) => self.problem.path.origin(path),
        };
        Place { origin, grid_point: Some(k + 1) }
    }

    fn not_finite(&mut self, v: &[f64]) -> Option<Place> {
        self.load(v);
        let (stages, rows) = (self.stages, self.row_bounds.len());
        for node in &mut self.nodes {
            if let Some((output, k)) = node.not_finite(stages, &self.parameters, rows) {
                return Some(Place { origin: self.problem.dynamics.origin(output), grid_point: Some(k) });
            }
        }
        if let Some((output, k)) = self.path.not_finite(stages, &self.parameters, rows) {
            return Some(Place { origin: self.problem.path.origin(output), grid_point: Some(k + 1) });
        }
        let output = self.ends.not_finite(stages, &self.parameters, rows)?;
        Some(Place { origin: self.problem.boundary.origin(output), grid_point: None })
    }
}
