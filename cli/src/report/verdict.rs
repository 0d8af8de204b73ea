//! What is said at the end of a solve: how it ended, what was found, what each surface did.

use crate::output::document::Document;
use crate::output::modes::switching;
use crate::output::number::{scientific, short};
use crate::output::optimality::on_the_true_system;
use crate::output::plural;
use crate::output::tried::Family;
use crate::report::attempts;
use crate::solved::Solved;
use fdcc::{Ended, Solution};
use fdcc_runtime::nlp::Status;
use fdcc_runtime::problem::{Chain, Method, Order, Problem};
use fdcc_runtime::transcribe::unknowns;
use std::collections::HashMap;

mod jumps;
mod next;
mod rest;
pub mod without_value;

/// More phases, or unknowns of a fit, than this are not told one by one,
const MOST_LISTED: usize = 8;
/// but so many of them, and how many more there are.
const FIRST_LISTED: usize = 3;

/// The size of the problem: one line, or one for each phase.
pub fn headline(chain: &Chain) -> String {
    let all = &chain.phases;
    if all.len() <= MOST_LISTED {
        return all.iter().map(phase).collect();
    }
    let (first, others) = all.split_at(FIRST_LISTED);
    let last = &others[others.len() - 1].name;
    let unknowns = plural(others.iter().map(unknowns).sum(), "unknown");
    let first: String = first.iter().map(phase).collect();
    format!("{first} and {} more phases up to {last}   {unknowns}\n", others.len())
}

fn phase(problem: &Problem) -> String {
    let shown = problem.states.iter().filter(|state| !state.hidden).count();
    let method = &problem.method;
    format!(
        " {}   {}  {}  {}  {}  N {}  {}\n",
        problem.name,
        plural(shown, "state"),
        plural(problem.controls.len(), "control"),
        plural(problem.surfaces.len(), "surface"),
        asked(method),
        method.intervals(),
        plural(unknowns(problem), "unknown"),
    )
}

/// The scheme as the model names it: without a number where that is to be found.
fn asked(method: &Method) -> String {
    let name = method.scheme.name();
    if method.order == Order::Auto {
        name.trim_end_matches(|c: char| c.is_ascii_digit()).into()
    } else {
        name
    }
}

/// The verdict for people.
pub fn verdict(solved: &Solved) -> String {
    let document = &solved.document;
    let work = format!(
        "{}   optimality error {}   constraint violation {}   {:.3} s",
        plural(document.iterations, "iteration"),
        scientific(document.kkt_error, 1),
        scientific(document.constraint_violation, 1),
        document.seconds.total
    );
    let word = if solved.is_good() { "done" } else { "stop" };
    let mut lines =
        vec![format!(" {word}  {}", how(solved)), format!("       {}", found(document))];
    lines.push(format!("       {work}"));
    lines.extend(jumps::lines(&solved.solution, document));
    lines.extend(spread(&solved.solution, document));
    if let Some(estimates) = &document.estimates {
        lines.extend(estimates.lines(document));
    }
    let is_certified = document.is_certified();
    lines.extend(surfaces(document, "", is_certified));
    for (name, phase) in &document.phases.0 {
        lines.extend(surfaces(&phase.0, &format!("{name}."), is_certified));
    }
    if let Some(certificate) = &document.certificate {
        lines.extend(certificate.lines(&document.units));
        lines.extend(certificate.failure());
        lines.extend(certificate.advice().map(str::to_owned));
    }
    lines.extend(rest::lines(solved));
    lines.extend(document.reach.iter().map(|it| format!(" near  {}", it.words(&document.units))));
    lines.extend(replayed(document));
    lines.extend(refined(solved));
    if solved.solution.status().is_solved() && solved.solution.problem.has_objective {
        lines.extend(hamiltonian(document));
    }
    lines.extend(sensitivities(document));
    let moved = document.derivatives.0.iter();
    lines.extend(moved.map(|(name, it)| it.line(name, &document.units)));
    lines.extend(next::line(document));
    lines.join("\n") + "\n"
}

/// The objective and the unknowns. Of a fit each has a line of its own, too: of many of them a few
/// are told here.
fn found(document: &Document) -> String {
    let named = |name: &str, value: f64| format!("{name} {}", document.units.value(name, value, 9));
    let unknowns = &document.free.0;
    let is_folded = document.estimates.is_some() && unknowns.len() > MOST_LISTED;
    let told = if is_folded { FIRST_LISTED } else { unknowns.len() };
    let more = is_folded.then(|| format!("and {} more", unknowns.len() - told));
    let first = unknowns.iter().take(told).map(|(name, value)| named(name, *value));
    let all = [named("objective", document.objective)].into_iter().chain(first).chain(more);
    all.collect::<Vec<_>>().join("   ")
}

/// Objectives within this, relative to their size, are told as one.
const SAME: f64 = 1e-6;

/// The minima that were found from several starts, the best one first, and how often.
fn spread(solution: &Solution, document: &Document) -> Vec<String> {
    let is_solved = |ended: &&Ended| ended.is_solved;
    let mut found: Vec<f64> =
        solution.starts.iter().filter(is_solved).map(|ended| ended.objective).collect();
    // The best one is the answer, whichever way is better.
    found.sort_by(|a, b| (a - document.objective).abs().total_cmp(&(b - document.objective).abs()));
    let same = |a: &f64, b: &f64| (a - b).abs() <= SAME * b.abs().max(1.0);
    let row = |count: usize, objective: f64, words: &str| {
        let value = document.units.value("objective", objective, 9);
        format!("       {count} of {} starts: objective {value}{words}", solution.starts.len())
    };
    let solved = found.len();
    let smoothed = found.chunk_by(same).map(|found| row(found.len(), found[0], ""));
    let mut rows: Vec<String> = match document.families.as_slice() {
        [] => smoothed.collect(),
        families => {
            let words = |it: &Family| if it.certified { ", certified" } else { ", not certified" };
            families.iter().map(|it| row(it.starts, it.objective, words(it))).collect()
        }
    };
    match solution.starts.len() - solved {
        0 => {}
        others => {
            rows.push(format!("       {others} of {} starts: not solved", solution.starts.len()))
        }
    }
    rows
}

/// What each surface did, if the trajectory says anything about it.
fn surfaces(document: &Document, phase: &str, is_certified: bool) -> impl Iterator<Item = String> {
    let has_trajectory = document.status != "not_finite";
    let units = &document.units;
    let sigmas = document.method.sigmas.0.iter().filter(move |_| has_trajectory);
    sigmas.map(move |(own, sigma)| {
        let modes =
            document.surfaces.get(own).map(|spans| switching(spans, units)).unwrap_or_default();
        let name = format!("{phase}{own}");
        if is_certified {
            return format!(" {name:<5} {modes}");
        }
        format!(
            " {name:<5} {modes}   (sigma {}, kernel {})",
            units.width(own, *sigma),
            document.method.kernel
        )
    })
}

/// The first line. It never says "optimal": an optimum of the discretised problem is not one of the
/// true system.
fn how(solved: &Solved) -> String {
    let Solved { solution, document } = solved;
    let Solution { problem, outcome, .. } = solution;
    let certificate = document.certificate.as_ref().filter(|it| it.certified);
    let found = match problem.has_objective {
        false if certificate.is_some() => "trajectory",
        false => "feasible trajectory",
        true if document.global => "global optimum",
        true => "local optimum",
    };
    if let Some(certificate) = certificate {
        return certificate.headline(found, problem.has_objective, document.all_jumps().len());
    }
    let status = &outcome.solution.status;
    let of = first_solved(document);
    let uncertified = if document.certificate.is_some() { "NOT CERTIFIED, " } else { "" };
    let tolerance = format!("tolerance {:e}", document.method.tol);
    let proof = if document.global || !problem.has_objective { "" } else { "; not proved global" };
    match status {
        Status::Solved => {
            format!(
                "{uncertified}{found} of the {of}, {} ({tolerance} met{proof})",
                on_the_true_system(document)
            )
        }
        Status::Acceptable => {
            format!(
                "{uncertified}{found} of the {of}, less accurate than asked for, {} ({tolerance} \
                 NOT met{proof})",
                on_the_true_system(document)
            )
        }
        Status::Infeasible if !outcome.is_impossible => format!("NOT SOLVED, {}", why(solved)),
        _ => format!("NOT SOLVED, {}: {}", solution.status_name().replace('_', " "), why(solved)),
    }
}

fn has_surfaces(document: &Document) -> bool {
    let phases = document.phases.0.iter().map(|(_, phase)| &phase.0);
    phases.chain([document]).any(|it| !it.surfaces.0.is_empty())
}

/// What was reached where the grid was to be chosen.
fn refined(solved: &Solved) -> Option<String> {
    let (document, method) = (&solved.document, &solved.solution.problem.method);
    let (error, tolerance) = (document.step_errors?, method.tolerance);
    let verdict = if error <= tolerance { "" } else { ", NOT met" };
    let order = if method.order == Order::Auto {
        format!(" of {}", document.method.scheme)
    } else {
        String::new()
    };
    Some(format!(
        " grid  {}{order}, errors of all steps {} (tolerance {}{verdict})",
        plural(document.method.n, "interval"),
        short(error),
        short(tolerance)
    ))
}

/// By how much of the size of its terms the Hamiltonian may miss what it has to be, before that is
/// told.
const MISSED: f64 = 0.05;

/// What is said where the Hamiltonian is not what it has to be: then the grid is too coarse for
/// what happens on it.
fn hamiltonian(document: &Document) -> Option<String> {
    let check = &document.hamiltonian_check;
    let deviation = check.deviation.filter(|it| *it > MISSED * check.size)?;
    let target = check.expected.map_or("constant".into(), |it| format!("{} throughout", short(it)));
    Some(format!(
        " grid  the Hamiltonian has to be {target} and is off by {} on average: the answer depends \
         on the grid, more intervals will change it",
        short(deviation)
    ))
}

/// What the optimum is worth to each parameter.
fn sensitivities(document: &Document) -> impl Iterator<Item = String> {
    let is_told = |slope: &f64| slope.is_finite() || slope.is_nan();
    let all = document.sensitivities.0.iter().filter(move |(_, slope)| is_told(slope));
    let params = document.params.0.iter().rev();
    let values: HashMap<&str, f64> = params.map(|(name, value)| (name.as_str(), *value)).collect();
    all.map(move |(name, slope)| {
        let value = values.get(name.as_str()).copied().unwrap_or(f64::NAN);
        let at = document.units.value(name, value, 6);
        if slope.is_nan() {
            return format!(
                " if    {name} = {at} changes, the objective has no derivative: a kink, or \
                            conditions that depend on each other"
            );
        }
        let percent = 0.01 * value * slope;
        let percent = if percent == 0.0 || !percent.is_finite() {
            String::new()
        } else {
            format!("   1 % more: {}", document.units.value("objective", percent, 3))
        };
        format!(
            " if    {name} = {at} changes, the objective changes by {}{percent}",
            document.units.per("objective", name, *slope, 5)
        )
    })
}

/// The replay in numbers.
fn replayed(document: &Document) -> Option<String> {
    let replay = document.verification.as_ref()?;
    replay.state_gap?;
    let units = &document.units;
    let mut words = vec![" true  replayed:".to_owned()];
    words.extend(
        replay.objective.map(|it| format!("objective {}", units.value("objective", it, 9))),
    );
    words.push(replay.difference(units).unwrap_or_else(|| "no state differs".into()));
    words.push(match replay.worst.as_ref().zip(replay.violation(units)) {
        Some((worst, amount)) => {
            let when = worst.time.map(|t| format!(" at t = {}", units.value("time", t, 6)));
            format!("`{}` off by {amount}{}", worst.condition, when.unwrap_or_default())
        }
        None => "all conditions met".into(),
    });
    words.push(plural(replay.events, "event"));
    Some(words.join("   ").replacen(":   ", ": ", 1))
}

/// What there is where a solve was stopped.
fn this_is(solved: &Solved) -> String {
    match solved.solution.certificate {
        // The search for an optimum of the true system begins at a solved problem.
        Some(_) => format!("this is the answer to the {}", first_solved(&solved.document)),
        None => "this is the last iterate".into(),
    }
}

/// What is solved before anything is located.
fn first_solved(document: &Document) -> &'static str {
    if has_surfaces(document) { "smoothed problem" } else { "discretised problem" }
}

fn intervals(solved: &Solved) -> String {
    plural(solved.solution.problem.method.intervals(), "interval")
}

/// What the status of a failed solve means.
fn why(solved: &Solved) -> String {
    let method = &solved.solution.problem.method;
    match &solved.solution.outcome.solution.status {
        Status::Infeasible if solved.solution.outcome.is_impossible => {
            format!(
                "proved: there is no trajectory of {} that meets all conditions",
                intervals(solved)
            )
        }
        Status::Infeasible => {
            format!("{}; {}", attempts::words(&solved.solution), attempts::advice(&solved.solution))
        }
        Status::Unbounded => "the objective improves without end; something needs a bound".into(),
        Status::IterationLimit => {
            format!("{}; `--method max_iter=...` allows more", plural(method.max_iter, "iteration"))
        }
        Status::TimeLimit => format!("the time of `--time-limit` is up; {}", this_is(solved)),
        Status::Interrupted => format!("stopped by Ctrl-C; {}", this_is(solved)),
        Status::NotFinite(_) => "an expression of the model has no value".into(),
        Status::NumericalFailure if solved.solution.outcome.solution.is_saddle => {
            "a saddle: stationary, but no minimum, and no step leads on; another `guess` or \
             `--starts 8` may help"
                .into()
        }
        // Those that are solved have been answered already.
        Status::NumericalFailure | Status::Solved | Status::Acceptable => {
            "no step makes progress; another `guess`, `sigma` or N may help".into()
        }
    }
}
