//! From expressions to machine code: up to three kernels for each function, all in one module.

mod cranelift;
mod function;
mod schedule;

use std::sync::Arc;

use fdcc_runtime::problem::Function;

use crate::graph::{ExprId, Graph};
use crate::program::Differentiated;
use function::CompiledFunction;
use schedule::{Place, Schedule, Table, schedule};

/// Compiles all functions of a program.
pub fn generate(graph: &Graph, functions: Vec<Differentiated>) -> Vec<Arc<dyn Function>> {
    let schedules: Vec<Vec<Schedule>> = functions.iter().map(|function| schedules(graph, function)).collect();
    let (code, kernels) = cranelift::compile(graph, schedules.iter().flatten());
    let code = Arc::new(code);
    let mut kernels = kernels.into_iter();
    let compiled = functions.into_iter().zip(&schedules).map(|(function, schedules)| {
        let own = kernels.by_ref().take(schedules.len()).collect();
        Arc::new(CompiledFunction::new(code.clone(), own, function)) as Arc<dyn Function>
    });
    compiled.collect()
}

/// The kernels as text, before Cranelift's own passes.
pub fn clif(graph: &Graph, functions: &[Differentiated]) -> String {
    let mut text = String::new();
    for function in functions {
        for (order, schedule) in schedules(graph, function).iter().enumerate() {
            text += &format!("; {}, derivatives of order {order}\n", function.function.name);
            text += &cranelift::text(graph, schedule);
            text += "\n";
        }
    }
    text
}

/// One schedule for each order of derivatives up to the last that has entries.
fn schedules(graph: &Graph, function: &Differentiated) -> Vec<Schedule> {
    let layout = &function.function.layout;
    let mut results = Vec::new();
    let mut schedules = Vec::new();
    for (table, outputs) in [
        (Table::Values, &function.function.outputs),
        (Table::Jacobian, &function.jacobian.1),
        (Table::Hessian, &function.hessian.1),
    ] {
        results.extend(places(table, outputs));
        if table == Table::Values || !outputs.is_empty() {
            schedules.push(schedule(graph, layout, &results));
        }
    }
    schedules
}

fn places(table: Table, outputs: &[ExprId]) -> impl Iterator<Item = (ExprId, Place)> {
    outputs.iter().enumerate().map(move |(column, &id)| (id, Place { table, column }))
}
