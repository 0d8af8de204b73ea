//! Surfaces that the state crosses against the direction of their jump: nothing is reset, but a
//! phase ends there.
//!
//! A ball that is thrown from below the rim rises through it before it can fall on it. On the way
//! up `psi <= 0`, then `psi >= 0` until the jump. A sequence has the number `n + i` where the
//! surface of jump `i`, of `n`, is crossed so. Only before the first jump on a surface this is
//! looked for, and only where the state may begin beyond it.

use crate::expressions::graph::{ExprId, Graph};
use crate::expressions::interval::{Interval, Tape};
use crate::model::guess::straight_guesses;
use crate::model::numbers::Numbers;
use crate::model::{Jump, Model, Place, Range, State, Symbol};
use fdcc_grammar::ast::Direction;

/// Rounding, relative to what is rounded.
const ROUNDING: f64 = 1e-9;

/// The crossing against each jump, as a jump that resets nothing.
pub fn crossings(model: &Model) -> Vec<Jump> {
    let crossing = |jump: &Jump| Jump {
        place: Place {
            name: format!("crossing of {}", model.surfaces[jump.surface].place.name),
            ..jump.place
        },
        surface: jump.surface,
        direction: match jump.direction {
            Direction::Falling => Direction::Rising,
            Direction::Rising => Direction::Falling,
        },
        at_most: None,
        then_hold: None,
        resets: Vec::new(),
        assignments: Vec::new(),
    };
    model.jumps.iter().map(crossing).collect()
}

/// On which sides of the surface of a jump the state may begin.
#[derive(Clone, Copy)]
pub(super) struct Beginning {
    /// On the side from which the jump happens.
    pub may_be_before: bool,
    /// On the other side.
    pub may_be_beyond: bool,
    /// Whether it begins there as it is guessed.
    pub is_guessed_beyond: bool,
    /// Whether the function of the surface is above 0 there, where that is certain.
    pub is_above: Option<bool>,
}

impl Beginning {
    /// Where nothing is crossed before.
    pub fn is_beyond(self) -> bool {
        self.may_be_beyond && (self.is_guessed_beyond || !self.may_be_before)
    }
}

/// For each jump, over the bounds of all unknowns and starts. Where a surface has jumps in both
/// directions each crossing is one of them.
pub(super) fn beginnings(model: &Model, numbers: &Numbers) -> Vec<Beginning> {
    let mut graph = model.graph.clone();
    let widest = boxed(model, numbers, |it| it.start_range.unwrap_or(it.range));
    let guessed = at_guess(model, numbers);
    let guesses = straight_guesses(model, &mut graph);
    let mut of = |jump: &Jump| {
        let psi = model.surfaces[jump.surface].psi;
        let [known, guess] = [false, true].map(|is_guess| {
            let state =
                |at: usize| if is_guess { Some(guesses[at]) } else { model.states[at].start };
            at_start(model, &mut graph, psi, &state)
        });
        let [known, guess] = [(known, &widest), (guess, &guessed)]
            .map(|(psi, domain)| Tape::new(&graph, &[psi]).evaluate(domain)[0]);
        let told = model.surfaces[jump.surface].begins;
        let known = known.intersect(Interval::new(told.range[0], told.range[1]));
        let guess = told.guess.map_or(guess, Interval::point);
        let [reach, guess] = [known, guess].map(|psi| height(jump.direction, psi));
        let has_both = super::path::has_both(&model.jumps, jump);
        Beginning {
            may_be_before: has_both || !is_below(reach.upper),
            may_be_beyond: !has_both && is_below(reach.lower),
            is_guessed_beyond: is_below(guess.upper),
            is_above: match () {
                () if is_below(-known.lower) => Some(true),
                () if is_below(known.upper) => Some(false),
                () => None,
            },
        }
    };
    model.jumps.iter().map(&mut of).collect()
}

/// The function of a surface at the first time.
fn at_start(
    model: &Model,
    graph: &mut Graph,
    psi: ExprId,
    state: &dyn Fn(usize) -> Option<ExprId>,
) -> ExprId {
    let begun = |at: u32| match model.symbols[at as usize] {
        Symbol::State(at) => state(at),
        _ => None,
    };
    let first = |at: u32| (model.symbols[at as usize] == Symbol::Time).then_some(model.interval[0]);
    let psi = graph.substitute(&[psi], &begun);
    graph.substitute(&psi, &first)[0]
}

/// Above 0 on the side from which the jump happens.
pub(super) fn height(direction: Direction, psi: Interval) -> Interval {
    match direction {
        Direction::Falling => psi,
        Direction::Rising => Interval::new(-psi.upper, -psi.lower),
    }
}

fn is_below(value: f64) -> bool {
    value < -ROUNDING
}

/// What each input of the graph may be, with ranges of the states.
pub(super) fn boxed(
    model: &Model,
    numbers: &Numbers,
    range: impl Fn(&State) -> Range,
) -> Vec<Interval> {
    let bounds = |range| {
        let bounds = numbers.bounds(model, range);
        Interval::new(bounds.lower, bounds.upper)
    };
    let one = |symbol: &Symbol| match *symbol {
        Symbol::Param(_) => Interval::point(numbers.of(*symbol)),
        Symbol::Free(at) => bounds(model.frees[at].range),
        Symbol::State(at) => bounds(range(&model.states[at])),
        Symbol::Control(at) => bounds(model.controls[at].range),
        Symbol::Selector(_) => Interval::new(-1.0, 1.0),
        _ => Interval::ALL,
    };
    model.symbols.iter().map(one).collect()
}

/// What each parameter and unknown is guessed to be.
fn at_guess(model: &Model, numbers: &Numbers) -> Vec<Interval> {
    let one = |symbol: &Symbol| match symbol {
        Symbol::Param(_) | Symbol::Free(_) => Interval::point(numbers.of(*symbol)),
        _ => Interval::ALL,
    };
    model.symbols.iter().map(one).collect()
}
