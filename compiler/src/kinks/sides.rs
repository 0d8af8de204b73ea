//! Conditions with kinks, as one for each side of each: `|a| + |b| <= 1` is four conditions.
//!
//! A kink is the larger of its sides, or the smaller. Where a condition grows with the larger and
//! has no lower bound, it holds if it holds with both; so it does where it falls with the smaller,
//! and the other way round for lower bounds.
//!
//! A length has a kink at 0: `sqrt(s) <= c` is `(s/c + c)/2 <= c`, whose value and slope are the
//! same where it holds as an equality.

use super::Kink;
use super::bent::{Tried, replaced};
use crate::expressions::graph::builtins::Builtin;
use crate::expressions::graph::derivative::derivative;
use crate::expressions::graph::{ExprId, Graph};
use crate::model::{Constraint, Range};

/// Conditions with more kinks are left as they are.
const MOST: usize = 4;

/// What is bounded in place of a length with an upper bound above 0 and no lower one; nothing where
/// it is none. `number` is the value of what is known beforehand.
pub(super) fn length(
    graph: &mut Graph,
    row: &Constraint,
    number: &dyn Fn(&Graph, ExprId) -> f64,
) -> Option<ExprId> {
    let Range { lower, upper } = row.range;
    let &[square] = graph.as_call(row.value, Builtin::Sqrt)? else { return None };
    let is_length = is_sum_of_squares(graph, square) && number(graph, lower) <= 0.0;
    let bound = number(graph, upper);
    (is_length && bound > 0.0 && bound.is_finite()).then(|| {
        let part = graph.div(square, upper);
        let twice = graph.add(part, upper);
        graph.scale(0.5, twice)
    })
}

/// What is bounded in place of the value of a condition, the first of these with all kinks above;
/// nothing where it has no kinks, or not of this kind. `symbols` inputs have a meaning.
pub(super) fn sides(graph: &mut Graph, symbols: usize, row: &Constraint) -> Option<Vec<ExprId>> {
    let (kinks, rewritten) = replaced(graph, symbols, &[row.value], Kink::of);
    let is_inside = |it: &Tried| graph.inputs_of(&[it.e]).iter().any(|at| *at as usize >= symbols);
    if kinks.is_empty() || kinks.len() > MOST || kinks.iter().any(is_inside) {
        return None;
    }
    let is_open = |bound: ExprId| graph.as_number(bound).is_some_and(f64::is_infinite);
    let [below, above] = [row.range.lower, row.range.upper].map(is_open);
    for it in &kinks {
        let slope = derivative(graph, rewritten[0], it.input);
        let slope = graph.as_number(slope)?;
        let is_divided = slope == 0.0 || if slope > 0.0 { below } else { above };
        is_divided.then_some(())?;
    }
    let mut values = rewritten;
    for Tried { e, input, .. } in kinks {
        let sides = [graph.number(0.0), graph.neg(e)];
        let with = |side: ExprId| graph.substitute(&values, &|at| (at == input).then_some(side));
        values = sides.map(with).concat();
    }
    Some(values)
}

/// Whether the root of an expression is a length.
fn is_sum_of_squares(graph: &Graph, id: ExprId) -> bool {
    if let Some(&[a, b]) = graph.as_call(id, Builtin::Add) {
        return is_sum_of_squares(graph, a) && is_sum_of_squares(graph, b);
    }
    let Some(&[a, b]) = graph.as_call(id, Builtin::Mul) else { return false };
    let is_scaled = |scale: ExprId, of: ExprId| {
        graph.as_number(scale).is_some_and(|it| it > 0.0) && is_sum_of_squares(graph, of)
    };
    a == b || is_scaled(a, b) || is_scaled(b, a)
}
