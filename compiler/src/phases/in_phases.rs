//! A model with phases in which time is divided within each of them.
//!
//! The phases of the chain are those of the first phase, then those of the second, and so on. The
//! links within each come before the links that were written, which read the first and the last
//! phase of each chain in place of the phase that they name.

use super::with_phases;
use crate::expressions::graph::{ById, ExprId, Graph};
use crate::model::guess::fixed_by_a_row;
use crate::model::{Constraint, Free, Link, Model, Phase, Place, Range, Symbol};
use fdcc_grammar::Diagnostic;
use fdcc_runtime::problem::End;
use std::ops::Range as Places;

/// The model in which exactly these jumps and [`crossings`](super::crossings()) happen in each of
/// its phases, one after the other.
///
/// # Errors
///
/// A parameter without a value.
pub fn with_jumps_in_phases(
    model: &Model,
    sequences: &[Vec<usize>],
) -> Result<Model, Vec<Diagnostic>> {
    let mut divided = divided(model, &mut |phase, own| match own.jumps.is_empty() {
        true => Ok(own),
        false => with_phases(&own, &sequences[phase]),
    })?;
    let mut pieces = divided.phases.iter_mut();
    for (written, sequence) in model.phases.iter().zip(sequences) {
        let open = open_states(&written.model);
        for (j, piece) in pieces.by_ref().take(sequence.len() + 1).enumerate() {
            // What is known of these, links say.
            open.iter().for_each(|at| piece.model.states[*at].guess = None);
            match j {
                0 => {
                    piece.place.clone_from(&written.place);
                    // On which side of a surface it begins, links say.
                    piece.hold_at_first = written.hold_at_first.min(written.model.path.len());
                }
                _ => piece.place.name = format!("{}.{}", written.place.name, piece.place.name),
            }
        }
    }
    Ok(divided)
}

/// The states of which a phase by itself knows nothing at the first time.
fn open_states(phase: &Model) -> Vec<usize> {
    let mut graph = phase.graph.clone();
    let mut is_open = |at: &usize| {
        let state = &phase.states[*at];
        let is_silent = state.start.is_none() && state.guess.is_none();
        is_silent && fixed_by_a_row(phase, &mut graph, Symbol::AtStart(*at)).is_none()
    };
    (0..phase.states.len()).filter(|at| is_open(at)).collect()
}

/// The model in which each phase, which is given the times of all, is what it is divided into.
pub(super) fn divided(
    model: &Model,
    divide: &mut dyn FnMut(usize, Model) -> Result<Model, Vec<Diagnostic>>,
) -> Result<Model, Vec<Diagnostic>> {
    let mut chain = Chain::new(model);
    for phase in 0..model.phases.len() {
        let own = chain.phase(phase);
        chain.take(phase, divide(phase, own)?);
    }
    Ok(chain.into_model())
}

struct Chain<'m> {
    written: &'m Model,
    /// With the times of all switches as unknowns.
    whole: Model,
    phases: Vec<Phase>,
    links: Vec<Link>,
    /// The phases of the chain of each phase.
    places: Vec<Places<usize>>,
}

impl<'m> Chain<'m> {
    fn new(written: &'m Model) -> Self {
        let whole = Model { phases: Vec::new(), links: Vec::new(), ..written.clone() };
        Chain { written, whole, phases: Vec::new(), links: Vec::new(), places: Vec::new() }
    }

    /// A phase with the times of those before it.
    fn phase(&self, phase: usize) -> Model {
        let mut own = self.written.phases[phase].model.clone();
        share_times(&mut own, &self.whole.frees);
        own
    }

    fn take(&mut self, phase: usize, divided: Model) {
        let places: Vec<Place> = divided.frees.iter().map(|it| it.place.clone()).collect();
        let known = self.whole.frees.len();
        places[known..].iter().for_each(|it| add_time(&mut self.whole, it));
        let first = self.phases.len();
        for link in &divided.links {
            self.take_link(&divided, link, first);
        }
        if divided.phases.is_empty() {
            let place = self.written.phases[phase].place.clone();
            self.phases.push(Phase { place, model: divided, hold_at_first: 0 });
        } else {
            self.phases.extend(divided.phases);
        }
        self.places.push(first..self.phases.len());
    }

    /// Copies a link within the chain of a phase, whose phases stand behind others now.
    fn take_link(&mut self, of: &Model, link: &Link, first: usize) {
        let mut known = ById::default();
        let ends = link.ends.iter().map(|end| match end {
            End::First(j) => End::First(first + j),
            End::Last(j) => End::Last(first + j),
        });
        let ends = ends.collect();
        let whole = &mut self.whole;
        let mut take = |id: ExprId| {
            let (graph, symbols) = (&mut whole.graph, &mut whole.symbols);
            let place = |graph: &mut Graph, input: u32| {
                let symbol = match of.symbols[input as usize] {
                    Symbol::OfPhase { phase, input } => {
                        Symbol::OfPhase { phase: first + phase, input }
                    }
                    shared => shared,
                };
                let input = crate::model::phases::Symbols { graph, symbols }.input(symbol);
                graph.input(input)
            };
            let mut place = place;
            graph.import(&of.graph, &[id], &mut known, &mut place)[0]
        };
        let objective = link.objective.map(&mut take);
        let rows = link.rows.iter().map(|row| Constraint {
            place: row.place.clone(),
            value: take(row.value),
            range: Range { lower: take(row.range.lower), upper: take(row.range.upper) },
        });
        let rows = rows.collect();
        self.links.push(Link { ends, objective, rows });
    }

    fn into_model(mut self) -> Model {
        for link in &self.written.links {
            let written = self.written_link(link);
            self.links.push(written);
        }
        let Chain { mut phases, links, whole, .. } = self;
        for phase in &mut phases {
            share_times(&mut phase.model, &whole.frees);
        }
        Model { phases, links, ..whole }
    }

    /// A link that was written, between the ends of chains.
    fn written_link(&mut self, link: &Link) -> Link {
        let rows = link
            .rows
            .iter()
            .map(|row| Constraint { value: self.at_ends(row.value), ..row.clone() });
        let rows: Vec<Constraint> = rows.collect();
        let objective = link.objective.map(|value| self.at_ends(value));
        let mut ends = Vec::new();
        for end in &link.ends {
            let places = self.places[end.phase()].clone();
            match end {
                End::First(_) => ends.push(End::First(places.start)),
                // Integrals of all phases may be read where they end.
                End::Last(_) => ends.extend(places.map(End::Last)),
            }
        }
        Link { ends, objective, rows }
    }

    /// A value that was written of ends of phases, as one of the ends of chains; an integral is the
    /// sum of those of a chain.
    fn at_ends(&mut self, value: ExprId) -> ExprId {
        let mut meanings = Vec::new();
        for input in self.whole.graph.inputs_of(&[value]) {
            let Symbol::OfPhase { phase, input: own } = self.whole.symbols[input as usize] else {
                continue;
            };
            let (symbol, places) = (
                self.written.phases[phase].model.symbols[own as usize],
                self.places[phase].clone(),
            );
            let read = match symbol {
                Symbol::AtEnd(_) | Symbol::ControlAtEnd(_) => places.end - 1..places.end,
                Symbol::Integral(_) | Symbol::Sum(_) => places,
                _ => places.start..places.start + 1,
            };
            let read: Vec<ExprId> = read.map(|j| self.of_phase(j, symbol)).collect();
            meanings.push((input, self.whole.graph.sum(&read)));
        }
        let meaning = |input: u32| meanings.iter().find(|it| it.0 == input).map(|it| it.1);
        self.whole.graph.substitute(&[value], &meaning)[0]
    }

    fn of_phase(&mut self, phase: usize, symbol: Symbol) -> ExprId {
        let own = self.phases[phase].model.input_of(symbol);
        let input = own.expect("a phase has all symbols that links read");
        let input = self.whole.symbols_mut().input(Symbol::OfPhase { phase, input });
        self.whole.graph.input(input)
    }
}

/// Gives a phase the unknowns of the chain that it does not have.
fn share_times(phase: &mut Model, frees: &[Free]) {
    for free in &frees[phase.frees.len()..] {
        add_time(phase, &free.place);
    }
}

fn add_time(model: &mut Model, place: &Place) {
    let [lower, upper] = [f64::NEG_INFINITY, f64::INFINITY].map(|it| model.graph.number(it));
    let symbol = Symbol::Free(model.frees.len());
    model.symbols_mut().input(symbol);
    model.frees.push(Free { place: place.clone(), range: Range { lower, upper }, guess: None });
}
