//! The first calls of the functions of a problem.

use super::{Columns, Function, Problem};

/// What every solve calls, called once, at a point of zeros: machine code is made when it is first called. The longest comes first; the calls may be made
/// side by side.
pub fn first_calls(problem: &Problem) -> Vec<Box<dyn Fn() + Send + Sync + '_>> {
    let solved = [&problem.dynamics, &problem.path, &problem.boundary];
    let told = [&problem.guess, &problem.guards, &problem.report, &problem.interval];
    let parameters = || problem.parameters.iter().map(|it| it.value).collect::<Vec<f64>>();
    let mut calls: Vec<Box<dyn Fn() + Send + Sync + '_>> = Vec::new();
    for function in solved {
        calls.push(Box::new(move || call_derivatives(&**function, &parameters())));
    }
    for function in solved.into_iter().chain(told) {
        calls.push(Box::new(move || call_value(&**function, &parameters())));
    }
    calls.push(Box::new(move || call_jacobian(&*problem.boundary, &parameters())));
    calls
}

fn call_value(function: &dyn Function, parameters: &[f64]) {
    let points = Columns::new(function.layout().point_inputs(), 1);
    function.value(&points, parameters, &mut Columns::new(function.outputs(), 1));
}

fn call_jacobian(function: &dyn Function, parameters: &[f64]) {
    let points = Columns::new(function.layout().point_inputs(), 1);
    let mut jacobian = Columns::new(function.jacobian_pattern().entries.len(), 1);
    function.jacobian(&points, parameters, &mut Columns::new(function.outputs(), 1), &mut jacobian);
}

fn call_derivatives(function: &dyn Function, parameters: &[f64]) {
    let table = |columns| Columns::new(columns, 1);
    let (points, multipliers) = (table(function.layout().point_inputs()), table(function.outputs()));
    let [mut jacobian, mut hessian] =
        [function.jacobian_pattern(), function.hessian_pattern()].map(|it| table(it.entries.len()));
    let mut values = table(function.outputs());
    function.derivatives(&points, parameters, &multipliers, &mut values, &mut jacobian, &mut hessian);
}
