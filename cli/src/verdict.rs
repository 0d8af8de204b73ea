//! What is said at the end of a solve: how it ended, what was found, what each surface did; and the diagnostics of a
//! solve that failed, at the lines of the model.

use crate::output::document::{Document, status_name, switching};

use crate::output::number::{short, significant};
use fdcc_grammar::{Code, Diagnostic, Span};
use fdcc_runtime::homotopy::{Limiting, Outcome};
use fdcc_runtime::nlp::{Place, Status};
use fdcc_runtime::problem::Problem;

/// One line: the size of the problem.
pub fn headline(problem: &Problem) -> String {
    let plural = |n: usize, noun: &str| format!("{n} {noun}{}", if n == 1 { "" } else { "s" });
    let shown = problem.states.iter().filter(|state| !state.hidden).count();
    let method = &problem.method;
    let unknowns = method.intervals * (problem.layout.x + problem.layout.u) + problem.layout.x + problem.unknowns.len();
    format!(
        " {}   {}  {}  {}  N {}  {}",
        problem.name,
        plural(shown, "state"),
        plural(problem.controls.len(), "control"),
        plural(problem.surfaces.len(), "surface"),
        method.intervals,
        plural(unknowns, "unknown"),
    )
}

/// The verdict for people.
pub fn verdict(document: &Document, outcome: &Outcome) -> String {
    let mut lines = vec![format!(" {:<6}{}", "done", how(document, outcome))];
    let mut result = vec![format!("objective {}", significant(document.objective, 9))];
    result.extend(document.free.0.iter().map(|(name, value)| format!("{name} {}", significant(*value, 9))));
    lines.push(format!("       {}", result.join("   ")));
    lines.push(format!(
        "       {} iterations   optimality error {}   constraint violation {}   {:.3} s",
        document.iterations,
        short_error(document.kkt_error),
        short_error(document.constraint_violation),
        document.seconds.total
    ));
    for (name, sigma) in &document.method.sigmas.0 {
        let modes = document.surfaces.get(name).map(|spans| switching(spans)).unwrap_or_default();
        lines.push(format!(" {name:<6}{modes}   (sigma {}, kernel {})", short(*sigma), document.method.kernel));
    }
    lines.join("\n") + "\n"
}

fn short_error(value: f64) -> String {
    format!("{value:.1e}")
}

fn how(document: &Document, outcome: &Outcome) -> String {
    let tolerance = format!("tolerance {:e}", document.method.tol);
    let not_replayed = if document.surfaces.0.is_empty() {
        "not replayed by a simulation"
    } else {
        "of the smoothed problem; not replayed on the true system"
    };
    match &outcome.solution.status {
        Status::Solved if document.global => format!("global optimum of the discretised problem ({tolerance} met; {not_replayed})"),
        Status::Solved => format!("local optimum, {not_replayed} ({tolerance} met; not proved global)"),
        Status::Acceptable => format!("local optimum to a lower accuracy than asked for, {not_replayed} ({tolerance} not met)"),
        status => format!("NOT SOLVED: {}", status_name(status).replace('_', " ")),
    }
}

/// What a failed solve says at the lines of the model.
pub fn diagnostic(problem: &Problem, outcome: &Outcome) -> Option<Diagnostic> {
    match &outcome.solution.status {
        Status::NotFinite(place) => Some(not_finite(outcome, place)),
        Status::Infeasible => outcome.limiting.as_ref().map(|limiting| infeasible(problem, outcome, limiting)),
        _ => None,
    }
}

fn span((start, end): (u32, u32)) -> Span {
    Span { start, end }
}

fn not_finite(outcome: &Outcome, place: &Place) -> Diagnostic {
    let time = place.grid_point.and_then(|k| outcome.trajectory.time.get(k));
    let when = time.map(|t| format!(" at t = {}", short(*t))).unwrap_or_default();
    let iteration = outcome.solution.counts.iterations;
    let message = format!("not a number{when}, iteration {iteration}");
    let label = format!("`{}` or one of its derivatives is infinite or undefined here", place.origin.label);
    Diagnostic::new(Code::NotFinite, message, span(place.origin.span), label).help(
        "look for a division by 0, a `sqrt` or `log` at 0 or below, a power of a negative number;\n\
         keep away from it by a bound or a `path` condition, round it as in `sqrt(x^2 + 1e-6)`,\n\
         or give a `guess` that starts elsewhere",
    )
}

fn infeasible(problem: &Problem, outcome: &Outcome, limiting: &Limiting) -> Diagnostic {
    let amount = significant(limiting.violation, 3);
    let message = format!("no feasible trajectory found: `{}` is violated by {amount} at best", limiting.origin.label);
    let when = limiting.time.map(|t| format!("worst at t = {}: ", short(t))).unwrap_or_default();
    let label = format!("{when}{amount} over the limit");
    let mut diagnostic = Diagnostic::new(Code::Infeasible, message, span(limiting.origin.span), label);
    for (text, origin) in saturated(problem, outcome, limiting) {
        diagnostic = diagnostic.label(span(origin), text);
    }
    diagnostic.help(format!(
        "no small move makes this better; loosen `{}` by {amount} or more, widen what holds it back,\n\
         or start from another `guess` if you know that a solution exists",
        limiting.origin.label
    ))
}

/// Controls that are at a bound at the worst time, with the span of time over which they are.
fn saturated(problem: &Problem, outcome: &Outcome, limiting: &Limiting) -> Vec<(String, (u32, u32))> {
    let time = &outcome.trajectory.time;
    let at = limiting.time.and_then(|t| time.iter().position(|other| *other >= t)).unwrap_or(time.len() - 1);
    let mut found: Vec<(String, (u32, u32))> = Vec::new();
    for (control, values) in problem.controls.iter().zip(&outcome.trajectory.controls) {
        let Some(interval) = at.checked_sub(1).filter(|k| *k < values.len()) else { continue };
        let bounds = control.bounds;
        let near = |value: f64, bound: f64| (value - bound).abs() <= 1e-3 * bound.abs().max(1.0);
        for bound in [bounds.lower, bounds.upper] {
            if !bound.is_finite() || !near(values[interval], bound) || bounds.is_equality() {
                continue;
            }
            let first = (0..=interval).rev().take_while(|k| near(values[*k], bound)).last().unwrap_or(interval);
            let last = (interval..values.len()).take_while(|k| near(values[*k], bound)).last().unwrap_or(interval);
            let (from, to) = (short(time[first]), short(time[last + 1]));
            let is_new = found.iter().all(|(_, origin)| *origin != control.origin.span);
            if is_new {
                found.push((format!("`{}` is at {} from t = {from} to {to}", control.name, short(bound)), control.origin.span));
            }
        }
    }
    found
}
