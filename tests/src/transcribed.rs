//! The nonlinear program of a problem at one point, once more, from nothing but the functions of
//! the problem.
//!
//! ```text
//! variables    x_0 u_0 y_0  x_1 u_1 y_1  ...  x_N  g
//! rows         d_0 c_1  d_1 c_2  ...  d_{N-1} c_N  b(x_0, x_N)
//! defects      x_{k+1} - x_k - h sum_j b_j F(tau_k + c_j h, (1 - w_j) x_k + w_j x_{k+1}, u_k)
//!                                                           of one-step schemes
//!              X'(c_i) - h F(tau_k + c_i h, X(c_i), u)      of collocation
//!              x_{k+1} - X(1)                               for Gauss
//! path         c(tau, x, u) at all grid points but the first, and at the nodes of collocation
//! objective    M(x_0, x_N) + h sum_k sum_j b_j cost_kj
//! ```
//!
//! with `h = tau_{k+1} - tau_k`, `F` over normalised time, and `X` the polynomial through `x_k`,
//! `y_k` and, for Radau, `x_{k+1}`.
//!
//! One point and one entry at a time, on purpose: nothing is shared with the transcription that it
//! checks.

use crate::quadrature::{gauss, radau, weights};
use fdcc_runtime::problem::{Bounds, Columns, ControlShape, Function, Problem, Scheme};

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

/// A value of an interval as a sum of its variables: places from `x_k` on, with factors.
type Sum = Vec<(usize, f64)>;

/// A point of an interval: its time, its states and its controls.
struct Point {
    time: f64,
    states: Vec<Sum>,
    controls: Vec<Sum>,
}

/// A point where the right side is evaluated: its weight `b`, its first row and the factor there.
struct Node {
    point: Point,
    weight: f64,
    row: usize,
    factor: f64,
}

/// One interval of the grid.
struct Grid {
    states: usize,
    controls: usize,
    /// What goes on to the next interval.
    carried: usize,
    /// All variables before `x_{k+1}`.
    step: usize,
    /// Of collocation.
    times: Vec<f64>,
    /// Steps in the interval.
    parts: usize,
    shape: ControlShape,
    nodes: Vec<Node>,
    /// Constant entries: row, place, value.
    links: Vec<(usize, usize, f64)>,
    path: Vec<Point>,
}

impl Grid {
    fn new(problem: &Problem) -> Self {
        let (method, states, controls) = (&problem.method, problem.layout.x, problem.layout.u);
        let times = match method.scheme {
            Scheme::Gauss(s) => gauss(s),
            Scheme::Radau(s) => radau(s),
            _ => Vec::new(),
        };
        let chosen = if method.controls == ControlShape::Polynomial {
            times.len() * controls
        } else {
            controls
        };
        let carried = states + if method.controls == ControlShape::Linear { controls } else { 0 };
        let inside = times.iter().filter(|time| **time < 1.0).count();
        let inner = method.steps * (inside + 1) - 1;
        let (nodes, links, path) = (Vec::new(), Vec::new(), Vec::new());
        let (step, parts, shape) =
            (carried + chosen + inner * states, method.steps, method.controls);
        let mut grid =
            Grid { states, controls, carried, step, times, parts, shape, nodes, links, path };
        for part in 0..parts {
            if grid.times.is_empty() {
                grid.one_step(problem, part)
            } else {
                grid.collocation(part)
            }
            if part + 1 < parts {
                let (time, place) = (grid.time(part, 1.0), grid.end_of(part));
                let point = grid.point(time, |i| vec![(place + i, 1.0)]);
                grid.path.push(point);
            }
        }
        let last = grid.point(1.0, |i| vec![(step + i, 1.0)]);
        grid.path.push(last);
        let first = grid.parts * grid.rows_of_part();
        for i in 0..carried - states {
            grid.links
                .extend([(first + i, step + states + i, 1.0), (first + i, carried + i, -1.0)]);
        }
        grid
    }

    /// Rows of the interval that are equations.
    fn defects(&self) -> usize {
        self.step - self.inner_place() + self.carried
    }

    /// The place of the first state inside the interval.
    fn inner_place(&self) -> usize {
        self.step + self.states - self.parts * self.rows_of_part()
    }

    /// Equations of one step; as many as it has variables beside those that it begins with.
    fn rows_of_part(&self) -> usize {
        (self.times.iter().filter(|time| **time < 1.0).count() + 1) * self.states
    }

    /// The place of the states at the end of a step.
    fn end_of(&self, part: usize) -> usize {
        let inside = self.inner_place() + (part + 1) * self.rows_of_part() - self.states;
        if part + 1 == self.parts { self.step } else { inside }
    }

    fn start_of(&self, part: usize) -> usize {
        if part == 0 { 0 } else { self.end_of(part - 1) }
    }

    fn time(&self, part: usize, time: f64) -> f64 {
        (part as f64 + time) / self.parts as f64
    }

    fn one_step(&mut self, problem: &Problem, part: usize) {
        let (states, start, end) = (self.states, self.start_of(part), self.end_of(part));
        let (row, length) = (part * self.rows_of_part(), 1.0 / self.parts as f64);
        let node = |weight: f64, time: f64| (weight, time, vec![time; states]);
        let nodes = match problem.method.scheme {
            Scheme::Midpoint => vec![node(1.0, 0.5)],
            Scheme::Trapezoid => vec![node(0.5, 0.0), node(0.5, 1.0)],
            Scheme::ImplicitEuler => {
                let mut new = node(1.0, 1.0);
                problem.method.lagged.iter().for_each(|&state| new.2[state] = 0.0);
                vec![new]
            }
            _ => vec![node(1.0, 0.0)],
        };
        for (weight, time, share) in nodes {
            let states = |i: usize| vec![(start + i, 1.0 - share[i]), (end + i, share[i])];
            let point = self.point(self.time(part, time), states);
            self.nodes.push(Node { point, weight: weight * length, row, factor: weight * length });
        }
        self.link(row, &[start, end], &[-1.0, 1.0]);
    }

    fn collocation(&mut self, part: usize) {
        let (states, times) = (self.states, self.times.clone());
        let (row, length) = (part * self.rows_of_part(), 1.0 / self.parts as f64);
        let first = self.inner_place() + row;
        let points: Vec<f64> = [0.0].into_iter().chain(times.iter().copied()).collect();
        let place = |j: usize| match j {
            0 => self.start_of(part),
            j if points[j] == 1.0 => self.end_of(part),
            j => first + (j - 1) * states,
        };
        let places: Vec<usize> = (0..points.len()).map(place).collect();
        let b = weights(&times, |q| 1.0 / f64::from(q + 1));
        for (i, time) in times.iter().enumerate() {
            let slopes =
                weights(&points, |q| if q == 0 { 0.0 } else { f64::from(q) * time.powi(q - 1) });
            self.link(row + i * states, &places, &slopes);
            let point =
                || self.point(self.time(part, *time), |state| vec![(places[i + 1] + state, 1.0)]);
            let (node, path) = (point(), point());
            let weight = b[i] * length;
            self.nodes.push(Node { point: node, weight, row: row + i * states, factor: length });
            if *time < 1.0 {
                self.path.push(path);
            }
        }
        if times.last() != Some(&1.0) {
            let end: Vec<f64> = weights(&points, |_| 1.0).iter().map(|value| -value).collect();
            self.link(row + times.len() * states, &places, &end);
            self.link(row + times.len() * states, &[self.end_of(part)], &[1.0]);
        }
    }

    fn link(&mut self, row: usize, places: &[usize], factors: &[f64]) {
        for state in 0..self.states {
            let entries = places.iter().zip(factors);
            self.links.extend(entries.map(|(place, factor)| (row + state, place + state, *factor)));
        }
    }

    fn point(&self, time: f64, state: impl Fn(usize) -> Sum) -> Point {
        let states = (0..self.states).map(state).collect();
        Point {
            time,
            states,
            controls: (0..self.controls).map(|i| self.control(i, time)).collect(),
        }
    }

    fn control(&self, i: usize, time: f64) -> Sum {
        match self.shape {
            ControlShape::Constant => vec![(self.carried + i, 1.0)],
            ControlShape::Linear => vec![(self.states + i, 1.0 - time), (self.carried + i, time)],
            ControlShape::Polynomial => {
                let values = weights(&self.times, |q| time.powi(q)).into_iter().enumerate();
                values.map(|(j, factor)| (self.carried + j * self.controls + i, factor)).collect()
            }
        }
    }
}

/// A function at one point: its values, and `(output, variable of the nonlinear program,
/// derivative)`.
struct Sample {
    values: Vec<f64>,
    slopes: Vec<(usize, usize, f64)>,
}

/// The problem at a point.
struct At<'a> {
    problem: &'a Problem,
    grid: Grid,
    v: &'a [f64],
    parameters: Vec<f64>,
}

impl Transcribed {
    /// Evaluates everything at `v`, with the smoothing widths `sigma`.
    pub fn new(problem: &Problem, sigma: &[f64], v: &[f64]) -> Self {
        let at =
            At { problem, grid: Grid::new(problem), v, parameters: parameters(problem, sigma, v) };
        let mut result = Transcribed {
            objective: 0.0,
            gradient: vec![0.0; v.len()],
            rows: Vec::new(),
            row_bounds: Vec::new(),
            jacobian: Vec::new(),
            variable_bounds: at.variable_bounds(),
        };
        for k in 0..problem.method.intervals() {
            result.defects(&at, k);
            for point in &at.grid.path {
                result.constraints(&at.sample(&*problem.path, k, point), 0, &problem.path_bounds);
            }
        }
        let ends = at.ends();
        result.cost(&ends, 0, 1.0);
        result.constraints(&ends, 1, &problem.boundary_bounds);
        result
    }

    fn defects(&mut self, at: &At, k: usize) {
        let (states, h) = (at.grid.states, at.tau(k + 1) - at.tau(k));
        let (first, here) = (self.rows.len(), at.place(k));
        self.rows.resize(first + at.grid.defects(), 0.0);
        self.row_bounds.resize(self.rows.len(), Bounds::fixed(0.0));
        for &(row, place, value) in &at.grid.links {
            self.rows[first + row] += value * at.v[here + place];
            self.jacobian.push((first + row, here + place, value));
        }
        for node in &at.grid.nodes {
            let (found, row, factor) = (
                at.sample(&*at.problem.dynamics, k, &node.point),
                first + node.row,
                h * node.factor,
            );
            for i in 0..states {
                self.rows[row + i] -= factor * found.values[i];
            }
            for &(output, variable, slope) in found.slopes.iter().filter(|slope| slope.0 < states) {
                self.jacobian.push((row + output, variable, -factor * slope));
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
    let mut parameters: Vec<f64> =
        problem.parameters.iter().map(|parameter| parameter.value).collect();
    for (surface, sigma) in problem.surfaces.iter().zip(sigma) {
        parameters[surface.sigma] = *sigma;
    }
    for (unknown, value) in problem.unknowns.iter().rev().zip(v.iter().rev()) {
        parameters[unknown.parameter] = *value;
    }
    parameters
}

impl At<'_> {
    /// The normalised time of a grid point.
    fn tau(&self, k: usize) -> f64 {
        let method = &self.problem.method;
        method.grid.times().get(k).copied().unwrap_or(k as f64 / method.intervals() as f64)
    }

    /// The place of `x_k`.
    fn place(&self, k: usize) -> usize {
        k * self.grid.step
    }

    /// The place of an unknown, given its place in `p`.
    fn unknown(&self, parameter: usize) -> usize {
        let unknowns = &self.problem.unknowns;
        let index = unknowns.iter().position(|unknown| unknown.parameter == parameter);
        self.v.len() - unknowns.len() + index.expect("differentiated by unknowns only")
    }

    /// A function over normalised time in interval `k`.
    fn sample(&self, function: &dyn Function, k: usize, at: &Point) -> Sample {
        let here = self.place(k);
        let sums: Vec<&Sum> = at.states.iter().chain(&at.controls).collect();
        // A variable that does not count may be anything.
        let own = |sum: &Sum| -> Sum {
            let terms = sum.iter().filter(|(_, factor)| *factor != 0.0);
            terms.map(|(place, factor)| (here + place, *factor)).collect()
        };
        let mut point = vec![self.tau(k) + at.time * (self.tau(k + 1) - self.tau(k))];
        point.extend(
            sums.iter()
                .map(|sum| own(sum).iter().map(|(place, w)| w * self.v[*place]).sum::<f64>()),
        );
        self.evaluate(function, &point, |input| match sums.get(input - 1) {
            Some(sum) => own(sum),
            None => vec![(self.unknown(input - 1 - sums.len()), 1.0)],
        })
    }

    fn ends(&self) -> Sample {
        let (states, last) = (self.problem.layout.x, self.place(self.problem.method.intervals()));
        let point: Vec<f64> =
            [0, last].iter().flat_map(|first| &self.v[*first..first + states]).copied().collect();
        self.evaluate(&*self.problem.boundary, &point, |input| match input {
            i if i >= 2 * states => vec![(self.unknown(i - 2 * states), 1.0)],
            i if i >= states => vec![(last + i - states, 1.0)],
            i => vec![(i, 1.0)],
        })
    }

    /// `places` says where an input is among the variables of the nonlinear program, with factors.
    fn evaluate(
        &self,
        function: &dyn Function,
        point: &[f64],
        places: impl Fn(usize) -> Vec<(usize, f64)>,
    ) -> Sample {
        let pattern = &function.jacobian_pattern().entries;
        let points = Columns::of_point(point);
        let (mut values, mut jacobian) =
            (Columns::new(function.outputs(), 1), Columns::new(pattern.len(), 1));
        function.jacobian(&points, &self.parameters, &mut values, &mut jacobian);
        let mut slopes = Vec::new();
        for (entry, (row, input)) in pattern.iter().enumerate() {
            let slope = jacobian.column(entry)[0];
            slopes.extend(
                places(*input as usize)
                    .iter()
                    .map(|(place, factor)| (*row as usize, *place, factor * slope)),
            );
        }
        Sample {
            values: (0..function.outputs()).map(|row| values.column(row)[0]).collect(),
            slopes,
        }
    }

    fn variable_bounds(&self) -> Vec<Bounds> {
        let (problem, grid, intervals) =
            (self.problem, &self.grid, self.problem.method.intervals());
        let states = || problem.states.iter().map(|state| state.bounds);
        let controls = || problem.controls.iter().map(|control| control.bounds);
        let mut bounds = Vec::new();
        for k in 0..=intervals {
            bounds.extend(states());
            // A control that goes on is bounded where it is chosen.
            let carried = controls().map(|it| if k == 0 { it } else { Bounds::FREE });
            bounds.extend(carried.take(grid.carried - grid.states));
            if k < intervals {
                let end = self.place(k + 1);
                let chosen = grid.inner_place() - grid.carried;
                bounds.extend((0..chosen).map(|i| problem.controls[i % grid.controls].bounds));
                bounds.extend(
                    (0..end - bounds.len()).map(|i| problem.states[i % grid.states].bounds),
                );
            }
        }
        for (i, start) in problem.start.iter().enumerate() {
            bounds[i] = start.map_or(bounds[i], Bounds::fixed);
        }
        bounds.extend(problem.unknowns.iter().map(|unknown| unknown.bounds));
        bounds
    }
}
