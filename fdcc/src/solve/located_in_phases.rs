//! From the smoothed answer to a model with phases to the optimum of the true system, where the
//! model asks for that.

use super::Solution;
use super::certify::{accuracy, certificate, size_of_objective};
use super::found::{FoundChain, Phases, Pieces};
use super::kink_gaps::is_tight;
use super::located::{grid, may_be_near, most_halvings};
use super::phases::jumps_of;
use super::report::Options;
use super::true_optimum::{
    Certificate, Check, Contacts, First, Located, Part, Spent, Whole, halved_in_phases,
    locate_in_phases, polished_in_phases,
};
use crate::model::Model;
use crate::verification::{LinkGap, Verification};
use fdcc_compiler::between_jumps;
use fdcc_runtime::nlp::Status;
use fdcc_runtime::problem::{Method, Problem};
use fdcc_runtime::solution::phases;
use fdcc_runtime::solve::{ChainOutcome, Outcome};
use std::borrow::Cow;

/// The located optimum if it is certified; else the smoothed answer, with what was checked.
pub(super) fn solution(model: &Model, found: FoundChain, options: &Options) -> Solution {
    if !asks_for_truth(model, &found) {
        return Solution::of_phases(model.clone(), found);
    }
    let unknowns = &found.chain.unknowns;
    let problems = found.chain.phases.iter();
    let problems: Vec<Problem> =
        problems.map(|it| Problem { unknowns: unknowns.clone(), ..it.clone() }).collect();
    let meaning = found.divided.as_ref().map_or(model.meaning(), |it| &it.written);
    let written = || meaning.phases.iter().map(|it| &it.model);
    let between: Vec<Cow<fdcc_compiler::Model>> = written().map(between_jumps).collect();
    let own = written().zip(&between).zip(&problems);
    let parts = own.map(|((written, model), problem)| Part { written, model, problem });
    let parts: Vec<Part> = parts.collect();
    let search = Search { model, whole: meaning, found: &found, parts: &parts, options };
    match search.certified() {
        Ok(answer) => answer,
        Err(certificate) => Solution::of_phases(model.clone(), found).missed(certificate, options),
    }
}

/// What is known before anything is located.
struct Search<'s> {
    model: &'s Model,
    /// What it means.
    whole: &'s fdcc_compiler::Model,
    found: &'s FoundChain,
    parts: &'s [Part<'s>],
    options: &'s Options<'s>,
}

impl Search<'_> {
    /// The answer that is certified, or the certificate that fails least.
    fn certified(&self) -> Result<Solution, Certificate> {
        self.certified_from(First::Controls)
            .or_else(|one| self.certified_from(First::Contacts).map_err(|other| one.least(other)))
    }

    /// The jumps and crossings of a phase of the smoothed answer.
    fn jumps(&self, phase: usize) -> Vec<(usize, phases::Jump)> {
        let Some(divided) = &self.found.divided else { return Vec::new() };
        let Pieces { events, happened, .. } = &divided.pieces[phase];
        events.iter().copied().zip(happened.iter().cloned()).collect()
    }

    fn certified_from(&self, first: First) -> Result<Solution, Certificate> {
        let (whole, stop) = (self.whole, self.options.stop);
        let mut spent = Spent::default();
        let of = |(at, (part, outcome)): (usize, (&Part, &Outcome))| {
            Whole::of_smoothed(part.model, part.problem, outcome.clone(), self.jumps(at))
        };
        let smoothed = self.parts.iter().zip(&self.found.outcome.phases).enumerate();
        let smoothed: Vec<Whole> = smoothed.map(of).collect();
        let from = (&smoothed[..], first);
        let located = locate_in_phases(whole, self.parts, from, stop, &mut spent);
        let Some(mut located) = located else { return Err(self.nothing()) };
        let mut answer = self.answer(&located);
        while let Some(most) = most_halvings(&answer) {
            let coarse = (located.clone(), most);
            let finer = halved_in_phases(whole, self.parts, coarse, stop, &mut spent);
            let Some(finer) = finer else { break };
            answer = self.answer(&finer);
            located = finer;
        }
        match answer.certificate.take_if(|it| !it.is_certified()) {
            Some(missing) => Err(missing),
            None => {
                let polished = polished_in_phases(whole, self.parts, located, stop, &mut spent);
                let sharper = polished.map(|it| self.answer(&it)).filter(Solution::is_certified);
                Ok(self.ended(sharper.unwrap_or(answer)))
            }
        }
    }

    /// What is certified meets more than the tolerance of the search.
    fn ended(&self, mut answer: Solution) -> Solution {
        let (is_global, first) = (self.is_global(), &self.found.outcome.solution);
        let solution = &mut answer.outcome.solution;
        solution.status = Status::Solved;
        solution.global = is_global;
        solution.counts.iterations += first.counts.iterations;
        answer
    }

    /// Whether every optimum is global: as for a model of one piece.
    fn is_global(&self) -> bool {
        let is_smooth = |it: &Part| {
            let is_one = it.model.surfaces.is_empty() && it.written.jumps.is_empty();
            is_one && it.problem.is_autonomous
        };
        self.found.outcome.solution.global && self.parts.iter().all(is_smooth)
    }

    /// Where no structure could be solved.
    fn nothing(&self) -> Certificate {
        Certificate::nothing_located("located")
    }

    /// All phases in the words of the model, with what is checked of them.
    fn answer(&self, located: &[Located]) -> Solution {
        let joint = &located[0].joint;
        let pairs = || self.parts.iter().zip(located);
        let of_pairs = pairs().map(|(part, it)| outcome(part, it));
        let (phases, jumps): (Vec<Outcome>, Vec<_>) = of_pairs.unzip();
        let problems = pairs().zip(&phases).map(|((part, it), own)| problem(part, it, own));
        let mut chain = self.found.chain.clone();
        chain.phases = problems.collect();
        let outcome = ChainOutcome { phases, sigma: Vec::new(), ..joint.outcome.clone() };
        let starts = self.found.starts.clone();
        let (step_errors, others, divided) = (None, Vec::new(), None);
        let found = FoundChain { chain, outcome, step_errors, starts, others, divided };
        let mut solution = Solution::of_phases(self.model.clone(), found);
        for ((part, it), jumps) in self.parts.iter().zip(&mut solution.parts).zip(jumps) {
            it.jumps = jumps_of(part.written, &it.problem, jumps);
        }
        if let Some(divided) = &self.found.divided {
            solution.sequences.clone_from(&divided.sequences);
            solution.sequences_left_out = divided.is_cut;
        }
        solution.certificate = Some(self.certificate(located, &solution));
        let mut first = 0;
        for ((part, own), it) in pairs().zip(&mut solution.parts) {
            let gradients = own.with_gradients(part.model, part.problem);
            it.outcome.trajectory.costates =
                gradients.whole(part.problem).outcome.trajectory.costates;
            it.between_jumps = Some(gradients.in_phase(first).into());
            first += own.structure.phases.len();
        }
        solution.of_holds = self.sensitivities_of_holds(located);
        let (model, chain) = (joint.model.clone(), joint.chain.clone());
        let outcome = joint.outcome.clone();
        solution.between_jumps = Some(Phases { model, chain, outcome });
        solution
    }

    fn sensitivities_of_holds(&self, located: &[Located]) -> Vec<f64> {
        let mut sum = vec![0.0; self.model.meaning().params.len()];
        for (part, it) in self.parts.iter().zip(located) {
            let own = it.sensitivities_of_holds(part.model, part.problem);
            sum.iter_mut().zip(own).for_each(|(sum, more)| *sum += more);
        }
        sum
    }

    /// Each figure is the worst of all phases; beside these the objective and the links, which are
    /// of all phases.
    fn certificate(&self, located: &[Located], solution: &Solution) -> Certificate {
        let replays = solution.verify_phases().ok();
        let of = |(at, (part, it)): (usize, (&Part, &Located))| {
            let replay = replays.as_ref().map(|it| &it.0[at]);
            let own = certificate(it, part.model, part.problem, &solution.parts[at], replay);
            own.of_phase(&self.model.meaning().phases[at].place.name)
        };
        let all = self.parts.iter().zip(located).enumerate().map(of);
        let mut all = all.reduce(Certificate::with).unwrap_or_default();
        let limit = accuracy(self.parts[0].problem);
        let links = replays.as_ref().map_or(f64::INFINITY, |it| largest(&it.1));
        all.put(Check { name: "links", figure: links, limit });
        let objective = |it: &Vec<Verification>| gap_of_objective(located, solution, it);
        let objective = replays.as_ref().map_or(f64::INFINITY, |it| objective(&it.0));
        all.put(Check { name: "objective", figure: objective, limit });
        all
    }
}

fn largest(gaps: &[LinkGap]) -> f64 {
    gaps.iter().map(|it| it.part.abs()).fold(0.0, f64::max)
}

/// The difference between the objective of the replays and that of the plan, for its size.
fn gap_of_objective(located: &[Located], solution: &Solution, replays: &[Verification]) -> f64 {
    if !solution.problem.has_objective {
        return 0.0;
    }
    let own = solution.objective();
    let phases = solution.model().meaning().phases.iter();
    let sizes = located.iter().zip(phases).map(|(it, of)| size_of_objective(it, &of.model));
    let size = own.abs().max(sizes.fold(0.0, f64::max));
    solution.objective_of(replays).map_or(f64::INFINITY, |it| (it - own).abs() / size)
}

/// A phase as one trajectory, and what happens in it.
fn outcome(part: &Part, located: &Located) -> (Outcome, Vec<(usize, phases::Jump)>) {
    let Whole { mut outcome, jumps, .. } = located.whole(part.problem);
    Contacts::new(part.model, located).put_multipliers(&mut outcome.trajectory);
    (outcome, jumps)
}

/// A phase on the grid of its answer.
fn problem(part: &Part, located: &Located, outcome: &Outcome) -> Problem {
    let finest = located.chain.phases.iter().max_by_key(|it| it.method.intervals());
    let method = finest.map_or(&part.problem.method, |it| &it.method).clone();
    let method = Method { grid: grid(&outcome.trajectory.time), ..method };
    Problem { method, ..part.problem.clone() }
}

/// Whether the system that was written is meant: where something switches, because no width is
/// named; else because no phase says on how many intervals.
fn asks_for_truth(model: &Model, found: &FoundChain) -> bool {
    let phases = || model.meaning().phases.iter().map(|it| &it.model);
    let mut pieces = found.chain.phases.iter().zip(&found.outcome.phases);
    let are_tight = pieces.all(|(problem, it)| is_tight(problem, &it.trajectory));
    if !are_tight || phases().any(|it| !it.are_sums_terms()) {
        return false;
    }
    let is_switched = |it: &fdcc_compiler::Model| !between_jumps(it).surfaces.is_empty();
    let outcome = &found.outcome;
    match phases().any(|it| !it.jumps.is_empty() || is_switched(it)) {
        true => {
            may_be_near(&outcome.solution.status, outcome.is_impossible)
                && phases().all(|it| !is_switched(it) || !it.method.names_width())
        }
        false => {
            let has_objective = found.chain.phases[0].has_objective;
            let is_meant = |it: &fdcc_compiler::Model| it.sums.is_empty() && !it.method.names_grid;
            found.is_solved() && has_objective && phases().all(is_meant)
        }
    }
}
