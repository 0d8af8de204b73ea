//! The scalar inclusion of Section 2 of Stewart & Anitescu (2005), stepped through: `x' in (1 +
//! alpha) - Sgn(x)`, `x(0) = x0 < 0`.
//!
//! ```text
//! J(x0) = (x(2) - 5/3)^2 + int x^2 = (x0 + 1)^2/9 - x0^3/9 + (x0 + 6)^3/81
//! J'    = 2(x0 + 1)/9 - x0^2/3 + (x0 + 6)^2/27
//! ```
//!
//! for alpha = 1. The discrete objective takes the trapezoidal sum for the integral, whatever the
//! rule of the steps is.

use fdcc_compiler::{compile_sensitivities, compile_smoothed};
use fdcc_runtime::fixed_step::{Gradient, Grid, Stepped, gradient, step_through};
use fdcc_runtime::simulate::{Controls, System};

use crate::models::meaning;

/// `missing` makes the sum of implicit (`h/2`) and explicit Euler (`-h/2`) the trapezoidal one.
const MODEL: &str = "model section_two
param alpha = 1
param x0 = -1
param T = 2
param missing = 0
time t in [0, T]
state x start x0
surface zero = x
dynamics { x' in (1 + alpha) - Sgn(zero) }
minimize (x(end) - 5/3)^2 + integral(x^2) + missing*(x(start)^2 - x(end)^2)
method { smooth sigma = 0.1 kernel tanh }
";

/// The inclusion.
pub fn inclusion() -> System {
    compile_sensitivities(&meaning(MODEL)).expect("the model can be simulated")
}

/// The inclusion, with the end as objective.
pub fn inclusion_to_the_end() -> System {
    compile_sensitivities(&meaning(&to_the_end())).expect("the model can be simulated")
}

/// With `tanh(x/sigma)` for `Sgn(x)`.
pub fn smoothed() -> System {
    compile_smoothed(&meaning(MODEL)).expect("the model can be smoothed")
}

/// The same, with the end as objective.
pub fn smoothed_to_the_end() -> System {
    compile_smoothed(&meaning(&to_the_end())).expect("the model can be smoothed")
}

fn to_the_end() -> String {
    let line =
        MODEL.lines().find(|line| line.starts_with("minimize")).expect("there is an objective");
    MODEL.replace(line, "minimize x(end)")
}

/// Gives parameters their values.
pub fn set(system: &mut System, values: &[(&str, f64)]) {
    for (name, value) in values {
        let parameter = system.parameters.iter_mut().find(|parameter| parameter.name == *name);
        parameter.unwrap_or_else(|| panic!("there is no parameter {name}")).value = *value;
    }
}

/// Steps and gradient of a system whose controls do not matter.
pub fn stepped(system: &System, grid: &Grid) -> (Stepped, Gradient) {
    let stepped =
        step_through(system, &Controls::Guess, grid).expect("the system can be stepped through");
    let gradient = gradient(system, &Controls::Guess, grid, &stepped).expect("there is a gradient");
    (stepped, gradient)
}

/// `J_h` and its derivative by `x0`, for implicit Euler with a number of steps.
pub fn implicit_euler(system: &mut System, x0: f64, steps: usize) -> [f64; 2] {
    set(system, &[("x0", x0), ("missing", 1.0 / steps as f64)]);
    let (stepped, gradient) = stepped(system, &Grid::theta(system, 1.0, steps));
    [stepped.objective.expect("the model has an objective"), gradient.starts[0]]
}

/// `J` and `J'`.
pub fn exact(x0: f64) -> [f64; 2] {
    let value = (x0 + 1.0).powi(2) / 9.0 - x0.powi(3) / 9.0 + (x0 + 6.0).powi(3) / 81.0;
    [value, 2.0 * (x0 + 1.0) / 9.0 - x0 * x0 / 3.0 + (x0 + 6.0).powi(2) / 27.0]
}

/// `J_h` and its derivative for any theta; the system is that to the end. The derivative of every
/// point is that of the end of a shorter run.
pub fn objective(system: &mut System, x0: f64, steps: usize, theta: f64) -> [f64; 2] {
    let h = 2.0 / steps as f64;
    let mut sum = [0.5 * h * x0 * x0, h * x0];
    let mut last = [x0, 1.0];
    for count in 1..=steps {
        set(system, &[("x0", x0), ("T", h * count as f64)]);
        let (stepped, gradient) = stepped(system, &Grid::theta(system, theta, count));
        last = [stepped.states[0][count], gradient.starts[0]];
        let weight = if count == steps { 0.5 * h } else { h };
        sum = [sum[0] + weight * last[0].powi(2), sum[1] + 2.0 * weight * last[0] * last[1]];
    }
    let miss = last[0] - 5.0 / 3.0;
    [miss * miss + sum[0], 2.0 * miss * last[1] + sum[1]]
}
