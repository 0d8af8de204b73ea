//! Steps that are as short as derivatives need them.
//!
//! The steps of a simulation follow the state. Where that is at rest, or moves as a polynomial in
//! time, they grow without limit, and what they make of a small change is arbitrary: explicit steps
//! outside of their region of stability, pulses that are stepped over. Forward sensitivities and
//! adjoint agree all the same, since they differentiate the same steps. So
//!
//! ```text
//! beside: simulate with all quantities a little different
//! no step longer than those of the trajectory beside it: derivatives
//! repeat: halve all steps: derivatives, until they stay the same, or no longer come to that; with
//!         the stiff method where they do not soon, which damps what is beside the motion as fast
//!         as it is
//! ```

use super::gradient::{Sensitivity, along_own_steps};
use super::quantity::Quantity;
use crate::sensitivity::tuning::resolved::{
    BESIDE, FEW_HALVINGS, MOST_EXPLICIT, MOST_HALVINGS, SETTLES, TOLERANCES,
};
use crate::simulate::{Controls, Integrator, Options, Piece, Simulation, Status, System, simulate};

/// Differentiates; nothing but the simulation where it does not reach the end or there is no
/// objective.
pub fn gradient(
    system: &System,
    controls: &Controls,
    options: &Options,
    quantities: &[Quantity],
) -> Result<Sensitivity, Box<Simulation>> {
    let mut options = Options { paces: beside(system, controls, options), ..options.clone() };
    let mut found = along_own_steps(system, controls, &options, quantities)?;
    let mut before = f64::INFINITY;
    for halving in 0..MOST_HALVINGS {
        if halving == MOST_EXPLICIT && options.integrator == Integrator::Automatic {
            options.integrator = Integrator::Stiff;
        }
        options = finer(&options, &found.simulation);
        let next = match along_own_steps(system, controls, &options, quantities) {
            Ok(next) => next,
            Err(simulation) if matches!(simulation.status, Status::Stopped(_)) => {
                return Err(simulation);
            }
            Err(_) => break,
        };
        // What has decayed to nothing is worth a few halvings, and no doubt where nothing can have
        // grown by the method alone.
        let [exact, forgiving] = [false, true].map(|forgets| difference(&found, &next, forgets));
        let is_damped = options.integrator == Integrator::Stiff && halving > MOST_EXPLICIT;
        let resolution = if is_damped { forgiving } else { exact };
        found = Sensitivity { resolution, resolution_of_rests: exact, ..next };
        let left = if halving < FEW_HALVINGS { exact } else { resolution };
        let is_stalled = halving >= FEW_HALVINGS && left > SETTLES * before;
        if left <= TOLERANCES * options.rtol || is_stalled {
            break;
        }
        before = left;
    }
    Ok(found)
}

/// Options with steps of half the length.
pub fn finer(options: &Options, simulation: &Simulation) -> Options {
    let mut paces = paces(simulation);
    paces.iter_mut().for_each(|it| it[1] *= 0.5);
    Options { paces, ..options.clone() }
}

/// The lengths of steps, each at least that of its neighbours: an event makes one short.
fn paces(simulation: &Simulation) -> Vec<[f64; 2]> {
    let pieces = simulation.tape.iter().flat_map(|tape| &tape.pieces);
    let step = |piece: &Piece| match piece {
        Piece::Step { start, h, .. } => Some([start.time, *h]),
        Piece::Event { .. } => None,
    };
    let steps: Vec<[f64; 2]> = pieces.filter_map(step).collect();
    let longest = |at: usize| {
        let around = &steps[at.saturating_sub(1)..(at + 2).min(steps.len())];
        around.iter().fold(0.0, |longest: f64, it| longest.max(it[1]))
    };
    (0..steps.len()).map(|at| [steps[at][0], longest(at)]).collect()
}

/// The lengths of the steps of a trajectory in which everything is a little different; none where
/// that does not reach the end, as where it grows beyond all bounds a moment sooner.
fn beside(system: &System, controls: &Controls, options: &Options) -> Vec<[f64; 2]> {
    let mut turns = (1..).map(|at| (f64::from(at) * GOLDEN).fract() + 0.5);
    let mut moved = |value: f64| {
        let size = if value == 0.0 { 1.0 } else { value };
        value + BESIDE * size * turns.next().expect("there is always one more")
    };
    let values: Vec<f64> = system.parameter_values().into_iter().map(&mut moved).collect();
    let mut other = system.with_parameters(&values);
    other.start.iter_mut().for_each(|it| *it = moved(*it));
    let mut driven = controls.clone();
    driven.rows_mut().iter_mut().flatten().for_each(|it| *it = moved(*it));
    driven.stretch(system.interval, other.interval);
    let found = simulate(&other, &driven, &Options { tape: true, ..options.clone() });
    if matches!(found.status, Status::Completed) { paces(&found) } else { Vec::new() }
}

/// The multiples of the golden ratio are spread most evenly.
const GOLDEN: f64 = 0.618_033_988_749_894_9;

/// The largest difference of two gradients, each entry relative to what it is made of, or to what
/// counts as 0 beside that.
fn difference(one: &Sensitivity, other: &Sensitivity, forgets: bool) -> f64 {
    let largest = other.adjoint.iter().fold(0.0, |largest: f64, it| largest.max(it.abs()));
    let is_each = other.sizes.len() == other.adjoint.len();
    let size = |at: usize| match other.sizes.get(at).filter(|_| is_each) {
        Some([size, nothing]) if forgets => size.max(*nothing),
        Some([size, _]) => *size,
        None => largest,
    };
    let ways = [(&one.adjoint, &other.adjoint), (&one.forward, &other.forward)];
    let pairs = ways.into_iter().flat_map(|(a, b)| a.iter().zip(b).enumerate());
    let differences = pairs.map(|(at, (a, b))| match (a - b).abs() {
        0.0 => 0.0,
        gap => gap / size(at).max(b.abs()),
    });
    differences.fold(0.0, |largest, it| if it > largest || it.is_nan() { it } else { largest })
}
