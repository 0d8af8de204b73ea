//! Whether a knot of a `piecewise` is one of what is made with it: `x*step(x)` does not jump at 0,
//! nor does `step(x)` where the bounds keep `x` away from there.

use crate::expressions::graph::builtins::Builtin;
use crate::expressions::graph::{Expr, ExprId};
use crate::model::Symbol;
use crate::resolve::elaborator::knots::{Knot, Site};
use crate::resolve::elaborator::{Elaborator, Usage};
use crate::surfaces::{Order, View, at_guards};

/// How smooth a value is where a guard of a definition in it changes. Of a value that is not known,
/// what the definition says.
pub(super) fn order(
    meaning: &Elaborator<'_>,
    view: &View<'_>,
    usage: &Usage<'_>,
    site: &Site<'_>,
    knot: &Knot<'_>,
) -> Order {
    let values = with_integrands(meaning, usage.parts.as_slice());
    if values.is_empty() {
        return knot.order.checked_sub(1).map_or(Order::Jumps, |times| Order::Times(times as u32));
    }
    let switches = switches(meaning, &values);
    let is_own = |sides: &[ExprId; 2]| site.guards.contains(&(knot.at, *sides));
    let own: Vec<[ExprId; 2]> = switches.iter().copied().filter(is_own).collect();
    // At an end of time the guards have other inputs.
    let guards = if own.is_empty() { switches } else { own };
    at_guards(view, &values, &guards)
}

/// Components, and what the integrals in them integrate.
fn with_integrands(meaning: &Elaborator<'_>, parts: &[ExprId]) -> Vec<ExprId> {
    let inputs = meaning.graph.inputs_of(parts).into_iter();
    let integrands = inputs.filter_map(|input| match meaning.symbols[input as usize] {
        Symbol::Integral(at) => Some(meaning.integrals[at].integrand),
        Symbol::Sum(at) => Some(meaning.model.sums[at].term),
        _ => None,
    });
    parts.iter().copied().chain(integrands).collect()
}

/// The two sides of every guard in some values.
fn switches(meaning: &Elaborator<'_>, values: &[ExprId]) -> Vec<[ExprId; 2]> {
    let nodes = meaning.graph.reachable(values).into_iter();
    let guards = nodes.filter_map(|node| match meaning.graph.expr(node) {
        Expr::Call(Builtin::SelectLe, operands) => Some([operands[0], operands[1]]),
        _ => None,
    });
    guards.collect()
}
