//! Where nothing is controlled, measured data are also fitted from the motion that the guess of the
//! unknowns leads to: signals that are guessed apart from each other may lead to a trajectory that
//! a grid allows, and no motion does.

use super::found::Found;
use super::report::{Options, Start as From};
use super::tuning::sequences::STEPS;
use crate::error::Error;
use crate::model::Model;
use crate::simulation::Simulation;
use fdcc_runtime::nlp::Start;
use fdcc_runtime::problem::{Chain, Problem};
use fdcc_runtime::simulate::{Controls, Options as Accuracy};
use fdcc_runtime::solve::warm_start::{Earlier, from_trajectories};

/// The motion from the guess on the grids of a chain; nothing where controls are free, nothing is
/// measured, or the motion does not reach its end.
pub(super) fn start(model: &Model, chain: &Chain) -> Option<Start> {
    let is_driven = chain.phases.iter().any(|it| !it.controls.is_empty());
    let is_measured = chain.phases.iter().any(|it| !it.measurements.is_empty());
    if is_driven || !is_measured {
        return None;
    }
    let motions = motions(model).ok()?;
    let is_whole =
        motions.len() == chain.phases.len() && motions.iter().all(Simulation::is_complete);
    let own = chain.phases.iter().zip(&motions);
    is_whole
        .then(|| from_trajectories(chain, &own.map(|(it, of)| earlier(it, of)).collect::<Vec<_>>()))
}

/// An answer with the unknowns as they are guessed, where it is one of a fit with switches, nothing
/// is controlled, and the times are given.
pub(super) fn of_guess(found: &Found, options: &Options) -> Option<Found> {
    let problem = &found.problem;
    let is_fit = problem.controls.is_empty() && !problem.measurements.is_empty();
    let is_asked = matches!(options.start, From::Guess) && !problem.surfaces.is_empty();
    if !is_fit || !is_asked {
        return None;
    }
    let mut guessed = found.clone();
    let own = &mut guessed.outcome.trajectory;
    for unknown in &problem.unknowns {
        own.parameters[unknown.parameter] = problem.parameters[unknown.parameter].value;
    }
    // The grid is that of the answer.
    let ends = [own.time[0], own.time[own.time.len() - 1]];
    (problem.ends(&own.parameters) == ends).then_some(guessed)
}

fn motions(model: &Model) -> Result<Vec<Simulation>, Error> {
    let accuracy = Accuracy { max_steps: STEPS, ..Accuracy::default() };
    match model.meaning().phases.is_empty() {
        true => Ok(vec![model.simulate(&Controls::Guess, &accuracy)?]),
        false => Ok(model.simulate_phases(None, &accuracy)?.all),
    }
}

/// States over normalised time.
fn earlier(problem: &Problem, motion: &Simulation) -> Earlier {
    let time = motion.time();
    let (first, last) = (time[0], time[time.len() - 1]);
    let state = |name: &str| motion.state(name).map(<[f64]>::to_vec);
    Earlier {
        times: time.iter().map(|it| (it - first) / (last - first)).collect(),
        states: problem.states.iter().map(|it| state(&it.name)).collect(),
        ..Earlier::default()
    }
}
