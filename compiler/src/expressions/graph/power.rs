//! Powers with a whole or half exponent as products and square roots.

use super::{ExprId, Graph};

/// Whole exponents up to this size become multiplications.
const LARGEST_EXPANDED_EXPONENT: f64 = 64.0;

/// `x^n` as products, `x^(n + 1/2)` with a square root; nothing for other exponents.
pub(super) fn pow(graph: &mut Graph, base: ExprId, exponent: ExprId) -> Option<ExprId> {
    let exponent =
        graph.as_number(exponent).filter(|number| number.abs() <= LARGEST_EXPANDED_EXPONENT)?;
    let halves = 2.0 * exponent;
    if halves.fract() != 0.0 {
        return None;
    }
    // x^n = x * x * ... * x
    let mut power = whole_power(graph, base, halves.abs() as u32 / 2);
    // x^(n + 1/2) = x^n sqrt(x)
    if exponent.fract() != 0.0 {
        let root = graph.sqrt(base);
        power = graph.mul(power, root);
    }
    // x^(-n) = 1 / x^n
    Some(if exponent < 0.0 { graph.reciprocal(power) } else { power })
}

/// Repeated squaring.
fn whole_power(graph: &mut Graph, base: ExprId, exponent: u32) -> ExprId {
    if exponent == 0 {
        return graph.number(1.0);
    }
    let root = whole_power(graph, base, exponent / 2);
    let square = graph.square(root);
    if exponent % 2 == 1 { graph.mul(square, base) } else { square }
}
