//! Resets that can pile up: `psi` stays 0, its rate is turned round and shrinks, and the flow
//! brings it back.
//!
//! ```text
//! psi(r(x)) = 0,   psi'(r(x)) = -e psi'(x) with 0 < e < 1
//! psi'' < 0 where psi' = 0      (falling)
//! ```
//!
//! The times between such resets shrink by `e`, so their sum is finite.

use super::local::Local;
use super::view::View;
use crate::expressions::graph::ExprId;
use crate::expressions::graph::derivative::gradient;
use crate::expressions::interval::{Claim, Interval, Prover};
use crate::model::{Jump, Symbol};
use fdcc_grammar::ast::Direction;

/// The factor `e` of a jump that is proved to pile up.
pub(crate) fn restitution(local: &mut Local, view: &View<'_>, jump: &Jump) -> Option<ExprId> {
    let incoming = if jump.direction == Direction::Falling { local.above } else { local.below };
    let after: Vec<(usize, ExprId)> =
        jump.resets.iter().map(|&(state, value)| (state, local.import(view, value))).collect();
    let psi = reset(local, local.psi, &after);
    let rate = reset(local, incoming, &after);
    if !local.form(psi).is_zero() {
        return None;
    }
    let (before, rate) = (local.form(incoming), local.form(rate));
    let factor = rate.divided(&before)?.to_expr(&mut local.graph);
    let factor = local.graph.neg(factor);
    let moves = |at: &u32| {
        matches!(
            local.symbols[*at as usize],
            Symbol::State(_) | Symbol::Control(_) | Symbol::Time | Symbol::Selector(_)
        )
    };
    let is_constant = !local.graph.inputs_of(&[factor]).iter().any(moves);
    let range = local.prover().range(&local.graph, factor);
    let shrinks = is_constant
        && range.lower >= 0.0
        && range.lower < 1.0
        && 0.0 < range.upper
        && range.upper <= 1.0;
    (shrinks && returns(local, view, incoming, jump.direction)).then_some(factor)
}

/// An expression after the jump, on the surface.
fn reset(local: &mut Local, expr: ExprId, after: &[(usize, ExprId)]) -> ExprId {
    let symbols = &local.symbols;
    let replaced = |position: u32| match symbols[position as usize] {
        Symbol::State(state) => after.iter().find(|it| it.0 == state).map(|it| it.1),
        _ => None,
    };
    let moved = local.graph.substitute(&[expr], &replaced)[0];
    local.on_surface(moved)
}

/// Whether the flow always pulls back to the surface where `psi' = 0`.
fn returns(local: &mut Local, view: &View<'_>, rate: ExprId, direction: Direction) -> bool {
    let inputs = local.graph.inputs_of(&[rate]);
    let slopes = gradient(&mut local.graph, rate, &inputs);
    let mut terms = Vec::new();
    for (input, slope) in inputs.into_iter().zip(slopes) {
        let speed = match local.symbols[input as usize] {
            Symbol::Time => local.graph.number(1.0),
            Symbol::State(state) if view.has_rate[state] => {
                local.import(view, view.states[state].rate)
            }
            Symbol::Param(_) | Symbol::Free(_) => continue,
            _ => return false,
        };
        terms.push(local.graph.mul(slope, speed));
    }
    let second = local.graph.sum(&terms);
    let second = local.on_surface(second);
    let mut constraints = local.constraints.clone();
    constraints.push((rate, Interval::point(0.0)));
    let claim = if direction == Direction::Falling { Claim::Negative } else { Claim::Positive };
    Prover::new(local.domain.clone(), constraints).proves(&local.graph, &[(second, claim)])
}
