//! What a surface does to the trajectories that meet it, before anything runs.
//!
//! Each surface is taken out of the model by itself ([`local`]), its class is proved over the
//! bounds of states and controls ([`class`]), with parameters at their values; what cannot be
//! proved is called unknown.

pub(crate) mod ball;
pub(crate) mod class;
pub(crate) mod coordinates;
pub(crate) mod degenerate;
pub(crate) mod endless;
pub(crate) mod holding;
pub(crate) mod local;
mod report;
mod sample;
mod smoothness;
pub(crate) mod view;
pub(crate) mod words;

pub use class::Class as SurfaceClass;
pub(crate) use local::Local;
pub use report::SurfaceReport;
pub(crate) use report::surfaces;
pub use smoothness::{Order, Smoothness};
pub(crate) use smoothness::{at_guards, of_expression, smoothness};
pub(crate) use view::View;
