//! The interpreter: the meaning of an expression. Machine code must agree with it.

use super::{Expr, ExprId, FEW, Graph};
use smallvec::SmallVec;

/// The values of `roots` at one point.
pub fn evaluate(graph: &Graph, roots: &[ExprId], inputs: &[f64], multipliers: &[f64]) -> Vec<f64> {
    evaluate_with(graph, roots, |input| inputs[input as usize], multipliers)
}

/// The same with a function that gives the inputs that are needed.
pub(crate) fn evaluate_with(
    graph: &Graph,
    roots: &[ExprId],
    inputs: impl Fn(u32) -> f64,
    multipliers: &[f64],
) -> Vec<f64> {
    let needed = graph.reachable(roots);
    let size = needed.last().map_or(0, |last| last.index() + 1);
    // Little of a large graph costs little.
    let is_little = needed.len() <= FEW;
    let place = |id: ExprId| match is_little {
        true => needed.binary_search(&id).unwrap_or(size),
        false => id.index(),
    };
    let mut values = vec![f64::NAN; if is_little { needed.len() } else { size }];
    for &id in &needed {
        values[place(id)] = match graph.expr(id) {
            Expr::Number(bits) => bits.value(),
            Expr::Input(position) => inputs(*position),
            Expr::Multiplier(output) => multipliers[*output as usize],
            Expr::Call(builtin, operands) => {
                let operands: SmallVec<[f64; 4]> =
                    operands.iter().map(|id| values[place(*id)]).collect();
                (builtin.row().value)(&operands)
            }
        };
    }
    roots.iter().map(|root| values[place(*root)]).collect()
}
