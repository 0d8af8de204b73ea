//! The interpreter: the meaning of an expression. Machine code must agree with it.

use super::{Expr, ExprId, Graph};
use smallvec::SmallVec;

/// The values of `roots` at one point.
pub fn evaluate(graph: &Graph, roots: &[ExprId], inputs: &[f64], multipliers: &[f64]) -> Vec<f64> {
    let needed = graph.reachable(roots);
    let mut values = vec![f64::NAN; needed.last().map_or(0, |last| last.index() + 1)];
    for id in needed {
        values[id.index()] = match graph.expr(id) {
            Expr::Number(bits) => bits.value(),
            Expr::Input(position) => inputs[*position as usize],
            Expr::Multiplier(output) => multipliers[*output as usize],
            Expr::Call(builtin, operands) => {
                let operands: SmallVec<[f64; 4]> =
                    operands.iter().map(|id| values[id.index()]).collect();
                (builtin.row().value)(&operands)
            }
        };
    }
    roots.iter().map(|root| values[root.index()]).collect()
}
