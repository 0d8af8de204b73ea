//! Beside the exact gradient: those that a user may be computing otherwise, of the smoothed and of
//! the discretised problem.

use super::tuning::approximations::RELATIVE_WIDTH;
use super::{Gradient, quantities};
use fdcc_runtime::fixed_step::{self, Failure, Grid, step_through};
use fdcc_runtime::problem::Scheme;
use fdcc_runtime::sensitivity::Quantity;
use fdcc_runtime::simulate::{Simulation, System};

/// The gradient of what fixed steps compute.
///
/// ```
/// let model = fdcc::Model::from_text("slide", "time t in [0, 2]
/// param mu = 2
/// state v start 1
/// surface slip = v
/// dynamics { v' in -mu * Sgn(slip) }
/// minimize integral(v)")?;
/// let gradient = model.gradient(&["mu"])?;
/// let smoothed = gradient.smoothed().expect("there is a surface").expect("it can be stepped");
/// assert!(smoothed.sigma.is_some() && smoothed.gradient.len() == 1);
/// # Ok::<(), fdcc::Error>(())
/// ```
pub struct Stepped {
    /// The smoothing width of the first surface; nothing for the true system.
    pub sigma: Option<f64>,
    /// By each quantity.
    pub gradient: Vec<f64>,
}

impl Gradient {
    /// The gradient of the true system, discretised, by the numbers of `by`; nothing of models with
    /// jumps, which fixed steps do not know, or without states and integrals.
    ///
    /// # Errors
    ///
    /// A scheme whose steps do not go through a set, or steps that do not reach the end, in words.
    pub fn discretised(&self) -> Option<Result<Stepped, String>> {
        let stepped = || Ok(Stepped { sigma: None, gradient: self.stepped(&self.system)? });
        let is_stepped = self.system.jumps.is_empty() && self.system.layout.x > 0;
        is_stepped.then(stepped)
    }

    /// The same with the surfaces smoothed, as a solve has it; nothing of a model without surfaces.
    ///
    /// # Errors
    ///
    /// As for [`discretised`](Gradient::discretised).
    pub fn smoothed(&self) -> Option<Result<Stepped, String>> {
        let model = self.model.meaning();
        let mut smooth = fdcc_compiler::compile_smoothed(model).ok()?;
        let first = self.system.surfaces.first()?;
        if !model.method.names_width() {
            let sizes = sizes(&self.system, self.simulation());
            for (surface, size) in self.system.surfaces.iter().zip(sizes) {
                smooth.parameters[surface.sigma].value =
                    RELATIVE_WIDTH * if size > 0.0 { size } else { 1.0 };
            }
        }
        let sigma = Some(smooth.parameters[first.sigma].value);
        Some(self.stepped(&smooth).map(|gradient| Stepped { sigma, gradient }))
    }

    fn stepped(&self, system: &System) -> Result<Vec<f64>, String> {
        let method = &self.model.meaning().method;
        let scheme = method.scheme;
        if matches!(scheme, Scheme::RungeKutta4 | Scheme::Radau(_) | Scheme::Gauss(_)) {
            return Err(format!("fixed steps of `{}` do not go through a set", scheme.name()));
        }
        let grid = Grid::new(system, method);
        let found = step_through(system, &self.controls, &grid)
            .and_then(|stepped| fixed_step::gradient(system, &self.controls, &grid, &stepped));
        let whole = found.map_err(|failure| why(&failure))?;
        let by = |quantity: Quantity| match quantity {
            Quantity::Parameter(at) => whole.parameters[at],
            Quantity::Start(at) => whole.starts[at],
            Quantity::Control { row, control } => whole.controls[row][control],
        };
        Ok(quantities(&self.by).into_iter().map(by).collect())
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
    let (inputs, parameters) =
        (system.switching.layout().point_inputs(), system.parameter_values());
    let mut largest = vec![0.0_f64; system.surfaces.len()];
    for (row, time) in simulation.time.iter().enumerate() {
        let states = simulation.states.iter().map(|column| column[row]);
        let mut point: Vec<f64> = std::iter::once(*time).chain(states).collect();
        point.resize(inputs, 0.0);
        let psi = system.switching_at(&mut point, &parameters);
        largest.iter_mut().zip(psi).for_each(|(most, psi)| *most = most.max(psi.abs()));
    }
    largest
}
