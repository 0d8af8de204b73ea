//! A function of the problem, evaluated once in every interval, and where its derivatives go.
//!
//! It sees a [`Point`] of the interval, whose states and controls are sums of variables with
//! factors. By the chain rule each derivative by a state or control splits into one by each of
//! these variables, with its factor.

use super::assembly::{Builder, Contribution, Destination, Repeated};
use super::interval::Point;
use super::mesh::Mesh;
use super::tables::{Tables, scatter};
use crate::linalg::Stages;
use crate::problem::{Columns, Function, Problem};
use std::sync::Arc;

/// Where an output goes.
#[derive(Clone, Copy, Debug)]
pub(super) enum Target {
    /// Local row of each interval, with a factor.
    Row(usize, f64),
    /// The objective, with a factor.
    Objective(f64),
}

/// A function with its tables.
pub(super) struct Sampled {
    tables: Tables,
    point: Point,
    /// By which its outputs are multiplied in each interval; nothing where that is 1.
    lengths: Option<Vec<f64>>,
    targets: Vec<Target>,
    /// Outputs that say nothing in the last interval, with the number that they are there.
    silent: Vec<(usize, f64)>,
    row_moves: Vec<Contribution>,
    /// Target: a variable of interval 0, and its step along the chain.
    gradient_moves: Vec<(Contribution, usize)>,
    hessian_moves: Vec<Contribution>,
}

/// The builders of both matrices.
pub(super) struct Matrices {
    pub(super) stages: Stages,
    pub(super) mesh: Mesh,
    pub(super) jacobian: Builder,
    pub(super) hessian: Builder,
}

impl Sampled {
    pub(super) fn new(
        problem: &Problem,
        function: &Arc<dyn Function>,
        point: Point,
        targets: Vec<Target>,
        matrices: &mut Matrices,
    ) -> Self {
        let mut tables = Tables::new(function, matrices.stages.intervals);
        point.set_times(&matrices.mesh, &mut tables.points);
        let (row_moves, gradient_moves, hessian_moves) = (Vec::new(), Vec::new(), Vec::new());
        let mut sampled = Sampled {
            tables,
            point,
            lengths: None,
            targets,
            silent: Vec::new(),
            row_moves,
            gradient_moves,
            hessian_moves,
        };
        sampled.map_jacobian(problem, matrices);
        sampled.map_hessian(problem, matrices);
        sampled
    }

    /// The same with outputs that count by the relative length of each interval.
    pub(super) fn per_length(self, mesh: &Mesh) -> Self {
        Sampled { lengths: mesh.all_relative(), ..self }
    }

    /// The path constraints at the end of each interval, without those that give way at the last
    /// time: there they are inside of their bounds, whatever the state.
    pub(super) fn half_open(self, problem: &Problem) -> Self {
        let inside = |row: &usize| (*row, problem.path_bounds[*row].inside());
        Sampled { silent: problem.half_open.iter().map(inside).collect(), ..self }
    }

    /// Silences what is said in the last interval: values and first derivatives.
    fn silence(&mut self) {
        let pattern = &self.tables.function.jacobian_pattern().entries;
        for &(output, inside) in &self.silent {
            set_last(&mut self.tables.values, output, inside);
            let own = pattern.iter().enumerate().filter(|(_, it)| it.0 as usize == output);
            own.for_each(|(column, _)| set_last(&mut self.tables.jacobian, column, 0.0));
        }
    }

    /// Multiplies every column by the relative lengths.
    fn scale(lengths: &Option<Vec<f64>>, table: &mut Columns) {
        let Some(lengths) = lengths else { return };
        for i in 0..table.columns() {
            table
                .column_mut(i)
                .iter_mut()
                .zip(lengths)
                .for_each(|(value, length)| *value *= length);
        }
    }

    fn map_jacobian(&mut self, problem: &Problem, matrices: &mut Matrices) {
        let (function, stages) = (Arc::clone(&self.tables.function), matrices.stages);
        for (column, &(output, input)) in function.jacobian_pattern().entries.iter().enumerate() {
            for (variable, factor) in self.places(problem, stages, input as usize) {
                match self.targets[output as usize] {
                    Target::Row(row, scale) => {
                        let row = Repeated { first: row, step: stages.row_step() };
                        let target = matrices.jacobian.place(row, variable, stages.intervals);
                        self.row_moves.push(Contribution {
                            column,
                            coefficient: scale * factor,
                            target,
                        });
                    }
                    Target::Objective(scale) => {
                        let target = Destination::taken(variable.first);
                        let contribution =
                            Contribution { column, coefficient: scale * factor, target };
                        self.gradient_moves.push((contribution, variable.step));
                    }
                }
            }
        }
    }

    fn map_hessian(&mut self, problem: &Problem, matrices: &mut Matrices) {
        let (function, stages) = (Arc::clone(&self.tables.function), matrices.stages);
        for (column, &(a, b)) in function.hessian_pattern().entries.iter().enumerate() {
            let first = self.places(problem, stages, a as usize);
            let second = self.places(problem, stages, b as usize);
            for (i, &(row, row_factor)) in first.iter().enumerate() {
                for (j, &(other, factor)) in second.iter().enumerate() {
                    // A square gives its mixed term once to the lower triangle.
                    if a == b && j > i {
                        continue;
                    }
                    let target = matrices.hessian.symmetric_place(row, other, stages.intervals);
                    let coefficient = row_factor * factor;
                    self.hessian_moves.push(Contribution { column, coefficient, target });
                }
            }
        }
    }

    /// The variables of the NLP behind an input, with their factors.
    fn places(&self, problem: &Problem, stages: Stages, input: usize) -> Vec<(Repeated, f64)> {
        let layout = self.tables.function.layout();
        let step = stages.variable_step();
        if let Some(parameter) = input.checked_sub(layout.parameters().start) {
            let unknown =
                problem.unknowns.iter().position(|unknown| unknown.parameter == parameter);
            let first = stages.globals().start + unknown.expect("differentiated by unknowns only");
            return vec![(Repeated { first, step: 0 }, 1.0)];
        }
        let combination = match input.checked_sub(layout.controls().start) {
            Some(control) => &self.point.controls[control],
            None => &self.point.states[input - layout.states().start],
        };
        combination.iter().map(|&(first, factor)| (Repeated { first, step }, factor)).collect()
    }

    /// Takes the states and controls from the variables of the NLP.
    pub(super) fn load(&mut self, stages: Stages, v: &[f64]) {
        let layout = *self.tables.function.layout();
        self.point.load(stages, &layout, v, &mut self.tables.points);
    }

    /// Adds the outputs to the rows; returns their part of the objective.
    pub(super) fn add_values(
        &mut self,
        stages: Stages,
        parameters: &[f64],
        rows: &mut [f64],
    ) -> f64 {
        self.tables.evaluate(parameters);
        self.silence();
        Self::scale(&self.lengths, &mut self.tables.values);
        let mut objective = 0.0;
        for (output, target) in self.targets.iter().enumerate() {
            let column = self.tables.values.column(output);
            match *target {
                Target::Objective(scale) => objective += scale * column.iter().sum::<f64>(),
                Target::Row(row, scale) => {
                    let rows = rows[row..].iter_mut().step_by(stages.row_step());
                    rows.zip(column).for_each(|(value, output)| *value += scale * output);
                }
            }
        }
        objective
    }

    /// Evaluates all derivatives at the loaded points.
    pub(super) fn differentiate(
        &mut self,
        stages: Stages,
        parameters: &[f64],
        weight: f64,
        multipliers: &[f64],
    ) {
        for (output, target) in self.targets.iter().enumerate() {
            let column = self.tables.multipliers.column_mut(output);
            match *target {
                Target::Objective(scale) => column.fill(weight * scale),
                Target::Row(row, scale) => {
                    let source = multipliers[row..].iter().step_by(stages.row_step());
                    column
                        .iter_mut()
                        .zip(source)
                        .for_each(|(value, lambda)| *value = scale * lambda);
                }
            }
        }
        // The Hessian is that of the multipliers times the lengths.
        Self::scale(&self.lengths, &mut self.tables.multipliers);
        for (output, _) in &self.silent {
            set_last(&mut self.tables.multipliers, *output, 0.0);
        }
        self.tables.differentiate(parameters);
        self.silence();
        Self::scale(&self.lengths, &mut self.tables.jacobian);
    }

    /// Adds the derivatives to the matrices of the NLP.
    pub(super) fn scatter(&self, gradient: &mut [f64], jacobian: &mut [f64], hessian: &mut [f64]) {
        scatter(&self.tables.jacobian, &self.row_moves, jacobian);
        scatter(&self.tables.hessian, &self.hessian_moves, hessian);
        self.gradient_moves.iter().for_each(|entry| self.add_gradient(entry, gradient));
    }

    fn add_gradient(&self, (entry, step): &(Contribution, usize), gradient: &mut [f64]) {
        for (k, d) in self.tables.jacobian.column(entry.column).iter().enumerate() {
            gradient[entry.target.first + k * step] += entry.coefficient * d;
        }
    }

    /// The gradient by the states at the beginning of each interval only.
    pub(super) fn add_own_gradient(&self, stages: Stages, gradient: &mut [f64]) {
        let own =
            self.gradient_moves.iter().filter(|(entry, _)| entry.target.first < stages.states);
        own.for_each(|entry| self.add_gradient(entry, gradient));
    }

    /// The output and interval of the first value or derivative that is not finite.
    pub(super) fn not_finite(
        &mut self,
        stages: Stages,
        parameters: &[f64],
        rows: usize,
    ) -> Option<(usize, usize)> {
        self.differentiate(stages, parameters, 0.0, &vec![0.0; rows]);
        let place = |table: &Columns, column: usize| {
            table.column(column).iter().position(|value| !value.is_finite())
        };
        let values = (0..self.tables.values.columns())
            .filter_map(|i| Some((i, place(&self.tables.values, i)?)));
        let pattern = &self.tables.function.jacobian_pattern().entries;
        let slopes = pattern.iter().enumerate();
        let slopes = slopes
            .filter_map(|(i, (row, _))| Some((*row as usize, place(&self.tables.jacobian, i)?)));
        if let Some(found) = values.chain(slopes).min_by_key(|(_, k)| *k) {
            return Some(found);
        }
        (0..self.targets.len()).find_map(|output| {
            (0..self.targets.len()).for_each(|i| self.tables.multipliers.column_mut(i).fill(0.0));
            self.tables.multipliers.column_mut(output).fill(1.0);
            self.tables.differentiate(parameters);
            (0..self.tables.hessian.columns())
                .find_map(|i| place(&self.tables.hessian, i))
                .map(|k| (output, k))
        })
    }
}

fn set_last(table: &mut Columns, column: usize, value: f64) {
    *table.column_mut(column).last_mut().expect("there is an interval") = value;
}
