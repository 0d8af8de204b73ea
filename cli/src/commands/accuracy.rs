//! How exactly a simulation integrates, and with which method: the options of every command that
//! simulates.

use clap::{Args, ValueEnum};
use fdcc_runtime::simulate::{Integrator, Options};

/// The options.
#[derive(Args)]
pub struct Accuracy {
    /// Relative tolerance of one step
    #[arg(allow_negative_numbers = true)]
    #[arg(long, value_name = "TOL", default_value = "1e-10", value_parser = relative)]
    rtol: f64,
    /// Absolute tolerance of one step, in SI units; 1e-12 of the largest that each state has been
    /// if left out
    #[arg(long, value_name = "TOL", value_parser = absolute, allow_negative_numbers = true)]
    atol: Option<f64>,
    /// The longest step, in the unit of time; by default only the tolerances limit it, and what
    /// surfaces do is seen between steps, too
    #[arg(long, value_name = "H", value_parser = longest, allow_negative_numbers = true)]
    max_step: Option<f64>,
    /// The method: explicit until a mode turns out to be stiff, or always the one named
    #[arg(long, value_name = "METHOD", value_enum, default_value = "auto")]
    integrator: Chosen,
}

#[derive(Clone, Copy, ValueEnum)]
enum Chosen {
    Auto,
    Explicit,
    Stiff,
}

impl Accuracy {
    /// The same as options of the runtime; the model's unit of time is so many of SI.
    pub fn options(&self, unit: f64) -> Options {
        let integrator = match self.integrator {
            Chosen::Auto => Integrator::Automatic,
            Chosen::Explicit => Integrator::Explicit,
            Chosen::Stiff => Integrator::Stiff,
        };
        let max_step = self.max_step.map_or(f64::INFINITY, |step| step * unit);
        Options { rtol: self.rtol, atol: self.atol, integrator, max_step, ..Options::default() }
    }
}

/// Below this rounding is larger than the tolerance.
const LEAST: f64 = 1e-14;

fn relative(text: &str) -> Result<f64, String> {
    let value = text.parse().ok().filter(|value| (LEAST..1.0).contains(value));
    value.ok_or_else(|| format!("a number from {LEAST:e} to 1 is needed"))
}

fn longest(text: &str) -> Result<f64, String> {
    let value = text.parse().ok().filter(|value: &f64| *value > 0.0);
    value.ok_or_else(|| "a positive number is needed".to_string())
}

fn absolute(text: &str) -> Result<f64, String> {
    let value = text.parse().ok().filter(|value: &f64| *value > 0.0 && value.is_finite());
    value.ok_or_else(|| "a positive number is needed".to_string())
}
