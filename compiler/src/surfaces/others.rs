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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::numbers::numbers;
    use crate::surfaces::Local;

    /// A force of that many surfaces.
    fn model(surfaces: usize) -> crate::Model {
        let sum: String = (0..surfaces).map(|i| format!(" - 2*Sgn(x - {i})")).collect();
        let text = format!(
            "time t in [0, 1]\nstate x start 0.5\ncontrol u in [-1, 1]\n\
             dynamics {{ x' in u{sum} }}\nminimize integral(u^2)\n"
        );
        crate::analyze(&text).model.expect("the model has no error")
    }

    /// The expressions that it takes to look at each surface.
    fn work(surfaces: usize) -> Vec<usize> {
        let model = model(surfaces);
        let numbers = numbers(&model).expect("every parameter has a value");
        let view = View::of_model(&model, &numbers);
        let work = |at: usize| {
            let mut local = Local::new(&view, at).expect("its function is known");
            assert!(local.add_rates(&view, at));
            local.graph.len()
        };
        (0..surfaces).map(work).collect()
    }

    #[test]
    fn a_surface_among_many_takes_no_more_work() {
        let [few, many] = [20, 200].map(|surfaces| work(surfaces).into_iter().max());
        assert!(many <= few.map(|it| it + 5), "{few:?} and {many:?}");
    }

    #[test]
    fn the_others_together_are_as_large_as_they_can_be() {
        let model = model(20);
        let view = View::of_model(&model, &numbers(&model).expect("every parameter has a value"));
        let sum = &view.sums[&0];
        assert_eq!((sum.own.len(), sum.size, sum.rest.len()), (20, 40.0, 1));
        assert_eq!(sum.own[&3].size, 2.0);
    }

    /// 60 levels, each of which adds the one below it twice: 2^60 paths, 121 terms.
    #[test]
    fn a_sum_that_is_used_twice_is_gone_through_once() {
        let mut graph = Graph::new();
        let mut sum = graph.input(0);
        for level in 0..60 {
            let [a, b] = [2 * level + 1, 2 * level + 2].map(|input| graph.input(input));
            let (first, second) = (graph.add(sum, a), graph.add(sum, b));
            sum = graph.add(first, second);
        }
        let found = terms(&graph, sum);
        assert_eq!(found.len(), 121);
        let of_first = found.iter().find(|it| it.1.index() == 0).expect("it is in the sum").0;
        assert_eq!(of_first, 2f64.powi(60));
    }
}
