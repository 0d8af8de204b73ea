//! Event-driven simulation of the true system: a Filippov system with selectors, resets and
//! prescribed controls.
//!
//! ```text
//! step (steps) -> events inside it (location) -> which modes follow (modes) -> step ...
//! ```
//!
//! In every mode each selector is -1, +1 or an unknown that keeps its surface at 0 (sliding); those
//! of a `Dir` are a direction or such unknowns. [`run`] is the loop, [`system`] the contract with
//! the compiler. Where the continuation is not unique it stops and says so; it never chooses.

mod bernstein;
mod controls;
mod field;
mod interval;
mod location;
mod mode;
mod modes;
mod result;
mod run;
mod steps;
mod system;
mod tape;
mod tuning;

pub use controls::{Controls, Polynomials};
pub use mode::Mode;
pub(crate) use modes::complementarity::selectors;
pub use result::{
    Candidate, Counts, Event, EventKind, Extreme, Integrator, Method, Options, Order, Simulation,
    Status, Watch,
};
pub use run::{controls_at, simulate};
pub(crate) use steps::{departure, dormand_prince, radau};
pub use system::{Ball, Enclosure, Enclosures, Interval, Jump, System, value};
pub use tape::{Cause, Change, Instant, Piece, Regime, Rule, Tape, Touch};
pub(crate) use tuning::touch::TOUCHING;
