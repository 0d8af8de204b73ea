//! Which jumps may happen, and in which order.

use super::crossings::{Beginning, beginnings, boxed, height};
use super::hold::{approach, rest};
use super::path::has_both;
use super::turns::turns;
use crate::expressions::graph::Graph;
use crate::expressions::interval::Tape;
use crate::model::numbers::{Numbers, numbers};
use crate::model::{Jump, Model, Symbol};
use fdcc_grammar::Diagnostic;
use fdcc_grammar::ast::Direction;

/// A jump is tried so often where the model does not say how often it may happen, or says a number
/// that is out of reach.
const TRIED: usize = 3;
/// Longer sequences are not tried.
const LONGEST: usize = 8;
/// More are not tried.
pub(super) const MOST: usize = 32;

/// What may happen in a model with jumps.
pub struct Sequences {
    /// Jumps that happen one after the other, as indices into [`Model::jumps`] and behind these
    /// into [`crossings`](super::crossings()); the short ones first.
    pub all: Vec<Vec<usize>>,
    /// Whether the surface of each jump may be crossed against its direction, because the state may
    /// begin beyond it.
    pub may_cross: Vec<bool>,
    /// Whether the model allows others that are left out.
    pub is_cut: bool,
    /// How often each jump may happen, if that is limited.
    limits: Vec<Option<usize>>,
}

impl Sequences {
    /// A sequence without its last jump, and with one more of each.
    pub fn beside(&self, sequence: &[usize]) -> Vec<Vec<usize>> {
        let count = |jump: usize| sequence.iter().filter(|it| **it == jump).count();
        let may_follow = |jump: &usize| self.limits[*jump].is_none_or(|most| count(*jump) < most);
        let longer = (0..self.limits.len()).filter(may_follow);
        let longer = longer.map(|jump| [sequence, &[jump]].concat());
        let shorter = sequence.split_last().map(|(_, rest)| rest.to_vec());
        shorter.into_iter().chain(longer).collect()
    }
}

/// All sequences in which no jump happens more often than it may; or says what cannot be solved
/// yet.
pub fn sequences(model: &Model) -> Result<Sequences, Vec<Diagnostic>> {
    if let Some(found) = model.jump_by_side() {
        return Err(vec![found]);
    }
    let numbers = numbers(model)?;
    let (most, limits, is_cut) = most(model, &numbers);
    let begins = beginnings(model, &numbers);
    let turns: Vec<Option<bool>> =
        model.jumps.iter().map(|jump| turns(model, &numbers, jump)).collect();
    let sides = Sides { jumps: &model.jumps, begins: &begins, turns: &turns, most: &most };
    let may_cross =
        begins.iter().zip(&most).map(|(it, most)| it.may_be_beyond && *most > 0).collect();
    let mut found = Sequences { all: vec![Vec::new()], may_cross, is_cut, limits };
    let mut next = 0;
    while next < found.all.len() {
        let shorter = found.all[next].clone();
        for event in 0..2 * most.len() {
            let is_allowed =
                may_follow(&shorter, event, &most, &begins) && sides.may_follow(&shorter, event);
            match is_allowed && shorter.len() < LONGEST && found.all.len() < MOST {
                true => found.all.push([&shorter[..], &[event]].concat()),
                false => found.is_cut |= is_allowed,
            }
        }
        next += 1;
    }
    Ok(found)
}

/// Whether a jump may happen once more after others, or its surface be crossed the other way before
/// the first one.
fn may_follow(earlier: &[usize], event: usize, most: &[usize], begins: &[Beginning]) -> bool {
    match event.checked_sub(most.len()) {
        Some(jump) => {
            let is_first = !earlier.contains(&jump) && !earlier.contains(&event);
            is_first && begins[jump].may_be_beyond && most[jump] > 0
        }
        None => {
            let is_before = begins[event].may_be_before || earlier.contains(&(event + most.len()));
            is_before && earlier.iter().filter(|it| **it == event).count() < most[event]
        }
    }
}

/// On which side of surfaces with jumps in both directions the state is.
struct Sides<'m> {
    jumps: &'m [Jump],
    begins: &'m [Beginning],
    turns: &'m [Option<bool>],
    most: &'m [usize],
}

impl Sides<'_> {
    /// Whether a jump may happen after others: the state is on the side from which it happens, or
    /// goes there where the jump on the way may happen no more.
    fn may_follow(&self, earlier: &[usize], event: usize) -> bool {
        let Some(jump) = self.jumps.get(event).filter(|it| has_both(self.jumps, it)) else {
            return true;
        };
        let falls = jump.direction == Direction::Falling;
        let is_used_up = |at: usize| {
            let other = &self.jumps[at];
            let is_other = other.surface == jump.surface && other.direction != jump.direction;
            !is_other || earlier.iter().filter(|it| **it == at).count() >= self.most[at]
        };
        let is_there = self.is_above(earlier, event).is_none_or(|is_above| is_above == falls);
        is_there || (0..self.jumps.len()).all(is_used_up)
    }

    /// Whether the function of the surface of a jump is above 0, where that is known: jumps on
    /// other surfaces may move the state.
    fn is_above(&self, earlier: &[usize], event: usize) -> Option<bool> {
        let Some(last) = earlier.last() else { return self.begins[event].is_above };
        let before = self.jumps.get(*last)?;
        let falls = before.direction == Direction::Falling;
        let is_there = before.surface == self.jumps[event].surface;
        self.turns[*last].filter(|_| is_there).map(|turns| falls == turns)
    }
}

/// How often each jump may happen, if that is limited.
pub(super) fn limits(model: &Model, numbers: &Numbers) -> Vec<Option<usize>> {
    let limit = |jump: &Jump| Some(numbers.value(model, jump.at_most?).max(0.0) as usize);
    model.jumps.iter().map(limit).collect()
}

/// How often each jump is tried, how often it may happen, and whether the one leaves out anything
/// of the other.
fn most(model: &Model, numbers: &Numbers) -> (Vec<usize>, Vec<Option<usize>>, bool) {
    let mut graph = model.graph.clone();
    let known = model.jumps.iter().map(|jump| crossed(model, numbers, &mut graph, jump));
    let known: Vec<Option<usize>> = known.collect();
    let mut tried = |(limit, jump): (Option<usize>, &Jump)| match limit {
        Some(limit) if jump.then_hold.is_some() && rest(model, &mut graph, jump).is_none() => {
            limit.saturating_sub(1).min(TRIED)
        }
        Some(limit) if limit > LONGEST => TRIED,
        Some(limit) => limit,
        None => TRIED,
    };
    let least = |(limit, known): (Option<usize>, Option<usize>)| match (limit, known) {
        (Some(limit), Some(known)) => Some(limit.min(known)),
        (limit, known) => limit.or(known),
    };
    let limits: Vec<Option<usize>> =
        limits(model, numbers).into_iter().zip(known).map(least).collect();
    let most: Vec<usize> = limits.iter().copied().zip(&model.jumps).map(&mut tried).collect();
    let is_cut = limits.iter().zip(&most).any(|(limit, most)| *limit != Some(*most));
    (most, limits, is_cut)
}

/// How often the state can come to the surface of a jump from the side on which it happens, where
/// that is plain: the function of the surface, such as `t - 8`, rises or falls at all times, and no
/// jump resets what it depends on.
fn crossed(model: &Model, numbers: &Numbers, graph: &mut Graph, jump: &Jump) -> Option<usize> {
    let psi = model.surfaces[jump.surface].psi;
    let is_reset = |at: usize| model.jumps.iter().flat_map(|it| &it.resets).any(|it| it.0 == at);
    let read = graph.inputs_of(&[psi]).into_iter().map(|at| model.symbols[at as usize]);
    if read.into_iter().any(|it| matches!(it, Symbol::State(at) if is_reset(at))) {
        return None;
    }
    let approach = approach(model, graph, psi);
    let rate = Tape::new(graph, &[approach]).evaluate(&boxed(model, numbers, |it| it.range))[0];
    let rate = height(jump.direction, rate);
    match () {
        () if rate.is_negative() => Some(1),
        () if rate.is_positive() => Some(0),
        () => None,
    }
}
