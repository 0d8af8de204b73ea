//! Optima on kinks: what an answer to a model without kinks says of the model that has them.
//!
//! There `q >= 0` and `q + e >= 0` stand for `q = max(-e, 0)`. The answer is one to the model where
//! one of both is 0 at all times; then the controls that the model has are an optimum of it, as
//! what it allows is a part of what was allowed. Where neither is, `q (q + e)` gets a price.

use super::kink_gaps::{are_tight, first_price, size_of_objective};
use super::kink_words::in_words_of;
use super::report::{Options, Start};
use super::true_optimum::gain_on_kinks;
use super::tuning::kinks::{EXACT, HIGHER, MOST_PRICES, WORSE};
use super::{Compiled, Solution};
use crate::error::Error;
use crate::model::Model;
use crate::record::Record;
use crate::verification::Verification;
use fdcc_compiler::{Kinks, Mode, is_kink};
use fdcc_runtime::nlp::Status;

/// The answer in the words of the model with its kinks; nothing where it is to be solved as it is.
pub(super) fn solve(
    own: &Compiled,
    without: &Compiled,
    options: &Options,
) -> Result<Option<Solution>, Error> {
    let record = match options.start {
        Start::Record(it) => Some(without_nodes(it.clone())),
        _ => None,
    };
    let start = record.as_ref().map_or(options.start, Start::Record);
    let found = without.solve_from(&Options { start, ..*options })?;
    let (found, price, first) = match certified(own, &found) {
        Some(first) => (found, None, first),
        None => {
            let Some(Tight { found, price }) = tight(own, found, options)? else { return Ok(None) };
            (found.clone(), price, with_kinks(own, found))
        }
    };
    // What the replay with its kinks contradicts is none.
    let is_lost = found.is_certified() && !first.is_certified();
    if let Some(located) = located(own, &first, options)? {
        return Ok(Some(located));
    }
    if is_lost { exact(own, Tight { found, price }, options) } else { Ok(Some(first)) }
}

/// An answer without gaps, as far as one can see, and what they cost there.
struct Tight {
    found: Solution,
    price: Option<f64>,
}

/// A certified answer whose replay with its kinks has the same objective: that is what was allowed
/// at best, whatever means over intervals say of its gaps.
fn certified(own: &Compiled, found: &Solution) -> Option<Solution> {
    let is_asked = found.is_certified() && own.problem.has_objective;
    let first = is_asked.then(|| with_kinks(own, found.clone()));
    first.filter(Solution::is_certified)
}

/// The answer to a model whose kinks stayed as they are; where those of time alone can be located,
/// and that is more exact, the one with surfaces in their place.
pub(super) fn in_time(
    own: &Compiled,
    first: Solution,
    options: &Options,
) -> Result<Solution, Error> {
    Ok(located(own, &first, options)?.unwrap_or(first))
}

/// The first answer without gaps: as it was found, or certified at a price. What has gaps has no
/// objective of the model, so it is none.
fn tight(own: &Compiled, found: Solution, options: &Options) -> Result<Option<Tight>, Error> {
    if is_end(&found, options) {
        return Ok(Some(Tight { found, price: None }));
    }
    let is_lost = matches!(found.status(), Status::Infeasible);
    if is_lost || own.model.names_its_discretisation() {
        return Ok(None);
    }
    let price = first_price(&found);
    at_prices(own, found, options, price)
}

/// What is certified without gaps, at the first price at which there is anything.
fn at_prices(
    own: &Compiled,
    mut found: Solution,
    options: &Options,
    mut price: f64,
) -> Result<Option<Tight>, Error> {
    for _ in 0..MOST_PRICES {
        let Some(model) = own.model.without_kinks(Kinks::Priced(price)) else { break };
        found = near(&model, &found, options)?;
        if found.is_certified() && is_end(&found, options) {
            return Ok(Some(Tight { found, price: Some(price) }));
        }
        if (options.stop)().is_break() {
            break;
        }
        price *= HIGHER;
    }
    Ok(None)
}

/// Gaps that are nearly none may still be worth something: an answer at a higher price that is
/// certified with its kinks, too.
fn exact(own: &Compiled, mut tight: Tight, options: &Options) -> Result<Option<Solution>, Error> {
    for _ in 0..MOST_PRICES {
        let Some(price) = tight.price else { break };
        let next = at_prices(own, tight.found, options, HIGHER * price)?;
        let Some(next) = next else { break };
        let first = with_kinks(own, next.found.clone());
        if first.is_certified() {
            return Ok(Some(first));
        }
        tight = next;
    }
    Ok(None)
}

/// The certified answer in which surfaces stand for kinks of states; nothing where what was found
/// is as good, or clearly better: a surface that is held throughout keeps unknowns where they are,
/// whatever they would be worth off it.
fn located(own: &Compiled, first: &Solution, options: &Options) -> Result<Option<Solution>, Error> {
    let replayed = first.certificate.as_ref().and_then(|it| it.figure("objective"));
    let is_exact = first.is_certified() && replayed.is_some_and(|it| it < EXACT);
    if is_exact || !first.status().is_solved() || (options.stop)().is_break() {
        return Ok(None);
    }
    let Some(model) = own.model.without_kinks(Kinks::Located) else { return Ok(None) };
    let mut found = with_kinks(own, near(&model, first, options)?);
    // What is convex in unknowns that are as small as they can be is convex without them.
    let is_convex = first.outcome.solution.global && found.problem.is_autonomous;
    found.outcome.solution.global = is_convex;
    let rise = own.problem.sense * (found.objective() - first.objective());
    let is_worse = rise > WORSE * size_of_objective(first).max(size_of_objective(&found));
    let is_kept = own.problem.controls.is_empty() && holds_a_surface(&found);
    Ok(Some(found).filter(|it| it.is_certified() && !is_worse && !is_kept))
}

/// Whether a surface is held anywhere: without controls nothing but unknowns can do that, and what
/// they would be worth off it nobody asked.
fn holds_a_surface(found: &Solution) -> bool {
    let phases = found.located.iter().flat_map(|it| &it.structure.phases);
    phases.into_iter().any(|it| it.modes.contains(&Mode::Held))
}

/// Solves from what was found for other kinks.
fn near(model: &Model, found: &Solution, options: &Options) -> Result<Solution, Error> {
    let record = record(found);
    let start = if found.status().is_solved() { Start::Record(&record) } else { options.start };
    model.compile_as_it_is(None)?.solve_from(&Options { start, ..*options })
}

/// Whether it is an answer to the model with its kinks, or there is none, or it was stopped. What
/// is proved to have no solution has none with kinks either.
fn is_end(found: &Solution, options: &Options) -> bool {
    let is_infeasible = matches!(found.status(), Status::Infeasible) && found.outcome.is_impossible;
    let is_answer = || found.status().is_solved() && are_tight(found);
    // An answer with gaps that came just in time is no answer.
    let is_stopped = (options.stop)().is_break() && !found.status().is_solved();
    is_stopped || is_infeasible || is_answer()
}

fn with_kinks(own: &Compiled, found: Solution) -> Solution {
    let mut own = in_words_of(own, found);
    replay_again(&mut own);
    own
}

/// Without what stands for kinks, which may be anything where nothing forbids it.
fn record(found: &Solution) -> Record<'_> {
    without_nodes(found.record())
}

/// Nodes of controls have to be those of all controls.
fn without_nodes(record: Record) -> Record {
    let mut record = Record { nodes: None, ..record };
    record.controls.retain(|it| !is_kink(it.0));
    record.free.retain(|it| !is_kink(it.0));
    record.phases = record.phases.into_iter().map(without_nodes).collect();
    record
}

/// By how much other controls make the Hamiltonian less, for the size of the objective over time,
/// where nothing switches, jumps or is divided: elsewhere modes are needed, and what was allowed is
/// compared alone.
fn gain(own: &Solution) -> f64 {
    let meaning = own.model().meaning();
    // Of a model in which unknowns stand for other kinks, they are not among its signals.
    let is_whole = own.problem.controls.len() == own.outcome.trajectory.controls.len();
    let is_divided = !own.parts.is_empty() || !meaning.at_times.is_empty();
    match !is_whole || is_divided || !meaning.surfaces.is_empty() || !meaning.jumps.is_empty() {
        true => 0.0,
        false => {
            let time = own.time();
            let gain = gain_on_kinks(meaning, &own.problem, &own.outcome);
            gain * (time[time.len() - 1] - time[0]) / size_of_objective(own).max(f64::MIN_POSITIVE)
        }
    }
}

/// What the true system with its kinks does with the controls of a certified answer.
fn replay_again(own: &mut Solution) {
    if !own.is_certified() {
        return;
    }
    let unknown = f64::INFINITY;
    let replays = own.replays().unwrap_or_default();
    let worst = |figure: fn(&Verification) -> f64| {
        let all = replays.iter().map(figure).fold(0.0, f64::max);
        if replays.is_empty() { unknown } else { all }
    };
    let replayed = own.objective_of(&replays).unwrap_or(unknown);
    let figures = [
        ("replayed", worst(|it| it.state_gap().unwrap_or(f64::INFINITY))),
        ("objective", (replayed - own.objective()).abs() / size_of_objective(own)),
        ("conditions", worst(|it| it.worst().map_or(0.0, |it| it.part))),
        ("minimum", gain(own)),
    ];
    for check in own.certificate.iter_mut().flat_map(|it| &mut it.checks) {
        let again = figures.iter().find(|it| it.0 == check.name);
        check.figure = again.map_or(check.figure, |it| check.figure.max(it.1));
    }
}
