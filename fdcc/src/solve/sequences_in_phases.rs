//! A model with jumps in its phases: each combination of sequences, one of each phase, is a problem
//! of its own, and the best answer is taken.

use super::alternatives::{self, Alternative, Solves, best_and_next};
use super::found::{Divided, FoundChain};
use super::joined_phases::joined;
use super::multistart::{all_attempts, first_stopped, unless_stopped};
use super::report::{Ended, Options, Part, Report};
use super::sequence_of_guess::{self, Guessed};
use super::start_beside;
use super::tuning::sequences::{CLIMB, MOST_CLIMBS, NEXT, STEPS};
use crate::error::Error;
use crate::model::Model;
use crate::record::Record;
use crate::simulation_of_phases::SimulationOfPhases;
use crate::warm_start;
use fdcc_compiler::{
    Alike, Combination, Sequences, beside, combinations, compile_chain_like, crossings, sequences,
    with_beginnings, with_jumps_in_phases,
};
use fdcc_runtime::nlp::Start;
use fdcc_runtime::problem::{Chain, Problem};
use fdcc_runtime::simulate::Options as Accuracy;

/// Solves for every combination of sequences; `chain` is what holds between the jumps. An earlier
/// solution is the start of the combination that it has.
pub(super) fn solve(
    model: &Model,
    chain: &Chain,
    earlier: Option<&Record>,
    options: &Options,
) -> Result<FoundChain, Error> {
    let motion = simulated(model);
    let begun: Vec<&fdcc_compiler::Model> =
        motion.iter().flat_map(|it| &it.models).map(Model::meaning).collect();
    let written = with_beginnings(model.meaning(), &begun).map_err(Error::Model)?;
    let phases = || written.phases.iter().map(|it| &it.model);
    let possible: Vec<Sequences> =
        phases().map(sequences).collect::<Result<_, _>>().map_err(Error::Model)?;
    let is_fit = phases().any(|it| !it.sums.is_empty());
    let between = chain.phases.iter().map(|it| of_whole(chain, it)).collect();
    let mut tried = Tried {
        subject: Subject { model, written, chain, between, possible, earlier, options },
        alike: Alike::default(),
        all: Vec::new(),
        found: Vec::new(),
        twice: Vec::new(),
    };
    // Of measured data what happens near the guess is meant, as what is estimated is.
    let is_fit = is_fit && !tried.subject.is_driven();
    let guessed = motion.and_then(|it| tried.subject.happened(it));
    let is_cut = tried.all(guessed.as_deref(), is_fit)?;
    Ok(tried.answer(is_cut))
}

/// What the true system does in all phases with everything as a model guesses it.
fn simulated(model: &Model) -> Option<SimulationOfPhases> {
    let accuracy = Accuracy { max_steps: STEPS, ..Accuracy::default() };
    model.simulate_phases(None, &accuracy).ok()
}

/// A phase with the unknowns of all.
pub(super) fn of_whole(chain: &Chain, phase: &Problem) -> Problem {
    Problem { unknowns: chain.unknowns.clone(), ..phase.clone() }
}

/// What is solved.
struct Subject<'s> {
    model: &'s Model,
    /// The same, whose phases know where they may begin.
    written: fdcc_compiler::Model,
    /// What holds between the jumps.
    chain: &'s Chain,
    /// Its phases, with the unknowns of all.
    between: Vec<Problem>,
    /// What may happen in each phase.
    possible: Vec<Sequences>,
    earlier: Option<&'s Record<'s>>,
    options: &'s Options<'s>,
}

impl Subject<'_> {
    fn is_driven(&self) -> bool {
        self.chain.phases.iter().any(|it| !it.controls.is_empty())
    }

    fn has_objective(&self) -> bool {
        self.chain.phases[0].has_objective
    }

    /// What happens in all phases of a motion; nothing where one does not reach its end.
    fn happened(&self, motion: SimulationOfPhases) -> Option<Vec<Guessed>> {
        let all = motion.all.into_iter().zip(&self.possible);
        let all = all.map(|(it, own)| Guessed::of_motion(it.system, it.result, own));
        let all: Vec<Guessed> = all.collect::<Option<_>>()?;
        (all.len() == self.possible.len()).then_some(all)
    }

    /// The same with the unknowns of an answer.
    fn motion_with(&self, found: &FoundChain) -> Option<Vec<Guessed>> {
        let values = &found.outcome.phases[0].trajectory.parameters;
        let names = &self.chain.phases[0].parameters;
        let mut meaning = self.model.meaning().clone();
        for it in &self.chain.unknowns {
            meaning.set_free(&names[it.parameter].name, values[it.parameter]);
        }
        self.happened(simulated(&self.model.with_meaning(meaning))?)
    }

    /// The answer of each.
    fn each(&self, all: &[Alternative], from: &From) -> Result<Vec<FoundChain>, Error> {
        let starts = |it: &Alternative| {
            let motion = from.motion.and_then(|own| self.start(own, it));
            let beside = from.beside.filter(|_| motion.is_none());
            let beside = beside.and_then(|own| start_beside::start(own, it, &self.between[0]));
            [self.earlier_start(it).or(beside), motion]
        };
        let (is_driven, has_objective) = (self.is_driven(), self.has_objective());
        let best = from.beside.map_or(f64::INFINITY, |it| it.1.outcome.solution.objective);
        let solves =
            Solves { starts: &starts, is_driven, has_objective, best, options: self.options };
        alternatives::each(all, &solves)
    }

    /// How many phases of a chain each phase of the model is.
    fn counts(events: &Combination) -> impl Iterator<Item = usize> {
        events.iter().map(|it| it.len() + 1)
    }

    /// The motion on the grids of a chain, if it is near.
    fn start(&self, motion: &[Guessed], of: &Alternative) -> Option<Start> {
        let is_driven = self.is_driven();
        let mut pairs = motion.iter().zip(&of.events);
        if !pairs.all(|(it, events)| it.is_near(events, is_driven)) {
            return None;
        }
        let own: Vec<_> = motion.iter().zip(Self::counts(&of.events)).collect();
        Some(sequence_of_guess::start(&own, &self.between[0], &of.chain))
    }

    /// The earlier solution, if it has these jumps and crosses nothing.
    fn earlier_start(&self, of: &Alternative) -> Option<Start> {
        let record = self.earlier.filter(|_| of.crosses.is_empty())?;
        let jumps = record
            .phases
            .iter()
            .flat_map(|phase| phase.jumps.iter().map(|it| format!("{}.{}", phase.model, it.jump)));
        if !jumps.eq(of.jumps.iter().flatten().cloned()) {
            return None;
        }
        let between: Vec<_> = self.between.iter().zip(Self::counts(&of.events)).collect();
        warm_start::phases::start_in_phases(record, &between, &of.chain)
    }

    fn alternative(&self, events: Combination, alike: &mut Alike) -> Result<Alternative, Error> {
        let meaning = &self.written;
        let model = with_jumps_in_phases(meaning, &events).map_err(Error::Model)?;
        let chain = compile_chain_like(&model, alike).map_err(Error::Model)?;
        let (mut jumps, mut crosses, mut words) = (Vec::new(), Vec::new(), Vec::new());
        for (phase, sequence) in meaning.phases.iter().zip(&events) {
            let (name, own) = (&phase.place.name, &phase.model.jumps);
            for at in sequence {
                let jump = own.get(*at).map(|it| format!("{name}.{}", it.place.name));
                if let Some(against) = at.checked_sub(own.len()) {
                    let surface = crossings(&phase.model)[against].surface;
                    crosses.push(format!("{name}.{}", phase.model.surfaces[surface].place.name));
                    words.push(format!("crossing of {}", crosses[crosses.len() - 1]));
                }
                words.extend(jump.clone());
                jumps.push(jump);
            }
        }
        let words = if words.is_empty() { "no jump".into() } else { words.join(", ") };
        Ok(Alternative { events, jumps, crosses, words, model, chain })
    }
}

/// Where solves begin.
struct From<'s> {
    /// At the motion of the true system, where that is near.
    motion: Option<&'s [Guessed]>,
    /// Else at the best answer so far, with its jumps.
    beside: Option<(&'s Combination, &'s FoundChain)>,
}

/// The combinations that were tried, each with its answer.
struct Tried<'s> {
    subject: Subject<'s>,
    alike: Alike,
    all: Vec<Alternative>,
    found: Vec<FoundChain>,
    /// Those that were begun at another answer, after all that was tried of them had found nothing.
    twice: Vec<usize>,
}

impl Tried<'_> {
    /// Tries what is to be tried, that of the guess first; whether anything is left out.
    fn all(&mut self, motion: Option<&[Guessed]>, is_fit: bool) -> Result<bool, Error> {
        let of = |it: &[Guessed]| it.iter().map(|it| it.events.clone()).collect();
        let likely: Option<Combination> = motion.map(of);
        let (mut others, are_more) = combinations(&self.subject.possible);
        let guess = From { motion, beside: None };
        let is_cut = are_more || self.subject.possible.iter().any(|it| it.is_cut);
        if let Some(likely) = likely.clone().filter(|_| is_fit || are_more) {
            self.add(vec![likely], &guess)?;
            self.climb()?;
            if self.found.iter().any(FoundChain::is_solved) {
                return Ok(is_cut || self.all.len() < others.len());
            }
        }
        others.retain(|it| Some(it) != likely.as_ref());
        let others: Vec<Combination> = likely.into_iter().chain(others).collect();
        let count = others.len();
        self.add(others, &guess)?;
        self.climb()?;
        Ok(is_cut || self.all.len() < count)
    }

    /// Tries more, as long as there is time; once more what was not solved, where there is another
    /// answer to begin at.
    fn add(&mut self, combinations: Vec<Combination>, from: &From) -> Result<(), Error> {
        let (mut new, mut places): (Vec<Alternative>, Vec<Option<usize>>) = Default::default();
        for events in combinations {
            let is_first = self.all.is_empty() && new.is_empty();
            if !is_first && (self.subject.options.stop)().is_break() {
                break;
            }
            let known = self.all.iter().position(|it| it.events == events);
            let is_new = new.iter().all(|it| it.events != events);
            match known {
                None if is_new => new.push(self.subject.alternative(events, &mut self.alike)?),
                Some(at) if is_new && from.beside.is_some() && self.may_be_found(at) => {
                    self.twice.push(at);
                    new.push(self.all[at].clone());
                }
                _ => continue,
            }
            places.push(known);
        }
        let found = self.subject.each(&new, from)?;
        for ((alternative, found), place) in new.into_iter().zip(found).zip(places) {
            match place {
                Some(at) if found.is_solved() => self.found[at] = found,
                Some(_) => {}
                None => {
                    self.all.push(alternative);
                    self.found.push(found);
                }
            }
        }
        Ok(())
    }

    /// Whether it was not solved, and never begun at an answer.
    fn may_be_found(&self, at: usize) -> bool {
        !self.found[at].is_solved() && !self.twice.contains(&at)
    }

    /// One jump more or less in one of the phases of the best answer, or in the next phase, and
    /// what happens with its unknowns, as long as that is better.
    fn climb(&mut self) -> Result<(), Error> {
        for _ in 0..MOST_CLIMBS {
            let is_any = self.found.iter().any(FoundChain::is_solved);
            if !is_any || !self.subject.has_objective() {
                return Ok(());
            }
            let (best, _) = best_and_next(&self.found);
            let subject = &self.subject;
            let motion = subject.motion_with(&self.found[best]).filter(|_| !subject.is_driven());
            let own = motion.iter().map(|it| it.iter().map(|it| it.events.clone()).collect());
            let near = beside(&subject.written, &subject.possible, &self.all[best].events);
            let new = own.chain(near).collect();
            let (events, answer) = (self.all[best].events.clone(), self.found[best].clone());
            let from = From { motion: motion.as_deref(), beside: Some((&events, &answer)) };
            self.add(new, &from)?;
            let next = &self.found[best_and_next(&self.found).0].outcome.solution;
            let own = answer.outcome.solution.objective;
            if own - next.objective <= CLIMB * own.abs() {
                return Ok(());
            }
        }
        Ok(())
    }

    /// The best one, with what else was tried.
    fn answer(self, is_cut: bool) -> FoundChain {
        let Tried { subject, all, found, .. } = self;
        for (it, found) in all.iter().zip(&found) {
            let part = Part { sequence: Some(&it.words), start: None };
            let ended = Ended::of(&found.chain, &found.outcome);
            (subject.options.report)(&Report::Ended(part, &ended));
        }
        let outcomes = found.iter().map(|it| &it.outcome);
        let (attempts, stopped) = (all_attempts(outcomes.clone()), first_stopped(outcomes));
        let subject = (subject.chain, &subject.between[..], &subject.written);
        let answer = |at: usize, next: Vec<FoundChain>| {
            let tried = all.iter().zip(&found).enumerate();
            let tried = tried.map(|(other, (it, found))| it.tried(found, other == at));
            let (sequences, mut own) = (tried.collect(), found[at].clone());
            own.outcome.attempts.clone_from(&attempts);
            unless_stopped(&mut own.outcome.solution, stopped.clone());
            let mut joined = joined(subject, all[at].clone(), own);
            let divided = joined.divided.take();
            let told = divided.map(|it| Box::new(Divided { sequences, is_cut, next, ..*it }));
            FoundChain { divided: told, ..joined }
        };
        let (best, next) = best_and_next(&found);
        let next = next.into_iter().take(NEXT).map(|at| answer(at, Vec::new())).collect();
        answer(best, next)
    }
}
