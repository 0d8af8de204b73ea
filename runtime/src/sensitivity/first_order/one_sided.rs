//! Derivatives from both sides, where there is no derivative: each from trajectories with the modes
//! of its side.
//!
//! The gradients at `q + d`, `q + d/4`, `q + d/16` approach the one-sided derivative like `d` where
//! events move smoothly and like `sqrt d` at a grazing; Aitken's extrapolation takes out either.
//! Where the objective itself does not approach its value at `q`, as where a jump happens on one
//! side only, the derivative of that side is infinite.

use super::Objective;
use super::perturbed::perturbed;
use super::quantity::{Gradient, Quantity};
use crate::sensitivity::linearised::linearisation::Lineariser;
use crate::sensitivity::linearised::variational_equation::LinearTape;
use crate::simulate::{Controls, Options, Status, System, simulate};

/// The largest of the three distances, relative to `max(1, |q|)`.
const DISTANCE: f64 = 1e-7;

/// An objective that does not come nearer by more than this part is another one,
const APPROACHES: f64 = 0.7;

/// if it is off by more than this part of its terms; a state that is 0 counts as this part of its
/// unit there.
const OFF: f64 = 1e-8;
const LEAST_OF_UNIT: f64 = 1e-3;

/// What takes so many times as many steps, such as a jump that happens again and again, is another
/// trajectory.
const MOST_TIMES: usize = 100;

/// Below and above each quantity; nothing where a side has no trajectory to the end, infinite where
/// the objective jumps.
pub fn one_sided(
    system: &System,
    controls: &Controls,
    options: &Options,
    quantities: &[Quantity],
) -> Vec<[Option<f64>; 2]> {
    // It is the same for all quantities and both sides.
    let first = quantities.first();
    let here = first.and_then(|quantity| Near::new(system, controls, options, quantity));
    let most = here.as_ref().map_or(0, |it| MOST_TIMES * (1 + it.steps));
    let options = &Options { max_steps: options.max_steps.min(most), ..options.clone() };
    let side = |quantity: &Quantity, sign: f64| {
        let here = here.as_ref()?;
        let distance = sign * DISTANCE * value(system, controls, quantity).abs().max(1.0);
        let near = |part: f64| {
            let (system, controls) = perturbed(system, controls, quantity, part * distance);
            Near::new(&system, &controls, options, quantity)
        };
        let [far, nearer, nearest] = [near(1.0)?, near(0.25)?, near(0.0625)?];
        let gap = nearest.objective - here.objective;
        let is_off = gap.abs() > OFF * nearest.terms.max(here.terms);
        if is_off && gap.abs() > APPROACHES * (far.objective - here.objective).abs() {
            return Some(sign * gap * f64::INFINITY);
        }
        Some(extrapolated([far, nearer, nearest].map(|it| it.derivative)))
    };
    quantities.iter().map(|quantity| [side(quantity, -1.0), side(quantity, 1.0)]).collect()
}

/// What a quantity is.
pub(crate) fn value(system: &System, controls: &Controls, quantity: &Quantity) -> f64 {
    match *quantity {
        Quantity::Parameter(at) => system.parameters[at].value,
        Quantity::Start(at) => system.start[at],
        Quantity::Control { row, control } => controls.rows()[row][control],
    }
}

/// The objective with a quantity near its value.
struct Near {
    objective: f64,
    /// By the adjoint alone.
    derivative: f64,
    /// The size of what the objective is made of, to first order.
    terms: f64,
    /// Of its simulation.
    steps: usize,
}

impl Near {
    fn new(
        system: &System,
        controls: &Controls,
        options: &Options,
        quantity: &Quantity,
    ) -> Option<Self> {
        let simulation = simulate(system, controls, &Options { tape: true, ..options.clone() });
        let lineariser = Lineariser::new(system, controls);
        let objective = Objective::new(&lineariser, &simulation)?;
        let tape =
            simulation.tape.as_ref().filter(|_| matches!(simulation.status, Status::Completed))?;
        let zero = Gradient::zero(system, controls);
        let pieces = LinearTape::new(&lineariser, tape);
        let gradient = super::adjoint(&pieces, &objective, zero, &mut |_, _| ());
        let derivative = Some(gradient.by(quantity)).filter(|value| value.is_finite())?;
        let states = simulation.end.iter().zip(&system.states);
        let sizes = states.map(|(value, state)| value.abs().max(LEAST_OF_UNIT * state.unit));
        let terms = objective.by_end.iter().zip(sizes).map(|(by, size)| by.abs() * size);
        let terms = objective.value.abs() + terms.sum::<f64>();
        let steps = simulation.counts.steps + simulation.counts.rejected;
        Some(Near { objective: objective.value, derivative, terms, steps })
    }
}

fn extrapolated([first, second, third]: [f64; 3]) -> f64 {
    let (before, after) = (second - first, third - second);
    let is_settled = after.abs() <= 1e-9 * third.abs().max(1.0) || after.abs() >= before.abs();
    if is_settled { third } else { third - after * after / (after - before) }
}
