//! A model with jumps as one without: a phase between each two jumps, all on the same grid.
//!
//! Jumps `1..n` at unknown times divide time into `n + 1` phases of unknown durations `D_j` that
//! begin at `T_j`. Each has states and controls of its own over the same `tau` in [0, 1], and
//! linkage conditions at its ends:
//!
//! ```text
//! x_j' = D_j f(T_j + tau D_j, x_j, u_j, p)      psi(T_j+1, x_j(1), p) = 0      x_j+1(0) = r(T_j+1, x_j(1), p)
//! ```
//!
//! Which jumps happen, and in which order, is given ([`sequences()`]). The result is a model like
//! any other: smooth between the jumps, and differentiated through them by the dependence of all
//! phases on the durations.

mod crossings;
mod hold;
mod links;
mod path;
mod phase;
mod sequences;

pub use crossings::crossings;
pub use sequences::{Sequences, sequences};

use crate::expressions::graph::{ExprId, Graph};
use crate::model::guess::straight_guesses;
use crate::model::numbers::numbers;
use crate::model::{
    Ball, Control, Expectation, Free, Integral, Jump, Model, Place, Range, Report, State, Surface,
    Symbol,
};
use crossings::Beginning;
use fdcc_grammar::Diagnostic;
use hold::Held;
use phase::Phase;

/// What holds between the jumps of a model: the model without them, and without surfaces at which
/// nothing else happens.
pub(crate) fn between_jumps(model: &Model) -> Model {
    if model.jumps.is_empty() {
        return model.clone();
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
    between
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

/// The model in which exactly these jumps and [`mod@crossings`] happen, one after the other.
pub fn with_phases(model: &Model, sequence: &[usize]) -> Result<Model, Vec<Diagnostic>> {
    let numbers = numbers(model)?;
    let begins = crossings::beginnings(model, &numbers);
    let mut limits = sequences::limits(model, &numbers);
    limits.resize(2 * model.jumps.len(), None);
    let whole = Model { jumps: [model.jumps.clone(), crossings(model)].concat(), ..model.clone() };
    let mut between = between_jumps(model);
    phase::input(&mut between.graph, &mut between.symbols, Symbol::Time);
    let mut graph = between.graph.clone();
    let mut symbols = between.symbols.clone();
    let held = Held::new(&whole, &mut graph, sequence, &limits);
    let durations = durations(&between, sequence, &mut graph, &mut symbols);
    let phases = Phase::all(&between, &mut graph, &mut symbols, &durations);
    let mut multi_phase = MultiPhase {
        whole: &whole,
        model: &between,
        sequence,
        held,
        begins,
        limits,
        graph,
        durations,
        phases,
    };
    let parts = multi_phase.parts();
    Ok(Model { graph: multi_phase.graph, symbols, ..parts })
}

/// `D_j`: an unknown for each phase but the last, which is what they leave of the time.
fn durations(
    model: &Model,
    sequence: &[usize],
    graph: &mut Graph,
    symbols: &mut Vec<Symbol>,
) -> Vec<ExprId> {
    let first = model.frees.len();
    let mut durations: Vec<ExprId> = (0..sequence.len())
        .map(|j| phase::input(graph, symbols, Symbol::Free(first + j)))
        .collect();
    let known = graph.sum(&durations);
    let whole = graph.sub(model.interval[1], model.interval[0]);
    durations.push(graph.sub(whole, known));
    durations
}

struct MultiPhase<'m> {
    /// As it is written, with the crossings behind its jumps.
    whole: &'m Model,
    /// What holds between the jumps.
    model: &'m Model,
    /// The jumps and crossings that happen, in their order.
    sequence: &'m [usize],
    /// The surface that is held in the end.
    held: Option<Held>,
    /// Where the state may begin, for each jump.
    begins: Vec<Beginning>,
    /// How often each jump may happen.
    limits: Vec<Option<usize>>,
    graph: Graph,
    durations: Vec<ExprId>,
    phases: Vec<Phase>,
}

impl<'m> MultiPhase<'m> {
    /// The jump at the end of a phase.
    fn jump(&self, j: usize) -> &'m Jump {
        &self.whole.jumps[self.sequence[j]]
    }

    /// The lists of the model, each with what every phase has of it.
    fn parts(&mut self) -> Model {
        let model = self.model;
        let [zero, one] = [0.0, 1.0].map(|it| self.graph.number(it));
        let count = self.phases.len();
        let each = |it: &std::ops::Range<usize>, j: usize| {
            it.start + j * model.surfaces.len()..it.end + j * model.surfaces.len()
        };
        let balls = (0..count).flat_map(|j| {
            model
                .balls
                .iter()
                .map(move |ball| Ball { surfaces: each(&ball.surfaces, j), ..ball.clone() })
        });
        let mut method = model.method.clone();
        let lagged = |j| model.method.lagged.iter().map(move |it| it + j * model.states.len());
        method.lagged = (0..count).flat_map(lagged).collect();
        Model {
            frees: self.frees(),
            states: self.states(),
            controls: self.controls(),
            surfaces: self.surfaces(),
            balls: balls.collect(),
            interval: [zero, one],
            path: self.path(),
            boundary: self.boundary(),
            objective: model.objective.clone().map(|(place, value)| (place, self.of_whole(value))),
            integrals: self.integrals(),
            report: self.report(),
            expectations: self.expectations(),
            method,
            ..model.clone()
        }
    }

    /// The unknowns, then the durations of all phases but the last.
    fn frees(&mut self) -> Vec<Free> {
        let mut frees = self.model.frees.clone();
        let [zero, infinity] = [0.0, f64::INFINITY].map(|it| self.graph.number(it));
        let whole = self.graph.sub(self.model.interval[1], self.model.interval[0]);
        let guess = self.graph.scale(1.0 / self.phases.len() as f64, whole);
        frees.extend((0..self.sequence.len()).map(|j| self.jump(j)).map(|jump| Free {
            place: Place {
                name: format!("time before {}", jump.place.name),
                span: jump.place.span,
            },
            range: Range { lower: zero, upper: infinity },
            guess: Some(guess),
        }));
        frees
    }

    fn states(&mut self) -> Vec<State> {
        let guesses = straight_guesses(self.model, &mut self.graph);
        let mut states = Vec::new();
        for j in 0..self.phases.len() {
            for (index, state) in self.model.states.iter().enumerate() {
                let rate = match self.is_still(j, index) {
                    true => self.graph.number(0.0),
                    false => self.in_phase(j, state.rate),
                };
                let is_first = j == 0;
                states.push(State {
                    place: self.named(j, &state.place),
                    range: self.range_of(index),
                    start: state.start.filter(|_| is_first),
                    start_range: state.start_range.filter(|_| is_first),
                    rate: self.graph.mul(self.durations[j], rate),
                    equation: state.equation.clone(),
                    guess: Some(self.in_phase(j, guesses[index])),
                });
            }
        }
        states
    }

    fn controls(&mut self) -> Vec<Control> {
        let mut controls = Vec::new();
        for j in 0..self.phases.len() {
            for control in &self.model.controls {
                let guess = control.guess.map(|guess| self.in_phase(j, guess));
                controls.push(Control {
                    place: self.named(j, &control.place),
                    guess,
                    ..control.clone()
                });
            }
        }
        controls
    }

    fn surfaces(&mut self) -> Vec<Surface> {
        let mut surfaces = Vec::new();
        for j in 0..self.phases.len() {
            for surface in &self.model.surfaces {
                let psi = self.in_phase(j, surface.psi);
                surfaces.push(Surface { place: self.named(j, &surface.place), psi });
            }
        }
        surfaces
    }

    /// Integrals add up over the phases.
    fn integrals(&mut self) -> Vec<Integral> {
        let mut integrals = self.model.integrals.clone();
        for integral in &mut integrals {
            let terms: Vec<ExprId> = (0..self.phases.len())
                .map(|j| {
                    let here = self.in_phase(j, integral.integrand);
                    self.graph.mul(self.durations[j], here)
                })
                .collect();
            integral.integrand = self.graph.sum(&terms);
        }
        integrals
    }

    fn report(&mut self) -> Vec<Report> {
        let mut report = Vec::new();
        for j in 0..self.phases.len() {
            for row in &self.model.report {
                report.push(Report { value: self.in_phase(j, row.value), ..row.clone() });
            }
        }
        report
    }

    fn expectations(&mut self) -> Vec<Expectation> {
        let mut all = self.model.expectations.clone();
        for expectation in &mut all {
            expectation.values = expectation.values.map(|value| self.of_whole(value));
        }
        all
    }

    /// A name of its own for each phase but the first.
    fn named(&self, j: usize, place: &Place) -> Place {
        let Some(before) = j.checked_sub(1) else { return place.clone() };
        let earlier = &self.jump(before).place.name;
        Place { name: format!("{} after {earlier} {j}", place.name), span: place.span }
    }
}
