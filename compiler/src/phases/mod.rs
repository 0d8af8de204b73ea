//! A model with jumps as a chain of phases: one between each two jumps.
//!
//! Jumps `1..n` at unknown times `T_1..T_n` divide time into `n + 1` phases, which are models of
//! their own: `T_0` and `T_n+1` are the first and last time. Links tie the end of each to the start
//! of the next:
//!
//! ```text
//! x_j' = f(t, x_j, u_j, p) on [T_j, T_j+1]
//! psi(T_j+1, x_j, p) = 0      x_j+1 = r(T_j+1, x_j, u_j, p)
//! ```
//!
//! Which jumps happen, and in which order, is given ([`sequences()`]). A phase depends on the two
//! times at its ends only, so that the cost of a solve is that of all phases one after the other.

mod at_times;
mod combinations;
mod course;
mod crossings;
mod division;
mod hold;
mod in_phases;
mod links;
mod modes;
mod path;
mod sequences;
mod shares;
mod turns;

pub use at_times::{ends_at, with_times};
pub use combinations::{Combination, beside, combinations};
pub use course::{Course, Ends};
pub use crossings::crossings;
pub use in_phases::with_jumps_in_phases;
pub use modes::{
    Arc, HoldNormals, Limit, Mode, NormalsAt, PhaseOfModes, Point, Slopes, hamiltonian,
    is_uncontrolled, limits, may_hold, with_beginnings, with_modes, with_modes_in_phases,
};
pub use sequences::{Sequences, sequences};

use crate::expressions::graph::ExprId;
use crate::model::guess::straight_guesses;
use crate::model::numbers::numbers;
use crate::model::{Jump, Model, Phase, Place, State, Symbol};
use crossings::Beginning;
use division::{Division, divide};
use fdcc_grammar::Diagnostic;
use hold::Held;
use shares::Shares;
use std::borrow::Cow;

/// What holds between the jumps of a model: the model without them, and without surfaces at which
/// nothing else happens.
pub fn between_jumps(model: &Model) -> Cow<'_, Model> {
    if model.jumps.is_empty() {
        return Cow::Borrowed(model);
    }
    let used = used_surfaces(model);
    let mut between = Model { jumps: Vec::new(), ..model.clone() };
    between.surfaces = used.iter().map(|&at| model.surfaces[at].clone()).collect();
    let asks_for_width = model.method.sigma.is_some() || !model.method.continuation.is_empty();
    between.smooth &= asks_for_width || !used.is_empty();
    let moved = |at: usize| used.iter().position(|&it| it == at);
    for ball in &mut between.balls {
        let first = moved(ball.surfaces.start).expect("a `Dir` reads its selectors");
        ball.surfaces = first..first + ball.surfaces.len();
    }
    for symbol in &mut between.symbols {
        if let Symbol::Selector(at) = symbol {
            // What nothing reads any more gets no place.
            *symbol = Symbol::Selector(moved(*at).unwrap_or(usize::MAX));
        }
    }
    Cow::Owned(between)
}

/// The surfaces whose selectors something reads.
fn used_surfaces(model: &Model) -> Vec<usize> {
    let mut roots: Vec<ExprId> = model.states.iter().map(|it| it.rate).collect();
    roots.extend(model.path.iter().map(|it| it.value));
    roots.extend(model.integrals.iter().map(|it| it.integrand));
    roots.extend(model.report.iter().map(|it| it.value));
    let read = model.graph.inputs_of(&roots);
    let is_read =
        |at: usize| model.input_of(Symbol::Selector(at)).is_some_and(|it| read.contains(&it));
    let in_ball = |at: usize| model.balls.iter().any(|ball| ball.surfaces.contains(&at));
    (0..model.surfaces.len()).filter(|&at| is_read(at) || in_ball(at)).collect()
}

/// The model in which exactly these jumps and [`mod@crossings`] happen, one after the other; of one
/// piece if there are none.
pub fn with_phases(model: &Model, sequence: &[usize]) -> Result<Model, Vec<Diagnostic>> {
    let jumps = Jumps::new(model)?;
    let mut between = between_jumps(model).into_owned();
    let times = times(&mut between, &jumps.whole, sequence);
    let events: Vec<Option<usize>> = sequence.iter().copied().map(Some).collect();
    Ok(MultiPhase::new(&jumps, Division::new(&between, times), &events).into_model())
}

/// The jumps of a model, and what is known of them beforehand.
struct Jumps {
    /// The model as it is written, with the crossings behind its jumps.
    whole: Model,
    /// Where the state may begin, for each jump.
    begins: Vec<Beginning>,
    /// How often each jump may happen.
    limits: Vec<Option<usize>>,
    /// Whether the state turns back at each, where that is known.
    turns: Vec<Option<bool>>,
}

impl Jumps {
    fn new(model: &Model) -> Result<Self, Vec<Diagnostic>> {
        let numbers = numbers(model)?;
        let begins = crossings::beginnings(model, &numbers);
        let mut limits = sequences::limits(model, &numbers);
        limits.resize(2 * model.jumps.len(), None);
        let turns = model.jumps.iter().map(|jump| turns::turns(model, &numbers, jump)).collect();
        let jumps = [model.jumps.clone(), crossings(model)].concat();
        Ok(Jumps { whole: Model { jumps, ..model.clone() }, begins, limits, turns })
    }
}

/// The times of the jumps, between the first and the last time.
fn times(model: &mut Model, whole: &Model, sequence: &[usize]) -> Vec<ExprId> {
    let place = |(j, at): (usize, &usize)| {
        let place = &whole.jumps[*at].place;
        Place { name: format!("time of {} {}", place.name, j + 1), span: place.span }
    };
    divide(model, sequence.iter().enumerate().map(place).collect())
}

struct MultiPhase<'m> {
    jumps: &'m Jumps,
    /// What holds between the jumps, with the times at which phases end as unknowns.
    division: Division<'m>,
    /// The jump or crossing at the end of each phase but the last, if one happens there.
    events: Vec<Option<usize>>,
    /// The jumps and crossings that happen, in their order.
    sequence: Vec<usize>,
    /// The surface that is held in the end.
    held: Option<Held>,
}

impl<'m> MultiPhase<'m> {
    fn new(jumps: &'m Jumps, mut division: Division<'m>, events: &[Option<usize>]) -> Self {
        let sequence: Vec<usize> = events.iter().copied().flatten().collect();
        let held = Held::new(&jumps.whole, &mut division.graph, &sequence, &jumps.limits);
        MultiPhase { jumps, division, events: events.to_vec(), sequence, held }
    }

    /// As it is written, with the crossings behind its jumps.
    fn whole(&self) -> &'m Model {
        &self.jumps.whole
    }

    /// The jump at the end of a phase.
    fn jump(&self, j: usize) -> &'m Jump {
        &self.whole().jumps[self.events[j].expect("a jump happens there")]
    }

    /// How many jumps happen before a phase.
    fn count_before(&self, j: usize) -> usize {
        self.events[..j].iter().flatten().count()
    }

    fn into_model(mut self) -> Model {
        let model = self.division.model;
        let shares = Shares::new(model, &mut self.division.graph);
        if self.sequence.is_empty() {
            let (boundary, objective) = (model.boundary.clone(), model.objective.clone());
            return Model { boundary, objective, ..self.phase(0, &shares) };
        }
        let phases: Vec<Phase> = (0..=self.sequence.len())
            .map(|j| Phase {
                place: self.named(j),
                model: self.phase(j, &shares),
                hold_at_first: 0,
            })
            .collect();
        let mut links: Vec<_> = (0..self.sequence.len()).map(|j| self.link(j)).collect();
        links.extend(self.division.link_of_whole(&shares, &model.boundary));
        let Division { graph, symbols, .. } = self.division;
        Model { graph, symbols, phases, links, ..model.clone() }
    }

    /// What holds until a jump, or until the last time.
    fn phase(&mut self, j: usize, shares: &Shares) -> Model {
        let model = self.division.model;
        let (path, half_open) = self.path(j);
        let states = self.states(j);
        let value = shares.of_phase(&mut self.division.graph, j, self.sequence.len());
        let place = model.objective.as_ref().map(|it| it.0.clone());
        let mut integrals = model.integrals.clone();
        shares.integrals.iter().for_each(|at| integrals[*at].is_linked = true);
        Model {
            graph: self.division.graph.clone(),
            interval: [self.division.times[j], self.division.times[j + 1]],
            states,
            path,
            half_open,
            boundary: Vec::new(),
            objective: place.zip(value),
            integrals,
            sums: self.division.sums(j),
            ..model.clone()
        }
    }

    fn states(&mut self, j: usize) -> Vec<State> {
        let guesses = straight_guesses(self.division.model, &mut self.division.graph);
        let mut states = Vec::new();
        for (index, state) in self.division.model.states.iter().enumerate() {
            let rate = match self.is_still(j, index) {
                true => self.division.graph.number(0.0),
                false => state.rate,
            };
            states.push(State {
                range: self.range_of(index),
                start: state.start.filter(|_| j == 0),
                start_range: state.start_range.filter(|_| j == 0),
                rate,
                guess: Some(guesses[index]),
                ..state.clone()
            });
        }
        states
    }

    /// A phase has the name of the jump before it.
    fn named(&self, j: usize) -> Place {
        match j.checked_sub(1) {
            Some(before) => self.jump(before).place.clone(),
            None => Place { name: self.division.model.name.clone(), ..Place::default() },
        }
    }
}
