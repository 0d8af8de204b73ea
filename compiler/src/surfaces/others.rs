//! A rate with the selectors of many surfaces in one sum: to each surface, the others together are
//! one number.
//!
//! ```text
//! x' = f + sum_j c_j s_j      =      f + c_i s_i + r,    |r| <= sum_(j != i) |c_j|
//! ```
//!
//! That is exact where each of them occurs there and nowhere else. Without it, to look at `n`
//! surfaces takes time in proportion to `n^2`.

use super::view::View;
use crate::expressions::graph::builtins::Builtin;
use crate::expressions::graph::{Expr, ExprId, Graph};
use crate::model::Symbol;
use std::collections::{BTreeMap, HashMap};

/// Fewer than these are looked at one by one, and shown so.
const FEW: usize = 8;

/// A rate as a sum.
#[derive(Clone, Debug)]
pub(crate) struct SumOfSelectors {
    /// All other terms, with their factors.
    pub rest: Vec<(f64, ExprId)>,
    /// The term of each surface.
    pub own: HashMap<usize, Own>,
    /// How large all of these together can be.
    pub size: f64,
}

/// `c_j s_j`.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Own {
    /// The term, with the number before it.
    pub term: (f64, ExprId),
    /// `|c_j|`.
    pub size: f64,
}

impl SumOfSelectors {
    /// Of the rate of a state; nothing if there are only few selectors in it that occur nowhere
    /// else.
    pub fn new(view: &View<'_>, state: usize) -> Option<SumOfSelectors> {
        if view.moved.iter().filter(|states| states.contains(&state)).count() < FEW {
            return None;
        }
        let (mut own, mut rest): (HashMap<usize, Own>, Vec<_>) = Default::default();
        for term in terms(view.graph, view.states[state].rate) {
            match own_term(view, term) {
                Some((at, it)) if !own.contains_key(&at) => drop(own.insert(at, it)),
                _ => rest.push(term),
            }
        }
        let others: Vec<ExprId> = rest.iter().map(|it| it.1).collect();
        for input in view.graph.inputs_of(&others) {
            if let Symbol::Selector(at) = view.symbols[input as usize] {
                rest.extend(own.remove(&at).map(|it| it.term));
            }
        }
        let size = own.values().map(|it| it.size).sum();
        (own.len() >= FEW).then_some(SumOfSelectors { rest, own, size })
    }
}

/// A selector times a constant, if it moves one state only and is by itself.
fn own_term(view: &View<'_>, term: (f64, ExprId)) -> Option<(usize, Own)> {
    let (constant, at) = match view.graph.expr(term.1) {
        Expr::Input(_) => (1.0, selector(view, term.1)?),
        Expr::Call(Builtin::Mul, operands) => match selector(view, operands[1]) {
            Some(at) => (view.number(operands[0]), at),
            None => (view.number(operands[1]), selector(view, operands[0])?),
        },
        _ => return None,
    };
    let is_alone = view.moved[at].len() == 1
        && !view.balls.iter().any(|ball| ball.surfaces.contains(&at))
        && constant.is_finite();
    is_alone.then(|| (at, Own { term, size: (term.0 * constant).abs() }))
}

fn selector(view: &View<'_>, term: ExprId) -> Option<usize> {
    let Expr::Input(position) = view.graph.expr(term) else { return None };
    match view.symbols[*position as usize] {
        Symbol::Selector(at) => Some(at),
        _ => None,
    }
}

/// The terms of a sum with their factors. A sum that is used twice is gone through once: operands
/// are older than what is made of them.
fn terms(graph: &Graph, sum: ExprId) -> Vec<(f64, ExprId)> {
    let mut found = Vec::new();
    let mut pending = BTreeMap::from([(sum, 1.0)]);
    while let Some((next, factor)) = pending.pop_last() {
        let mut add = |id: ExprId, factor: f64| *pending.entry(id).or_insert(0.0) += factor;
        match (graph.expr(next), graph.operands(next)) {
            (Expr::Call(Builtin::Add, _), &[a, b]) => {
                [a, b].into_iter().for_each(|it| add(it, factor))
            }
            (Expr::Call(Builtin::Sub, _), &[a, b]) => {
                add(a, factor);
                add(b, -factor);
            }
            (Expr::Call(Builtin::Neg, _), &[a]) => add(a, -factor),
            (Expr::Call(Builtin::Mul, _), &[a, b]) if graph.as_number(a).is_some() => {
                add(b, factor * graph.as_number(a).unwrap_or(1.0));
            }
            _ => found.push((factor, next)),
        }
    }
    found
}
