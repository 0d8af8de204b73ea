//! The diagnostics of a solve that failed, at the lines of the model: FDC0601 and FDC0602.

use crate::output::units::Units;
use crate::report::attempts;
use crate::report::verdict::without_value::WithoutValue;
use crate::solved::Solved;
use fdcc::Solution;
use fdcc_grammar::{Code, Diagnostic, Span};
use fdcc_runtime::nlp::{Place, Status};
use fdcc_runtime::problem::{Problem, Variable};
use fdcc_runtime::solve::{Limiting, Outcome};

/// What a failed solve says, if it is about a line of the model.
pub fn diagnostic(solved: &Solved) -> Option<Diagnostic> {
    let Solved { solution, document } = solved;
    let outcome = &solution.outcome;
    match &outcome.solution.status {
        // The runtime may not know the place.
        Status::NotFinite(place) if place.origin.label.is_empty() => None,
        Status::NotFinite(place) => {
            let phase = solution.phases().get(place.phase).map_or(outcome, |it| &it.outcome);
            Some(not_finite(phase, place, &document.units))
        }
        Status::Infeasible => {
            outcome.limiting.as_ref().map(|limiting| infeasible(solved, limiting))
        }
        _ => None,
    }
}

fn span((start, end): (u32, u32)) -> Span {
    Span { start, end }
}

fn not_finite(outcome: &Outcome, place: &Place, units: &Units) -> Diagnostic {
    let time = place.grid_point.and_then(|k| outcome.trajectory.time.get(k));
    let when = time.map(|t| format!(" at t = {}", units.value("time", *t, 6))).unwrap_or_default();
    let message = format!("not a number{when}, iteration {}", outcome.solution.counts.iterations);
    let label =
        format!("`{}` or one of its derivatives is infinite or undefined", place.origin.label);
    Diagnostic::new(Code::NotFinite, message, span(place.origin.span), label).help(
        "look for a division by 0, a `sqrt` or `log` at 0 or below, a power of a negative number. \
         Keep the trajectory away from it by a bound, round it off as in `sqrt(e + 1e-6)`, or give \
         a `guess` where everything has a value.",
    )
}

fn infeasible(solved: &Solved, limiting: &Limiting) -> Diagnostic {
    let Solved { solution, document } = solved;
    let Solution { problem, outcome, .. } = solution;
    let units = &document.units;
    let Limiting { origin, condition, violation, in_all, .. } = limiting;
    let (found, is_not) = match outcome.is_impossible {
        true => ("no feasible trajectory found", "cannot be met"),
        false => ("no feasible trajectory found near the guess", "is not met"),
    };
    let when =
        limiting.time.map(|t| format!(" at t = {}", units.value("time", t, 6))).unwrap_or_default();
    let mut diagnostic = match condition {
        Some(condition) => {
            let message = format!("{found}: `{}` {is_not}", condition.label);
            let label = "this stands against the equations most";
            // What is off is the state of the equation.
            let state = origin.label.trim_end_matches('\'');
            let [once, in_all] = [*violation, *in_all].map(|it| units.violation(state, it, 3));
            let worst = format!("worst{when}: off by {once} in one step, {in_all} in all");
            Diagnostic::new(Code::Infeasible, message, span(condition.span), label)
                .label(span(origin.span), worst)
        }
        None => {
            let amount = units.violation(&origin.label, *violation, 3);
            let message = format!("{found}: `{}` is violated by {amount}", origin.label);
            let label = format!("worst{when}: off by {amount}");
            Diagnostic::new(Code::Infeasible, message, span(origin.span), label)
        }
    };
    let phase = solution.phases().get(limiting.phase);
    let (problem, outcome) =
        phase.map_or((problem, outcome), |phase| (&phase.problem, &phase.outcome));
    for (control, text) in saturated(problem, outcome, limiting, units) {
        diagnostic = diagnostic.label(span(control.origin.span), text);
    }
    let diagnostic = diagnostic.help(advice(solution));
    let without_value = solution.sequences.iter().find_map(|it| WithoutValue::of(solution, it));
    match without_value {
        Some(it) => it.before(diagnostic),
        None => diagnostic,
    }
}

/// A proof and a failed search want different words.
fn advice(solution: &Solution) -> String {
    if solution.outcome.is_impossible {
        return "this is certain on this grid, because the problem is convex: no `guess` can help. \
                Loosen a condition, widen the bounds of a control, or allow more time."
            .into();
    }
    format!(
        "{}. No small change of this trajectory makes it better, but {}. Otherwise loosen a \
         condition, widen the bounds of a control, or allow more time.",
        attempts::words(solution),
        attempts::advice(solution)
    )
}

/// How close to a bound counts as at the bound, as a part of the range of a control, or of its
/// largest value where that is open.
const NEAR: f64 = 1e-3;

/// Controls that are at a bound at the worst time, with the span of time over which they are; where
/// there is no such time, as at the end, their longest stays.
fn saturated<'p>(
    problem: &'p Problem,
    outcome: &Outcome,
    limiting: &Limiting,
    units: &Units,
) -> Vec<(&'p Variable, String)> {
    let trajectory = &outcome.trajectory;
    let worst = limiting.time.and_then(|t| trajectory.time.iter().position(|other| *other >= t));
    let controls = problem.controls.iter().zip(&trajectory.controls);
    let mut found: Vec<(&Variable, String)> = controls
        .filter_map(|(control, values)| {
            let (bound, first, last) = match worst.filter(|_| limiting.condition.is_none()) {
                Some(worst) => stay(control, values, worst.saturating_sub(1))?,
                None => longest_stay(control, values)?,
            };
            let [from, to] = [first, last + 1].map(|k| units.value("time", trajectory.time[k], 6));
            let bound = units.value(&control.name, bound, 6);
            Some((control, format!("`{}` is at {bound} from t = {from} to {to}", control.name)))
        })
        .collect();
    // The parts of a vector share one declaration, and one label there is enough.
    found.dedup_by_key(|(control, _)| control.origin.span);
    found
}

/// The longest of all stays.
fn longest_stay(control: &Variable, values: &[f64]) -> Option<(f64, usize, usize)> {
    let intervals = (0..values.len()).rev();
    let all = intervals.filter_map(|interval| stay(control, values, interval));
    // The first of equals.
    all.max_by_key(|(_, first, last)| last - first)
}

/// The bound at which a control is in an interval, with the first and last interval of that stay.
fn stay(control: &Variable, values: &[f64], interval: usize) -> Option<(f64, usize, usize)> {
    let bounds = control.bounds;
    let range = bounds.upper - bounds.lower;
    let largest = values.iter().fold(0.0, |largest: f64, it| largest.max(it.abs()));
    let size = if range.is_finite() { range } else { largest };
    let is_near = |k: usize, bound: f64| (values[k] - bound).abs() <= NEAR * size;
    let ends = [bounds.lower, bounds.upper].into_iter().filter(|bound| bound.is_finite());
    let bound = ends.filter(|_| !bounds.is_equality()).find(|bound| is_near(interval, *bound))?;
    let first = (0..=interval).rev().take_while(|k| is_near(*k, bound)).last()?;
    let last = (interval..values.len()).take_while(|k| is_near(*k, bound)).last()?;
    Some((bound, first, last))
}
