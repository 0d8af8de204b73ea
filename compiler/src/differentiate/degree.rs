//! How the outputs of a function depend on its inputs: affine, quadratic or neither.

use crate::expressions::graph::builtins::Builtin;
use crate::expressions::graph::{ById, Expr, Graph};
use crate::lower::VectorFunction;
use fdcc_runtime::problem::Degree;

/// The degree of each output as a polynomial of the inputs that it is differentiated by.
pub(super) fn degrees(graph: &Graph, function: &VectorFunction) -> Vec<Degree> {
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
