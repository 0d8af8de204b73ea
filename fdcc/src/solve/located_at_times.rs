//! From the answer on a grid to a smooth model with conditions at times, to the optimum in
//! continuous time: that of the phases into which these times divide it, as one trajectory.

use super::found::{Found, FoundChain, Phases};
use super::located::grid;
use super::report::Options;
use super::{Solution, located_in_phases};
use crate::model::Model;
use fdcc_runtime::problem::{Method, Problem};
use fdcc_runtime::solution::phases::joined;

/// The located optimum if it is certified; else the answer on the grid, with what was checked.
pub(super) fn solution(model: &Model, found: Found, options: &Options) -> Solution {
    let is_meant = !model.meaning().method.names_grid && model.meaning().sums.is_empty();
    let Some(phases) = found.phases.clone().filter(|_| is_meant) else {
        return Solution::new(model.clone(), found);
    };
    let Phases { model: divided, chain, outcome } = phases;
    let names = divided.phases.iter().map(|it| it.place.name.clone());
    let names: Vec<String> = names.collect();
    let starts = found.starts.clone();
    let (step_errors, others) = (None, Vec::new());
    let in_phases = FoundChain { chain, outcome, step_errors, starts, others, divided: None };
    let mut answer = located_in_phases::solution(&model.with_meaning(divided), in_phases, options);
    let Some(certificate) = answer.certificate.take().map(|it| it.of_whole(&names)) else {
        return Solution::new(model.clone(), found);
    };
    if !certificate.is_certified() {
        return Solution::new(model.clone(), found).missed(certificate, options);
    }
    let mut solution = Solution::new(model.clone(), whole(found, answer));
    solution.certificate = Some(certificate);
    solution
}

/// All phases one after the other.
fn whole(found: Found, answer: Solution) -> Found {
    let Some(Phases { model, chain, mut outcome }) = answer.between_jumps else { return found };
    let added = model.phases.first().map_or(0, |it| it.model.boundary.len());
    // The multipliers of conditions that nobody wrote are told to nobody.
    outcome.phases[0].trajectory.end_multipliers.drain(..added);
    outcome.solution = answer.outcome.solution;
    let (joined, _) = joined(&found.problem, &chain, &outcome);
    let finest = chain.phases.iter().max_by_key(|it| it.method.intervals());
    let method = finest.map_or(&found.problem.method, |it| &it.method).clone();
    let method = Method { grid: grid(&joined.trajectory.time), ..method };
    let problem = Problem { method, ..found.problem };
    let phases = Some(Phases { model, chain, outcome });
    Found { starts: found.starts, phases, ..Found::new(problem, joined) }
}
