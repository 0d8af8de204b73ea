//! The words that models, files and verdicts have for statuses, modes and settings.

use fdcc_runtime::nlp::Status;
use fdcc_runtime::problem::{ControlShape, Linear, Solver};
use fdcc_runtime::solution::modes::Mode;
use fdcc_runtime::solve::Outcome;

/// The name of a status in files and verdicts. `infeasible` is what is proved to be so.
pub fn status_name(outcome: &Outcome) -> &'static str {
    match &outcome.solution.status {
        Status::Solved => "solved",
        Status::Acceptable => "acceptable",
        Status::Infeasible if outcome.is_impossible => "infeasible",
        Status::Infeasible => "none_found",
        Status::Unbounded => "unbounded",
        Status::IterationLimit => "iteration_limit",
        Status::TimeLimit => "time_limit",
        Status::Interrupted => "interrupted",
        Status::NotFinite(_) => "not_finite",
        Status::NumericalFailure => "numerical_failure",
    }
}

/// The name of a mode in files and verdicts.
pub fn mode_name(mode: Mode) -> &'static str {
    match mode {
        Mode::Below => "below",
        Mode::Held => "held",
        Mode::Above => "above",
    }
}

/// The name of the shape of controls in models and files.
pub fn shape_name(shape: ControlShape) -> &'static str {
    match shape {
        ControlShape::Constant => "constant",
        ControlShape::Linear => "linear",
        ControlShape::Polynomial => "polynomial",
    }
}

/// The name of a solver in models and files.
pub fn solver_name(solver: Solver) -> &'static str {
    match solver {
        Solver::Automatic | Solver::InteriorPoint => "interior_point",
        Solver::Convex => "convex",
    }
}

/// The name of a factorisation in models and files.
pub fn linear_name(linear: Linear) -> &'static str {
    match linear {
        Linear::Automatic => "auto",
        Linear::Riccati => "riccati",
        Linear::SparseLdl => "sparse_ldl",
    }
}

/// The shape of a name, as [`shape_name`] gives it.
pub fn find_shape(name: &str) -> Option<ControlShape> {
    let all = [ControlShape::Constant, ControlShape::Linear, ControlShape::Polynomial];
    all.into_iter().find(|it| shape_name(*it) == name)
}
