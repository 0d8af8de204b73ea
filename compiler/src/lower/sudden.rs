//! Which rates may do something sudden between any points where they are looked at.
//!
//! Along a step states and controls are polynomials in time, and so is a polynomial of them: of a
//! low degree, it is known from a few of its values. A pulse needs another function, such as
//! `tanh`, `exp`, or a quotient.

use super::function::VectorFunction;
use crate::expressions::graph::builtins::Builtin;
use crate::expressions::graph::{ById, Expr, Graph};
use fdcc_runtime::problem::Layout;

/// Polynomials of time, states and controls up to this degree do nothing sudden.
const MOST_DEGREE: u32 = 4;

/// The outputs that are no polynomials of a low degree, ascending.
pub(super) fn sudden(graph: &Graph, layout: &Layout, flow: &VectorFunction) -> Vec<usize> {
    let moving = 0..layout.controls().end;
    let mut degrees: ById<u32> = ById::default();
    for id in graph.reachable(&flow.outputs) {
        let degree = match graph.expr(id) {
            Expr::Input(position) => u32::from(moving.contains(&(*position as usize))),
            Expr::Call(builtin, operands) => {
                let operands: Vec<u32> = operands.iter().map(|operand| degrees[operand]).collect();
                degree(*builtin, &operands)
            }
            _ => 0,
        };
        degrees.insert(id, degree);
    }
    let is_sudden = |row: &usize| degrees[&flow.outputs[*row]] > MOST_DEGREE;
    (0..flow.outputs.len()).filter(is_sudden).collect()
}

/// The degree as a polynomial, given those of the operands; one more than the most stands for all
/// else.
fn degree(builtin: Builtin, operands: &[u32]) -> u32 {
    let highest = operands.iter().copied().max().unwrap_or(0);
    match builtin {
        Builtin::Add | Builtin::Sub | Builtin::Neg => highest,
        Builtin::Mul => operands.iter().sum::<u32>().min(MOST_DEGREE + 1),
        Builtin::Div if operands[1] == 0 => highest,
        _ if highest == 0 => 0,
        _ => MOST_DEGREE + 1,
    }
}
