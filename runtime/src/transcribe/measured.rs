//! Sums over rows of measured data: a function evaluated once for each row, at a time inside an
//! interval.
//!
//! What it reads of the trajectory is a sum of variables of that interval, with factors that
//! differ from row to row. The values of all rows of an interval are added up in families that
//! repeat along the whole chain, as the matrices want them: an interval without rows has zeros.
//! Where an end of time is an unknown a row may change its interval from iterate to iterate.

use super::assembly::{Builder, Repeated};
use super::interval::{Combination, Interval, Signal};
use super::mesh::Mesh;
use super::sampled::Matrices;
use super::tables::Tables;
use crate::linalg::Stages;
use crate::problem::{Columns, Interpolant, Layout, Measurements, Origin, Problem};
use std::collections::BTreeMap;

/// A value of a table that is added to a vector: `target += coefficient * table[column][row]`.
struct Move {
    column: usize,
    row: usize,
    coefficient: f64,
    target: usize,
}

/// The families of a matrix that rows are added to.
#[derive(Default)]
struct Families {
    /// The first value of each.
    places: BTreeMap<(Repeated, Repeated), usize>,
    /// Those that nothing else writes.
    own: Vec<usize>,
    moves: Vec<Move>,
}

/// A sum with its tables.
pub(super) struct Measured<'p> {
    problem: &'p Problem,
    measurements: &'p Measurements,
    stages: Stages,
    tables: Tables,
    /// The interval of each row, and what the function reads there.
    rows: Vec<(usize, Vec<Combination>)>,
    /// Which of them are rows of this phase.
    is_own: Vec<bool>,
    /// Rows of an interval that the sum enters, with factors; none for the objective.
    targets: Vec<(usize, f64)>,
    /// Moves to the variables.
    gradient: Vec<Move>,
    jacobian: Families,
    hessian: Families,
    /// First and last time for which rows have their intervals.
    ends: [f64; 2],
}

impl<'p> Measured<'p> {
    pub(super) fn new(
        problem: &'p Problem,
        measurements: &'p Measurements,
        interval: &Interval,
        matrices: &mut Matrices,
    ) -> Self {
        let count = measurements.times.len();
        let mut measured = Measured {
            problem,
            measurements,
            stages: matrices.stages,
            tables: Tables::new(&measurements.function, count),
            rows: vec![(0, Vec::new()); count],
            is_own: vec![true; count],
            targets: targets(interval, measurements),
            gradient: Vec::new(),
            jacobian: Families::default(),
            hessian: Families::default(),
            ends: [f64::NAN; 2],
        };
        // Points leave parameters out.
        let first = measurements.function.layout().controls().end;
        for at in 0..measurements.columns.columns() {
            let column = measurements.columns.column(at);
            measured.tables.points.column_mut(first + at).copy_from_slice(column);
        }
        for step in 0..interval.steps() {
            let inputs = measured.inputs(interval, interval.middle_of(step), 1.0);
            measured.place(&inputs, matrices);
        }
        measured
    }

    fn layout(&self) -> Layout {
        *self.measurements.function.layout()
    }

    /// What the function reads at a time of an interval with this length, states before controls.
    fn inputs(&self, interval: &Interval, time: f64, length: f64) -> Vec<Combination> {
        let (layout, grid) = (self.layout(), self.problem.layout);
        let states = (0..layout.x).map(|at| (Signal::State(at % grid.x), at / grid.x));
        let controls = (0..layout.u).map(|at| (Signal::Control(at % grid.u), at / grid.u));
        let combination = |(signal, which): (Signal, usize)| match self.measurements.interpolant {
            Interpolant::Polynomial => {
                let mut terms = interval.derivative_at(signal, time, which);
                let scale = length.powi(which as i32).recip();
                terms.iter_mut().for_each(|(_, factor)| *factor *= scale);
                terms
            }
            Interpolant::Hermite => interval.end_of_step(signal, time, which == 1),
        };
        states.chain(controls).map(combination).collect()
    }

    /// The variables behind an input of the function, with their factors.
    fn variables(&self, inputs: &[Combination], input: u32) -> Vec<(Repeated, f64)> {
        let (layout, input) = (self.layout(), input as usize);
        if let Some(parameter) = input.checked_sub(layout.parameters().start) {
            let is_it = |unknown: &crate::problem::Unknown| unknown.parameter == parameter;
            let unknown = self.problem.unknowns.iter().position(is_it);
            let first =
                self.stages.globals().start + unknown.expect("differentiated by unknowns only");
            return vec![(Repeated { first, step: 0 }, 1.0)];
        }
        let step = self.stages.variable_step();
        let terms = inputs[input - layout.t].iter();
        terms.map(|&(first, factor)| (Repeated { first, step }, factor)).collect()
    }

    /// Every entry of the Jacobian with the variables behind it.
    fn slopes(&self, inputs: &[Combination], mut act: impl FnMut(usize, Repeated, f64)) {
        let pattern = self.measurements.function.jacobian_pattern();
        for (column, (_, input)) in pattern.entries.iter().enumerate() {
            for (variable, factor) in self.variables(inputs, *input) {
                act(column, variable, factor);
            }
        }
    }

    /// Every entry of the Hessian with the pairs of variables behind it.
    fn curvatures(&self, inputs: &[Combination], mut act: impl FnMut(usize, [Repeated; 2], f64)) {
        let pattern = self.measurements.function.hessian_pattern();
        for (column, &(a, b)) in pattern.entries.iter().enumerate() {
            let (first, second) = (self.variables(inputs, a), self.variables(inputs, b));
            for (i, &(row, row_factor)) in first.iter().enumerate() {
                for (j, &(other, factor)) in second.iter().enumerate() {
                    // A square gives its mixed term once to the lower triangle, and a mixed term
                    // of two inputs gives a square twice.
                    if a == b && j > i {
                        continue;
                    }
                    let times = if a != b && row == other { 2.0 } else { 1.0 };
                    let pair = if row.first >= other.first { [row, other] } else { [other, row] };
                    act(column, pair, times * row_factor * factor);
                }
            }
        }
    }

    /// Makes room in the matrices for what rows of a step may need.
    fn place(&mut self, inputs: &[Combination], matrices: &mut Matrices) {
        let row_step = self.stages.row_step();
        let (mut slopes, mut pairs) = (Vec::new(), Vec::new());
        self.slopes(inputs, |_, variable, _| slopes.push(variable));
        self.curvatures(inputs, |_, pair, _| pairs.push(pair));
        for (first, _) in &self.targets {
            let row = Repeated { first: *first, step: row_step };
            for variable in &slopes {
                self.jacobian.place(&mut matrices.jacobian, [row, *variable], self.stages);
            }
        }
        for pair in pairs {
            self.hessian.place(&mut matrices.hessian, pair, self.stages);
        }
    }

    /// Takes the states and controls from the variables of the NLP.
    pub(super) fn load(&mut self, interval: &Interval, mesh: &Mesh, parameters: &[f64], v: &[f64]) {
        let ends = self.problem.ends(parameters);
        if ends != self.ends {
            self.ends = ends;
            self.assign(interval, mesh);
        }
        let (step, first) = (self.stages.variable_step(), self.layout().t);
        for (row, (k, inputs)) in self.rows.iter().enumerate() {
            for (at, terms) in inputs.iter().enumerate() {
                let value = terms.iter().map(|(place, factor)| factor * v[place + k * step]).sum();
                self.tables.points.column_mut(first + at)[row] = value;
            }
        }
    }

    /// Gives each row its interval.
    fn assign(&mut self, interval: &Interval, mesh: &Mesh) {
        let [first, last] = self.ends;
        let begin = self.tables.points.columns() - 2;
        for row in 0..self.rows.len() {
            let tau = (self.measurements.times[row] - first) / (last - first);
            self.is_own[row] = self.measurements.has(tau);
            let tau = if tau.is_nan() { 0.0 } else { tau.clamp(0.0, 1.0) };
            let (k, time) = mesh.find(tau);
            let length = mesh.at(k, 1.0) - mesh.at(k, 0.0);
            self.tables.points.column_mut(0)[row] = tau;
            if self.measurements.interpolant == Interpolant::Hermite {
                let (start, part) = interval.step_at(time);
                self.tables.points.column_mut(begin)[row] = mesh.at(k, start);
                self.tables.points.column_mut(begin + 1)[row] = part * length;
            }
            self.rows[row] = (k, self.inputs(interval, time, length));
        }
        self.find_moves();
    }

    fn find_moves(&mut self) {
        let (mut gradient, mut jacobian, mut hessian) = (Vec::new(), Vec::new(), Vec::new());
        let row_step = self.stages.row_step();
        let own = self.rows.iter().enumerate().filter(|it| self.is_own[it.0]);
        for (row, (k, inputs)) in own {
            self.slopes(inputs, |column, variable, coefficient| {
                if self.targets.is_empty() {
                    let target = variable.first + k * variable.step;
                    gradient.push(Move { column, row, coefficient, target });
                }
                for (first, factor) in &self.targets {
                    let place = [Repeated { first: *first, step: row_step }, variable];
                    let (coefficient, target) =
                        (coefficient * factor, self.jacobian.first(place) + k);
                    jacobian.push(Move { column, row, coefficient, target });
                }
            });
            self.curvatures(inputs, |column, pair, coefficient| {
                let target = self.hessian.first(pair) + k;
                hessian.push(Move { column, row, coefficient, target });
            });
        }
        self.gradient = gradient;
        self.jacobian.moves = jacobian;
        self.hessian.moves = hessian;
    }

    /// The terms of the rows of this phase at the loaded points, each with the number of its row.
    pub(super) fn terms(&mut self, parameters: &[f64]) -> Vec<(usize, f64)> {
        self.tables.evaluate(parameters);
        let terms = self.tables.values.column(0).iter().copied().enumerate();
        terms.filter(|it| self.is_own[it.0]).collect()
    }

    /// Adds the terms to the rows; returns their part of the objective.
    pub(super) fn add_values(&mut self, parameters: &[f64], rows: &mut [f64]) -> f64 {
        let terms = self.terms(parameters);
        for (target, factor) in &self.targets {
            for (row, term) in &terms {
                rows[target + self.rows[*row].0 * self.stages.row_step()] += factor * term;
            }
        }
        if self.targets.is_empty() { terms.iter().map(|it| it.1).sum() } else { 0.0 }
    }

    /// Evaluates all derivatives at the loaded points.
    pub(super) fn differentiate(&mut self, parameters: &[f64], weight: f64, multipliers: &[f64]) {
        let weights = self.weights(weight, multipliers);
        self.tables.multipliers.column_mut(0).copy_from_slice(&weights);
        self.tables.differentiate(parameters);
    }

    /// What the term of each row counts in the Lagrangian.
    pub(super) fn weights(&self, weight: f64, multipliers: &[f64]) -> Vec<f64> {
        let row_step = self.stages.row_step();
        let sum = |k: usize| {
            let each = self.targets.iter().map(|(row, by)| by * multipliers[row + k * row_step]);
            each.sum::<f64>()
        };
        let of = |((k, _), is_own): (&(usize, Vec<Combination>), &bool)| match is_own {
            false => 0.0,
            true if self.targets.is_empty() => weight,
            true => sum(*k),
        };
        self.rows.iter().zip(&self.is_own).map(of).collect()
    }

    /// The points of all rows, as loaded.
    pub(super) fn points(&self) -> &Columns {
        &self.tables.points
    }

    /// Adds the derivatives to the matrices of the NLP.
    pub(super) fn scatter(&self, gradient: &mut [f64], jacobian: &mut [f64], hessian: &mut [f64]) {
        self.jacobian.clear(self.stages, jacobian);
        self.hessian.clear(self.stages, hessian);
        scatter(&self.tables.jacobian, &self.gradient, gradient);
        scatter(&self.tables.jacobian, &self.jacobian.moves, jacobian);
        scatter(&self.tables.hessian, &self.hessian.moves, hessian);
    }

    /// The gradient by the states at the beginning of the interval of each row only.
    pub(super) fn add_own_gradient(&self, gradient: &mut [f64]) {
        let step = self.stages.variable_step();
        for Move { column, row, coefficient, target } in &self.gradient {
            let is_own = target.checked_sub(self.rows[*row].0 * step);
            if is_own.is_some_and(|place| place < self.stages.states) {
                gradient[*target] += coefficient * self.tables.jacobian.column(*column)[*row];
            }
        }
    }

    /// Where the sum stands.
    pub(super) fn origin(&self) -> Origin {
        self.measurements.origin.clone()
    }

    /// The interval of the first row with a value or derivative that is not finite.
    pub(super) fn not_finite(&mut self, parameters: &[f64]) -> Option<usize> {
        self.tables.multipliers.column_mut(0).fill(1.0);
        self.tables.differentiate(parameters);
        let tables = [&self.tables.values, &self.tables.jacobian, &self.tables.hessian];
        let columns = tables.into_iter().flat_map(|it| (0..it.columns()).map(|at| it.column(at)));
        let rows = columns.filter_map(|it| it.iter().position(|value| !value.is_finite()));
        rows.min().map(|row| self.rows[row].0)
    }
}

impl Families {
    fn place(&mut self, builder: &mut Builder, [row, column]: [Repeated; 2], stages: Stages) {
        if self.places.contains_key(&(row, column)) {
            return;
        }
        let destination = builder.place(row, column, stages.intervals);
        self.places.insert((row, column), destination.first);
        self.own.extend(destination.is_new.then_some(destination.first));
    }

    fn first(&self, [row, column]: [Repeated; 2]) -> usize {
        self.places[&(row, column)]
    }

    /// What nothing else has written.
    fn clear(&self, stages: Stages, values: &mut [f64]) {
        self.own.iter().for_each(|first| values[*first..][..stages.intervals].fill(0.0));
    }
}

/// The steps of the state that grows by a sum: at a constant rate in the interval of a row.
fn targets(interval: &Interval, measurements: &Measurements) -> Vec<(usize, f64)> {
    let of =
        |state: usize| interval.nodes.iter().map(|node| (node.row + state, -node.factor)).collect();
    measurements.state.map(of).unwrap_or_default()
}

fn scatter(table: &Columns, moves: &[Move], values: &mut [f64]) {
    for Move { column, row, coefficient, target } in moves {
        values[*target] += coefficient * table.column(*column)[*row];
    }
}
