//! A model with conditions at times between its ends as a chain of phases: one between each two of
//! these times.
//!
//! ```text
//! x_j+1(T_j+1) = x_j(T_j+1)      lower <= c(T_j+1, x_j(T_j+1), p) <= upper      T_j <= T_j+1
//! ```
//!
//! The trajectory is continuous, the grid has these times as points, and where an equality holds
//! the costate jumps by its multiplier.

use super::division::{Division, add_symbols, numbered};
use super::shares::Shares;
use crate::expressions::graph::Graph;
use crate::expressions::interval::Interval;
use crate::model::guess::straight_guesses;
use crate::model::numbers::{Numbers, numbers};
use crate::model::{Constraint, Instant, Link, Model, Place, Range, State, Symbol, between_times};
use fdcc_grammar::{Diagnostic, Severity};
use fdcc_runtime::problem::{End, Grid, Method};

/// The model in which each time of a condition ends a phase; they follow each other as guessed.
///
/// # Errors
///
/// A parameter without a value, a time outside of the horizon.
pub fn with_times(model: &Model) -> Result<Model, Vec<Diagnostic>> {
    let numbers = numbers(model)?;
    let mut misplaced = model.misplaced_times(&numbers);
    misplaced.retain(|it| it.severity == Severity::Error);
    if !misplaced.is_empty() {
        return Err(misplaced);
    }
    let instants = model.instants(&numbers);
    let mut whole = Model { at_times: Vec::new(), ..model.clone() };
    add_symbols(&mut whole);
    let [begin, end] = model.interval;
    let times = std::iter::once(begin).chain(instants.iter().map(|it| it.time)).chain([end]);
    let division = Division::new(&whole, times.collect());
    let domain = model.timeless(&numbers);
    let (numbers, instants) = (&numbers, &instants);
    Ok(Pieces { written: model, numbers, domain, instants, division }.into_model())
}

/// For each time of a condition, as it is guessed, a model whose end conditions are those that hold
/// then.
///
/// # Errors
///
/// A parameter without a value.
pub fn ends_at(model: &Model) -> Result<Vec<(f64, Model)>, Vec<Diagnostic>> {
    let numbers = numbers(model)?;
    let mut whole = Model { at_times: Vec::new(), objective: None, ..model.clone() };
    add_symbols(&mut whole);
    let ends = |it: &Instant| {
        let mut own = whole.clone();
        let rows = it.conditions.iter().flat_map(|it| &it.rows);
        own.boundary = rows.map(|row| at_end(&mut own.graph, &whole, it, row)).collect();
        (it.guess, own)
    };
    Ok(model.instants(&numbers).iter().map(ends).collect())
}

/// A row of a time as one of the last time.
fn at_end(graph: &mut Graph, model: &Model, instant: &Instant, row: &Constraint) -> Constraint {
    let ends: Vec<Option<_>> = (model.symbols.iter())
        .map(|symbol| match *symbol {
            Symbol::Time => Some(instant.time),
            Symbol::State(at) => model.input_of(Symbol::AtEnd(at)).map(|input| graph.input(input)),
            _ => None,
        })
        .collect();
    let value = graph.substitute(&[row.value], &|input| ends[input as usize])[0];
    Constraint { value, ..row.clone() }
}

struct Pieces<'m> {
    /// The model as it is written.
    written: &'m Model,
    numbers: &'m Numbers,
    /// Where the parameters and the unknowns of the written model may lie.
    domain: Vec<Interval>,
    instants: &'m [Instant<'m>],
    division: Division<'m>,
}

impl Pieces<'_> {
    fn into_model(mut self) -> Model {
        let (model, last) = (self.division.model, self.division.last());
        let shares = Shares::new(model, &mut self.division.graph);
        let phases = numbered(&model.name, (0..=last).map(|j| self.phase(j, &shares)));
        let mut links: Vec<Link> = (0..last).map(|j| self.link(j)).collect();
        links.extend(self.division.link_of_whole(&shares, &model.boundary));
        let Division { graph, symbols, .. } = self.division;
        Model { graph, symbols, phases, links, ..model.clone() }
    }

    fn phase(&mut self, j: usize, shares: &Shares) -> Model {
        let (model, last) = (self.division.model, self.division.last());
        let states = self.states(j);
        let value = shares.of_phase(&mut self.division.graph, j, last);
        let place = model.objective.as_ref().map(|it| it.0.clone());
        let mut integrals = model.integrals.clone();
        shares.integrals.iter().for_each(|at| integrals[*at].is_linked = true);
        Model {
            graph: self.division.graph.clone(),
            interval: [self.division.times[j], self.division.times[j + 1]],
            states,
            boundary: Vec::new(),
            objective: place.zip(value),
            integrals,
            method: Method { grid: self.grid(j), ..model.method.clone() },
            ..model.clone()
        }
    }

    fn states(&mut self, j: usize) -> Vec<State> {
        let guesses = straight_guesses(self.division.model, &mut self.division.graph);
        let states = self.division.model.states.iter().zip(guesses);
        let state = |(state, guess): (&State, _)| State {
            start: state.start.filter(|_| j == 0),
            start_range: state.start_range.filter(|_| j == 0),
            guess: Some(guess),
            ..state.clone()
        };
        states.map(state).collect()
    }

    /// The intervals are shared out by the lengths of the phases, as they are guessed.
    fn grid(&self, j: usize) -> Grid {
        let Grid::Uniform(count) = self.written.method.grid else {
            return self.written.method.grid.clone();
        };
        let time = |j: usize| self.numbers.value(self.written, self.division.times[j]);
        let part = (time(j + 1) - time(j)) / (time(self.division.last() + 1) - time(0));
        Grid::Uniform(((part * count as f64).round() as usize).clamp(1, count))
    }

    /// What holds at the end of a phase, and that the next one goes on from there.
    fn link(&mut self, j: usize) -> Link {
        let mut rows = Vec::new();
        let name = self.instants[j].conditions[0].place.clone();
        let zero = self.division.exactly_zero();
        for (at, state) in self.division.model.states.iter().enumerate() {
            let before = self.division.of_phase(j, Symbol::AtEnd(at));
            let after = self.division.of_phase(j + 1, Symbol::AtStart(at));
            let value = self.division.graph.sub(after, before);
            let place = Place {
                name: format!("{} after {}", state.place.name, name.name),
                span: name.span,
            };
            rows.push(Constraint { place, value, range: zero });
        }
        for row in self.instants[j].conditions.iter().flat_map(|it| &it.rows) {
            let value = self.division.at_end(j, row.value);
            rows.push(Constraint { value, ..row.clone() });
        }
        rows.extend(self.duration(j, &name, "before"));
        if j + 1 == self.instants.len() {
            rows.extend(self.duration(j + 1, &name, "after"));
        }
        Link { ends: vec![End::Last(j), End::First(j + 1)], objective: None, rows }
    }

    /// That a phase does not end before it begins, unless the bounds of the unknowns say so.
    fn duration(&mut self, j: usize, of: &Place, word: &str) -> Option<Constraint> {
        let times = [self.division.times[j + 1], self.division.times[j]];
        let graph = &mut self.division.graph;
        let passed = between_times(graph, &self.domain, times);
        let place = Place { name: format!("time {word} {}", of.name), span: of.span };
        let value = graph.sub(times[0], times[1]);
        let range: Range = self.division.not_below();
        (passed.lower < 0.0).then_some(Constraint { place, value, range })
    }
}
