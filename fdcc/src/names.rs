//! The words that files and verdicts have for statuses, modes and events.

use fdcc_runtime::nlp::Status;
use fdcc_runtime::simulate::EventKind;
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

/// [`Status::is_solved`] of a status by its name, where only that is known.
pub fn is_solved(name: &str) -> bool {
    [Status::Solved, Status::Acceptable].iter().any(|it| status_name(it, false) == name)
}

/// The name of a mode in files and verdicts.
pub fn mode_name(mode: Mode) -> &'static str {
    match mode {
        Mode::Below => "below",
        Mode::Held => "held",
        Mode::Above => "above",
    }
}

/// The name of what happens at an event, in files.
pub fn event_name(kind: EventKind) -> &'static str {
    match kind {
        EventKind::CrossesUp => "crosses_up",
        EventKind::CrossesDown => "crosses_down",
        EventKind::EntersSliding => "enters_sliding",
        EventKind::LeavesUp => "leaves_up",
        EventKind::LeavesDown => "leaves_down",
        EventKind::Passes => "passes",
        EventKind::Jump(_) => "jump",
        EventKind::StartsSliding => "starts_sliding",
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_name_says_of_a_status_whether_it_is_solved() {
        for status in [
            Status::Solved,
            Status::Acceptable,
            Status::Infeasible,
            Status::Unbounded,
            Status::IterationLimit,
            Status::TimeLimit,
            Status::Interrupted,
            Status::NumericalFailure,
        ] {
            assert_eq!(is_solved(status_name(&status, false)), status.is_solved(), "{status:?}");
        }
    }
}
