//! From expressions to compiled functions and tables of points, in the few words that tests want to
//! spend on it.

use std::sync::Arc;

use fdcc_compiler::differentiate::Differentiated;
use fdcc_compiler::differentiate::differentiate;
use fdcc_compiler::generate::generate;
use fdcc_compiler::graph::{ExprId, Graph};
use fdcc_compiler::lower::{Order, VectorFunction};
use fdcc_runtime::problem::{Columns, Function, Layout, Origin};

use crate::random::Random;

/// Outputs as a function of inputs of any layout, differentiated by all of them.
pub fn function(graph: &mut Graph, outputs: Vec<ExprId>, layout: Layout) -> Differentiated {
    let origins = vec![Origin::default(); outputs.len()];
    let by = (0..layout.inputs() as u32).collect();
    differentiate(
        graph,
        VectorFunction { name: "test".into(), layout, outputs, origins, by, order: Order::Second },
    )
}

/// Inputs that are `x` states and then `p` parameters.
pub fn states_and_parameters(x: usize, p: usize) -> Layout {
    Layout { x, p, ..Layout::default() }
}

/// Machine code.
pub fn compile(graph: &Graph, symbols: &Differentiated) -> Arc<dyn Function> {
    generate(graph.clone(), vec![symbols.clone()]).remove(0)
}

/// Random numbers in all columns; what pads them is not a number.
pub fn table(random: &mut Random, columns: usize, count: usize, low: f64, high: f64) -> Columns {
    let mut table = Columns::new(columns, count);
    table.as_mut_slice().fill(f64::NAN);
    for column in 0..columns {
        table.column_mut(column).iter_mut().for_each(|value| *value = random.between(low, high));
    }
    table
}
