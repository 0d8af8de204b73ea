//! Event-driven simulation of the true system: a Filippov system with selectors, resets and
//! prescribed controls.
//!
//! ```text
//! step (Dormand-Prince 5(4)) -> events inside it (locate) -> which modes follow (decide) -> step ...
//! ```
//!
//! In every mode each selector is -1, +1 or an unknown that keeps its surface at 0 (sliding); those
//! of a `Dir` are a direction or such unknowns. [`simulate`] is the loop. Where the continuation is
//! not unique it stops and says so; it never chooses.

mod advance;
mod ball;
mod complementarity;
mod controls;
mod decide;
mod direction;
mod events;
mod explicit;
mod extremes;
mod field;
mod interval;
mod landing;
mod locate;
mod memory;
mod normals;
pub(crate) mod radau;
mod record;
mod result;
mod run;
mod search;
pub(crate) mod setting_out;
mod sides;
mod sliding;
mod staying;
mod step;
mod system;
pub(crate) mod tableau;
mod tape;
mod tolerance;
mod tube;
mod zeno;

pub(crate) use complementarity::selectors;
pub use controls::Controls;
pub use extremes::Extreme;
pub use field::Mode;
pub use result::{
    Candidate, Counts, Event, Integrator, Kind, Method, Options, Simulation, Status, Watch,
};
pub use run::simulate;
pub use system::{Ball, Enclosure, Enclosures, Interval, Jump, System, value};
pub use tape::{Cause, Change, Instant, Piece, Regime, Rule, Tape};
