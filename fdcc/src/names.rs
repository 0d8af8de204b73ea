//! The words that files and verdicts have for statuses and modes.

use fdcc_runtime::nlp::Status;
use fdcc_runtime::solution::modes::Mode;

/// The name of a status in files and verdicts. `infeasible` is what is proved to be so.
pub fn status_name(status: &Status, is_impossible: bool) -> &'static str {
    match status {
        Status::Solved => "solved",
        Status::Acceptable => "acceptable",
        Status::Infeasible if is_impossible => "infeasible",
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
