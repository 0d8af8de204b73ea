//! Optimal control of systems with friction, switches and impacts: read a [`Model`], solve it,
//! check the [`Solution`] on the true system, differentiate it.
//!
//! ```
//! use fdcc::{Model, Options};
//!
//! let model = Model::from_file("../models/block.fdc")?;
//! let solution = model.with("mu", 0.2)?.solve(&Options::default())?;
//! let replay = solution.verify()?;
//! println!("{} {}", solution.objective(), replay.confirms(1e-3));
//! # assert!(solution.is_solved());
//! # Ok::<(), fdcc::Error>(())
//! ```
//!
//! All numbers are in SI. An `Err` is a wrong model or a wrong call; that nothing was found is a
//! status. Nothing here prints, and files are read by [`Model::from_file`] and [`DataFiles`] alone.

mod closed_loop;
mod error;
mod estimates;
mod executor;
mod expectations;
mod gradient;
pub mod language;
mod measured;
mod model;
pub mod names;
mod plant;
mod plots;
pub mod record;
mod replay;
mod simulation;
mod simulation_of_phases;
mod solve;
mod verification;
mod warm_start;

pub use closed_loop::ClosedLoop;
pub use error::Error;
pub use estimates::{Estimate, Estimates, Residual};
pub use executor::Executor;
pub use expectations::{Expectation, Expected, Sides};
pub use fdcc_runtime::nlp::{Status, Stop};
pub use fdcc_runtime::simulate::{Controls, Options as Accuracy, Polynomials};
pub use gradient::{By, Exact, Gradient, NotBy, Stepped, by_names};
pub use model::{Checked, DataFiles, Model, Stage, Value, check, check_with, text};
pub use plant::Plant;
pub use plots::{Plot, Segment};
pub use record::Record;
pub use replay::Replay;
pub use simulation::Simulation;
pub use simulation_of_phases::SimulationOfPhases;
pub use solve::true_optimum;
pub use solve::{
    Case, Cases, Compiled, Controller, CostatesBefore, Ended, Family, Grid, Jump, Options,
    ParametricSensitivity, Part, PathCondition, PhaseSensitivity, Phases, Reach, Report, Sequence,
    Solution, Start, Sweep, optimality,
};
pub use verification::{Condition, Gap, LinkGap, Stay, TIME_OF, Verification, modes};

/// The code of the page about the library.
#[cfg(doctest)]
#[doc = include_str!("../../docs/library.md")]
#[doc = include_str!("../../docs/real-time.md")]
struct Pages;
