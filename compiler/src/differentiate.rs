//! Exact derivatives, as expressions of the same graph.
//!
//! ```text
//! adjoint(y) = 1,  adjoint(a) = sum over the calls c that use a of adjoint(c) * dc/da     (reverse mode)
//! Jacobian row i = adjoints of y_i at the inputs
//! L = sum_i multiplier(i) y_i,  Hessian column k = tangent of the gradient of L in direction z_k
//! ```
//!
//! Hash-consing shares whatever value, Jacobian and Hessian have in common. An entry is in a
//! pattern unless it simplifies to the number 0.

use fdcc_runtime::problem::{Degree, Pattern};

use crate::builtins::Builtin;
use crate::graph::{ById, Expr, ExprId, Graph, Operands};
use crate::program::{Differentiated, Order, VectorFunction};

/// The derivative of `expr` by one input.
pub fn derivative(graph: &mut Graph, expr: ExprId, input: u32) -> ExprId {
    tangents(graph, &[expr], input)[0]
}

/// Adds the Jacobian, the Lagrangian Hessian and the degrees.
pub fn differentiate(graph: &mut Graph, function: VectorFunction) -> Differentiated {
    let jacobian = jacobian(graph, &function);
    let hessian = match function.order {
        Order::First => (Pattern::default(), Vec::new()),
        Order::Second => hessian(graph, &function),
    };
    let degrees = degrees(graph, &function);
    Differentiated { function, jacobian, hessian, degrees }
}

fn jacobian(graph: &mut Graph, function: &VectorFunction) -> (Pattern, Vec<ExprId>) {
    let mut matrix = Matrix::new(graph, function.outputs.len(), function.layout.inputs());
    for (row, &output) in function.outputs.iter().enumerate() {
        let gradient = gradient(graph, output, &function.by);
        for (&column, entry) in function.by.iter().zip(gradient) {
            matrix.push(row as u32, column, entry);
        }
    }
    matrix.finish()
}

fn hessian(graph: &mut Graph, function: &VectorFunction) -> (Pattern, Vec<ExprId>) {
    let lagrangian = lagrangian(graph, &function.outputs);
    let gradient = gradient(graph, lagrangian, &function.by);
    let columns: Vec<Vec<ExprId>> = (0..function.by.len())
        .map(|column| tangents(graph, &gradient[column..], function.by[column]))
        .collect();
    let inputs = function.layout.inputs();
    let mut matrix = Matrix::new(graph, inputs, inputs);
    for (i, &row) in function.by.iter().enumerate() {
        for (j, &column) in function.by[..=i].iter().enumerate() {
            matrix.push(row, column, columns[j][i - j]);
        }
    }
    matrix.finish()
}

fn lagrangian(graph: &mut Graph, outputs: &[ExprId]) -> ExprId {
    let terms: Vec<ExprId> = outputs
        .iter()
        .enumerate()
        .map(|(index, &output)| {
            let multiplier = graph.multiplier(index as u32);
            graph.mul(multiplier, output)
        })
        .collect();
    graph.sum(&terms)
}

/// A sparse matrix of expressions in the making, filled by rows, then columns.
struct Matrix {
    zero: ExprId,
    pattern: Pattern,
    entries: Vec<ExprId>,
}

impl Matrix {
    fn new(graph: &mut Graph, rows: usize, columns: usize) -> Self {
        let pattern = Pattern { rows, columns, entries: Vec::new() };
        Matrix { zero: graph.number(0.0), pattern, entries: Vec::new() }
    }
    fn push(&mut self, row: u32, column: u32, entry: ExprId) {
        if entry != self.zero {
            self.pattern.entries.push((row, column));
            self.entries.push(entry);
        }
    }
    fn finish(self) -> (Pattern, Vec<ExprId>) {
        (self.pattern, self.entries)
    }
}

/// The derivatives of one expression by several inputs (reverse mode).
pub(crate) fn gradient(graph: &mut Graph, output: ExprId, by: &[u32]) -> Vec<ExprId> {
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
fn tangents(graph: &mut Graph, outputs: &[ExprId], input: u32) -> Vec<ExprId> {
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

fn degrees(graph: &Graph, function: &VectorFunction) -> Vec<Degree> {
    let mut degrees: ById<u32> = ById::default();
    for id in graph.reachable(&function.outputs) {
        let degree = match graph.expr(id) {
            Expr::Input(position) => u32::from(function.by.contains(position)),
            Expr::Call(builtin, operands) => {
                let operands: Vec<u32> = operands.iter().map(|operand| degrees[operand]).collect();
                polynomial_degree(*builtin, &operands)
            }
            _ => 0,
        };
        degrees.insert(id, degree);
    }
    function.outputs.iter().map(|output| class(degrees[output])).collect()
}

fn class(degree: u32) -> Degree {
    match degree {
        0 | 1 => Degree::Affine,
        2 => Degree::Quadratic,
        _ => Degree::Nonlinear,
    }
}

/// The degree as a polynomial, given those of the operands; 3 stands for everything higher.
fn polynomial_degree(builtin: Builtin, operands: &[u32]) -> u32 {
    let highest = operands.iter().copied().max().unwrap_or(0);
    match builtin {
        Builtin::Add | Builtin::Sub | Builtin::Neg => highest,
        Builtin::Mul => operands.iter().sum::<u32>().min(3),
        Builtin::SelectLe if operands[..2] == [0, 0] => highest,
        _ if highest == 0 => 0,
        _ => 3,
    }
}
