//! Systems in the plane with one surface: `S = dx(T)/dx(0)`, exact, for the smoothed system, and
//! for fixed steps through that.

use fdcc_compiler::{compile_sensitivities, compile_smoothed};
use fdcc_runtime::fixed_step::{Grid, gradient as gradient_of_steps, step_through};
use fdcc_runtime::sensitivity::{Costates, Quantity, Sensitivity, gradient};
use fdcc_runtime::simulate::{Controls, Options, System};

use crate::documents;
use crate::models::changed;
use crate::section_two::set;

/// The derivatives of `x(T)`, then of `y(T)`, by both starts.
pub type Matrix = [[f64; 2]; 2];

/// The largest difference of two entries.
pub fn distance(one: &Matrix, other: &Matrix) -> f64 {
    let pairs = one.iter().flatten().zip(other.iter().flatten());
    pairs
        .map(|(a, b)| (a - b).abs())
        .fold(0.0, |most, error| if error <= most { most } else { error })
}

/// The text of a model of `tests/simulations/`.
pub fn simulated(name: &str) -> String {
    let found = documents("tests/simulations", "fdc").into_iter().find(|(other, _)| other == name);
    found.expect("a model of tests/simulations").1
}

/// The true system of a text with states `x` and `y`, with an objective.
pub fn exact(text: &str, objective: &str) -> System {
    let model = changed(&format!("{text}\nminimize {objective}\n"), &[], &[]);
    compile_sensitivities(&model).expect("the model can be simulated")
}

/// The same, smoothed with a kernel; `surface` names the width.
pub struct Smoothed {
    /// With `x(end)` and `y(end)` as objectives.
    systems: [System; 2],
    width: String,
}

impl Smoothed {
    /// A text whose only surface has this name.
    pub fn new(text: &str, surface: &str, kernel: &str) -> Self {
        let compiled = |objective: &str| {
            let text = format!("{text}\nminimize {objective}\nmethod {{ smooth sigma = 0.1 }}\n");
            compile_smoothed(&changed(&text, &[], &[("kernel", kernel)]))
                .expect("the model can be smoothed")
        };
        let systems = ["x(end)", "y(end)"].map(compiled);
        Smoothed { systems, width: format!("sigma({surface})") }
    }

    fn set(&mut self, sigma: f64) {
        self.systems.iter_mut().for_each(|system| set(system, &[(&self.width, sigma)]));
    }

    /// `S` of the differential equation.
    pub fn derivative(&mut self, sigma: f64) -> Matrix {
        self.set(sigma);
        derivative(&self.systems[0])
    }

    /// The adjoint of `x(T)`, seen at these times, too.
    pub fn costates(&mut self, sigma: f64, times: &[f64]) -> Costates {
        self.set(sigma);
        costates(&self.systems[0], times)
    }

    /// `S` of steps of the theta scheme, by their adjoint.
    pub fn stepped(&mut self, sigma: f64, theta: f64, steps: usize) -> Matrix {
        self.set(sigma);
        self.systems.each_ref().map(|system| {
            let grid = Grid::theta(system, theta, steps);
            let stepped = step_through(system, &Controls::Guess, &grid).expect("steps");
            let found =
                gradient_of_steps(system, &Controls::Guess, &grid, &stepped).expect("a gradient");
            [found.starts[0], found.starts[1]]
        })
    }
}

/// `S` of a differential equation or inclusion.
pub fn derivative(system: &System) -> Matrix {
    let end = differentiated(system, &Controls::Guess).end;
    [0, 1].map(|state| [end[state][0], end[state][1]])
}

/// The adjoint of the objective; integration stops at these times on its way, which changes nothing
/// else.
pub fn costates(system: &System, times: &[f64]) -> Costates {
    let times = [&[system.interval[0]], times].concat();
    let rows = vec![Vec::new(); times.len()];
    differentiated(system, &Controls::Held { times, rows, is_stretched: true }).costates
}

fn differentiated(system: &System, controls: &Controls) -> Sensitivity {
    let starts = [Quantity::Start(0), Quantity::Start(1)];
    let options = Options { rtol: 1e-13, atol: Some(1e-15), ..Options::default() };
    let found =
        gradient(system, controls, &options, &starts).expect("the simulation reaches its end");
    assert!(found.agreement < 1e-9, "forward and adjoint differ by {}", found.agreement);
    found
}
