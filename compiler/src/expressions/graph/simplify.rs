//! Local identities, each stated above its code. A node is simplified when it is made.
//!
//! Normal forms: a product carries at most one number, in front; a negation stands outside
//! products; a quotient is a product with a reciprocal, so that one division serves everything over
//! the same denominator; operands of `+` and `*` are sorted. Each identity holds wherever the left
//! side has a finite value, up to rounding.

use super::builtins::{Builtin, Parity};
use super::power::pow;
use super::products::{div, mul};
use super::{Expr, ExprId, Graph, Operands};

/// The simplest known equal of `builtin(operands)`.
pub(super) fn simplify(graph: &mut Graph, builtin: Builtin, operands: &[ExprId]) -> ExprId {
    if let Some(folded) = fold(graph, builtin, operands) {
        return folded;
    }
    let simpler = match *operands {
        [a, b] => binary(graph, builtin, a, b),
        [a] => unary(graph, builtin, a),
        [a, b, x, y] => select(graph, a, b, x, y),
        _ => None,
    };
    simpler.unwrap_or_else(|| keep(graph, builtin, operands))
}

pub(super) fn keep(graph: &mut Graph, builtin: Builtin, operands: &[ExprId]) -> ExprId {
    graph.intern(Expr::Call(builtin, Operands::from_slice(operands)))
}

// f(numbers) = number, if finite or a side without a bound: anything else is left to be met, and
// reported, when it is evaluated.
fn fold(graph: &mut Graph, builtin: Builtin, operands: &[ExprId]) -> Option<ExprId> {
    let numbers: Option<Vec<f64>> =
        operands.iter().map(|&operand| graph.as_number(operand)).collect();
    let numbers = numbers?;
    let value = (builtin.row().value)(&numbers);
    let is_open = value.is_infinite() && numbers.iter().any(|number| number.is_infinite());
    (value.is_finite() || is_open).then(|| graph.number(value))
}

fn binary(graph: &mut Graph, builtin: Builtin, a: ExprId, b: ExprId) -> Option<ExprId> {
    match builtin {
        Builtin::Add => Some(add(graph, a, b)),
        Builtin::Sub => Some(sub(graph, a, b)),
        Builtin::Mul => Some(mul(graph, a, b)),
        Builtin::Div => div(graph, a, b),
        Builtin::Pow => pow(graph, a, b),
        // min(x, x) = max(x, x) = x
        Builtin::Min | Builtin::Max => (a == b).then_some(a),
        _ => None,
    }
}

fn unary(graph: &mut Graph, builtin: Builtin, a: ExprId) -> Option<ExprId> {
    if builtin == Builtin::Neg {
        return Some(neg(graph, a));
    }
    let (factor, _) = split(graph, a);
    if factor >= 0.0 || graph.as_number(a).is_some() {
        return None;
    }
    match builtin.row().parity {
        // f(-x) = f(x)
        Parity::Even => {
            let positive = graph.neg(a);
            Some(graph.call(builtin, &[positive]))
        }
        // f(-x) = -f(x)
        Parity::Odd => {
            let positive = graph.neg(a);
            let call = graph.call(builtin, &[positive]);
            Some(graph.neg(call))
        }
        Parity::Neither => None,
    }
}

/// `a = factor * rest` with the number of a product, or the sign of a negation, as the factor.
pub(super) fn split(graph: &Graph, a: ExprId) -> (f64, ExprId) {
    if let Some(operands) = graph.as_call(a, Builtin::Neg) {
        return (-1.0, operands[0]);
    }
    match graph.as_call(a, Builtin::Mul) {
        Some(operands) => {
            graph.as_number(operands[0]).map_or((1.0, a), |factor| (factor, operands[1]))
        }
        None => (1.0, a),
    }
}

/// How deep constants without a value are recognised.
const DEEPEST_CONSTANT: usize = 8;

/// Whether an expression may have a finite value: constants that have one are folded, so one that
/// is still there, such as `1 / 0`, has none.
fn has_value(graph: &Graph, a: ExprId) -> bool {
    graph.as_number(a).is_some() || !is_constant(graph, a, DEEPEST_CONSTANT)
}

fn is_constant(graph: &Graph, a: ExprId, depth: usize) -> bool {
    match graph.expr(a) {
        Expr::Number(_) => true,
        Expr::Call(_, operands) if depth > 0 => {
            operands.iter().all(|&operand| is_constant(graph, operand, depth - 1))
        }
        _ => false,
    }
}

/// `factor * rest` for a rest without a factor of its own.
pub(super) fn join(graph: &mut Graph, factor: f64, rest: ExprId) -> ExprId {
    if factor == 0.0 && has_value(graph, rest) {
        // 0 * x = 0
        graph.number(0.0)
    } else if factor == 1.0 {
        // 1 * x = x
        rest
    } else if factor == -1.0 {
        // -1 * x = -x
        keep(graph, Builtin::Neg, &[rest])
    } else {
        let factor = graph.number(factor);
        keep(graph, Builtin::Mul, &[factor, rest])
    }
}

fn neg(graph: &mut Graph, a: ExprId) -> ExprId {
    // -(x - y) = y - x
    if let Some(&[x, y]) = graph.as_call(a, Builtin::Sub) {
        return graph.sub(y, x);
    }
    // -(c x) = (-c) x, -(-x) = x
    let (factor, rest) = split(graph, a);
    join(graph, -factor, rest)
}

fn add(graph: &mut Graph, a: ExprId, b: ExprId) -> ExprId {
    let (a, b) = sorted(graph, a, b);
    if let Some(number) = graph.as_number(a) {
        return add_number(graph, number, b);
    }
    let ((c, x), (d, y)) = (split(graph, a), split(graph, b));
    // c x + d x = (c + d) x
    if x == y {
        return join(graph, c + d, x);
    }
    // x + (-y) = x - y, (-x) + y = y - x
    if d == -1.0 {
        return graph.sub(a, y);
    }
    if c == -1.0 {
        return graph.sub(b, x);
    }
    merge_selections(graph, Builtin::Add, a, b)
        .unwrap_or_else(|| keep(graph, Builtin::Add, &[a, b]))
}

fn add_number(graph: &mut Graph, number: f64, b: ExprId) -> ExprId {
    // 0 + x = x
    if number == 0.0 {
        return b;
    }
    // c + (d + x) = (c + d) + x
    if let Some(&[d, x]) = graph.as_call(b, Builtin::Add)
        && let Some(inner) = graph.as_number(d)
    {
        let total = graph.number(number + inner);
        return graph.add(total, x);
    }
    let number_id = graph.number(number);
    // c + (-x) = c - x
    match split(graph, b) {
        (-1.0, x) => graph.sub(number_id, x),
        _ => keep(graph, Builtin::Add, &[number_id, b]),
    }
}

fn sub(graph: &mut Graph, a: ExprId, b: ExprId) -> ExprId {
    // x - c = -c + x
    if let Some(number) = graph.as_number(b) {
        let negative = graph.number(-number);
        return graph.add(negative, a);
    }
    // 0 - x = -x
    if graph.as_number(a) == Some(0.0) {
        return graph.neg(b);
    }
    let ((c, x), (d, y)) = (split(graph, a), split(graph, b));
    // c x - d x = (c - d) x
    if x == y {
        return join(graph, c - d, x);
    }
    // x - (-y) = x + y, (-x) - y = -(x + y)
    if d == -1.0 {
        return graph.add(a, y);
    }
    if c == -1.0 {
        let sum = graph.add(x, b);
        return graph.neg(sum);
    }
    merge_selections(graph, Builtin::Sub, a, b)
        .unwrap_or_else(|| keep(graph, Builtin::Sub, &[a, b]))
}

// select(p <= q, x, y) + select(p <= q, u, v) = select(p <= q, x + u, y + v), and so for
// differences
fn merge_selections(graph: &mut Graph, operator: Builtin, a: ExprId, b: ExprId) -> Option<ExprId> {
    let &[p, q, x, y] = graph.as_call(a, Builtin::SelectLe)? else { return None };
    let &[r, s, u, v] = graph.as_call(b, Builtin::SelectLe)? else { return None };
    ((p, q) == (r, s)).then(|| {
        let (yes, no) = (graph.call(operator, &[x, u]), graph.call(operator, &[y, v]));
        graph.select_le(p, q, yes, no)
    })
}

fn select(graph: &mut Graph, a: ExprId, b: ExprId, x: ExprId, y: ExprId) -> Option<ExprId> {
    // select(p <= q, x, x) = x, select(p <= p, x, y) = x
    if x == y || a == b {
        return Some(x);
    }
    // a comparison of numbers is known
    if let (Some(a), Some(b)) = (graph.as_number(a), graph.as_number(b)) {
        return Some(if a <= b { x } else { y });
    }
    // select(p <= q, select(p <= q, x, _), y) = select(p <= q, x, y), and so on the other side
    let inner = |branch: ExprId, which: usize| {
        let operands = graph.as_call(branch, Builtin::SelectLe)?;
        (operands[..2] == [a, b]).then(|| operands[which])
    };
    let (taken, other) = (inner(x, 2), inner(y, 3));
    if taken.is_none() && other.is_none() {
        return None;
    }
    Some(graph.select_le(a, b, taken.unwrap_or(x), other.unwrap_or(y)))
}

/// x + y = y + x, x y = y x: numbers first, then by age.
pub(super) fn sorted(graph: &Graph, a: ExprId, b: ExprId) -> (ExprId, ExprId) {
    let key = |id: ExprId| (graph.as_number(id).is_none(), id);
    if key(a) <= key(b) { (a, b) } else { (b, a) }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Builds both sides of an identity in x, y and z.
    type Identity = fn(&mut Graph, ExprId, ExprId, ExprId) -> (ExprId, ExprId);

    const IDENTITIES: &[(&str, Identity)] = &[
        ("x / x = 1", |g, x, _, _| (g.div(x, x), g.number(1.0))),
        ("(x y) / y = x", |g, x, y, _| (cancelled(g, x, y), x)),
        ("(x y) / x = y", |g, x, y, _| (cancelled(g, y, x), y)),
        ("1 / (1 / x) = x", |g, x, _, _| {
            let reciprocal = g.reciprocal(x);
            (g.reciprocal(reciprocal), x)
        }),
        ("x + x = 2 x", |g, x, _, _| (g.add(x, x), g.scale(2.0, x))),
        ("3 x - 2 x = x", |g, x, _, _| {
            let (three, two) = (g.scale(3.0, x), g.scale(2.0, x));
            (g.sub(three, two), x)
        }),
        ("(2 x) (3 y) = 6 (y x)", |g, x, y, _| {
            let (two, three, product) = (g.scale(2.0, x), g.scale(3.0, y), g.mul(y, x));
            (g.mul(two, three), g.scale(6.0, product))
        }),
        ("x^3 = (x x) x", |g, x, _, _| {
            let (three, square) = (g.number(3.0), g.square(x));
            (g.pow(x, three), g.mul(square, x))
        }),
        ("x^(-1/2) = 1 / sqrt(x)", |g, x, _, _| {
            let (exponent, root) = (g.number(-0.5), g.sqrt(x));
            (g.pow(x, exponent), g.reciprocal(root))
        }),
        ("sin(-2 x) = -sin(2 x)", |g, x, _, _| {
            let (minus, plus) = (g.scale(-2.0, x), g.scale(2.0, x));
            let sine = g.sin(plus);
            (g.sin(minus), g.neg(sine))
        }),
        ("a branch knows that its condition holds", |g, x, y, z| {
            let inner = g.select_le(x, y, z, x);
            (g.select_le(x, y, inner, y), g.select_le(x, y, z, y))
        }),
        ("a branch knows that its condition fails", |g, x, y, z| {
            let inner = g.select_le(x, y, z, x);
            (g.select_le(x, y, y, inner), g.select_le(x, y, y, x))
        }),
        ("both branches the same", |g, x, y, z| (g.select_le(x, y, z, z), z)),
        ("a known comparison", |g, x, y, _| {
            let (one, two) = (g.number(1.0), g.number(2.0));
            (g.select_le(two, one, x, y), y)
        }),
        ("select(c, x, 0) y = select(c, x y, 0)", |g, x, y, z| {
            let (zero, product) = (g.number(0.0), g.mul(x, z));
            let gated = g.select_le(x, y, x, zero);
            (g.mul(gated, z), g.select_le(x, y, product, zero))
        }),
    ];

    fn cancelled(graph: &mut Graph, x: ExprId, y: ExprId) -> ExprId {
        let product = graph.mul(x, y);
        graph.div(product, y)
    }

    #[test]
    fn identities_hold() {
        for (name, identity) in IDENTITIES {
            let mut graph = Graph::new();
            let [x, y, z] = [0, 1, 2].map(|input| graph.input(input));
            let (left, right) = identity(&mut graph, x, y, z);
            assert_eq!(left, right, "{name}");
        }
    }

    #[test]
    fn what_has_no_finite_value_is_not_folded() {
        let mut graph = Graph::new();
        let zero = graph.number(0.0);
        let infinite = graph.log(zero);
        assert_eq!(graph.as_number(infinite), None);
    }
}
