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

/// What lasts for no longer than this part of the whole only touches.
const TOUCH: f64 = 1e-9;

/// Whether a span is a touch, where all of them last this long.
fn is_touch(span: &Span, whole: f64) -> bool {
    span.to - span.from <= TOUCH * whole
}

/// How often a surface is held for no time, of the `surface`s that change to a mode at a time.
pub fn touches(switches: &[(&str, f64, &str)]) -> usize {
    let end = switches.iter().map(|it| it.1.abs()).fold(0.0, f64::max);
    let is_touch = |(at, (surface, time, to)): &(usize, &(&str, f64, &str))| {
        let next = switches[at + 1..].iter().find(|it| it.0 == *surface);
        *to == HELD && next.is_some_and(|it| it.1 - time <= TOUCH * end)
    };
    switches.iter().enumerate().filter(is_touch).count()
}

const HELD: &str = "held";
const FREE: &str = "free";

/// Spans without those that last for no time and say nothing; those beside them that are alike are
/// one.
fn joined(spans: &[Span], whole: f64) -> Vec<Span> {
    let mut all: Vec<Span> = Vec::new();
    for span in spans.iter().filter(|it| it.mode != FREE || !is_touch(it, whole)) {
        match all.last_mut().filter(|it| it.mode == span.mode) {
            Some(last) => last.to = span.to,
            None => all.push(span.clone()),
        }
    }
    all
}

/// What follows what, without times: `held`, `below`; what only touches is `touches min`.
pub fn order(spans: &[Span]) -> Vec<String> {
    let ends = spans.first().zip(spans.last());
    let whole = ends.map_or(0.0, |(first, last)| last.to - first.from);
    let words = |span: &Span| match is_touch(span, whole) {
        true => format!("touches {}", span.mode),
        false => span.mode.clone(),
    };
    joined(spans, whole).iter().map(words).collect()
}

/// `held 0-0.31, below 0.31-1.92 min`; what only touches is `held at 0.31`.
pub fn switching(spans: &[Span], units: &Units) -> String {
    let ends = spans.first().zip(spans.last());
    let whole = ends.map_or(0.0, |(first, last)| last.to - first.from);
    let time = |t: f64| significant(units.scaled("time", t), 4);
    let words = |span: &Span| {
        let [from, to] = [span.from, span.to].map(time);
        // A minus sign next to a dash cannot be read.
        let dash = if from.contains('-') || to.contains('-') { " to " } else { "-" };
        match is_touch(span, whole) {
            true => format!("{} at {from}", span.mode),
            false => format!("{} {from}{dash}{to}", span.mode),
        }
    };
    let spans: Vec<String> = joined(spans, whole).iter().map(words).collect();
    if spans.is_empty() { String::new() } else { spans.join(", ") + &units.unit("time") }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_lasts_for_no_time_touches() {
        let span = |mode: &str, from, to| Span { mode: mode.into(), from, to };
        let spans = [
            span("min", 0.0, 1.0),
            span("free", 1.0, 1.0 + 1e-12),
            span("min", 1.0 + 1e-12, 2.0),
            span("free", 2.0, 3.0),
            span("max", 3.0, 3.0),
            span("free", 3.0, 4.0),
        ];
        let words = switching(&spans, &Units::default());
        assert_eq!(words, "min 0-2, free 2-3, max at 3, free 3-4");
        let switches = [
            ("s", 1.0, "held"),
            ("r", 1.0, "held"),
            ("s", 1.0 + 1e-12, "below"),
            ("r", 2.0, "above"),
        ];
        assert_eq!(touches(&switches), 1);
    }
}
