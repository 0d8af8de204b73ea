//! Optima on kinks of `abs`, `min` and `max`.
//!
//! What minimises `integral(abs(u))` rests at `u = 0`, where no derivative says so. So a kink gives
//! way to an unknown, `q = max(-e, 0)`:
//!
//! ```text
//! |e| = e + 2 q     max(a, b) = a + q, min(a, b) = b - q with e = a - b     q >= 0, q + e >= 0
//! ```
//!
//! The two conditions allow more than the kink does. Where less `q` is worth something, as in an
//! objective that is convex, one of them holds as an equality, and the optimum of what is allowed
//! is that of the model. Whoever solves has to look whether it does.
//!
//! A kink of states alone in the right side of an equation would be a force without a reason. It
//! becomes a surface, which is located like others, and so does one of time alone:
//!
//! ```text
//! |e| = s e     max(a, b) = (a + b + s e)/2     min(a, b) = (a + b - s e)/2     s in Sgn(e)
//! ```
//!
//! A condition with kinks is one for each side of them, where that says the same ([`mod@sides`]).

mod bent;
mod hinges;
mod in_phases;
mod of_parameters;
mod sides;

use crate::expressions::blend::sides;
use crate::expressions::graph::builtins::Builtin;
use crate::expressions::graph::{ExprId, Graph, evaluate};
use crate::model::numbers::numbers;
use crate::model::phases::Symbols;
use crate::model::{
    Begins, Constraint, Control, Free, Integral, Model, Place, Range, Surface, Symbol,
};
use bent::Bent;
use hinges::with_hinges;
pub use of_parameters::parameters_on_kinks;

/// What is made of kinks.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Kinks {
    /// Unknowns, where that can be.
    Relaxed,
    /// The same, and `q (q + e)` has a price, so that a trajectory on which both conditions are
    /// inequalities is no optimum (Leyffer, Lopez-Calva, Nocedal, *Interior methods for
    /// mathematical programs with complementarity constraints*, 2006).
    Priced(f64),
    /// Surfaces, where that can be; nothing where that makes no difference.
    Located,
}

/// The model in which unknowns and surfaces stand for kinks; nothing where it has none, or says how
/// wide they are to be smoothed. `is_true` where the optimum of the system that was written is
/// meant; without that nothing becomes a surface.
///
/// What is new stands behind what the model declares: controls with a path condition each, unknowns
/// with a condition at the ends each, surfaces.
///
/// In a model with phases each of them is such a model, and what is new has a number of its own.
pub fn without_kinks(model: &Model, kinks: Kinks, is_true: bool) -> Option<Model> {
    if !model.phases.is_empty() {
        return in_phases::without(model, kinks, is_true);
    }
    // Conditions at times are not known beside surfaces.
    let is_true = is_true && model.at_times.is_empty();
    // Without an objective nothing draws the unknowns to their bounds.
    let is_asked = model.not_yet.is_empty() && model.objective.is_some();
    let without = is_asked.then(|| Without::of(model, kinks, is_true, 0)).flatten();
    without.map(|it| it.own)
}

/// Whether a name is that of something that stands for a kink; no name of a model is.
pub fn is_kink(name: &str) -> bool {
    name.starts_with(NAME)
}

/// The condition that a name is another side of; nothing where it is of none.
pub fn side_of(name: &str) -> Option<&str> {
    name.strip_prefix(NAME)?.strip_prefix(SIDE)
}

/// What the names begin with, and what those of sides go on with.
const NAME: &str = "kink ";
const SIDE: &str = "side of ";

/// What a kink can become.
#[derive(Clone, Copy, PartialEq)]
enum Kind {
    /// A control and a path condition.
    Along,
    /// An unknown and a condition at the ends.
    AtEnds,
    /// A surface.
    Surface,
    /// A control, or a surface where it is located.
    Either,
    /// Of time alone: a surface where it is located.
    Timed,
}

/// The model with sums of `max` in the place of pieces of straight lines ([`mod@hinges`]).
fn hinged(model: &Model) -> Model {
    let mut own = model.clone();
    let conditions = own.path.iter().chain(&own.boundary).map(|row| row.value);
    let roots: Vec<ExprId> = roots(&own).into_iter().chain(conditions).collect();
    let fresh = own.symbols.len() as u32;
    let mut hinged = with_hinges(&mut own.graph, &roots, fresh).into_iter();
    let mut next = || hinged.next().expect("one for each root");
    own.states.iter_mut().for_each(|it| it.rate = next());
    own.integrals.iter_mut().for_each(|it| it.integrand = next());
    own.objective.iter_mut().for_each(|it| it.1 = next());
    own.path.iter_mut().chain(&mut own.boundary).for_each(|row| row.value = next());
    own
}

/// The roots in which kinks are looked for: right sides, integrands, the objective.
fn roots(model: &Model) -> Vec<ExprId> {
    let rates = model.states.iter().map(|it| it.rate);
    let integrands = model.integrals.iter().map(|it| it.integrand);
    rates.chain(integrands).chain(model.objective.iter().map(|it| it.1)).collect()
}

/// A kink: `above + share * q`, and `q = max(-e, 0)`.
struct Kink {
    e: ExprId,
    below: ExprId,
    above: ExprId,
    share: f64,
}

impl Kink {
    /// Nothing of what is none.
    fn of(graph: &mut Graph, original: ExprId, rebuilt: ExprId) -> Option<Kink> {
        let shares = [(Builtin::Abs, 2.0), (Builtin::Max, 1.0), (Builtin::Min, -1.0)];
        let share = shares.into_iter().find(|it| graph.as_call(original, it.0).is_some())?.1;
        let (e, [below, above]) = sides(graph, original, rebuilt)?;
        Some(Kink { e, below, above, share })
    }

    /// The same, and what `piecewise` is made of: what reads it changes with `q` if it is bent, or
    /// jumps.
    fn or_knot(graph: &mut Graph, original: ExprId, rebuilt: ExprId) -> Option<Kink> {
        Kink::of(graph, original, rebuilt).or_else(|| {
            let (e, [below, above]) = sides(graph, original, rebuilt)?;
            (below != above).then_some(Kink { e, below, above, share: 1.0 })
        })
    }

    /// Its value where an unknown stands for `q`.
    fn with_unknown(&self, graph: &mut Graph, unknown: ExprId) -> ExprId {
        let part = graph.scale(self.share, unknown);
        graph.add(self.above, part)
    }

    /// Its value where a selector says on which side of 0 `e` is.
    fn with_selector(&self, graph: &mut Graph, selector: ExprId) -> ExprId {
        let (sum, jump) = (graph.add(self.below, self.above), graph.sub(self.above, self.below));
        let change = graph.mul(selector, jump);
        let twice = graph.add(sum, change);
        graph.scale(0.5, twice)
    }
}

/// What stands for a kink.
struct Standing {
    kind: Kind,
    e: ExprId,
    /// `max(-e, 0)`, or the selector.
    value: ExprId,
}

struct Without {
    own: Model,
    bent: Bent,
    kinks: Kinks,
    is_true: bool,
    all: Vec<Standing>,
    /// How many stand for the kinks of other phases.
    others: usize,
    /// Whether a surface of the model stands for a kink.
    has_declared: bool,
}

impl Without {
    /// Nothing where the model has no kinks, or says how wide they are to be smoothed.
    fn of(model: &Model, kinks: Kinks, is_true: bool, others: usize) -> Option<Self> {
        let is_smoothed = model.smooth && model.method.names_width();
        if is_smoothed || !model.sums.is_empty() {
            return None;
        }
        let model = &hinged(model);
        let bent = Bent::of(model);
        if kinks == Kinks::Located && !(is_true && bent.has_more_surfaces()) {
            return None;
        }
        let (own, all, has_declared) = (model.clone(), Vec::new(), false);
        let mut without = Without { own, bent, kinks, is_true, all, others, has_declared };
        without.rewrite();
        let is_divided = without.divide_conditions();
        if let Kinks::Priced(price) = kinks {
            without.charge(price);
        }
        let is_changed = is_divided || without.has_declared || !without.all.is_empty();
        is_changed.then_some(without)
    }

    fn rewrite(&mut self) {
        let roots = roots(&self.own);
        let mut graph = std::mem::take(&mut self.own.graph);
        let rewritten = graph.rewrite(&roots, |graph, original, rebuilt| {
            self.replaced(graph, original, rebuilt).unwrap_or(rebuilt)
        });
        self.own.graph = graph;
        let mut rewritten = rewritten.into_iter();
        let mut next = || rewritten.next().expect("one for each root");
        self.own.states.iter_mut().for_each(|it| it.rate = next());
        self.own.integrals.iter_mut().for_each(|it| it.integrand = next());
        self.own.objective.iter_mut().for_each(|it| it.1 = next());
    }

    /// The value of a kink by what stands for it.
    fn replaced(&mut self, graph: &mut Graph, original: ExprId, rebuilt: ExprId) -> Option<ExprId> {
        let (kind, place) = self.bent.kinks.get(&original)?.clone();
        let kind = match kind {
            Kind::Either | Kind::Timed if self.kinks == Kinks::Located => Kind::Surface,
            Kind::Either => Kind::Along,
            other => other,
        };
        let is_left = kind == Kind::Timed || kind == Kind::Surface && !self.is_true;
        let kink = Kink::of(graph, original, rebuilt).filter(|_| !is_left)?;
        // A surface knows no others: what switches where the kinks inside of it are none.
        let e = match kind {
            Kind::Surface => Kink::of(graph, original, original)?.e,
            _ => kink.e,
        };
        let known = self.known(graph, e);
        let (kind, value) = known.unwrap_or_else(|| (kind, self.stand(graph, kind, &place, e)));
        Some(match kind {
            Kind::Surface => kink.with_selector(graph, value),
            _ => kink.with_unknown(graph, value),
        })
    }

    /// What stands for another kink at the same place: `max(e, 0) = max(-e, 0) + e`.
    fn known(&mut self, graph: &mut Graph, e: ExprId) -> Option<(Kind, ExprId)> {
        let opposite = graph.neg(e);
        if let Some(selector) = self.declared(graph, [e, opposite]) {
            return Some((Kind::Surface, selector));
        }
        let is_same = |it: &&Standing| it.e == e || it.e == opposite;
        let known = self.all.iter().find(is_same)?;
        let value = match known.kind {
            _ if known.e == e => known.value,
            Kind::Surface => graph.neg(known.value),
            _ => graph.add(known.value, known.e),
        };
        Some((known.kind, value))
    }

    /// The selector of a surface of the model on which a kink is, or its opposite.
    fn declared(&mut self, graph: &mut Graph, [e, opposite]: [ExprId; 2]) -> Option<ExprId> {
        let surfaces = self.own.surfaces.iter().filter(|_| self.is_true);
        let mut surfaces = surfaces.enumerate().filter(|it| !is_kink(&it.1.place.name));
        let (at, surface) = surfaces.find(|it| it.1.psi == e || it.1.psi == opposite)?;
        let is_same = surface.psi == e;
        self.has_declared = true;
        let symbols = &mut self.own.symbols;
        let input = Symbols { graph, symbols }.input(Symbol::Selector(at));
        let selector = graph.input(input);
        Some(if is_same { selector } else { graph.neg(selector) })
    }

    /// Declares what stands for a kink.
    fn stand(&mut self, graph: &mut Graph, kind: Kind, place: &Place, e: ExprId) -> ExprId {
        let symbol = match kind {
            Kind::Along | Kind::Either => Symbol::Control(self.own.controls.len()),
            Kind::AtEnds => Symbol::Free(self.own.frees.len()),
            Kind::Surface | Kind::Timed => Symbol::Selector(self.own.surfaces.len()),
        };
        let input = Symbols { graph, symbols: &mut self.own.symbols }.input(symbol);
        let value = graph.input(input);
        self.all.push(Standing { kind, e, value });
        let name = format!("{NAME}{}", self.others + self.all.len());
        let place = Place { name, ..place.clone() };
        let [lower, upper] = [0.0, f64::INFINITY].map(|it| graph.number(it));
        let range = Range { lower, upper };
        let row = Constraint { place: place.clone(), value: graph.add(value, e), range };
        match kind {
            Kind::Along | Kind::Either => {
                self.own.controls.push(Control { place, range, guess: None });
                self.own.path.push(row);
            }
            Kind::AtEnds => {
                self.own.frees.push(Free { place, range, guess: None });
                self.own.boundary.push(row);
            }
            Kind::Surface | Kind::Timed => {
                self.own.surfaces.push(Surface { place, psi: e, begins: Begins::default() })
            }
        }
        value
    }

    /// Puts sides in the place of conditions with kinks; whether there are any.
    fn divide_conditions(&mut self) -> bool {
        let inputs = numbers(&self.own).map_or(Vec::new(), |it| it.inputs().to_vec());
        let number = |graph: &Graph, id| match inputs.is_empty() {
            true => f64::NAN,
            false => evaluate(graph, &[id], &inputs, &[])[0],
        };
        let (symbols, graph) = (self.own.symbols.len(), &mut self.own.graph);
        let mut is_any = false;
        for rows in [&mut self.own.path, &mut self.own.boundary] {
            let mut others = Vec::new();
            // Those of what stands for a kink say which of both is 0 there: they stay whole.
            for row in rows.iter_mut().filter(|it| !is_kink(&it.place.name)) {
                if let Some(value) = sides::length(graph, row, &number) {
                    (row.value, is_any) = (value, true);
                    continue;
                }
                let Some(values) = sides::sides(graph, symbols, row) else { continue };
                is_any = true;
                let name = format!("{NAME}{SIDE}{}", row.place.name);
                let place = Place { name, ..row.place.clone() };
                row.value = values[0];
                let other =
                    |value: &ExprId| Constraint { place: place.clone(), value: *value, ..*row };
                others.extend(values[1..].iter().map(other));
            }
            rows.extend(others);
        }
        is_any
    }

    /// Adds `price * q (q + e)` to what is minimised.
    fn charge(&mut self, price: f64) {
        let mut sums = [Vec::new(), Vec::new()];
        for it in self.all.iter().filter(|it| it.kind != Kind::Surface) {
            let other = self.own.graph.add(it.value, it.e);
            let product = self.own.graph.mul(it.value, other);
            sums[usize::from(it.kind == Kind::AtEnds)].push(product);
        }
        let [integrand, at_ends] = sums.map(|it| self.own.graph.sum(&it));
        let place = Place { name: format!("{NAME}price"), ..Place::default() };
        let symbol = Symbol::Integral(self.own.integrals.len());
        self.own.integrals.push(Integral { place, integrand, is_linked: false });
        let input = self.own.symbols_mut().input(symbol);
        let integral = self.own.graph.input(input);
        let gap = self.own.graph.add(integral, at_ends);
        let charge = self.own.graph.scale(self.own.sense * price, gap);
        let (place, known) = self.own.objective.take().unwrap_or_else(|| {
            let nothing = self.own.graph.number(0.0);
            (self.own.states[0].place.clone(), nothing)
        });
        self.own.objective = Some((place, self.own.graph.add(known, charge)));
    }
}
