//! Points on a surface, found by trial: what is accused of something must exist.

use super::local::Local;
use crate::expressions::graph::derivative::gradient;
use crate::expressions::graph::{ExprId, evaluate};
use crate::expressions::interval::Interval;
use crate::model::Symbol;

const TRIALS: u64 = 24;
const STEPS: usize = 30;

/// Points within the bounds and path constraints at which `psi` is 0 to the last digits.
pub(crate) fn points(local: &Local) -> Vec<Vec<f64>> {
    let found = (0..TRIALS).filter_map(|trial| {
        let mut point = start(local, trial);
        onto_surface(local, &mut point).then_some(point)
    });
    found.collect()
}

/// A point within the bounds, another one for each trial.
fn start(local: &Local, trial: u64) -> Vec<f64> {
    let domains = local.domain.iter().enumerate();
    domains.map(|(at, domain)| inside(*domain, trial, at as u64)).collect()
}

/// Whether an expression can be 0 within the bounds.
pub(crate) fn zero(local: &mut Local, expr: ExprId) -> bool {
    !zeros(local, expr).is_empty()
}

/// Points within the bounds at which an expression is 0; parameters keep their values.
pub(crate) fn zeros(local: &mut Local, expr: ExprId) -> Vec<Vec<f64>> {
    let inputs: Vec<u32> = local.graph.inputs_of(&[expr]);
    let slopes = gradient(&mut local.graph, expr, &inputs);
    let roots: Vec<ExprId> = std::iter::once(expr).chain(slopes).collect();
    let is_fixed = |at: u32| matches!(local.symbols[at as usize], Symbol::Param(_));
    let moves: Vec<bool> = inputs.iter().map(|&at| !is_fixed(at)).collect();
    let found = (0..TRIALS).filter_map(|trial| {
        let mut point = start(local, trial);
        for _ in 0..STEPS {
            let values = evaluate(&local.graph, &roots, &point, &[]);
            if values[0].abs() <= 1e-12 {
                let is_inside =
                    point.iter().zip(&local.domain).all(|(value, domain)| near(*value, *domain));
                return is_inside.then_some(point);
            }
            let steps: Vec<(u32, f64)> = (0..inputs.len())
                .filter(|&at| moves[at])
                .map(|at| (inputs[at], values[1 + at]))
                .collect();
            let size: f64 = steps.iter().map(|step| step.1 * step.1).sum();
            steps.iter().for_each(|(at, slope)| point[*at as usize] -= values[0] * slope / size);
        }
        None
    });
    found.collect()
}

/// A number in an interval that depends on nothing but the trial.
fn inside(domain: Interval, trial: u64, at: u64) -> f64 {
    let mut state =
        trial.wrapping_mul(0x9E37_79B9_7F4A_7C15) ^ (at + 1).wrapping_mul(0xD1B5_4A32_D192_ED03);
    state ^= state >> 32;
    state = state.wrapping_mul(0xD6E8_FEB8_6659_FD93);
    state ^= state >> 32;
    let part = if trial == 0 { 0.5 } else { (state >> 11) as f64 / (1u64 << 53) as f64 };
    match (domain.lower.is_finite(), domain.upper.is_finite()) {
        (true, true) => domain.lower + part * (domain.upper - domain.lower),
        (true, false) => domain.lower + 2.0 * part,
        (false, true) => domain.upper - 2.0 * part,
        (false, false) => 4.0 * part - 2.0,
    }
}

/// Moves the states along the gradient until `psi` vanishes; says whether that worked within all
/// bounds.
fn onto_surface(local: &Local, point: &mut [f64]) -> bool {
    for &(input, value) in local.replaced.iter().rev() {
        point[input as usize] = evaluate(&local.graph, &[value], point, &[])[0];
    }
    if !local.replaced.is_empty() {
        return is_allowed(local, point);
    }
    let inputs: Vec<usize> = local
        .gradient
        .iter()
        .filter_map(|it| local.input_of(Symbol::State(it.0)))
        .map(|it| it as usize)
        .collect();
    let roots: Vec<ExprId> =
        std::iter::once(local.psi).chain(local.gradient.iter().map(|it| it.1)).collect();
    for _ in 0..STEPS {
        let values = evaluate(&local.graph, &roots, point, &[]);
        let size: f64 = values[1..].iter().map(|slope| slope * slope).sum();
        if values[0].abs() <= 1e-12 {
            return size > 0.0 && is_allowed(local, point);
        }
        for (&input, slope) in inputs.iter().zip(&values[1..]) {
            point[input] -= values[0] * slope / size;
        }
    }
    false
}

fn is_allowed(local: &Local, point: &[f64]) -> bool {
    let roots: Vec<ExprId> = local.constraints.iter().map(|it| it.0).collect();
    let values = evaluate(&local.graph, &roots, point, &[]);
    let inside = local.domain.iter().zip(point).all(|(domain, value)| near(*value, *domain));
    inside && values.iter().zip(&local.constraints).all(|(value, it)| near(*value, it.1))
}

/// Within a range, but for rounding.
fn near(value: f64, range: Interval) -> bool {
    let slack = 1e-9 * (1.0 + value.abs());
    range.lower - slack <= value && value <= range.upper + slack
}
