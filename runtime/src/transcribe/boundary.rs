//! The ends of the trajectory: the Mayer objective and the boundary conditions.

use super::assembly::{Builder, Contribution, Repeated};
use crate::linalg::Stages;
use crate::problem::{Columns, Function, Problem};
use std::sync::Arc;

/// The boundary function with its tables. Output 0 is the objective, the others are coupling rows.
pub(super) struct Ends {
    function: Arc<dyn Function>,
    points: Columns,
    values: Columns,
    jacobian: Columns,
    hessian: Columns,
    multipliers: Columns,
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
        let variable = |input: u32| Repeated { first: variable(problem, stages, input as usize), step: 0 };
        let (mut row_moves, mut gradient_moves, mut hessian_moves) = (Vec::new(), Vec::new(), Vec::new());
        for (column, &(output, input)) in function.jacobian_pattern().entries.iter().enumerate() {
            let place = variable(input);
            match (output as usize).checked_sub(1) {
                None => gradient_moves.push(Contribution { column, coefficient: 1.0, target: place.first }),
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
        Ends {
            points: Columns::new(function.layout().point_inputs(), 1),
            values: Columns::new(function.outputs(), 1),
            jacobian: Columns::new(function.jacobian_pattern().entries.len(), 1),
            hessian: Columns::new(function.hessian_pattern().entries.len(), 1),
            multipliers: Columns::new(function.outputs(), 1),
            row_moves,
            gradient_moves,
            hessian_moves,
            function,
        }
    }

    pub(super) fn load(&mut self, stages: Stages, v: &[f64]) {
        let first = self.function.layout().states().start;
        let ends = stages.state(0).chain(stages.state(stages.intervals));
        for (i, variable) in ends.enumerate() {
            self.points.column_mut(first + i)[0] = v[variable];
        }
    }

    /// Writes the coupling rows; returns the Mayer objective.
    pub(super) fn values(&mut self, stages: Stages, parameters: &[f64], rows: &mut [f64]) -> f64 {
        self.function.value(&self.points, parameters, &mut self.values);
        for (i, row) in stages.coupling().enumerate() {
            rows[row] = self.values.column(i + 1)[0];
        }
        self.values.column(0)[0]
    }

    pub(super) fn differentiate(
        &mut self,
        stages: Stages,
        parameters: &[f64],
        weight: f64,
        multipliers: &[f64],
    ) {
        self.multipliers.column_mut(0)[0] = weight;
        for (i, row) in stages.coupling().enumerate() {
            self.multipliers.column_mut(i + 1)[0] = multipliers[row];
        }
        self.function.derivatives(
            &self.points,
            parameters,
            &self.multipliers,
            &mut self.values,
            &mut self.jacobian,
            &mut self.hessian,
        );
    }

    pub(super) fn scatter(&self, gradient: &mut [f64], jacobian: &mut [f64], hessian: &mut [f64]) {
        let parts = [
            (&self.jacobian, &self.gradient_moves, gradient),
            (&self.jacobian, &self.row_moves, jacobian),
            (&self.hessian, &self.hessian_moves, hessian),
        ];
        for (table, moves, values) in parts {
            for entry in moves {
                values[entry.target] += entry.coefficient * table.column(entry.column)[0];
            }
        }
    }

    /// The gradient by the last state only.
    pub(super) fn add_last_gradient(&self, stages: Stages, gradient: &mut [f64]) {
        let last = stages.state(stages.intervals);
        for entry in self.gradient_moves.iter().filter(|entry| last.contains(&entry.target)) {
            gradient[entry.target] += entry.coefficient * self.jacobian.column(entry.column)[0];
        }
    }

    /// The first output with a value or derivative that is not finite, for these multipliers.
    pub(super) fn not_finite(&mut self, stages: Stages, parameters: &[f64], rows: usize) -> Option<usize> {
        self.differentiate(stages, parameters, 1.0, &vec![1.0; rows]);
        let bad = |table: &Columns, column: usize| !table.column(column)[0].is_finite();
        let values = (0..self.values.columns()).find(|i| bad(&self.values, *i));
        let pattern = &self.function.jacobian_pattern().entries;
        let slopes = || pattern.iter().enumerate().find(|(i, _)| bad(&self.jacobian, *i));
        let curvature = || (0..self.hessian.columns()).any(|i| bad(&self.hessian, i)).then_some(0);
        values.or_else(|| slopes().map(|(_, (row, _))| *row as usize)).or_else(curvature)
    }
}

/// The variable of the programme behind an input.
fn variable(problem: &Problem, stages: Stages, input: usize) -> usize {
    let layout = problem.boundary.layout();
    if let Some(parameter) = input.checked_sub(layout.parameters().start) {
        let unknown = problem.unknowns.iter().position(|unknown| unknown.parameter == parameter);
        return stages.globals().start + unknown.expect("differentiated by unknowns only");
    }
    let state = input - layout.states().start;
    match state.checked_sub(stages.states) {
        None => state,
        Some(state) => stages.state(stages.intervals).start + state,
    }
}
