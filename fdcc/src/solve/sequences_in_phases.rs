//! A model with jumps in its phases: each combination of sequences, one of each phase, is a problem
//! of its own, and the best answer is taken.

use super::alternatives::{self, Alternative, Solves, best_and_next};
use super::found::{Divided, FoundChain};
use super::joined_phases::joined;
use super::multistart::{all_attempts, first_stopped, unless_stopped};
use super::report::{Ended, Options, Part, Report};
use super::sequence_of_guess::{self, Guessed};
use super::tuning::sequences::{MOST_CLIMBS, NEXT, STEPS};
use crate::error::Error;
use crate::model::Model;
use crate::record::Record;
use crate::warm_start;
use fdcc_compiler::{
    Alike, Combination, Sequences, beside, combinations, compile_chain_like, crossings, sequences,
    with_jumps_in_phases,
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
    let phases = || model.meaning().phases.iter().map(|it| &it.model);
    let possible: Vec<Sequences> =
        phases().map(sequences).collect::<Result<_, _>>().map_err(Error::Model)?;
    let between = chain.phases.iter().map(|it| of_whole(chain, it)).collect();
    let mut tried = Tried {
        subject: Subject { model, chain, between, possible, earlier, options },
        alike: Alike::default(),
        all: Vec::new(),
        found: Vec::new(),
    };
    // Of measured data what happens near the guess is meant, as what is estimated is.
    let is_fit = phases().any(|it| !it.sums.is_empty()) && !tried.subject.is_driven();
    let is_cut = tried.all(is_fit)?;
    Ok(tried.answer(is_cut))
}

/// A phase with the unknowns of all.
pub(super) fn of_whole(chain: &Chain, phase: &Problem) -> Problem {
    Problem { unknowns: chain.unknowns.clone(), ..phase.clone() }
}

/// What is solved.
struct Subject<'s> {
    model: &'s Model,
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

    /// What happens in all phases with everything as a model guesses it; nothing where one does not
    /// reach its end.
    fn motion(&self, model: &Model) -> Option<Vec<Guessed>> {
        let accuracy = Accuracy { max_steps: STEPS, ..Accuracy::default() };
        let simulated = model.simulate_phases(None, &accuracy).ok()?;
        let all = simulated.all.into_iter().zip(&self.possible);
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
        self.motion(&self.model.with_meaning(meaning))
    }

    /// The answer of each.
    fn each(
        &self,
        all: &[Alternative],
        motion: Option<&[Guessed]>,
        best: f64,
    ) -> Result<Vec<FoundChain>, Error> {
        let starts =
            |it: &Alternative| [self.earlier_start(it), motion.and_then(|own| self.start(own, it))];
        let (is_driven, has_objective) = (self.is_driven(), self.has_objective());
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
        let meaning = self.model.meaning();
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

/// The combinations that were tried, each with its answer.
struct Tried<'s> {
    subject: Subject<'s>,
    alike: Alike,
    all: Vec<Alternative>,
    found: Vec<FoundChain>,
}

impl Tried<'_> {
    /// Tries what is to be tried, that of the guess first; whether anything is left out.
    fn all(&mut self, is_fit: bool) -> Result<bool, Error> {
        let guessed = self.subject.motion(self.subject.model);
        let motion = guessed.as_deref();
        let of =
            |it: &[Guessed]| -> Combination { it.iter().map(|it| it.events.clone()).collect() };
        let likely = motion.map(of);
        if let Some(likely) = likely.clone().filter(|_| is_fit) {
            self.add(vec![likely], motion, f64::INFINITY)?;
            self.climb()?;
            if self.found.iter().any(FoundChain::is_solved) {
                return Ok(true);
            }
        }
        let (mut others, is_cut) = combinations(&self.subject.possible);
        others.retain(|it| Some(it) != likely.as_ref());
        let others: Vec<Combination> = likely.into_iter().chain(others).collect();
        let count = others.len();
        self.add(others, motion, f64::INFINITY)?;
        if is_cut || !self.subject.is_driven() {
            self.climb()?;
        }
        Ok(is_cut || self.all.len() < count)
    }

    /// Tries more, as long as there is time.
    fn add(
        &mut self,
        combinations: Vec<Combination>,
        motion: Option<&[Guessed]>,
        best: f64,
    ) -> Result<(), Error> {
        let mut new: Vec<Alternative> = Vec::new();
        for events in combinations {
            let is_first = self.all.is_empty() && new.is_empty();
            if !is_first && (self.subject.options.stop)().is_break() {
                break;
            }
            if self.all.iter().chain(&new).all(|it| it.events != events) {
                new.push(self.subject.alternative(events, &mut self.alike)?);
            }
        }
        self.found.extend(self.subject.each(&new, motion, best)?);
        self.all.extend(new);
        Ok(())
    }

    /// One jump more or less in one of the phases of the best answer, and what happens with its
    /// unknowns, as long as that is better.
    fn climb(&mut self) -> Result<(), Error> {
        for _ in 0..MOST_CLIMBS {
            let is_any = self.found.iter().any(FoundChain::is_solved);
            if !is_any || !self.subject.has_objective() {
                return Ok(());
            }
            let (best, _) = best_and_next(&self.found);
            let motion = self.subject.motion_with(&self.found[best]);
            let motion = motion.filter(|_| !self.subject.is_driven());
            let own = motion.iter().map(|it| it.iter().map(|it| it.events.clone()).collect());
            let near = beside(&self.subject.possible, &self.all[best].events);
            let new = own.chain(near).collect();
            let so_far = self.found[best].outcome.solution.objective;
            self.add(new, motion.as_deref(), so_far)?;
            if best_and_next(&self.found).0 == best {
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
        let subject = (subject.chain, &subject.between[..], subject.model.meaning().links.len());
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
