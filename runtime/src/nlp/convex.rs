//! Convex programmes go to the conic solver, and their answer is a global optimum.
//!
//! A programme whose rows are affine and whose objective is a convex quadratic is read off its own derivatives at
//! one point `v0`: `P = hessian`, `q = gradient - P v0`, `A = jacobian`, constants from the row values.

use super::scaling::Scaled;
use super::sides::Sides;
use super::{Counts, Derivatives, Multipliers, Nlp, Solution, Start, Status, constraint_violation};
use crate::clarabel::{Columns, ConicProgram, ConicStatus, Ldl, solve_conic};
use crate::linalg::Triplets;
use crate::problem::{Degree, Problem};

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

/// Solves the programme if its Hessian is positive semidefinite; `None` if it is not convex. The caller has made sure
/// that it is quadratic.
pub fn solve(nlp: &mut dyn Nlp, start: &Start, tolerance: f64, max_iterations: usize) -> Option<Solution> {
    let mut scaled = Scaled::new(nlp, &start.v);
    let start = scaled.start(start);
    let mut solution = solve_scaled(&mut scaled, &start, tolerance, max_iterations)?;
    scaled.unscale(&mut solution.v, &mut solution.multipliers);
    solution.objective = nlp.values(&solution.v, &mut vec![0.0; nlp.row_bounds().len()]);
    solution.constraint_violation = constraint_violation(nlp, &solution.v);
    Some(solution)
}

fn solve_scaled(nlp: &mut dyn Nlp, start: &Start, tolerance: f64, max_iterations: usize) -> Option<Solution> {
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
    let sides = Sides::new(nlp);
    let program = ConicProgram {
        q: linear_part(nlp, &derivatives, &start.v),
        a: sides.columns(nlp, &derivatives.jacobian),
        b: right_side(nlp, &derivatives.jacobian, &sides, &start.v),
        p: hessian,
        equalities: sides.equalities,
    };
    let found = solve_conic(program, (0.1 * tolerance).max(1e-10), max_iterations);
    Some(into_solution(nlp, &sides, found))
}

/// Positive semidefinite up to rounding: all pivots of `P + tiny I` are positive.
fn is_semidefinite(hessian: &Columns) -> bool {
    let size = hessian.rows;
    let largest = hessian.values.iter().fold(1.0f64, |a, value| a.max(value.abs()));
    let mut entries = hessian.entries();
    entries.extend((0..size).map(|i| (i, i, 1e-12 * largest)));
    let shifted = Columns::of_entries(&entries, size, size);
    let values = shifted.values.clone();
    Ldl::new(shifted).factor(&values) == Some(size)
}

fn linear_part(nlp: &dyn Nlp, derivatives: &Derivatives, v: &[f64]) -> Vec<f64> {
    let mut curved = vec![0.0; v.len()];
    nlp.hessian_structure().symmetric_multiply_add(&derivatives.hessian, v, &mut curved);
    derivatives.gradient.iter().zip(&curved).map(|(gradient, curved)| gradient - curved).collect()
}

/// `b`, from which the constant parts of the rows have been taken.
fn right_side(nlp: &mut dyn Nlp, jacobian: &[f64], sides: &Sides, v: &[f64]) -> Vec<f64> {
    let count = nlp.row_bounds().len();
    let (mut rows, mut linear) = (vec![0.0; count], vec![0.0; count]);
    nlp.values(v, &mut rows);
    nlp.jacobian_structure().multiply_add(jacobian, v, &mut linear);
    rows.iter_mut().zip(&linear).for_each(|(row, linear)| *row -= linear);
    sides.right_side(&rows, &vec![0.0; v.len()])
}

fn into_solution(nlp: &mut dyn Nlp, sides: &Sides, found: crate::clarabel::ConicSolution) -> Solution {
    let status = match found.status {
        ConicStatus::Solved => Status::Solved,
        ConicStatus::Infeasible => Status::Infeasible,
        ConicStatus::Unbounded => Status::Unbounded,
        ConicStatus::IterationLimit => Status::IterationLimit,
        ConicStatus::Roughly | ConicStatus::Failed => Status::NumericalFailure,
    };
    let mut v = found.x;
    clamp(nlp, &mut v);
    let multipliers = sides.multipliers(&found.z);
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
    Columns::of_entries(&entries.collect::<Vec<_>>(), size, size)
}
