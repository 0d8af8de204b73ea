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
mod on_side;
pub(crate) mod others;
pub(crate) mod report;
mod roots;
mod sample;
pub(crate) mod smoothness;
pub(crate) mod view;
pub(crate) mod words;

use crate::model::Model;
use crate::model::numbers::numbers;
use fdcc_grammar::Diagnostic;

pub use class::Class as SurfaceClass;
pub(crate) use local::Local;
pub use report::SurfaceReport;

pub use smoothness::{Order, Smoothness};
pub(crate) use smoothness::{at_guards, of_expression};
pub(crate) use view::View;

/// What is known about every surface of a model, or which parameters it waits for.
pub fn surfaces(model: &Model) -> Result<Vec<SurfaceReport>, Vec<Diagnostic>> {
    Ok(report::surfaces(model, &numbers(model)?))
}

/// How smooth everything is that has a name in a model, or which parameters it waits for.
pub fn smoothness(model: &Model) -> Result<Vec<Smoothness>, Vec<Diagnostic>> {
    Ok(smoothness::smoothness(model, &numbers(model)?))
}
