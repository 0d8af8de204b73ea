//! Kinks that only parameters reach: `start abs(a)` at `a = 0`, `time t in [0, max(a, 1)]` at 1, or
//! `surface s = x - abs(a)`. They are found as those of an objective are.

use super::kink::{Kink, KinkMet};
use super::objective_kink::{distance_from, has_kink};
use crate::problem::{Columns, Function};
use crate::sensitivity::linearised::linearisation::{Jacobian, Lineariser};
use crate::simulate::{Piece, Tape};
use std::ops::Range;
use std::sync::Arc;

/// A second distance, for comparison, and the part of a difference that stays there.
const NEARER: f64 = 16.0;
const STAYS: f64 = 0.5;

/// So many times are looked at, at most.
const GUESSES: usize = 64;

/// What is less than this part of the terms, and of the value, is rounding.
const UNKNOWN: f64 = 5e-14;

/// The first kink that one of these parameters is on: of the times, of the starts, of a surface or
/// a guessed control where a regime begins, or of the right side where a step begins.
pub(crate) fn parameter_kink(
    lineariser: &Lineariser,
    tape: &Tape,
    parameters: &[usize],
) -> Option<Kink> {
    let system = lineariser.system;
    let nothing = Columns::new(0, 1);
    let fixed = [(&system.interval_of, nothing.clone()), (&system.start_of, nothing)];
    let watched = begins(lineariser, tape).into_iter().map(|point| (&system.switching, point));
    let all = fixed.into_iter().chain(watched).map(|(function, point)| (function, point, 0));
    let others = all.chain(guesses(lineariser, tape)).find_map(|(function, point, first)| {
        let outputs = first..function.outputs();
        let of = |parameter: &usize| {
            output_with_kink(&**function, &point, lineariser, *parameter, outputs.clone())
        };
        Some(function.origin(parameters.iter().find_map(of)?))
    });
    let of_flow = || {
        steps_on_kinks(lineariser, tape, parameters).find_map(|point| {
            let of = |parameter: &usize| {
                let all = 0..system.flow.outputs();
                let bent = output_with_kink(&*system.flow, &point, lineariser, *parameter, all);
                bent.or_else(|| output_of_one_side(&*system.flow, &point, lineariser, *parameter))
            };
            Some(system.flow.origin(parameters.iter().find_map(of)?))
        })
    };
    others.or_else(of_flow).map(|of| Kink { of, met: KinkMet::ByParameters })
}

/// Where the first steps of all regimes begin.
fn begins(lineariser: &Lineariser, tape: &Tape) -> Vec<Columns> {
    let mut seen = vec![false; tape.regimes.len()];
    let mut points = Vec::new();
    for piece in &tape.pieces {
        let Piece::Step { start, .. } = piece else { continue };
        if !std::mem::replace(&mut seen[start.regime], true) {
            let (regime, state) = (&tape.regimes[start.regime], start.state.clone().into());
            points.push(lineariser.table(regime, &start.selectors, start.time, &state));
        }
    }
    points
}

/// The guess where some of the steps begin, and the first of its controls; nothing where controls
/// are given. At one time alone a kink may be multiplied by 0.
fn guesses<'a>(
    lineariser: &'a Lineariser,
    tape: &Tape,
) -> impl Iterator<Item = (&'a Arc<dyn Function>, Columns, usize)> {
    let starts = tape.pieces.iter().filter_map(|piece| match piece {
        Piece::Step { start, .. } => Some(start.time),
        _ => None,
    });
    let all: Vec<f64> = starts.filter(|_| lineariser.is_guessed()).collect();
    let apart = all.len().div_ceil(GUESSES).max(1);
    let guess = &lineariser.system.guess;
    let controls = lineariser.system.layout.x;
    let times: Vec<f64> = all.into_iter().step_by(apart).collect();
    times.into_iter().map(move |time| (guess, Columns::of_point(&[lineariser.tau(time)]), controls))
}

/// Where the steps begin, if one of these parameters is on a kink of the right side. Whether that
/// bends anything depends on the state: `max(a, 0) x` has no kink where `x` is 0.
fn steps_on_kinks<'a>(
    lineariser: &'a Lineariser,
    tape: &'a Tape,
    parameters: &[usize],
) -> impl Iterator<Item = Columns> + 'a {
    let fixed_kinks = &*lineariser.system.fixed_kinks;
    let inputs = fixed_kinks.layout().inputs() - lineariser.parameters.len();
    let zeros = |values: &[f64]| values_of(fixed_kinks, &Columns::new(inputs, 1), values);
    let is_on = parameters.iter().any(|at| {
        let moved = |by: f64| {
            let mut parameters = lineariser.parameters.clone();
            parameters[*at] += by;
            zeros(&parameters)
        };
        let distance = distance_from(lineariser.parameters[*at]);
        let [below, above] = [moved(-distance), moved(distance)];
        below.iter().zip(&above).any(|(below, above)| below * above <= 0.0 && below != above)
    });
    let points = tape.pieces.iter().filter_map(|piece| {
        let Piece::Step { start, .. } = piece else { return None };
        let (regime, state) = (&tape.regimes[start.regime], start.state.clone().into());
        Some(lineariser.table(regime, &start.selectors, start.time, &state))
    });
    points.take(if is_on { usize::MAX } else { 0 })
}

/// The first of some outputs of a function at a point that has a kink along a parameter.
fn output_with_kink(
    function: &dyn Function,
    point: &Columns,
    lineariser: &Lineariser,
    parameter: usize,
    outputs: Range<usize>,
) -> Option<usize> {
    let values = |moved: f64| {
        let mut parameters = lineariser.parameters.clone();
        parameters[parameter] += moved;
        values_of(function, point, &parameters)
    };
    let terms = terms_of(function, point, &lineariser.parameters);
    first_with_kink(lineariser.parameters[parameter], outputs, &terms, values)
}

/// The first output of a function at a point whose derivative by a parameter is that of neither
/// side: kinks that cancel, as those of `max(a, 0) + min(a, 0)`, are on one side each.
fn output_of_one_side(
    function: &dyn Function,
    point: &Columns,
    lineariser: &Lineariser,
    parameter: usize,
) -> Option<usize> {
    let distance = distance_from(lineariser.parameters[parameter]);
    let moved = |by: f64| {
        let mut parameters = lineariser.parameters.clone();
        parameters[parameter] += by;
        values_of(function, point, &parameters)
    };
    let both = |distance: f64| [moved(-distance), moved(distance)];
    let (far, near) = (both(distance), both(distance / NEARER));
    let terms = terms_of(function, point, &lineariser.parameters);
    let column = function.layout().parameters().start + parameter;
    let Jacobian { values, by } = Jacobian::of(function, point, &lineariser.parameters);
    (0..function.outputs()).find(|&output| {
        let gap = |[below, above]: &[Vec<f64>; 2], distance: f64| {
            (by[(output, column)] - (above[output] - below[output]) / (2.0 * distance)).abs()
        };
        let [off, nearer] = [gap(&far, distance), gap(&near, distance / NEARER)];
        let size = terms[output].max(values[output].abs());
        let rounding = UNKNOWN * (size / distance).max(by[(output, column)].abs());
        // One that is right is approached.
        nearer > rounding && nearer > STAYS * off
    })
}

/// The outputs of a function at a point.
pub(super) fn values_of(function: &dyn Function, point: &Columns, parameters: &[f64]) -> Vec<f64> {
    let mut values = Columns::new(function.outputs(), 1);
    function.value(point, parameters, &mut values);
    (0..function.outputs()).map(|it| values.column(it)[0]).collect()
}

/// The size of what each output of a function at a point is a sum of: `sum of |dy/dz z|` over all
/// inputs. On a surface, for example, the output itself is 0 and says nothing of its rounding.
pub(super) fn terms_of(function: &dyn Function, point: &Columns, parameters: &[f64]) -> Vec<f64> {
    let mut inputs: Vec<f64> = (0..point.columns()).map(|at| point.column(at)[0]).collect();
    let place = function.layout().parameters().start;
    inputs.splice(place..place, parameters.iter().copied());
    let by = Jacobian::of(function, point, parameters).by;
    let term = |(by, input): (&f64, &f64)| Some((by * input).abs()).filter(|it| it.is_finite());
    by.row_iter().map(|row| row.iter().zip(&inputs).filter_map(term).sum()).collect()
}

/// The first of some outputs that has a kink along an input of this value, which is moved; `terms`
/// are those of all outputs.
pub(super) fn first_with_kink(
    input: f64,
    mut outputs: Range<usize>,
    terms: &[f64],
    values: impl Fn(f64) -> Vec<f64>,
) -> Option<usize> {
    outputs.find(|it| has_kink(input, terms[*it], |moved| values(moved)[*it]))
}
