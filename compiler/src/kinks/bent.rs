//! Which kinks bend what the optimum depends on, and what they depend on themselves.

use super::{Kind, Kink, roots};
use crate::expressions::graph::derivative::derivative;
use crate::expressions::graph::{ById, ExprId, Graph};
use crate::model::{Model, Place, Symbol};

/// More kinks are left as they are: each would be one more control on all intervals.
const MOST: usize = 100;

/// The kinks that an optimum may lie on.
pub(super) struct Bent {
    /// What each can become, and where it is read.
    pub kinks: ById<(Kind, Place)>,
}

/// A kink in a copy of the graph, in which an input stands for `max(-e, 0)`.
pub(super) struct Tried {
    pub original: ExprId,
    pub e: ExprId,
    /// Behind the symbols of the model, in the order of the kinks.
    pub input: u32,
}

impl Bent {
    pub fn of(model: &Model) -> Self {
        let mut kinks = ById::default();
        let mut graph = model.graph.clone();
        let symbols = model.symbols.len();
        let (tried, rewritten) = replaced(&mut graph, symbols, &roots(model), Kink::of);
        if tried.len() > MOST {
            return Bent { kinks };
        }
        let mut readers: Vec<(ExprId, Place)> = rewritten.into_iter().zip(places(model)).collect();
        // What is inside of another one comes first.
        for (it, kind) in tried.iter().zip(kinds(model, &mut graph, &tried)).rev() {
            let Some(kind) = kind else { continue };
            let reader = readers.iter().find(|reader| is_bent(&mut graph, reader.0, it));
            let Some((_, place)) = reader.cloned() else { continue };
            readers.push((it.e, place.clone()));
            kinks.insert(it.original, (kind, place));
        }
        Bent { kinks }
    }

    /// Whether some become surfaces only where they are located.
    pub fn has_more_surfaces(&self) -> bool {
        self.kinks.values().any(|it| matches!(it.0, Kind::Either | Kind::Timed))
    }
}

/// What an expression is as a kink, and what it has become; nothing of what is none.
type AsKink = fn(&mut Graph, ExprId, ExprId) -> Option<Kink>;

/// Roots with an input for each kink, behind the first `symbols`.
pub(super) fn replaced(
    graph: &mut Graph,
    symbols: usize,
    roots: &[ExprId],
    as_kink: AsKink,
) -> (Vec<Tried>, Vec<ExprId>) {
    let (mut tried, mut next) = (Vec::new(), symbols as u32);
    let rewritten = graph.rewrite(roots, |graph, original, rebuilt| {
        let Some(kink) = as_kink(graph, original, rebuilt) else { return rebuilt };
        let input = next;
        next += 1;
        tried.push(Tried { original, e: kink.e, input });
        let unknown = graph.input(input);
        kink.with_unknown(graph, unknown)
    });
    (tried, rewritten)
}

/// What each kink can become, by what moves it; nothing where nothing does, or where friction does.
fn kinds(model: &Model, graph: &mut Graph, tried: &[Tried]) -> Vec<Option<Kind>> {
    let rates: Vec<ExprId> = model.states.iter().map(|it| it.rate).collect();
    let in_rates = model.graph.reachable(&rates);
    let mut kind = |it: &Tried| {
        let e = Kink::of(graph, it.original, it.original)?.e;
        Some(match movers(model, graph, e)? {
            Movers { has_control: true, .. } => Kind::Along,
            Movers { has_state: true, .. } if !in_rates.contains(&it.original) => Kind::Either,
            Movers { has_state: true, .. } => Kind::Surface,
            Movers { has_time: true, .. } => Kind::Timed,
            Movers { is_of_ends: true, .. } => Kind::AtEnds,
            _ => return None,
        })
    };
    tried.iter().map(&mut kind).collect()
}

/// What moves a kink.
#[derive(Default)]
struct Movers {
    has_control: bool,
    has_state: bool,
    has_time: bool,
    is_of_ends: bool,
}

/// Nothing where friction moves it.
fn movers(model: &Model, graph: &Graph, e: ExprId) -> Option<Movers> {
    let mut movers = Movers::default();
    for at in graph.inputs_of(&[e]) {
        match model.symbols[at as usize] {
            Symbol::Param(_) => {}
            Symbol::Time => movers.has_time = true,
            Symbol::State(_) => movers.has_state = true,
            Symbol::Control(_) => movers.has_control = true,
            Symbol::Free(_)
            | Symbol::AtStart(_)
            | Symbol::AtEnd(_)
            | Symbol::Integral(_)
            | Symbol::ControlAtStart(_)
            | Symbol::ControlAtEnd(_) => movers.is_of_ends = true,
            _ => return None,
        }
    }
    Some(movers)
}

/// Whether what reads a kink has a kink there: not `v*abs(v)`, nor `max(x, 0)^2`.
pub(super) fn is_bent(graph: &mut Graph, root: ExprId, kink: &Tried) -> bool {
    let slope = derivative(graph, root, kink.input);
    let zero = graph.number(0.0);
    let below = graph.substitute(&[slope], &|at| (at == kink.input).then_some(zero))[0];
    let there = graph.rewrite(&[below], |_, original, rebuilt| match original == kink.e {
        true => zero,
        false => rebuilt,
    })[0];
    graph.as_number(there) != Some(0.0)
}

/// Where the roots are written.
fn places(model: &Model) -> impl Iterator<Item = Place> {
    let rates = model.states.iter().map(|it| &it.equation);
    let integrands = model.integrals.iter().map(|it| &it.place);
    rates.chain(integrands).chain(model.objective.iter().map(|it| &it.0)).cloned()
}
