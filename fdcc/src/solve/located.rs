//! From a smoothed answer to the optimum of the true system, where the model asks for that.

use super::Solution;
use super::certify::certificate;
use super::families::is_same;
use super::found::Found;
use super::kink_gaps::is_tight;
use super::report::Options;
use super::sequences::happened;
use super::simulated_start::of_guess;
use super::true_optimum::{
    Certificate, Contacts, First, Located, Spent, Whole, locate, locate_again, on_half_intervals,
    polished, replayed,
};
use crate::model::Model;
use fdcc_compiler::{between_jumps, limits};
use fdcc_runtime::nlp::{Counts, Status};
use fdcc_runtime::problem::{Grid, Method, Problem};
use fdcc_runtime::solution::phases;
use std::sync::Arc;

/// An answer that is not certified is replayed so often, to look near what the true system does.
const MOST_REPLAYS: usize = 3;

/// The located optimum if it is certified; else the smoothed answer, with what was checked.
pub(super) fn solution(model: &Model, found: Found, options: &Options) -> Solution {
    let between = between_jumps(model.meaning());
    if !asks_for_truth(model, &between, &found) {
        return Solution::new(model.clone(), found);
    }
    let near = |first: First| {
        let spent = Spent::default();
        Search { model, between: &between, found: &found, options, first, spent }.certified()
    };
    // Without limits there are no contacts.
    let may_differ = !limits(&between).is_empty();
    let certified = near(First::Controls).or_else(|one| match may_differ {
        true => near(First::Contacts).map_err(|other| one.least(other)),
        false => Err(one),
    });
    // A fit follows the motion of its guess, too: what is certified there may fit far better.
    let certified = match of_guess(&found, options) {
        Some(guessed) => better_of(certified, || {
            let spent = Spent::default();
            let (between, found) = (&between, &guessed);
            Search { model, between, found, options, first: First::Controls, spent }.near_motion()
        }),
        None => certified,
    };
    match certified {
        Ok(answer) => answer,
        Err(certificate) => Solution::new(model.clone(), found).missed(certificate, options),
    }
}

/// The certified optimum with the structure of that of an earlier solution, if there is one.
/// `problem` is the smoothed one.
pub(super) fn continued(
    model: &Model,
    earlier: &Solution,
    problem: &Problem,
    options: &Options,
) -> Option<Solution> {
    let located = earlier.located.as_ref()?;
    let (between, jumps) = (between_jumps(model.meaning()), model.meaning().jumps.len());
    if !located.fits(&between, jumps) {
        return None;
    }
    // That an optimum is global was proved of other values.
    let is_divided = !model.meaning().at_times.is_empty() || !model.meaning().phases.is_empty();
    if is_divided || earlier.outcome.solution.global || options.starts > 1 {
        return None;
    }
    let mut found = Found::new(problem.clone(), located.whole(problem).outcome);
    found.outcome.solution.counts = Counts::default();
    found.outcome.solution.global = false;
    if !asks_for_truth(model, &between, &found) {
        return None;
    }
    let (between, found, spent) = (&between, &found, Spent::default());
    let first = First::Controls;
    Search { model, between, found, options, first, spent }.again(located)
}

/// The certified answer, or the better one of two.
fn better_of(
    first: Result<Solution, Certificate>,
    second: impl FnOnce() -> Option<Solution>,
) -> Result<Solution, Certificate> {
    match (first, second()) {
        (Ok(first), Some(second)) => {
            let [own, its] = [&first, &second].map(|it| it.problem.sense * it.objective());
            Ok(if its < own && !is_same(its, own) { second } else { first })
        }
        (Err(_), Some(second)) => Ok(second),
        (first, None) => first,
    }
}

/// What is known before anything is located.
struct Search<'s> {
    model: &'s Model,
    /// What holds between its jumps.
    between: &'s fdcc_compiler::Model,
    /// The smoothed answer.
    found: &'s Found,
    options: &'s Options<'s>,
    first: First,
    spent: Spent,
}

impl Search<'_> {
    /// The first answer that is certified, or the certificate that fails least. It is looked for
    /// near the smoothed answer, then near what the true system does with the controls of what was
    /// found there, then near what it does with those of the smoothed answer.
    fn certified(&mut self) -> Result<Solution, Certificate> {
        let found = self.found;
        let outcome = found.outcome.clone();
        let smoothed = Whole::of_smoothed(self.between, &found.problem, outcome, jumps(found));
        let mut least = self.nothing();
        let mut near = self.attempt(&smoothed);
        // Without modes and jumps a replay says nothing of the structure.
        let most_replays = if is_smooth(self.model, self.between) { 0 } else { MOST_REPLAYS };
        for replays in 0..=most_replays {
            let Some(located) = near.take() else { break };
            let (answer, located) = self.refined(located);
            least = least.least(answer.certificate.clone().unwrap_or_default());
            if least.is_certified() {
                return Ok(self.ended(answer, &located));
            }
            if replays < most_replays {
                near = self.replayed(&answer, &located.whole(&found.problem));
            }
        }
        let answer = Solution::new(self.model.clone(), found.clone());
        let near = if most_replays > 0 { self.replayed(&answer, &smoothed) } else { None };
        if let Some(located) = near {
            let (answer, located) = self.refined(located);
            least = least.least(answer.certificate.clone().unwrap_or_default());
            if least.is_certified() {
                return Ok(self.ended(answer, &located));
            }
        }
        Err(least)
    }

    /// What is certified near the motion of the true system with what was found.
    fn near_motion(&mut self) -> Option<Solution> {
        let found = self.found;
        let outcome = found.outcome.clone();
        let whole = Whole::of_smoothed(self.between, &found.problem, outcome, Vec::new());
        let located = self.replayed(&Solution::new(self.model.clone(), found.clone()), &whole)?;
        let (answer, located) = self.refined(located);
        let is_certified = answer.is_certified();
        is_certified.then(|| self.ended(answer, &located))
    }

    /// What is certified with the structure of another optimum.
    fn again(&mut self, earlier: &Located) -> Option<Solution> {
        let models = [self.model.meaning(), self.between];
        let (problem, stop) = (&self.found.problem, self.options.stop);
        let located = locate_again(models, problem, earlier, stop, &mut self.spent)?;
        let (answer, located) = self.refined(located);
        let is_certified = answer.is_certified();
        is_certified.then(|| self.ended(answer, &located))
    }

    /// The first that is certified: what was located at last, or on the way.
    fn refined(&mut self, mut located: Located) -> (Solution, Located) {
        let others = std::mem::take(&mut located.others);
        let last = self.halved(located);
        if last.0.is_certified() {
            return last;
        }
        let mut others = others.into_iter().map(|it| self.halved(it));
        others.find(|it| it.0.is_certified()).unwrap_or(last)
    }

    /// On shorter and shorter intervals where nothing is wrong but the replay.
    fn halved(&mut self, mut located: Located) -> (Solution, Located) {
        let mut answer = self.answer(&located);
        while let Some(most) = most_halvings(&answer) {
            let models = [self.model.meaning(), self.between];
            let (problem, stop) = (&self.found.problem, self.options.stop);
            let coarse = (&located, most);
            let finer = on_half_intervals(models, problem, coarse, stop, &mut self.spent);
            let Some(finer) = finer else { break };
            located = finer;
            answer = self.answer(&located);
        }
        (answer, located)
    }

    fn answer(&self, located: &Located) -> Solution {
        of(self.model, self.between, self.found, located.clone())
    }

    /// Near what the true system does with the controls of an answer.
    fn replayed(&mut self, answer: &Solution, whole: &Whole) -> Option<Located> {
        let replay = answer.verify().ok()?;
        self.attempt(&replayed(self.between, whole, &replay)?)
    }

    fn attempt(&mut self, near: &Whole) -> Option<Located> {
        let models = [self.model.meaning(), self.between];
        let near = (near, self.first);
        locate(models, &self.found.problem, near, self.options.stop, &mut self.spent)
    }

    /// What is certified meets more than the tolerance of the search.
    fn ended(&mut self, answer: Solution, located: &Located) -> Solution {
        let mut answer = self.polished(located).unwrap_or(answer);
        let (is_global, first) = (self.is_global(), &self.found.outcome.solution);
        let solution = &mut answer.outcome.solution;
        solution.status = Status::Solved;
        solution.global = is_global;
        solution.counts.iterations += first.counts.iterations;
        answer
    }

    /// With more digits, where it is certified with these, too.
    fn polished(&mut self, located: &Located) -> Option<Solution> {
        let models = [self.model.meaning(), self.between];
        let (problem, stop) = (&self.found.problem, self.options.stop);
        let polished = polished(models, problem, located, stop, &mut self.spent)?;
        Some(self.answer(&polished)).filter(Solution::is_certified)
    }

    /// Whether every optimum is global. A smooth problem that is convex on a grid is so in
    /// continuous time where time itself does not matter: what was proved at one node holds
    /// between nodes.
    fn is_global(&self) -> bool {
        let Found { problem, outcome, .. } = self.found;
        is_smooth(self.model, self.between) && outcome.solution.global && problem.is_autonomous
    }

    /// Where no structure could be solved.
    fn nothing(&self) -> Certificate {
        let is_told = self.between.are_sums_terms();
        Certificate::nothing_located(if is_told { "located" } else { "without data" })
    }
}

/// How often intervals may be halved for an answer; nothing where that does not help.
pub(super) fn most_halvings(answer: &Solution) -> Option<u32> {
    let certificate = answer.certificate.as_ref().filter(|it| it.is_inaccurate());
    certificate.map(Certificate::most_halvings)
}

/// The jumps and crossings of a smoothed answer.
fn jumps(found: &Found) -> Vec<(usize, phases::Jump)> {
    let Some(own) = &found.phases else { return Vec::new() };
    let (_, jumps) = phases::joined(&found.problem, &own.chain, &own.outcome);
    found.events.iter().copied().zip(jumps).collect()
}

/// Whether the system that was written is meant, because no width is named of what would be
/// smoothed, or no grid where nothing is, and there is an answer to begin with. `between` is what
/// holds between jumps.
fn asks_for_truth(model: &Model, between: &fdcc_compiler::Model, found: &Found) -> bool {
    let status = &found.outcome.solution.status;
    if !is_tight(&found.problem, &found.outcome.trajectory) {
        return false;
    }
    if is_smooth(model, between) {
        return status.is_solved() && is_in_continuous_time(between);
    }
    let is_meant = between.surfaces.is_empty() || !between.method.names_width();
    is_meant && may_be_near(status, found.outcome.is_impossible)
}

/// Whether an answer of the true system may be near one that is smoothed: also near one that cannot
/// be solved where it is, such as a rest to which friction alone leads.
pub(super) fn may_be_near(status: &Status, is_impossible: bool) -> bool {
    let is_lost =
        matches!(status, Status::IterationLimit | Status::Infeasible | Status::NumericalFailure);
    status.is_solved() || is_lost && !is_impossible
}

/// Whether nothing switches and nothing jumps.
fn is_smooth(model: &Model, between: &fdcc_compiler::Model) -> bool {
    between.surfaces.is_empty() && model.meaning().jumps.is_empty()
}

/// Whether a smooth model has an optimum in continuous time that is looked for.
fn is_in_continuous_time(model: &fdcc_compiler::Model) -> bool {
    !model.method.names_grid && model.objective.is_some() && model.sums.is_empty()
}

fn of(model: &Model, between: &fdcc_compiler::Model, found: &Found, located: Located) -> Solution {
    let smoothed = &found.problem;
    let Whole { mut outcome, jumps, .. } = located.whole(smoothed);
    Contacts::new(between, &located).put_multipliers(&mut outcome.trajectory);
    let finest = located.chain.phases.iter().max_by_key(|phase| phase.method.intervals());
    let method = finest.map_or(&smoothed.method, |phase| &phase.method).clone();
    let method = Method { grid: grid(&outcome.trajectory.time), ..method };
    let problem = Problem { method, ..smoothed.clone() };
    let own = &model.meaning().jumps;
    let named = jumps.into_iter().filter_map(|(at, jump)| Some((own.get(at)?, jump)));
    let named = named.map(|(it, jump)| happened(smoothed, it.place.name.clone(), jump));
    let whole = Found {
        jumps: named.collect(),
        starts: found.starts.clone(),
        sequences: found.sequences.clone(),
        is_cut: found.is_cut,
        ..Found::new(problem, outcome)
    };
    let mut solution = Solution::new(model.clone(), whole);
    let replay = solution.verify().ok();
    let certificate = certificate(&located, between, smoothed, &solution, replay.as_ref());
    solution.certificate = Some(certificate);
    solution.of_holds = located.sensitivities_of_holds(between, smoothed);
    solution.located = solution.is_certified().then(|| Arc::new(located.clone()));
    let located = located.with_gradients(between, smoothed);
    let costates = located.whole(smoothed).outcome.trajectory.costates;
    solution.outcome.trajectory.costates = costates;
    solution.between_jumps = Some(located.in_phases().into());
    solution
}

/// The grids of all phases, one after the other.
pub(super) fn grid(time: &[f64]) -> Grid {
    let [first, last] = [time[0], time[time.len() - 1]];
    Grid::Mesh(time.iter().map(|it| (it - first) / (last - first)).collect())
}
