//! Convex programs go to the conic solver, and their answer is a global optimum.
//!
//! An NLP whose rows are affine and whose objective is a convex quadratic is read off its own
//! derivatives at one point `v0`: `P = hessian`, `q = gradient - P v0`, `A = jacobian`, constants
//! from the row values.

mod clarabel;
mod convexity;
mod farkas;
mod one_sided;

use super::conclusion::{Ended, conclude};
use super::scaling::Scaled;
use super::scaling::factors::ScalingFactors;
use super::{
    Counts, Derivatives, Multipliers, Nlp, Options, Progress, Solution, Start, Status, Stop, Watch,
    constraint_violation,
};
use crate::linalg::{Columns, Triplets};
use crate::nlp::tuning::convex::{CONIC_TOLERANCE, FLAT_RAY, LEAST_CONIC_TOLERANCE, RAY_ROUNDING};
use crate::problem::{Bounds, Chain, Degree, Link, Problem};
use clarabel::{ConicProgram, ConicSolution, ConicStatus, solve_conic};
use farkas::proves_infeasible;
use one_sided::OneSidedConstraints;

/// Whether the transcription of a chain is affine in its rows and quadratic in its objective.
pub fn is_quadratic_program(chain: &Chain) -> bool {
    let is_linear = |link: &Link| {
        let conditions = (1..link.function.outputs()).map(|row| link.function.degree(row));
        is_affine(conditions) && link.function.degree(0) <= Degree::Quadratic
    };
    chain.phases.iter().all(is_quadratic_phase) && chain.links.iter().all(is_linear)
}

fn is_affine(mut degrees: impl Iterator<Item = Degree>) -> bool {
    degrees.all(|degree| degree == Degree::Affine)
}

fn is_quadratic_phase(problem: &Problem) -> bool {
    let states = problem.layout.x;
    let dynamics = is_affine((0..states).map(|row| problem.dynamics.degree(row)));
    let path = is_affine((0..problem.path.outputs()).map(|row| problem.path.degree(row)));
    let rows = 1..problem.boundary.outputs();
    let boundary = is_affine(rows.map(|row| problem.boundary.degree(row)));
    let cost = !problem.running_cost || problem.dynamics.degree(states) <= Degree::Quadratic;
    let measured = problem.measurements.iter().all(|it| match it.state {
        Some(_) => is_affine([it.function.degree(0)].into_iter()),
        None => it.function.degree(0) <= Degree::Quadratic,
    });
    let objective = problem.boundary.degree(0) <= Degree::Quadratic;
    dynamics && path && boundary && cost && measured && objective
}

/// Whether the objective of a quadratic program is proved to be convex in the variables that are
/// free ([`convexity`]).
pub fn is_proved(nlp: &mut dyn Nlp) -> bool {
    let size = nlp.variable_bounds().len();
    let mut derivatives = Derivatives::new(nlp);
    let multipliers = vec![0.0; nlp.constraint_bounds().len()];
    nlp.derivatives(&vec![0.0; size], 1.0, &multipliers, &mut derivatives);
    let is_free = |i: usize| !nlp.variable_bounds()[i].is_equality();
    let entries = nlp.hessian_structure().entries().zip(&derivatives.hessian);
    let free = entries.filter(|((i, j), _)| is_free(*i) && is_free(*j));
    convexity::is_proved(free.map(|((i, j), value)| (i, j, *value)), size)
}

/// Solves a convex quadratic program; `None` where there is nothing to choose. The caller has
/// made sure that it is one.
pub fn solve(
    nlp: &mut dyn Nlp,
    start: &Start,
    options: &Options,
    watch: &mut Watch,
) -> Option<Solution> {
    let used = ScalingFactors::new(nlp, &start.v);
    let first = with_factors(nlp, used.clone(), start, options, watch)?;
    let is_lost = matches!(first.status, Status::NumericalFailure | Status::IterationLimit);
    let other = ScalingFactors::of_equations(nlp, &start.v);
    if !is_lost || other.distance(&used) <= 1.0 {
        return Some(first);
    }
    with_factors(nlp, other, start, options, watch)
}

fn with_factors(
    nlp: &mut dyn Nlp,
    factors: ScalingFactors,
    start: &Start,
    options: &Options,
    watch: &mut Watch,
) -> Option<Solution> {
    let mut scaled = Scaled::with(nlp, factors);
    let v = scaled.start(start).v;
    let mut ended = solve_scaled(&mut scaled, &v, options, watch)?;
    scaled.unscale(&mut ended.v, &mut ended.multipliers);
    let mut solution = conclude(nlp, ended, options);
    solution.global = solution.status == Status::Solved;
    Some(solution)
}

fn solve_scaled(
    nlp: &mut dyn Nlp,
    v: &[f64],
    options: &Options,
    watch: &mut Watch,
) -> Option<Ended> {
    if v.is_empty() {
        return None;
    }
    let mut derivatives = Derivatives::new(nlp);
    let multipliers = vec![0.0; nlp.constraint_bounds().len()];
    nlp.derivatives(v, 1.0, &multipliers, &mut derivatives);
    let sides = OneSidedConstraints::new(nlp);
    let program = ConicProgram {
        q: linear_part(nlp, &derivatives, v),
        a: sides.columns(nlp, &derivatives.jacobian),
        b: right_side(nlp, &derivatives.jacobian, &sides, v),
        p: upper_columns(nlp.hessian_structure(), &derivatives.hessian, v.len()),
        equalities: sides.equalities,
    };
    let (mut iteration, mut stop) = (0, None);
    let mut ask = || {
        iteration += 1;
        stop = watch(&Progress { iteration, is_conic: true, ..Progress::default() }).break_value();
        stop.is_some()
    };
    let tolerance = (CONIC_TOLERANCE * options.tol).max(LEAST_CONIC_TOLERANCE);
    let found = solve_conic(program, tolerance, options.max_iter, &mut ask);
    Some(ended(nlp, &sides, found, stop))
}

fn linear_part(nlp: &dyn Nlp, derivatives: &Derivatives, v: &[f64]) -> Vec<f64> {
    let mut curved = vec![0.0; v.len()];
    nlp.hessian_structure().symmetric_multiply_add(&derivatives.hessian, v, &mut curved);
    derivatives.gradient.iter().zip(&curved).map(|(gradient, curved)| gradient - curved).collect()
}

/// `b`, from which the constant parts of the rows have been taken.
fn right_side(
    nlp: &mut dyn Nlp,
    jacobian: &[f64],
    sides: &OneSidedConstraints,
    v: &[f64],
) -> Vec<f64> {
    let count = nlp.constraint_bounds().len();
    let (mut rows, mut linear) = (vec![0.0; count], vec![0.0; count]);
    nlp.values(v, &mut rows);
    nlp.jacobian_structure().multiply_add(jacobian, v, &mut linear);
    rows.iter_mut().zip(&linear).for_each(|(row, linear)| *row -= linear);
    sides.right_side(&rows)
}

fn ended(
    nlp: &mut dyn Nlp,
    sides: &OneSidedConstraints,
    found: ConicSolution,
    stop: Option<Stop>,
) -> Ended {
    let status = match found.status {
        ConicStatus::Stopped => stop.map_or(Status::Interrupted, Status::from),
        ConicStatus::Solved => Status::Solved,
        ConicStatus::Infeasible => Status::Infeasible,
        ConicStatus::Unbounded if proves_unbounded(nlp, &found.x) => Status::Unbounded,
        ConicStatus::IterationLimit => Status::IterationLimit,
        ConicStatus::Unbounded | ConicStatus::Roughly | ConicStatus::Failed => {
            Status::NumericalFailure
        }
    };
    let mut v = found.x;
    clamp(nlp, &mut v);
    let multipliers = sides.multipliers(&found.z);
    let status = match status {
        Status::Infeasible if !proves_infeasible(nlp, &multipliers.constraints) => {
            Status::NumericalFailure
        }
        status => status,
    };
    let counts = Counts {
        iterations: found.iterations,
        factorizations: found.iterations,
        ..Counts::default()
    };
    let kkt_error = stationarity(nlp, &v, &multipliers).max(constraint_violation(nlp, &v));
    let (mu, is_saddle, descent, decrement) = (0.0, false, None, f64::INFINITY);
    let assessed = None;
    Ended { status, v, multipliers, mu, kkt_error, is_saddle, descent, assessed, decrement, counts }
}

/// Whether along a ray the objective falls without end and no condition ends it: each entry of the
/// ray that a finite bound stops is rounding, the rows do not change, and nor does the curved part
/// of the objective (Boyd & Vandenberghe, Convex Optimization, section 4.4). Bounds far away look
/// to the conic solver as if there were none.
fn proves_unbounded(nlp: &mut dyn Nlp, ray: &[f64]) -> bool {
    let origin = vec![0.0; ray.len()];
    let mut at = Derivatives::new(nlp);
    nlp.derivatives(&origin, 1.0, &vec![0.0; nlp.constraint_bounds().len()], &mut at);
    let stops = |bounds: &Bounds, along: f64, size: f64| {
        let rounding = RAY_ROUNDING * size;
        along < -rounding && bounds.lower.is_finite()
            || along > rounding && bounds.upper.is_finite()
    };
    let size = ray.iter().fold(0.0f64, |most, d| most.max(d.abs()));
    let (mut along, mut sizes) =
        (vec![0.0; nlp.constraint_bounds().len()], vec![0.0; nlp.constraint_bounds().len()]);
    for ((row, column), slope) in nlp.jacobian_structure().entries().zip(&at.jacobian) {
        along[row] += slope * ray[column];
        sizes[row] += (slope * ray[column]).abs();
    }
    let mut curved = vec![0.0; ray.len()];
    nlp.hessian_structure().symmetric_multiply_add(&at.hessian, ray, &mut curved);
    let falls: f64 = at.gradient.iter().zip(ray).map(|(slope, d)| slope * d).sum();
    let curvature: f64 = curved.iter().zip(ray).map(|(slope, d)| slope * d).sum();
    let variables = nlp.variable_bounds().iter().zip(ray);
    let rows = nlp.constraint_bounds().iter().zip(&along).zip(&sizes);
    let is_open = variables.map(|(bounds, d)| stops(bounds, *d, size)).all(|it| !it)
        && rows.map(|((bounds, d), size)| stops(bounds, *d, *size)).all(|it| !it);
    let entries = nlp.hessian_structure().entries().zip(&at.hessian);
    let terms: f64 = entries.map(|(_, value)| (value * size * size).abs()).sum();
    is_open && falls < 0.0 && curvature.abs() <= FLAT_RAY * terms
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
    nlp.derivatives(v, 1.0, &multipliers.constraints, &mut derivatives);
    let mut gradient = derivatives.gradient;
    nlp.jacobian_structure().transposed_multiply_add(
        &derivatives.jacobian,
        &multipliers.constraints,
        &mut gradient,
    );
    let bounds = multipliers.upper.iter().zip(&multipliers.lower);
    gradient.iter().zip(bounds).fold(0.0, |a, (g, (upper, lower))| a.max((g + upper - lower).abs()))
}

fn upper_columns(structure: &Triplets, values: &[f64], size: usize) -> Columns {
    let entries =
        structure.entries().zip(values).map(|((i, j), value)| (i.min(j), i.max(j), *value));
    Columns::of_entries(&entries.collect::<Vec<_>>(), size, size)
}
