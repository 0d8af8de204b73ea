//! Solutions of models with phases: each phase is a solution of its own.

use super::found::{Divided, FoundChain, Jump};
use super::sequences::happened;
use super::solution::Solution;
use crate::error::Error;
use crate::model::{Model, frame};
use crate::record::Record;
use crate::verification::{LinkGap, Verification, objective_of_links, verify_phases};
use fdcc_runtime::problem::{Chain, Problem};
use fdcc_runtime::solution::{Trajectory, phases};
use fdcc_runtime::solve::{ChainOutcome, Outcome};

/// The answer to a chain, as the solver has it.
#[derive(Clone)]
pub(super) struct Whole {
    pub chain: Chain,
    pub outcome: ChainOutcome,
}

impl Solution {
    /// The solution of a model with phases.
    pub(super) fn of_phases(model: Model, found: FoundChain) -> Self {
        let FoundChain { chain, outcome, step_errors, starts, divided, .. } = found;
        let own = model.phases().into_iter().zip(&chain.phases).zip(&outcome.phases);
        let parts = own.map(|((model, problem), outcome)| {
            Solution::new(model, super::found::Found::new(problem.clone(), outcome.clone()))
        });
        let mut parts: Vec<Solution> = parts.collect();
        for (at, part) in parts.iter_mut().enumerate() {
            let controls = 0..part.problem.controls.len();
            part.linked = controls.map(|it| model.meaning().links_read(at, it)).collect();
        }
        let problem = frame(&chain);
        let outcome_of_all = of_all(&outcome, problem.parameters.len());
        let whole = super::found::Found::new(problem, outcome_of_all);
        let mut solution = Solution::new(model, whole);
        (solution.step_errors, solution.starts) = (step_errors, starts);
        (solution.parts, solution.whole) = (parts, Some(Whole { chain, outcome }));
        divided.into_iter().for_each(|it| solution.take_pieces(*it));
        solution
    }

    /// What its phases are divided into at their jumps.
    fn take_pieces(&mut self, divided: Divided) {
        let Divided { whole, pieces, sequences, is_cut, .. } = divided;
        let phases = self.model().meaning().phases.clone();
        for ((part, it), phase) in self.parts.iter_mut().zip(pieces).zip(&phases) {
            let named = it.events.into_iter().zip(it.happened);
            part.jumps = jumps_of(&phase.model, &part.problem, named);
            part.between_jumps = Some(it.phases);
        }
        (self.sequences, self.sequences_left_out) = (sequences, is_cut);
        self.between_jumps = Some(whole);
    }

    /// The solution of each phase, in the order of time; none where the model has no phases.
    pub fn phases(&self) -> &[Solution] {
        &self.parts
    }

    /// What a replay and another solve need of a phase: its times may depend on the unknowns of
    /// others.
    pub(super) fn record_of<'s>(&'s self, part: &'s Solution) -> Record<'s> {
        Record { free: self.unknowns().collect(), ..part.record() }
    }

    /// Replays each phase on the true system, from the state at which it begins in the solution,
    /// and the links between the ends of the replays.
    ///
    /// # Errors
    ///
    /// As for [`verify`](Solution::verify).
    pub fn verify_phases(&self) -> Result<(Vec<Verification>, Vec<LinkGap>), Error> {
        let Some(Whole { chain, .. }) = &self.whole else { return Ok((Vec::new(), Vec::new())) };
        verify_phases(self.model().meaning(), chain, &self.record())
    }

    /// The replays of all phases, or of the one piece that it is.
    pub(super) fn replays(&self) -> Result<Vec<Verification>, Error> {
        match self.whole {
            Some(_) => self.verify_phases().map(|it| it.0),
            None => self.verify().map(|it| vec![it]),
        }
    }

    /// The objective of replays, as the model writes it; nothing where one did not reach its end.
    pub(super) fn objective_of(&self, replays: &[Verification]) -> Option<f64> {
        let is_whole = !replays.is_empty() && replays.iter().all(|it| it.is_whole);
        let Some(Whole { chain, .. }) = self.whole.as_ref().filter(|_| is_whole) else {
            return replays.first().filter(|_| is_whole)?.simulation.objective;
        };
        let of_phases: f64 = replays.iter().filter_map(|it| it.simulation.objective).sum();
        let of_links = objective_of_links(chain, &self.record(), replays);
        Some(of_phases + self.problem.sense * of_links)
    }
}

/// The jumps among what happens in a phase of the model, with their names.
pub(super) fn jumps_of(
    model: &fdcc_compiler::Model,
    problem: &Problem,
    events: impl IntoIterator<Item = (usize, phases::Jump)>,
) -> Vec<Jump> {
    let named = events.into_iter().filter_map(|(at, it)| Some((model.jumps.get(at)?, it)));
    named.map(|(jump, it)| happened(problem, jump.place.name.clone(), it)).collect()
}

/// What is said of all phases together: no signals.
fn of_all(outcome: &ChainOutcome, parameters: usize) -> Outcome {
    let ends = [outcome.phases.first(), outcome.phases.last()];
    let [first, last] = ends.map(|it| it.map(|it| &it.trajectory));
    let time = first.into_iter().flat_map(|it| it.time.first());
    let time = time.chain(last.into_iter().flat_map(|it| it.time.last()));
    let values = first.map(|it| it.parameters[..parameters].to_vec());
    Outcome {
        solution: outcome.solution.clone(),
        trajectory: Trajectory {
            time: time.copied().collect(),
            parameters: values.unwrap_or_default(),
            ..Trajectory::default()
        },
        sigma: outcome.sigma.clone(),
        modes: Vec::new(),
        convex: outcome.convex,
        limiting: outcome.limiting.clone(),
        is_impossible: outcome.is_impossible,
        attempts: outcome.attempts.clone(),
    }
}
