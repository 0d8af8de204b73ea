//! Convex programmes go to the conic solver, and their answer is a global optimum.
//!
//! A programme whose rows are affine and whose objective is a convex quadratic is read off its own derivatives at
//! one point `v0`: `P = hessian`, `q = gradient - P v0`, `A = jacobian`, constants from the row values.

use super::{Counts, Derivatives, Multipliers, Nlp, Solution, Start, Status, constraint_violation};
use crate::clarabel::{Columns, ConicProgram, ConicStatus, Ldl, solve_conic};
use crate::linalg::Triplets;
use crate::problem::{Bounds, Degree, Problem};

/// Whether the transcription of a problem is affine in its rows and quadratic in its objective.
pub fn is_quadratic_programme(problem: &Problem) -> bool {
    let states = problem.layout.x;
    let affine = |degree: Degree| degree == Degree::Affine;
    let dynamics = (0..states).all(|row| affine(problem.dynamics.degree(row)));
    let path = (0..problem.path.outputs()).all(|row| affine(problem.path.degree(row)));
    let boundary = (1..problem.boundary.outputs()).all(|row| affine(problem.boundary.degree(row)));
    let cost = !problem.running_cost || problem.dynamics.degree(states) <= Degree::Quadratic;
    dynamics && path && boundary && cost && problem.boundary.degree(0) <= Degree::Quadratic
}

/// A solution whose optimality error is above this, relative to its multipliers, is none.
const CREDIBLE: f64 = 1e-6;

/// A row of `A v + s = b`: coefficients come from a row of the programme or from one variable.
#[derive(Clone, Copy)]
enum Source {
    Row(usize),
    Variable(usize),
}

/// One side of one constraint: `sign * (c - bound) <= 0`, or `= 0` for an equality.
#[derive(Clone, Copy)]
struct Side {
    source: Source,
    sign: f64,
    bound: f64,
}

/// Solves the programme if its Hessian is positive semidefinite; `None` if it is not convex. The caller has made sure
/// that it is quadratic.
pub fn solve(nlp: &mut dyn Nlp, start: &Start, tolerance: f64, max_iterations: usize) -> Option<Solution> {
    let variables = start.v.len();
    if variables == 0 {
        return None;
    }
    let mut derivatives = Derivatives::new(nlp);
    let multipliers = vec![0.0; nlp.row_bounds().len()];
    nlp.derivatives(&start.v, 1.0, &multipliers, &mut derivatives);
    let hessian = upper_columns(nlp.hessian_structure(), &derivatives.hessian, variables);
    if !is_semidefinite(&hessian) {
        return None;
    }
    let sides = sides(nlp);
    let equalities = sides.iter().take_while(|side| side.sign == 0.0).count();
    let program = ConicProgram {
        q: linear_part(nlp, &derivatives, &start.v),
        a: constraint_columns(nlp, &derivatives.jacobian, &sides, variables),
        b: right_sides(nlp, &derivatives.jacobian, &sides, &start.v),
        p: hessian,
        equalities,
    };
    let found = solve_conic(program, (0.1 * tolerance).max(1e-10), max_iterations);
    Some(into_solution(nlp, &sides, found))
}

/// Positive semidefinite up to rounding: all pivots of `P + tiny I` are positive.
fn is_semidefinite(hessian: &Columns) -> bool {
    let size = hessian.rows;
    let largest = hessian.values.iter().fold(1.0f64, |a, value| a.max(value.abs()));
    let mut entries = Vec::new();
    for column in 0..size {
        let range = hessian.column_starts[column]..hessian.column_starts[column + 1];
        entries.extend(range.map(|i| (hessian.row_indices[i], column, hessian.values[i])));
        entries.push((column, column, 1e-12 * largest));
    }
    let shifted = to_columns(entries, size, size);
    let values = shifted.values.clone();
    Ldl::new(shifted).factor(&values) == Some(size)
}

/// All one-sided constraints, equalities (sign 0) first.
fn sides(nlp: &dyn Nlp) -> Vec<Side> {
    let rows = nlp.row_bounds().iter().enumerate().map(|(i, bounds)| (Source::Row(i), *bounds));
    let variables =
        nlp.variable_bounds().iter().enumerate().map(|(i, bounds)| (Source::Variable(i), *bounds));
    let (mut sides, mut inequalities) = (Vec::new(), Vec::new());
    for (source, Bounds { lower, upper }) in rows.chain(variables) {
        if lower == upper {
            sides.push(Side { source, sign: 0.0, bound: lower });
            continue;
        }
        let finite = [(1.0, upper), (-1.0, lower)].into_iter().filter(|(_, bound)| bound.is_finite());
        inequalities.extend(finite.map(|(sign, bound)| Side { source, sign, bound }));
    }
    sides.extend(inequalities);
    sides
}

impl Side {
    fn factor(&self) -> f64 {
        if self.sign == 0.0 { 1.0 } else { self.sign }
    }
}

fn linear_part(nlp: &dyn Nlp, derivatives: &Derivatives, v: &[f64]) -> Vec<f64> {
    let mut curved = vec![0.0; v.len()];
    nlp.hessian_structure().symmetric_multiply_add(&derivatives.hessian, v, &mut curved);
    derivatives.gradient.iter().zip(&curved).map(|(gradient, curved)| gradient - curved).collect()
}

fn constraint_columns(nlp: &dyn Nlp, jacobian: &[f64], sides: &[Side], variables: usize) -> Columns {
    let mut of_row: Vec<Vec<(usize, f64)>> = vec![Vec::new(); nlp.row_bounds().len()];
    for ((row, column), value) in nlp.jacobian_structure().entries().zip(jacobian) {
        of_row[row].push((column, *value));
    }
    let mut entries = Vec::new();
    for (i, side) in sides.iter().enumerate() {
        match side.source {
            Source::Variable(j) => entries.push((i, j, side.factor())),
            Source::Row(row) => {
                entries.extend(of_row[row].iter().map(|(j, value)| (i, *j, side.factor() * value)))
            }
        }
    }
    to_columns(entries, sides.len(), variables)
}

/// `b = sign * (bound - constant part of the row)`
fn right_sides(nlp: &mut dyn Nlp, jacobian: &[f64], sides: &[Side], v: &[f64]) -> Vec<f64> {
    let count = nlp.row_bounds().len();
    let (mut rows, mut linear) = (vec![0.0; count], vec![0.0; count]);
    nlp.values(v, &mut rows);
    nlp.jacobian_structure().multiply_add(jacobian, v, &mut linear);
    let constant = |source| match source {
        Source::Row(row) => rows[row] - linear[row],
        Source::Variable(_) => 0.0,
    };
    sides.iter().map(|side| side.factor() * (side.bound - constant(side.source))).collect()
}

fn into_solution(nlp: &mut dyn Nlp, sides: &[Side], found: crate::clarabel::ConicSolution) -> Solution {
    let status = match found.status {
        ConicStatus::Solved => Status::Solved,
        ConicStatus::Infeasible => Status::Infeasible,
        ConicStatus::Unbounded => Status::Unbounded,
        ConicStatus::IterationLimit => Status::IterationLimit,
        ConicStatus::Failed => Status::NumericalFailure,
    };
    let mut v = found.x;
    clamp(nlp, &mut v);
    let multipliers = multipliers(nlp, sides, &found.z);
    let mut rows = vec![0.0; nlp.row_bounds().len()];
    let objective = nlp.values(&v, &mut rows);
    let counts =
        Counts { iterations: found.iterations, factorizations: found.iterations, ..Counts::default() };
    let constraint_violation = constraint_violation(nlp, &v);
    let kkt_error = stationarity(nlp, &v, &multipliers).max(constraint_violation);
    // The conic solver measures its errors relative to numbers that may be huge: believe the conditions themselves.
    let largest = multipliers.rows.iter().fold(1.0, |a: f64, lambda| a.max(lambda.abs()));
    let status = match status {
        Status::Solved if kkt_error > CREDIBLE * largest => Status::NumericalFailure,
        status => status,
    };
    let global = status == Status::Solved;
    Solution { status, v, multipliers, mu: 0.0, objective, kkt_error, constraint_violation, global, counts }
}

/// The conic solver keeps bounds only to its tolerance.
fn clamp(nlp: &dyn Nlp, v: &mut [f64]) {
    for (value, bounds) in v.iter_mut().zip(nlp.variable_bounds()) {
        *value = value.max(bounds.lower).min(bounds.upper);
    }
}

fn multipliers(nlp: &dyn Nlp, sides: &[Side], z: &[f64]) -> Multipliers {
    let variables = nlp.variable_bounds().len();
    let mut multipliers = Multipliers {
        rows: vec![0.0; nlp.row_bounds().len()],
        lower: vec![0.0; variables],
        upper: vec![0.0; variables],
    };
    for (side, z) in sides.iter().zip(z) {
        let value = side.factor() * z;
        match side.source {
            Source::Row(row) => multipliers.rows[row] += value,
            Source::Variable(i) if value < 0.0 => multipliers.lower[i] -= value,
            Source::Variable(i) => multipliers.upper[i] += value,
        }
    }
    multipliers
}

/// Largest component of the gradient of the Lagrangian.
fn stationarity(nlp: &mut dyn Nlp, v: &[f64], multipliers: &Multipliers) -> f64 {
    let mut derivatives = Derivatives::new(nlp);
    nlp.derivatives(v, 1.0, &multipliers.rows, &mut derivatives);
    let mut gradient = derivatives.gradient;
    nlp.jacobian_structure().transposed_multiply_add(&derivatives.jacobian, &multipliers.rows, &mut gradient);
    let bounds = multipliers.upper.iter().zip(&multipliers.lower);
    gradient.iter().zip(bounds).fold(0.0, |a, (g, (upper, lower))| a.max((g + upper - lower).abs()))
}

fn upper_columns(structure: &Triplets, values: &[f64], size: usize) -> Columns {
    let entries = structure.entries().zip(values).map(|((i, j), value)| (i.min(j), i.max(j), *value));
    to_columns(entries.collect(), size, size)
}

/// Entries (row, column, value), duplicates added.
fn to_columns(mut entries: Vec<(usize, usize, f64)>, rows: usize, columns: usize) -> Columns {
    entries.sort_by_key(|(row, column, _)| (*column, *row));
    let mut result =
        Columns { rows, column_starts: vec![0; columns + 1], row_indices: Vec::new(), values: Vec::new() };
    let mut last = None;
    for (row, column, value) in entries {
        if last == Some((row, column)) {
            *result.values.last_mut().expect("there is a last entry") += value;
            continue;
        }
        result.row_indices.push(row);
        result.values.push(value);
        result.column_starts[column + 1] += 1;
        last = Some((row, column));
    }
    for column in 0..columns {
        result.column_starts[column + 1] += result.column_starts[column];
    }
    result
}
