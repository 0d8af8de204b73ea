//! Where nothing is controlled, measured data are also fitted from the motion that the guess of the
//! unknowns leads to: signals that are guessed apart from each other may lead to a trajectory that
//! a grid allows, and no motion does.

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
