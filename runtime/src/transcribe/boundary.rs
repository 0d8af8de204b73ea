//! The ends of the trajectory: the Mayer objective and the boundary conditions.

use super::assembly::{Builder, Contribution, Destination, Repeated};
use super::tables::{Tables, scatter};
use crate::linalg::Stages;
use crate::problem::{Bounds, Columns, Degree, Problem};
use std::sync::Arc;

/// The boundary function with its tables. Output 0 is the objective, the others are coupling rows.
pub(super) struct Ends {
    tables: Tables,
    row_moves: Vec<Contribution>,
    gradient_moves: Vec<Contribution>,
    hessian_moves: Vec<Contribution>,
}

impl Ends {
    pub(super) fn new(
        problem: &Problem,
        stages: Stages,
        jacobian: &mut Builder,
        hessian: &mut Builder,
    ) -> Self {
        let function = Arc::clone(&problem.boundary);
        let variable =
            |input: u32| Repeated { first: variable(problem, stages, input as usize), step: 0 };
        let (mut row_moves, mut gradient_moves, mut hessian_moves) =
            (Vec::new(), Vec::new(), Vec::new());
        for (column, &(output, input)) in function.jacobian_pattern().entries.iter().enumerate() {
            let place = variable(input);
            match (output as usize).checked_sub(1) {
                None => {
                    let target = Destination::taken(place.first);
                    gradient_moves.push(Contribution { column, coefficient: 1.0, target });
                }
                Some(row) => {
                    let row = Repeated { first: stages.coupling().start + row, step: 0 };
                    let target = jacobian.place(row, place, 1);
                    row_moves.push(Contribution { column, coefficient: 1.0, target });
                }
            }
        }
        for (column, &(a, b)) in function.hessian_pattern().entries.iter().enumerate() {
            let target = hessian.symmetric_place(variable(a), variable(b), 1);
            hessian_moves.push(Contribution { column, coefficient: 1.0, target });
        }
        Ends { tables: Tables::new(&function, 1), row_moves, gradient_moves, hessian_moves }
    }

    pub(super) fn load(&mut self, stages: Stages, v: &[f64]) {
        let first = self.tables.function.layout().states().start;
        let states = self.tables.function.layout().x / 2;
        let ends = stages.state(0).take(states).chain(stages.state(stages.intervals).take(states));
        for (i, variable) in ends.enumerate() {
            self.tables.points.column_mut(first + i)[0] = v[variable];
        }
    }

    /// Writes the coupling rows; returns the Mayer objective.
    pub(super) fn values(&mut self, stages: Stages, parameters: &[f64], rows: &mut [f64]) -> f64 {
        self.tables.evaluate(parameters);
        for (i, row) in stages.coupling().enumerate() {
            rows[row] = self.tables.values.column(i + 1)[0];
        }
        self.tables.values.column(0)[0]
    }

    pub(super) fn differentiate(
        &mut self,
        stages: Stages,
        parameters: &[f64],
        weight: f64,
        multipliers: &[f64],
    ) {
        self.tables.multipliers.column_mut(0)[0] = weight;
        for (i, row) in stages.coupling().enumerate() {
            self.tables.multipliers.column_mut(i + 1)[0] = multipliers[row];
        }
        self.tables.differentiate(parameters);
    }

    pub(super) fn scatter(&self, gradient: &mut [f64], jacobian: &mut [f64], hessian: &mut [f64]) {
        scatter(&self.tables.jacobian, &self.gradient_moves, gradient);
        scatter(&self.tables.jacobian, &self.row_moves, jacobian);
        scatter(&self.tables.hessian, &self.hessian_moves, hessian);
    }

    /// The gradient by the last state only.
    pub(super) fn add_last_gradient(&self, stages: Stages, gradient: &mut [f64]) {
        let last = stages.state(stages.intervals);
        for entry in self.gradient_moves.iter().filter(|entry| last.contains(&entry.target.first)) {
            gradient[entry.target.first] +=
                entry.coefficient * self.tables.jacobian.column(entry.column)[0];
        }
    }

    /// The first output with a value or derivative that is not finite, for these multipliers.
    pub(super) fn not_finite(
        &mut self,
        stages: Stages,
        parameters: &[f64],
        rows: usize,
    ) -> Option<usize> {
        self.differentiate(stages, parameters, 1.0, &vec![1.0; rows]);
        let bad = |table: &Columns, column: usize| !table.column(column)[0].is_finite();
        let values = (0..self.tables.values.columns()).find(|i| bad(&self.tables.values, *i));
        let pattern = &self.tables.function.jacobian_pattern().entries;
        let slopes = || pattern.iter().enumerate().find(|(i, _)| bad(&self.tables.jacobian, *i));
        let curvature = || {
            (0..self.tables.hessian.columns()).any(|i| bad(&self.tables.hessian, i)).then_some(0)
        };
        values.or_else(|| slopes().map(|(_, (row, _))| *row as usize)).or_else(curvature)
    }
}

/// The last states that a condition by itself gives a value, such as `end x == 1`, with that value.
pub(super) fn given_at_the_end(problem: &Problem, stages: Stages) -> Vec<(usize, f64)> {
    let function = &problem.boundary;
    let layout = function.layout();
    let entries = &function.jacobian_pattern().entries;
    if !problem.boundary_bounds.iter().any(Bounds::is_equality) {
        return Vec::new();
    }
    let mut points = Columns::new(layout.point_inputs(), 1);
    points.as_mut_slice().fill(0.0);
    let parameters: Vec<f64> = problem.parameters.iter().map(|parameter| parameter.value).collect();
    let mut values = Columns::new(function.outputs(), 1);
    let mut slopes = Columns::new(entries.len(), 1);
    function.jacobian(&points, &parameters, &mut values, &mut slopes);
    let last = stages.state(stages.intervals);
    let given = |(row, bounds): (usize, &Bounds)| {
        let output = row + 1;
        let mut own = entries.iter().enumerate().filter(|(_, entry)| entry.0 as usize == output);
        let ((place, entry), None) = (own.next()?, own.next()) else { return None };
        let target = variable(problem, stages, entry.1 as usize);
        let (slope, at_zero) = (slopes.column(place)[0], values.column(output)[0]);
        let is_simple =
            bounds.is_equality() && function.degree(output) == Degree::Affine && slope != 0.0;
        (is_simple && last.contains(&target)).then(|| (target, (bounds.lower - at_zero) / slope))
    };
    problem.boundary_bounds.iter().enumerate().filter_map(given).collect()
}

/// The variable of the NLP behind an input.
fn variable(problem: &Problem, stages: Stages, input: usize) -> usize {
    let layout = problem.boundary.layout();
    if let Some(parameter) = input.checked_sub(layout.parameters().start) {
        let unknown = problem.unknowns.iter().position(|unknown| unknown.parameter == parameter);
        return stages.globals().start + unknown.expect("differentiated by unknowns only");
    }
    let state = input - layout.states().start;
    match state.checked_sub(problem.layout.x) {
        None => state,
        Some(state) => stages.state(stages.intervals).start + state,
    }
}
