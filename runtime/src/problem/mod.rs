//! The contract between symbols and numbers: an optimal control problem as functions, bounds and
//! names.
//!
//! Everything a model means is here; nothing of its text but the [`Origin`] of each row. Whoever
//! fills a [`Problem`] (the compiler, or a test with hand-written functions) is not the runtime's
//! business.
//!
//! Time is normalised in all functions that a transcription evaluates: their input `t` is `tau` in
//! [0, 1], and the real time is `t0(p) + tau * (tf(p) - t0(p))`. So a free final time needs no
//! special treatment: it is a parameter like any other, and its derivatives come out of the
//! functions.

mod by_parameters;
mod chain;
mod choices;
mod columns;
mod function;
mod layout;
mod measurements;
mod method;
mod often_called;
mod scheme;
mod variables;

pub use by_parameters::{ByParameters, ChainByParameters};
pub use chain::{Chain, End, Link};
pub use choices::{ControlShape, Linear, Solver, Word};
pub use columns::Columns;
pub use function::{Degree, Function, Origin, Pattern};
pub use layout::Layout;
pub use measurements::{Interpolant, Measurements};
pub use method::{FIRST_GRID, Grid, Method, Order};
pub use often_called::often_called;
pub(crate) use scheme::RADAU;
pub use scheme::{MOST_STAGES, Scheme};
pub use variables::{Bounds, Parameter, StartGuess, Surface, Unknown, Variable};

use std::sync::Arc;

/// An optimal control problem on one phase.
#[derive(Clone)]
pub struct Problem {
    /// Name of the model.
    pub name: String,
    /// Sizes of `t x u p s`.
    pub layout: Layout,
    /// States.
    pub states: Vec<Variable>,
    /// Controls.
    pub controls: Vec<Variable>,
    /// All of `p`, with values.
    pub parameters: Vec<Parameter>,
    /// Which entries of `p` are unknowns.
    pub unknowns: Vec<Unknown>,
    /// Switching surfaces.
    pub surfaces: Vec<Surface>,
    /// The smoothed right side over normalised time: `(tf - t0) * f(t, x, u, p, s = Sgn_sigma(psi)
    /// or Dir_sigma(psi))`, one output per state; then, if [`Problem::running_cost`], one more:
    /// `(tf - t0) *` the integrand of the objective. Differentiated by `x`, `u` and the unknowns.
    pub dynamics: Arc<dyn Function>,
    /// Whether the last output of `dynamics` is the integrand of the objective.
    pub running_cost: bool,
    /// Path constraints, over normalised time. Differentiated by `x`, `u` and the unknowns.
    pub path: Arc<dyn Function>,
    /// One per output of `path`.
    pub path_bounds: Vec<Bounds>,
    /// Which path constraints need not hold at the last time.
    pub half_open: Vec<usize>,
    /// Inputs `[x(start), x(end) | p]` in the layout `x = 2n`. Output 0 is the Mayer objective, the
    /// others are boundary conditions. Differentiated by both ends and the unknowns.
    pub boundary: Arc<dyn Function>,
    /// One per output of `boundary` but the first.
    pub boundary_bounds: Vec<Bounds>,
    /// `-1` if the model says `maximize`: the functions above are of the minimisation problem.
    pub sense: f64,
    /// Whether there is an objective at all.
    pub has_objective: bool,
    /// States whose start is a number.
    pub start: Vec<Option<f64>>,
    /// What the guess of each state knows of its start; nothing is known of hidden ones, which a
    /// model cannot link.
    pub start_guesses: Vec<StartGuess>,
    /// Inputs `[t | p]`; outputs the guess of all states, then of all controls, at normalised time
    /// `t`.
    pub guess: Arc<dyn Function>,
    /// Inputs `[p]`; outputs `t0, tf`.
    pub interval: Arc<dyn Function>,
    /// `psi`, or `|psi|` of a `Dir`, one output per surface, over normalised time.
    pub switching: Arc<dyn Function>,
    /// Sums over rows of measured data, which are part of the objective or of a state.
    pub measurements: Vec<Measurements>,
    /// Whether neither `dynamics` nor `path` depends on the time but through states and controls,
    /// and nothing is measured at certain times.
    pub is_autonomous: bool,
    /// Whether dynamics, path constraints or ends have kinks or knots.
    pub has_kinks: bool,
    /// The unknown that is the last time and appears in no right side, path constraint or first
    /// time.
    pub last_time: Option<usize>,
    /// Names of the outputs of `report`.
    pub report_names: Vec<String>,
    /// What the model reports, over normalised time.
    pub report: Arc<dyn Function>,
    /// How the model asks to be solved.
    pub method: Method,
}
