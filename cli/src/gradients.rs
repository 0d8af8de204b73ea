//! Beside the exact gradient: those that a user may be computing otherwise, of the smoothed and of the discretised problem.

use fdcc_compiler::Model;
use fdcc_runtime::problem::Columns;
use fdcc_runtime::sensitivity::Quantity;
use fdcc_runtime::simulate::{Controls, Simulation, System};
use fdcc_runtime::stepping::{self, Failure, Grid, step_through};

/// The gradient of what fixed steps compute.
pub struct Stepped {
    /// The smoothing width of the first surface; nothing for the true system.
    pub sigma: Option<f64>,
    /// By each quantity.
    pub gradient: Vec<f64>,
}

/// Where the method names no width: this part of the largest value of a switching function.
const RELATIVE_WIDTH: f64 = 0.01;

/// The gradient of the true system, discretised; or why there is none.
pub fn discretised(
    model: &Model,
    system: &System,
    controls: &Controls,
    quantities: &[Quantity],
) -> Result<Stepped, String> {
    Ok(Stepped { sigma: None, gradient: stepped(model, system, controls, quantities)? })
}

/// The same with the surfaces smoothed, as a solve has it. `simulation` is of the true system.
pub fn smoothed(
    model: &Model,
    system: &System,
    simulation: &Simulation,
    controls: &Controls,
    quantities: &[Quantity],
) -> Result<Stepped, String> {
    let refused = |_| "a jump cannot be smoothed".to_string();
    let mut smooth = fdcc_compiler::compile_smoothed(model).map_err(refused)?;
    if model.method.sigma.is_none() && model.method.continuation.is_empty() {
        let sizes = sizes(system, simulation);
        for (surface, size) in system.surfaces.iter().zip(sizes) {
            smooth.parameters[surface.sigma].value = RELATIVE_WIDTH * if size > 0.0 { size } else { 1.0 };
        }
    }
    let sigma = system.surfaces.first().map(|surface| smooth.parameters[surface.sigma].value);
    Ok(Stepped { sigma, gradient: stepped(model, &smooth, controls, quantities)? })
}

fn stepped(
    model: &Model,
    system: &System,
    controls: &Controls,
    quantities: &[Quantity],
) -> Result<Vec<f64>, String> {
    let grid = Grid::new(system, &model.method);
    let found = step_through(system, controls, &grid)
        .and_then(|stepped| stepping::gradient(system, controls, &grid, &stepped));
    let whole = found.map_err(|failure| why(&failure))?;
    let by = |quantity: &Quantity| match *quantity {
        Quantity::Parameter(at) => whole.parameters[at],
        Quantity::Start(at) => whole.starts[at],
        Quantity::Control { row, control } => whole.controls[row][control],
    };
    Ok(quantities.iter().map(by).collect())
}

fn why(failure: &Failure) -> String {
    match failure {
        Failure::Jumps => "fixed steps know no jumps".into(),
        Failure::NoObjective => "there is nothing to differentiate".into(),
        Failure::NotFinite { time, origin } => format!("`{}` has no value at t = {time}", origin.label),
        Failure::NotConverged { time, .. } => {
            format!("the step to t = {time} has no solution near its beginning")
        }
        Failure::Singular { time, .. } => format!("the step to t = {time} has no unique solution"),
    }
}

/// The largest size of each switching function along a simulation.
fn sizes(system: &System, simulation: &Simulation) -> Vec<f64> {
    let mut points = Columns::new(system.guards.layout().point_inputs(), simulation.time.len());
    points.column_mut(0).copy_from_slice(&simulation.time);
    for (at, column) in simulation.states.iter().enumerate() {
        points.column_mut(1 + at).copy_from_slice(column);
    }
    let mut values = Columns::new(system.guards.outputs(), points.count());
    system.guards.value(&points, &system.parameter_values(), &mut values);
    let largest = |at| values.column(at).iter().fold(0.0, |most: f64, psi: &f64| most.max(psi.abs()));
    (0..system.surfaces.len()).map(largest).collect()
}
