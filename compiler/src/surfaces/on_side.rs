//! An expression as it is near a point, with the branch of every switch that is taken there.
//!
//! Only what is reached is looked at: of a curve through n points the way to one of its pieces.

use crate::expressions::graph::builtins::Builtin;
use crate::expressions::graph::{ById, Expr, ExprId, Graph, Operands};
use smallvec::SmallVec;

/// Each node that was reached, with the same node without switches and its value.
type Known = ById<(ExprId, f64)>;

/// The expression with every switch replaced by the branch that is taken near a point.
pub(super) fn on_side(graph: &mut Graph, root: ExprId, near: &[f64]) -> ExprId {
    let mut known = Known::default();
    let mut stack = vec![root];
    while let Some(&id) = stack.last() {
        let before = stack.len();
        if !known.contains_key(&id) {
            let needed = needed(graph, id, &known);
            stack.extend(needed.iter().filter(|it| !known.contains_key(it)));
        }
        if stack.len() == before {
            stack.pop();
            if !known.contains_key(&id) {
                let side = side(graph, id, near, &known);
                known.insert(id, side);
            }
        }
    }
    known[&root].0
}

/// What has to be known of a node: its operands, of a selection the branch once that is chosen.
fn needed(graph: &Graph, id: ExprId, known: &Known) -> Operands {
    match graph.expr(id) {
        Expr::Call(Builtin::SelectLe, operands) => {
            let sides = [0, 1].map(|at| known.get(&operands[at]));
            match sides {
                [Some(left), Some(right)] => {
                    Operands::from_slice(&[operands[if left.1 <= right.1 { 2 } else { 3 }]])
                }
                _ => Operands::from_slice(&operands[..2]),
            }
        }
        Expr::Call(_, operands) => operands.clone(),
        _ => Operands::new(),
    }
}

/// A node whose operands are known.
fn side(graph: &mut Graph, id: ExprId, near: &[f64], known: &Known) -> (ExprId, f64) {
    let (builtin, operands) = match graph.expr(id) {
        Expr::Number(bits) => return (id, bits.value()),
        Expr::Input(position) => return (id, near[*position as usize]),
        Expr::Multiplier(_) => return (id, f64::NAN),
        Expr::Call(builtin, operands) => (*builtin, operands.clone()),
    };
    if builtin == Builtin::SelectLe {
        return known[&needed(graph, id, known)[0]];
    }
    let now: SmallVec<[(ExprId, f64); 4]> = operands.iter().map(|it| known[it]).collect();
    let is_less = now.len() > 1 && now[0].1 <= now[1].1;
    match (builtin, is_less) {
        (Builtin::Abs, _) if now[0].1 < 0.0 => (graph.neg(now[0].0), -now[0].1),
        (Builtin::Abs, _) | (Builtin::Min, true) | (Builtin::Max, false) => now[0],
        (Builtin::Min, false) | (Builtin::Max, true) => now[1],
        _ => {
            let exprs: Operands = now.iter().map(|it| it.0).collect();
            let values: SmallVec<[f64; 4]> = now.iter().map(|it| it.1).collect();
            (graph.call(builtin, &exprs), (builtin.row().value)(&values))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// `abs(min(x, 1))` for `x <= 3`, else `x^2`.
    #[test]
    fn each_switch_is_the_branch_that_is_taken() {
        let mut graph = Graph::new();
        let x = graph.input(0);
        let [one, three] = [1.0, 3.0].map(|number| graph.number(number));
        let (least, square, minus) = (graph.min(x, one), graph.square(x), graph.neg(x));
        let size = graph.abs(least);
        let root = graph.select_le(x, three, size, square);
        for (place, side) in [(-2.0, minus), (0.5, x), (2.0, one), (4.0, square)] {
            assert_eq!(on_side(&mut graph, root, &[place]), side, "{place}");
        }
    }
}
