//! Which sequences of jumps may happen in all phases of a model together.

use super::sequences::{MOST, Sequences};

/// A sequence of each phase.
pub type Combination = Vec<Vec<usize>>;

/// Sequences of each phase in all combinations, those with few jumps first; and whether some are
/// left out.
pub fn combinations(all: &[Sequences]) -> (Vec<Combination>, bool) {
    let most: usize = all.iter().map(|it| longest(it)).sum();
    let mut found = Vec::new();
    for jumps in 0..=most {
        append(all, jumps, &mut Vec::new(), &mut found);
    }
    let is_cut = found.len() > MOST || all.iter().any(|it| it.is_cut);
    found.truncate(MOST);
    (found, is_cut)
}

/// Those that have one jump more or less than a combination, in one of its phases.
pub fn beside(all: &[Sequences], combination: &Combination) -> Vec<Combination> {
    let mut found: Vec<Combination> = Vec::new();
    for (phase, (own, sequence)) in all.iter().zip(combination).enumerate() {
        let listed = own.all.iter().filter(|it| is_beside(it, sequence)).cloned();
        for other in listed.chain(own.beside(sequence)) {
            let mut changed = combination.clone();
            changed[phase] = other;
            if !found.contains(&changed) {
                found.push(changed);
            }
        }
    }
    found
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
