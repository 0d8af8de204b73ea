//! Whether the controls minimise the Hamiltonian: its slope by a control points away from the bound
//! that is active, and is zero where none is.
//!
//! ```text
//!     dH/du > 0  only at the lower bound,      dH/du < 0  only at the upper bound
//! ```
//!
//! The slope is that of the Lagrangian without the multipliers of bounds, over the length of the
//! interval: costates, path constraints and running cost are in it, what the solver says about
//! bounds is not. What is left to gain,
//!
//! ```text
//!     dH/du (u - lower)   where dH/du > 0,        -dH/du (upper - u)   where dH/du < 0
//! ```
//!
//! is an amount of `H`, and is compared with the size of its terms. A bound that is farther away
//! than the control ever is from 0 says nothing of its size: then it is that size which could be
//! gained.

use super::outcome::Outcome;
use crate::nlp::{Derivatives, Multipliers, Nlp, Solution};
use crate::problem::{Bounds, Problem};
use crate::transcribe::TranscribedNlp;
use crate::transcribe::interval::Signal;

/// A smaller part of the size of the Hamiltonian is no gain.
const GAIN: f64 = 1e-3;

/// For each control, the part of the time on which the rule of signs is violated at a point with
/// these slopes, over this time and with terms of this size.
pub(super) fn violations(
    nlp: &TranscribedNlp,
    (v, slopes): (&[f64], &[f64]),
    (duration, size): (f64, f64),
) -> Vec<f64> {
    let controls = &nlp.problem().controls;
    let gains = controls
        .iter()
        .enumerate()
        .map(|(control, it)| gains(nlp, (v, slopes), control, largest(nlp, v, control, it.unit)));
    let part = |k: usize| nlp.mesh().relative(k) / nlp.chain().intervals as f64;
    let is_large = |k: usize, gain: f64| gain > GAIN * size * duration.abs() * part(k);
    let violated = |gains: Vec<f64>| {
        let large = gains.iter().enumerate().filter(|(k, gain)| is_large(*k, **gain));
        large.map(|(k, _)| part(k)).fold(0.0, |sum: f64, part| (sum + part).min(1.0))
    };
    gains.map(violated).collect()
}

/// The slope of the Hamiltonian of the minimisation problem by a control, over all of its values in
/// a phase.
#[derive(Clone, Copy)]
pub struct ControlSlopes {
    /// The least one, and the interval that it is on.
    pub least: (f64, usize),
    /// The largest one.
    pub largest: (f64, usize),
    /// The largest sum of the sizes of what it is the sum of.
    pub terms: f64,
}

/// Those of all controls of a phase.
pub fn control_slopes(problem: &Problem, outcome: &Outcome) -> Vec<ControlSlopes> {
    let mut nlp = TranscribedNlp::new(problem);
    let parameters = outcome.trajectory.parameters.iter().enumerate();
    parameters.for_each(|(index, value)| nlp.set_parameter(index, *value));
    let slopes = slopes(&mut nlp, &outcome.solution);
    let sizes = sizes_of_slopes(&mut nlp, &outcome.solution);
    let time = &outcome.trajectory.time;
    let stages = problem.method.scheme.stages() as f64;
    let none =
        ControlSlopes { least: (f64::INFINITY, 0), largest: (f64::NEG_INFINITY, 0), terms: 0.0 };
    let of = |control: usize| {
        variables(&nlp, control).fold(none, |all, (k, at)| {
            let [slope, terms] =
                [slopes[at], sizes[at]].map(|it| it * stages / (time[k + 1] - time[k]));
            ControlSlopes {
                least: if slope < all.least.0 { (slope, k) } else { all.least },
                largest: if slope > all.largest.0 { (slope, k) } else { all.largest },
                terms: all.terms.max(terms),
            }
        })
    };
    (0..problem.controls.len()).map(of).collect()
}

/// Of each slope, what its terms add up to without their signs.
fn sizes_of_slopes(nlp: &mut TranscribedNlp, solution: &Solution) -> Vec<f64> {
    let rows = &solution.multipliers.constraints;
    let Derivatives { gradient, jacobian, .. } = derivatives(nlp, solution);
    let mut sizes: Vec<f64> = gradient.iter().map(|it| it.abs()).collect();
    let jacobian: Vec<f64> = jacobian.iter().map(|it| it.abs()).collect();
    let rows: Vec<f64> = rows.iter().map(|it| it.abs()).collect();
    nlp.jacobian_structure().transposed_multiply_add(&jacobian, &rows, &mut sizes);
    sizes
}

/// The gradient of the Lagrangian without the multipliers of bounds.
pub(crate) fn slopes(nlp: &mut TranscribedNlp, solution: &Solution) -> Vec<f64> {
    let derivatives = derivatives(nlp, solution);
    gradient(nlp, solution, &derivatives)
}

/// The same from the derivatives at the solution.
pub(super) fn gradient(
    nlp: &TranscribedNlp,
    solution: &Solution,
    Derivatives { gradient, jacobian, .. }: &Derivatives,
) -> Vec<f64> {
    let (mut slopes, rows) = (gradient.clone(), &solution.multipliers.constraints);
    nlp.jacobian_structure().transposed_multiply_add(jacobian, rows, &mut slopes);
    slopes
}

/// The derivatives at a solution.
pub(super) fn derivatives(nlp: &mut TranscribedNlp, solution: &Solution) -> Derivatives {
    let mut derivatives = Derivatives::new(nlp);
    nlp.derivatives(&solution.v, 1.0, &solution.multipliers.constraints, &mut derivatives);
    derivatives
}

/// Gives a control whose bounds are equal the multiplier that its value has: the slope. The
/// interior point method does not see it, the conic solver has a multiplier of its own for it.
pub(crate) fn set_multipliers_of_fixed(nlp: &TranscribedNlp, slopes: &[f64], of: &mut Multipliers) {
    for control in 0..nlp.problem().controls.len() {
        let fixed = variables(nlp, control).filter(|it| nlp.variable_bounds()[it.1].is_equality());
        fixed.for_each(|(_, at)| (of.lower[at], of.upper[at]) = (slopes[at], 0.0));
    }
}

/// The variables that are values of a control, each with its interval; a value that two intervals
/// share belongs to the later one.
pub(super) fn variables<'a>(
    nlp: &'a TranscribedNlp,
    control: usize,
) -> impl Iterator<Item = (usize, usize)> + 'a {
    let chain = nlp.chain();
    let slots = nlp.interval().slots.iter().enumerate();
    let places = slots
        .filter(move |(_, slot)| slot.signal == Signal::Control(control))
        .map(|(place, _)| place);
    places
        .flat_map(move |place| (0..chain.intervals).map(move |k| (k, chain.state(k).start + place)))
}

/// How large a control is anywhere; one of its unit where it is 0 throughout.
fn largest(nlp: &TranscribedNlp, v: &[f64], control: usize, unit: f64) -> f64 {
    let most = variables(nlp, control).fold(0.0, |most: f64, (_, at)| most.max(v[at].abs()));
    if most > 0.0 { most } else { unit }
}

/// What could be gained on each interval, times its length.
fn gains(
    nlp: &TranscribedNlp,
    (v, slopes): (&[f64], &[f64]),
    control: usize,
    size: f64,
) -> Vec<f64> {
    let mut gains = vec![0.0; nlp.chain().intervals];
    for (k, variable) in variables(nlp, control) {
        gains[k] += gain(&nlp.variable_bounds()[variable], v[variable], slopes[variable], size);
    }
    gains
}

/// By a move to the bound, or by as much as the control is large.
fn gain(bounds: &Bounds, value: f64, slope: f64, size: f64) -> f64 {
    let room = if slope > 0.0 { value - bounds.lower } else { bounds.upper - value };
    slope.abs() * room.clamp(0.0, size)
}

#[cfg(test)]
mod tests {
    use super::gain;
    use crate::problem::Bounds;

    #[test]
    fn a_slope_is_a_gain_unless_it_points_away_from_the_active_bound() {
        let bounds = Bounds { lower: -1.0, upper: 2.0 };
        let gain = |value, slope| gain(&bounds, value, slope, 10.0);
        assert_eq!([gain(-1.0, 3.0), gain(2.0, -3.0), gain(0.5, 0.0)], [0.0; 3]);
        assert_eq!([gain(-1.0, -3.0), gain(2.0, 3.0), gain(0.0, 0.5)], [9.0, 9.0, 0.5]);
    }

    /// A wide bound, or none, is no size.
    #[test]
    fn what_can_be_gained_is_no_more_than_the_size_of_the_control() {
        let wide = Bounds { lower: -1e7, upper: 1e7 };
        assert_eq!(gain(&wide, 0.1, -0.25, 2.0), 0.5);
        assert_eq!(gain(&Bounds::FREE, 0.1, -0.25, 2.0), 0.5);
    }
}
