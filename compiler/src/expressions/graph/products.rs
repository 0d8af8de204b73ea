//! Identities of products and quotients, each stated above its code.

use super::builtins::Builtin;
use super::simplify::{join, keep, sorted, split};
use super::{ExprId, Graph};

pub(super) fn mul(graph: &mut Graph, a: ExprId, b: ExprId) -> ExprId {
    let (a, b) = sorted(graph, a, b);
    let ((c, x), (d, y)) = (split(graph, a), split(graph, b));
    // c (d x) = (c d) x
    if let Some(number) = graph.as_number(a) {
        return join(graph, number * d, y);
    }
    // (c x) (d y) = (c d) (x y)
    if c != 1.0 || d != 1.0 {
        let product = graph.mul(x, y);
        return graph.scale(c * d, product);
    }
    cancel(graph, a, b)
        .or_else(|| cancel(graph, b, a))
        .or_else(|| gate(graph, a, b))
        .or_else(|| gate(graph, b, a))
        .unwrap_or_else(|| keep(graph, Builtin::Mul, &[a, b]))
}

fn cancel(graph: &mut Graph, a: ExprId, b: ExprId) -> Option<ExprId> {
    let denominator = reciprocal_of(graph, b)?;
    // x * (1 / x) = 1
    if a == denominator {
        return Some(graph.number(1.0));
    }
    // (x y) * (1 / y) = x
    match *graph.as_call(a, Builtin::Mul)? {
        [x, y] if y == denominator => Some(x),
        [y, x] if y == denominator => Some(x),
        _ => None,
    }
}

/// Keeps what is infinite or undefined on the side not taken out of derivatives.
fn gate(graph: &mut Graph, a: ExprId, factor: ExprId) -> Option<ExprId> {
    let &[p, q, x, y] = graph.as_call(a, Builtin::SelectLe)? else { return None };
    let zero = graph.number(0.0);
    // select(p <= q, x, 0) * z = select(p <= q, x z, 0)
    if y == zero {
        let product = graph.mul(x, factor);
        return Some(graph.select_le(p, q, product, zero));
    }
    // select(p <= q, 0, y) * z = select(p <= q, 0, y z)
    (x == zero).then(|| {
        let product = graph.mul(y, factor);
        graph.select_le(p, q, zero, product)
    })
}

pub(super) fn div(graph: &mut Graph, a: ExprId, b: ExprId) -> Option<ExprId> {
    if graph.as_number(a) == Some(1.0) {
        return reciprocal(graph, b);
    }
    // x / c = (1/c) x, x / y = x * (1 / y)
    let one = graph.number(1.0);
    let reciprocal = graph.div(one, b);
    Some(graph.mul(a, reciprocal))
}

fn reciprocal(graph: &mut Graph, b: ExprId) -> Option<ExprId> {
    // 1 / (1 / x) = x
    if let Some(x) = reciprocal_of(graph, b) {
        return Some(x);
    }
    // 1 / (c x) = (1/c) (1 / x)
    let (factor, rest) = split(graph, b);
    (factor != 1.0).then(|| {
        let reciprocal = graph.reciprocal(rest);
        graph.scale(1.0 / factor, reciprocal)
    })
}

fn reciprocal_of(graph: &Graph, a: ExprId) -> Option<ExprId> {
    let operands = graph.as_call(a, Builtin::Div)?;
    (graph.as_number(operands[0]) == Some(1.0)).then_some(operands[1])
}
