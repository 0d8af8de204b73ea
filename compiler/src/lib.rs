//! From the syntax tree to compiled functions.
//!
//! The modules are listed in the order of the stages: each knows those above it and none below.

mod analyze;
mod check;
mod compile;
mod data;
pub mod differentiate;
pub(crate) mod expressions;
pub mod generate;
mod kinks;
pub mod lower;
pub mod model;
mod phases;
mod preflight;
mod resolve;
pub(crate) mod settings;
mod surfaces;
pub mod symbols;
pub(crate) mod syntax;
pub mod units;

pub use analyze::repair::repair;
pub use analyze::sensitivity_query::check_with_objective;
pub use analyze::{Analysis, Checked, analyze, analyze_with, check, check_given, check_with};
pub use compile::alike::Alike;
pub use compile::chain::{
    ChainCode, ChainExpectations, chain_expectations, compile_chain, compile_chain_by_parameters,
    compile_chain_like, integrands,
};
pub use compile::dump::{Stage, dump};
pub use compile::emit::emit_c;
pub use compile::residuals::{Readings, Residuals, residuals};
pub use compile::{Expectations, expectations};
pub use compile::{ProblemCode, compile, compile_by_parameters};
pub use compile::{compile_sensitivities, compile_simulation, compile_smoothed};
pub use data::{Files, Table, matches};
pub use expressions::graph::builtins;
pub use expressions::{graph, interval, kernels};
pub use kinks::{Kinks, is_kink, parameters_on_kinks, side_of, without_kinks};
pub use lower::{Expected, LoweredProblem};
pub use model::{Along, Border, Model, Phase, Plane, Plot, Switch};
pub use phases::{
    Arc, Combination, Course, Ends, HoldNormals, Limit, Mode, NormalsAt, PhaseOfModes, Point,
    Sequences, Slopes, beside, between_jumps, combinations, crossings, ends_at, hamiltonian,
    is_uncontrolled, limits, may_hold, sequences, with_beginnings, with_jumps_in_phases,
    with_modes, with_modes_in_phases, with_phases, with_times,
};
pub use settings::is_key as is_method_key;
pub use surfaces::{Order, Smoothness, SurfaceClass, SurfaceReport, smoothness, surfaces};
pub use symbols::{Grid, SymbolInformation, grid, symbol_information, vocabulary};
pub use syntax::closest;
pub use syntax::functions::function_names;
pub use units::{NamedUnit, WidthUnit, parse_quantity};
