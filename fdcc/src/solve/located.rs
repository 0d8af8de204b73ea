//! From a smoothed answer to the optimum of the true system, where the model asks for that.

use super::Solution;
use super::certify::certificate;
use super::found::{Found, Phases};
use super::report::Options;
use super::true_optimum::{Certificate, Located, locate};
use crate::model::Model;
use fdcc_runtime::problem::{Grid, Method, Problem};

/// The located optimum if it is certified; else the smoothed answer, with what was checked.
pub(super) fn solution(model: &Model, found: Found, options: &Options) -> Solution {
    let smoothed = found.problem.clone();
    if !asks_for_truth(model, &found) {
        return Solution::new(model.clone(), found);
    }
    let Some(located) = locate(model.meaning(), &smoothed, &found.outcome, options.stop) else {
        let mut answer = Solution::new(model.clone(), found);
        let is_stopped = (options.stop)().is_break();
        answer.certificate = Some(Certificate::nothing_located(is_stopped));
        return answer;
    };
    let counts = [found.outcome.solution.counts, located.outcome.solution.counts];
    let mut answer = of(model, &smoothed, located);
    answer.outcome.solution.counts.iterations = counts[0].iterations + counts[1].iterations;
    answer.starts = found.starts.clone();
    if answer.is_certified() {
        return answer;
    }
    let mut smoothed = Solution::new(model.clone(), found);
    smoothed.certificate = answer.certificate;
    smoothed
}

/// Whether no width is named, so that the system that was written is meant, and there is an
/// optimum to begin with.
fn asks_for_truth(model: &Model, found: &Found) -> bool {
    let meaning = model.meaning();
    let method = &meaning.method;
    let has_switches = !meaning.surfaces.is_empty();
    let is_named = method.sigma.is_some() || !method.continuation.is_empty();
    has_switches
        && !is_named
        && found.problem.has_objective
        && found.outcome.solution.status.is_solved()
}

fn of(model: &Model, between: &Problem, located: Located) -> Solution {
    let outcome = located.whole(between);
    let finest = located.chain.phases.iter().max_by_key(|phase| phase.method.intervals());
    let method = finest.map_or(&between.method, |phase| &phase.method).clone();
    let method = Method { grid: grid(&outcome.trajectory.time), ..method };
    let problem = Problem { method, ..between.clone() };
    let mut solution = Solution::new(model.clone(), Found::new(problem, outcome));
    let replay = solution.verify().ok();
    solution.certificate = Some(certificate(&located, between, &solution, replay.as_ref()));
    let Located { model: phased, chain, outcome, .. } = located;
    solution.between_jumps = Some(Phases { model: phased, chain, outcome });
    solution
}

/// The grids of all phases, one after the other.
fn grid(time: &[f64]) -> Grid {
    let [first, last] = [time[0], time[time.len() - 1]];
    Grid::Mesh(time.iter().map(|it| (it - first) / (last - first)).collect())
}
