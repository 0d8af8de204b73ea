//! Exact derivatives of vector functions, as expressions of the same graph.
//!
//! ```text
//! Jacobian row i = adjoints of y_i at the inputs
//! L = sum_i multiplier(i) y_i,  Hessian column k = tangent of the gradient of L in direction z_k
//! ```
//!
//! Hash-consing shares whatever value, Jacobian and Hessian have in common. An entry is in a
//! pattern unless it simplifies to the number 0.

mod degree;

use crate::expressions::graph::derivative::{gradient, tangents};
use crate::expressions::graph::{ExprId, Graph};
use crate::lower::{Order, VectorFunction};
use degree::degrees;
use fdcc_runtime::problem::{Degree, Pattern};
use std::collections::HashMap;

/// A function with its derivatives.
#[derive(Clone, Debug)]
pub struct Differentiated {
    /// The function itself.
    pub function: VectorFunction,
    /// `dy/dz`: which entries, and their expressions.
    pub jacobian: (Pattern, Vec<ExprId>),
    /// The lower triangle of the Hessian of `sum_i multiplier(i) * y_i`.
    pub hessian: (Pattern, Vec<ExprId>),
    /// How each output depends on the inputs it was differentiated by.
    pub degrees: Vec<Degree>,
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
    let places = places(function);
    for (row, &output) in function.outputs.iter().enumerate() {
        let by = read(graph, &[output], &places);
        let gradient = gradient(graph, output, &by);
        for (&column, entry) in by.iter().zip(gradient) {
            matrix.push(row as u32, column, entry);
        }
    }
    matrix.finish()
}

fn hessian(graph: &mut Graph, function: &VectorFunction) -> (Pattern, Vec<ExprId>) {
    let lagrangian = lagrangian(graph, &function.outputs);
    let by = read(graph, &function.outputs, &places(function));
    let gradient = gradient(graph, lagrangian, &by);
    let columns: Vec<Vec<ExprId>> =
        (0..by.len()).map(|column| tangents(graph, &gradient[column..], by[column])).collect();
    let inputs = function.layout.inputs();
    let mut matrix = Matrix::new(graph, inputs, inputs);
    for (i, &row) in by.iter().enumerate() {
        for (j, &column) in by[..=i].iter().enumerate() {
            matrix.push(row, column, columns[j][i - j]);
        }
    }
    matrix.finish()
}

/// Where each of the inputs stands by which a function is differentiated.
fn places(function: &VectorFunction) -> HashMap<u32, usize> {
    function.by.iter().enumerate().map(|(place, input)| (*input, place)).collect()
}

/// Those of the inputs that some outputs read, in their order: there may be thousands of others.
fn read(graph: &Graph, outputs: &[ExprId], places: &HashMap<u32, usize>) -> Vec<u32> {
    let mut inputs = graph.inputs_of(outputs);
    inputs.retain(|input| places.contains_key(input));
    inputs.sort_by_key(|input| places[input]);
    inputs
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
