//! The nonlinear programme of a problem at one point, once more, from nothing but the functions of the problem.
//!
//! ```text
//! variables    x_0 u_0  x_1 u_1  ...  x_N  g            h = 1/N,  F over normalised time
//! rows         d_0 c_1  d_1 c_2  ...  d_{N-1} c_N  b(x_0, x_N)
//! defects      d_k = x_{k+1} - x_k - h sum_j b_j F(tau_k + c_j h, (1 - w_j) x_k + w_j x_{k+1}, u_k)
//! path         c_{k+1} = c(tau_{k+1}, x_{k+1}, u_k)
//! objective    M(x_0, x_N) + h sum_k sum_j b_j cost_kj
//! ```
//!
//! One point and one entry at a time, on purpose: nothing is shared with the transcription that it checks.

use fdcc_runtime::problem::{Bounds, Columns, Function, Problem, Scheme};

/// Values and first derivatives.
pub struct Transcribed {
    /// Objective of the minimisation problem.
    pub objective: f64,
    /// Its gradient.
    pub gradient: Vec<f64>,
    /// Rows.
    pub rows: Vec<f64>,
    /// Their bounds.
    pub row_bounds: Vec<Bounds>,
    /// `(row, variable, derivative)`; several for one place add up.
    pub jacobian: Vec<(usize, usize, f64)>,
    /// Bounds of the variables.
    pub variable_bounds: Vec<Bounds>,
}

/// One evaluation of the right side: its weight `b`, its time `c`, and the share `w` of the new states.
struct Node {
    weight: f64,
    time: f64,
    share: Vec<f64>,
}

fn nodes(problem: &Problem) -> Vec<Node> {
    let node = |weight, time| Node { weight, time, share: vec![time; problem.layout.x] };
    match problem.method.scheme {
        Scheme::Euler | Scheme::RungeKutta4 => vec![node(1.0, 0.0)],
        Scheme::Midpoint => vec![node(1.0, 0.5)],
        Scheme::Trapezoid => vec![node(0.5, 0.0), node(0.5, 1.0)],
        Scheme::ImplicitEuler => {
            let mut new = node(1.0, 1.0);
            problem.method.lagged.iter().for_each(|&state| new.share[state] = 0.0);
            vec![new]
        }
    }
}

/// A function at one point: its values, and `(output, variable of the programme, derivative)`.
struct Sample {
    values: Vec<f64>,
    slopes: Vec<(usize, usize, f64)>,
}

/// The problem at a point.
struct At<'a> {
    problem: &'a Problem,
    v: &'a [f64],
    parameters: Vec<f64>,
}

impl Transcribed {
    /// Evaluates everything at `v`, with the smoothing widths `sigma`.
    pub fn new(problem: &Problem, sigma: &[f64], v: &[f64]) -> Self {
        let at = At { problem, v, parameters: parameters(problem, sigma, v) };
        let mut result = Transcribed {
            objective: 0.0,
            gradient: vec![0.0; v.len()],
            rows: Vec::new(),
            row_bounds: Vec::new(),
            jacobian: Vec::new(),
            variable_bounds: at.variable_bounds(),
        };
        for k in 0..problem.method.intervals {
            result.defects(&at, k);
            let path = at.sample(&*problem.path, k, 1.0, &vec![1.0; problem.layout.x]);
            result.constraints(&path, 0, &problem.path_bounds);
        }
        let ends = at.ends();
        result.cost(&ends, 0, 1.0);
        result.constraints(&ends, 1, &problem.boundary_bounds);
        result
    }

    fn defects(&mut self, at: &At, k: usize) {
        let (states, h) = (at.problem.layout.x, 1.0 / at.problem.method.intervals as f64);
        let (first, here, next) = (self.rows.len(), at.place(k), at.place(k + 1));
        for i in 0..states {
            self.rows.push(at.v[next + i] - at.v[here + i]);
            self.row_bounds.push(Bounds::fixed(0.0));
            self.jacobian.extend([(first + i, next + i, 1.0), (first + i, here + i, -1.0)]);
        }
        for node in nodes(at.problem) {
            let found = at.sample(&*at.problem.dynamics, k, node.time, &node.share);
            for i in 0..states {
                self.rows[first + i] -= h * node.weight * found.values[i];
            }
            for &(output, variable, slope) in found.slopes.iter().filter(|slope| slope.0 < states) {
                self.jacobian.push((first + output, variable, -h * node.weight * slope));
            }
            if at.problem.running_cost {
                self.cost(&found, states, h * node.weight);
            }
        }
    }

    /// Adds an output to the objective.
    fn cost(&mut self, found: &Sample, output: usize, weight: f64) {
        self.objective += weight * found.values[output];
        for (_, variable, slope) in found.slopes.iter().filter(|slope| slope.0 == output) {
            self.gradient[*variable] += weight * slope;
        }
    }

    /// Adds rows for the outputs from `skipped` on.
    fn constraints(&mut self, found: &Sample, skipped: usize, bounds: &[Bounds]) {
        let first = self.rows.len();
        self.rows.extend_from_slice(&found.values[skipped..]);
        self.row_bounds.extend_from_slice(bounds);
        for &(output, variable, slope) in found.slopes.iter().filter(|slope| slope.0 >= skipped) {
            self.jacobian.push((first + output - skipped, variable, slope));
        }
    }
}

/// The parameters of the model, with these widths and with the unknowns as in `v`.
fn parameters(problem: &Problem, sigma: &[f64], v: &[f64]) -> Vec<f64> {
    let mut parameters: Vec<f64> = problem.parameters.iter().map(|parameter| parameter.value).collect();
    for (surface, sigma) in problem.surfaces.iter().zip(sigma) {
        parameters[surface.sigma] = *sigma;
    }
    for (unknown, value) in problem.unknowns.iter().rev().zip(v.iter().rev()) {
        parameters[unknown.parameter] = *value;
    }
    parameters
}

impl At<'_> {
    /// The place of `x_k`; `u_k` follows it.
    fn place(&self, k: usize) -> usize {
        k * (self.problem.layout.x + self.problem.layout.u)
    }

    /// The place of an unknown, given its place in `p`.
    fn unknown(&self, parameter: usize) -> usize {
        let unknowns = &self.problem.unknowns;
        let index = unknowns.iter().position(|unknown| unknown.parameter == parameter);
        self.v.len() - unknowns.len() + index.expect("differentiated by unknowns only")
    }

    /// A function over normalised time in interval `k`.
    fn sample(&self, function: &dyn Function, k: usize, time: f64, share: &[f64]) -> Sample {
        let (here, next, states) = (self.place(k), self.place(k + 1), share.len());
        let mut point = vec![(k as f64 + time) / self.problem.method.intervals as f64];
        for i in 0..states {
            // The end that does not count may be anything.
            let ends = [(1.0 - share[i], self.v[here + i]), (share[i], self.v[next + i])];
            point.push(ends.iter().filter(|(weight, _)| *weight > 0.0).map(|(weight, x)| weight * x).sum());
        }
        point.extend_from_slice(&self.v[here + states..here + states + self.problem.layout.u]);
        let controls_end = point.len();
        self.evaluate(function, &point, |input| match input {
            i if i > controls_end - 1 => vec![(self.unknown(i - controls_end), 1.0)],
            i if i > states => vec![(here + i - 1, 1.0)],
            i => vec![(here + i - 1, 1.0 - share[i - 1]), (next + i - 1, share[i - 1])],
        })
    }

    fn ends(&self) -> Sample {
        let (states, last) = (self.problem.layout.x, self.place(self.problem.method.intervals));
        let point: Vec<f64> =
            [0, last].iter().flat_map(|first| &self.v[*first..first + states]).copied().collect();
        self.evaluate(&*self.problem.boundary, &point, |input| match input {
            i if i >= 2 * states => vec![(self.unknown(i - 2 * states), 1.0)],
            i if i >= states => vec![(last + i - states, 1.0)],
            i => vec![(i, 1.0)],
        })
    }

    /// `places` says where an input is among the variables of the programme, with factors.
    fn evaluate(
        &self,
        function: &dyn Function,
        point: &[f64],
        places: impl Fn(usize) -> Vec<(usize, f64)>,
    ) -> Sample {
        let pattern = &function.jacobian_pattern().entries;
        let mut points = Columns::new(point.len(), 1);
        point.iter().enumerate().for_each(|(column, value)| points.column_mut(column)[0] = *value);
        let (mut values, mut jacobian) =
            (Columns::new(function.outputs(), 1), Columns::new(pattern.len(), 1));
        function.jacobian(&points, &self.parameters, &mut values, &mut jacobian);
        let mut slopes = Vec::new();
        for (entry, (row, input)) in pattern.iter().enumerate() {
            let slope = jacobian.column(entry)[0];
            slopes.extend(
                places(*input as usize).iter().map(|(place, factor)| (*row as usize, *place, factor * slope)),
            );
        }
        Sample { values: (0..function.outputs()).map(|row| values.column(row)[0]).collect(), slopes }
    }

    fn variable_bounds(&self) -> Vec<Bounds> {
        let (problem, intervals) = (self.problem, self.problem.method.intervals);
        let mut bounds = Vec::new();
        for k in 0..=intervals {
            bounds.extend(problem.states.iter().map(|state| state.bounds));
            bounds.extend(problem.controls.iter().filter(|_| k < intervals).map(|control| control.bounds));
        }
        for (i, start) in problem.start.iter().enumerate() {
            bounds[i] = start.map_or(bounds[i], Bounds::fixed);
        }
        bounds.extend(problem.unknowns.iter().map(|unknown| unknown.bounds));
        bounds
    }
}
