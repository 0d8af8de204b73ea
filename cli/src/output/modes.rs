//! The modes of surfaces over time, in documents and in words.

use super::named::Named;
use super::number::significant;
use super::units::Units;
use fdcc::names::mode_name;
use fdcc_runtime::problem::Problem;
use fdcc_runtime::solution::modes;
use fdcc_runtime::solve::Outcome;
use serde::Serialize;

/// A time span in one mode of a surface.
#[derive(Clone, Debug, Serialize)]
pub struct Span {
    pub mode: String,
    pub from: f64,
    pub to: f64,
}

/// Those of every surface.
pub(super) fn spans_of(problem: &Problem, outcome: &Outcome) -> Named<Vec<Span>> {
    let spans = |spans: &Vec<modes::Span>| {
        let spans = spans.iter();
        spans
            .map(|s| Span { mode: mode_name(s.mode).to_string(), from: s.from, to: s.to })
            .collect()
    };
    let surfaces = problem.surfaces.iter().zip(&outcome.modes);
    surfaces.map(|(surface, modes)| (surface.name.clone(), spans(modes))).collect()
}

/// `held 0-0.31, below 0.31-1.92 min`
pub fn switching(spans: &[Span], units: &Units) -> String {
    let range = |from: String, to: String| {
        // A minus sign next to a dash cannot be read.
        let dash = if from.contains('-') || to.contains('-') { " to " } else { "-" };
        format!("{from}{dash}{to}")
    };
    let spans = spans.iter();
    let time = |t: f64| significant(units.scaled("time", t), 4);
    let spans: Vec<String> =
        spans.map(|s| format!("{} {}", s.mode, range(time(s.from), time(s.to)))).collect();
    if spans.is_empty() { String::new() } else { spans.join(", ") + &units.unit("time") }
}
