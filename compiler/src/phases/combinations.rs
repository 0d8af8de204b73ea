//! Which sequences of jumps may happen in all phases of a model together.

use super::crossings::crossings;
use super::sequences::{MOST, Sequences};
use crate::model::Model;
use fdcc_runtime::problem::End;

/// A sequence of each phase.
pub type Combination = Vec<Vec<usize>>;

/// Sequences of each phase in all combinations, those with few jumps first; and whether there are
/// more than are tried.
pub fn combinations(all: &[Sequences]) -> (Vec<Combination>, bool) {
    let most: usize = all.iter().map(longest).sum();
    let mut found = Vec::new();
    for jumps in 0..=most {
        append(all, jumps, &mut Vec::new(), &mut found);
    }
    let are_more = found.len() > MOST;
    found.truncate(MOST);
    (found, are_more)
}

/// Those in which one jump happens in the phase before or behind instead, then those that have one
/// jump more or less in one of the phases; of very many the first.
pub fn beside(model: &Model, all: &[Sequences], combination: &Combination) -> Vec<Combination> {
    let mut found: Vec<Combination> = Vec::new();
    let mut add = |other: Combination| {
        if found.len() < MOST && !found.contains(&other) {
            found.push(other);
        }
    };
    moved(model, combination).into_iter().for_each(&mut add);
    for (phase, (own, sequence)) in all.iter().zip(combination).enumerate() {
        let listed = own.all.iter().filter(|it| is_beside(it, sequence)).cloned();
        for other in listed.chain(own.beside(sequence)) {
            let mut changed = combination.clone();
            changed[phase] = other;
            add(changed);
        }
    }
    found
}

/// Those in which the last jump of a phase is the first of the next one, or the other way round.
fn moved(model: &Model, combination: &Combination) -> Vec<Combination> {
    let mut found = Vec::new();
    for [before, behind] in followers(model) {
        if let Some((last, rest)) = combination[before].split_last()
            && let Some(same) = same_event(model, [before, behind], *last)
        {
            let mut changed = combination.clone();
            changed[before] = rest.to_vec();
            changed[behind].insert(0, same);
            found.push(changed);
        }
        if let Some((first, rest)) = combination[behind].split_first()
            && let Some(same) = same_event(model, [behind, before], *first)
        {
            let mut changed = combination.clone();
            changed[behind] = rest.to_vec();
            changed[before].push(same);
            found.push(changed);
        }
    }
    found
}

/// Which phase begins where another one ends.
fn followers(model: &Model) -> Vec<[usize; 2]> {
    let mut found = Vec::new();
    for link in &model.links {
        let lasts = link.ends.iter().filter(|it| matches!(it, End::Last(_)));
        for before in lasts.map(|it| it.phase()) {
            let firsts = link.ends.iter().filter(|it| matches!(it, End::First(_)));
            found.extend(firsts.map(|it| [before, it.phase()]).filter(|it| it[0] != it[1]));
        }
    }
    found
}

/// The jump or crossing of another phase that has the name of one.
fn same_event(model: &Model, [of, wanted]: [usize; 2], event: usize) -> Option<usize> {
    let events = |phase: usize| {
        let own = &model.phases[phase].model;
        [own.jumps.clone(), crossings(own)].concat()
    };
    let name = events(of)[event].place.name.clone();
    events(wanted).iter().position(|it| it.place.name == name)
}

fn longest(of: &Sequences) -> usize {
    of.all.iter().map(Vec::len).max().unwrap_or(0)
}

/// All ways to have so many jumps in the phases behind some, up to one more than are tried.
fn append(
    rest: &[Sequences],
    jumps: usize,
    chosen: &mut Combination,
    found: &mut Vec<Combination>,
) {
    let Some((first, behind)) = rest.split_first() else {
        if jumps == 0 {
            found.push(chosen.clone());
        }
        return;
    };
    let possible: usize = rest.iter().map(longest).sum();
    if jumps > possible {
        return;
    }
    for sequence in first.all.iter().filter(|it| it.len() <= jumps) {
        if found.len() > MOST {
            return;
        }
        chosen.push(sequence.clone());
        append(behind, jumps - sequence.len(), chosen, found);
        chosen.pop();
    }
}

/// Whether one of two sequences is the other with one more event somewhere.
fn is_beside(a: &[usize], b: &[usize]) -> bool {
    let (short, long) = if a.len() < b.len() { (a, b) } else { (b, a) };
    long.len() == short.len() + 1
        && (0..long.len()).any(|at| long[..at] == short[..at] && long[at + 1..] == short[at..])
}
