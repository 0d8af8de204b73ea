//! Beside the exact gradient: those that a user may be computing otherwise, of the smoothed and of
//! the discretised problem.

use fdcc::quantities::By;
use fdcc_compiler::Model;
use fdcc_runtime::fixed_step::{self, Failure, Grid, step_through};
use fdcc_runtime::problem::{Columns, Scheme};
use fdcc_runtime::sensitivity::{Quantity, hessian};
use fdcc_runtime::simulate::{Controls, Simulation, System};

/// What is to be differentiated by what.
pub struct Question<'a> {
    pub model: &'a Model,
    /// For sensitivities, compiled from the model.
    pub system: System,
    pub controls: Controls,
    pub by: Vec<By>,
}

/// The gradient of what fixed steps compute.
pub struct Stepped {
    /// The smoothing width of the first surface; nothing for the true system.
    pub sigma: Option<f64>,
    /// By each quantity.
    pub gradient: Vec<f64>,
}

/// Where the method names no width: this part of the largest value of a switching function.
const RELATIVE_WIDTH: f64 = 0.01;

impl Question<'_> {
    /// All numbers to differentiate by, in the order of their names.
    pub fn quantities(&self) -> Vec<Quantity> {
        self.by.iter().flat_map(|by| by.quantities.iter().copied()).collect()
    }

    /// The gradient of the true system, discretised, or why there is none; fixed steps know no
    /// jumps.
    pub fn discretised(&self) -> Option<Result<Stepped, String>> {
        let stepped = || Ok(Stepped { sigma: None, gradient: self.stepped(&self.system)? });
        self.system.jumps.is_empty().then(stepped)
    }

    /// The same with the surfaces smoothed, as a solve has it. `simulation` is of the true system.
    pub fn smoothed(&self, simulation: &Simulation) -> Option<Result<Stepped, String>> {
        let mut smooth = fdcc_compiler::compile_smoothed(self.model).ok()?;
        let first = self.system.surfaces.first()?;
        if self.model.method.sigma.is_none() && self.model.method.continuation.is_empty() {
            let sizes = sizes(&self.system, simulation);
            for (surface, size) in self.system.surfaces.iter().zip(sizes) {
                smooth.parameters[surface.sigma].value =
                    RELATIVE_WIDTH * if size > 0.0 { size } else { 1.0 };
            }
        }
        let sigma = Some(smooth.parameters[first.sigma].value);
        Some(self.stepped(&smooth).map(|gradient| Stepped { sigma, gradient }))
    }

    /// The second derivatives, or why there are none.
    pub fn second(&self, simulation: &Simulation) -> Result<Vec<Vec<f64>>, String> {
        let found = hessian(&self.system, &self.controls, simulation, &self.quantities());
        let why = "there are no second derivatives here: none are known where infinitely many \
                   jumps come to rest, where a `Dir` \
                   moves, by a start that leaves a surface on which it slides, and where a kink is \
                   met together with something else";
        found.ok_or(why.to_string())
    }

    fn stepped(&self, system: &System) -> Result<Vec<f64>, String> {
        let scheme = self.model.method.scheme;
        if matches!(scheme, Scheme::RungeKutta4 | Scheme::Radau(_) | Scheme::Gauss(_)) {
            return Err(format!("fixed steps of `{}` do not go through a set", scheme.name()));
        }
        let grid = Grid::new(system, &self.model.method);
        let found = step_through(system, &self.controls, &grid)
            .and_then(|stepped| fixed_step::gradient(system, &self.controls, &grid, &stepped));
        let whole = found.map_err(|failure| why(&failure))?;
        let by = |quantity: Quantity| match quantity {
            Quantity::Parameter(at) => whole.parameters[at],
            Quantity::Start(at) => whole.starts[at],
            Quantity::Control { row, control } => whole.controls[row][control],
        };
        Ok(self.quantities().into_iter().map(by).collect())
    }
}

fn why(failure: &Failure) -> String {
    match failure {
        Failure::Jumps => "fixed steps know no jumps".into(),
        Failure::Directions => "fixed steps know no `Dir`".into(),
        Failure::NoObjective => "there is nothing to differentiate".into(),
        Failure::NotFinite { time, origin } => {
            format!("`{}` has no value at t = {time}", origin.label)
        }
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
    let largest =
        |at| values.column(at).iter().fold(0.0, |most: f64, psi: &f64| most.max(psi.abs()));
    (0..system.surfaces.len()).map(largest).collect()
}
