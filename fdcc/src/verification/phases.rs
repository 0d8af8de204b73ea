//! A solution of a model with phases: each phase is replayed from the state at which it begins in
//! the solution, and the links are looked at between the ends of the replays.

use super::conditions::parameters;
use super::links::{Ends, gaps_of_links, objectives};
use super::{Gap, LinkGap, Verification, verify};
use crate::error::Error;
use crate::record::{Record, find};
use fdcc_compiler::{Model, Phase};
use fdcc_runtime::problem::{Chain, Problem};

impl crate::model::Model {
    /// What a replay of a recorded solution of a model with phases does on the true system: that of
    /// each phase, from the state at which it begins in the record, and how far the links are
    /// violated by the ends of the replays.
    ///
    /// # Errors
    ///
    /// A record that does not belong to this model; a phase that cannot be simulated.
    pub fn verify_phases(
        &self,
        record: &Record,
    ) -> Result<(Vec<Verification>, Vec<LinkGap>), Error> {
        verify_phases(self.meaning(), &self.chain()?, record)
    }
}

/// Replays a solution of a chain that was compiled from the model.
pub(crate) fn verify_phases(
    model: &Model,
    chain: &Chain,
    record: &Record,
) -> Result<(Vec<Verification>, Vec<LinkGap>), Error> {
    let parts = chain
        .phases
        .iter()
        .enumerate()
        .map(|it| part(it, record))
        .collect::<Result<Vec<_>, _>>()?;
    let own = || chain.phases.iter().zip(&parts);
    let replayed = |(phase, (problem, part)): (&Phase, (&Problem, &&Record))| {
        verify(&phase.model, problem, part)
    };
    let replayed = model.phases.iter().zip(own()).map(replayed);
    let mut all: Vec<Verification> = replayed.collect::<Result<_, _>>()?;
    all.iter_mut().flat_map(|it| &mut it.gaps).for_each(|gap| compare_with_whole(gap, &parts));
    let values = parameters(&chain.phases[0], parts[0]);
    let ends = own().zip(&all).map(|((problem, part), replay)| Ends::new(problem, part, replay));
    let gaps = gaps_of_links(chain, &values, &ends.collect::<Vec<_>>());
    Ok((all, gaps))
}

/// What a record says of a phase, by its place if it has that name, else by its name.
fn part<'r, 's>(
    (at, problem): (usize, &Problem),
    record: &'r Record<'s>,
) -> Result<&'r Record<'s>, Error> {
    let is_its = |it: &&Record| *it.model == *problem.name;
    let found = record.phases.get(at).filter(is_its);
    let found = found.or_else(|| record.phases.iter().find(is_its));
    found.ok_or_else(|| Error::Record(format!("it has no phase `{}`", problem.name)))
}

/// A state that rests in one phase may move in another: its gap counts for all its motion.
fn compare_with_whole(gap: &mut Gap, parts: &[&Record]) {
    let columns = parts.iter().filter_map(|part| find(&part.states, &gap.name));
    let (least, most) = columns
        .flatten()
        .fold((f64::INFINITY, f64::NEG_INFINITY), |it, x| (it.0.min(*x), it.1.max(*x)));
    if most > least {
        gap.part = gap.part.min(gap.difference / (most - least));
    }
}

/// What links add to the objective of the minimisation problem at the ends of the replays of a
/// record.
pub(crate) fn objective_of_links(chain: &Chain, record: &Record, replays: &[Verification]) -> f64 {
    let own = chain.phases.iter().zip(&record.phases).zip(replays);
    let ends: Vec<Ends> =
        own.map(|((problem, it), replay)| Ends::new(problem, it, replay)).collect();
    let values = record.phases.first().map(|it| parameters(&chain.phases[0], it));
    objectives(chain, &values.unwrap_or_default(), &ends)
}
