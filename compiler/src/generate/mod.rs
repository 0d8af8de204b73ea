//! From expressions to functions of the runtime: values, Jacobian and Hessian are computed step by
//! step until machine code pays.

mod bytecode;
pub(crate) mod c;
mod cranelift;
mod function;
mod numbers;
mod schedule;

use std::sync::Arc;

use fdcc_runtime::problem::Function;

use crate::differentiate::Differentiated;
use crate::expressions::graph::{ExprId, Graph};
use cranelift::Machine;
use function::CompiledFunction;
use schedule::{Schedule, Slot, Table, schedule};

/// What all kernels of a program are made of, and for.
struct Source {
    graph: Graph,
    machine: Machine,
}

/// All functions of a program, ready to be called.
pub fn generate(graph: Graph, functions: Vec<Differentiated>) -> Vec<Arc<dyn Function>> {
    let source = Arc::new(Source { graph, machine: Machine::host() });
    let compiled =
        functions.into_iter().map(|function| CompiledFunction::new(source.clone(), function));
    compiled.map(|function| Arc::new(function) as Arc<dyn Function>).collect()
}

/// The kernels as text, before Cranelift's own passes.
pub fn clif(graph: &Graph, functions: &[Differentiated]) -> String {
    let machine = Machine::host();
    let mut text = String::new();
    for function in functions {
        for order in 0..=highest_order(function) {
            text += &format!("; {}, derivatives of order {order}\n", function.function.name);
            text += &cranelift::text(&machine, graph, &work(graph, function, order));
            text += "\n";
        }
    }
    text
}

/// The last order of derivatives that has entries.
fn highest_order(function: &Differentiated) -> usize {
    usize::from(!function.jacobian.1.is_empty()) + usize::from(!function.hessian.1.is_empty())
}

/// What the kernel for derivatives up to an order does.
fn work(graph: &Graph, function: &Differentiated, order: usize) -> Schedule {
    let Differentiated { function, jacobian, hessian, .. } = function;
    let tables = [
        (Table::Values, &function.outputs),
        (Table::Jacobian, &jacobian.1),
        (Table::Hessian, &hessian.1),
    ];
    let results =
        tables.into_iter().take(order + 1).flat_map(|(table, outputs)| places(table, outputs));
    schedule(graph, &function.layout, &results.collect::<Vec<_>>())
}

fn places(table: Table, outputs: &[ExprId]) -> impl Iterator<Item = (ExprId, Slot)> {
    outputs.iter().enumerate().map(move |(column, &id)| (id, Slot { table, column }))
}
