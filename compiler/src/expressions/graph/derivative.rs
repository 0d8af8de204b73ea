//! Derivatives of expressions, as expressions of the same graph.
//!
//! ```text
//! adjoint(y) = 1,  adjoint(a) = sum over the calls c that use a of adjoint(c) * dc/da
//! ```
//!
//! in reverse mode.

use super::builtins::Builtin;
use super::{ById, Expr, ExprId, Graph, Operands};

/// The derivative of `expr` by one input.
pub fn derivative(graph: &mut Graph, expr: ExprId, input: u32) -> ExprId {
    tangents(graph, &[expr], input)[0]
}

/// The derivatives of one expression by several inputs (reverse mode).
pub fn gradient(graph: &mut Graph, output: ExprId, by: &[u32]) -> Vec<ExprId> {
    let active = active(graph, &[output], by);
    let one = graph.number(1.0);
    let mut adjoints = ById::from_iter([(output, one)]);
    for &id in active.iter().rev() {
        let Some(&adjoint) = adjoints.get(&id) else { continue };
        let Expr::Call(builtin, operands) = graph.expr(id).clone() else { continue };
        for (which, operand) in operands.iter().enumerate() {
            if active.binary_search(operand).is_ok() {
                let term = chain(graph, builtin, id, &operands, which, adjoint);
                let sum = match adjoints.get(operand) {
                    Some(&sum) => graph.add(sum, term),
                    None => term,
                };
                adjoints.insert(*operand, sum);
            }
        }
    }
    by.iter()
        .map(|&input| {
            let input = graph.input(input);
            adjoints.get(&input).copied().unwrap_or_else(|| graph.number(0.0))
        })
        .collect()
}

/// The derivatives of several expressions by one input (forward mode).
pub(crate) fn tangents(graph: &mut Graph, outputs: &[ExprId], input: u32) -> Vec<ExprId> {
    let one = graph.number(1.0);
    let mut tangents = ById::from_iter([(graph.input(input), one)]);
    for id in active(graph, outputs, &[input]) {
        let Expr::Call(builtin, operands) = graph.expr(id).clone() else { continue };
        let mut sum = graph.number(0.0);
        for (which, operand) in operands.iter().enumerate() {
            if let Some(&tangent) = tangents.get(operand) {
                let term = chain(graph, builtin, id, &operands, which, tangent);
                sum = graph.add(sum, term);
            }
        }
        tangents.insert(id, sum);
    }
    let zero = graph.number(0.0);
    outputs.iter().map(|output| tangents.get(output).copied().unwrap_or(zero)).collect()
}

/// `factor * d call / d operand`.
fn chain(
    graph: &mut Graph,
    builtin: Builtin,
    call: ExprId,
    operands: &Operands,
    which: usize,
    factor: ExprId,
) -> ExprId {
    let partial = (builtin.row().partial)(graph, call, operands, which);
    graph.mul(factor, partial)
}

/// Everything between the inputs and the outputs, ascending.
fn active(graph: &Graph, outputs: &[ExprId], by: &[u32]) -> Vec<ExprId> {
    let mut active: Vec<ExprId> = Vec::new();
    for id in graph.reachable(outputs) {
        let depends = match graph.expr(id) {
            Expr::Input(position) => by.contains(position),
            Expr::Call(_, operands) => {
                operands.iter().any(|operand| active.binary_search(operand).is_ok())
            }
            _ => false,
        };
        if depends {
            active.push(id);
        }
    }
    active
}
