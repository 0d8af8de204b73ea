//! Optima on kinks: what an answer to a model without kinks says of the model that has them.
//!
//! There `q >= 0` and `q + e >= 0` stand for `q = max(-e, 0)`. The answer is one to the model where
//! one of both is 0 at all times; then the controls that the model has are an optimum of it, as
//! what it allows is a part of what was allowed. Where neither is, `q (q + e)` gets a price.

use super::found::Phases;
use super::report::{Options, Start};
use super::shown::path_conditions;
use super::true_optimum::Stretch;
use super::tuning::kinks::{EXACT, HIGHER, LOOSE, MOST_PRICES, NOTHING, PRICE, ROUNDING, TIGHT};
use super::{Compiled, Solution};
use crate::error::Error;
use crate::model::Model;
use crate::record::Record;
use crate::verification::Verification;
use fdcc_compiler::{Kinks, is_kink, side_of};
use fdcc_runtime::nlp::Status;
use fdcc_runtime::problem::{Chain, Columns, Function, Problem, Variable};
use fdcc_runtime::solution::{ChainOutcome, Outcome, Trajectory};

/// The answer in the words of the model with its kinks; nothing where it is to be solved as it is.
pub(super) fn solve(
    own: &Compiled,
    without: &Compiled,
    options: &Options,
) -> Result<Option<Solution>, Error> {
    // Nodes of controls have to be those of all controls.
    let record = match options.start {
        Start::Record(it) => Some(Record { nodes: None, ..it.clone() }),
        _ => None,
    };
    let start = record.as_ref().map_or(options.start, Start::Record);
    let found = without.solve(&Options { start, ..*options })?;
    let Some(found) = tight(own, found, options)? else { return Ok(None) };
    let first = with_kinks(own, found);
    Ok(Some(located(own, &first, options)?.unwrap_or(first)))
}

/// The first answer without gaps: as it was found, or certified at a price. What has gaps has no
/// objective of the model, so it is none.
fn tight(own: &Compiled, found: Solution, options: &Options) -> Result<Option<Solution>, Error> {
    if is_end(&found, options) {
        return Ok(Some(found));
    }
    let is_lost = matches!(found.status(), Status::Infeasible);
    if is_lost || own.model.names_its_discretisation() {
        return Ok(None);
    }
    let (mut found, mut price) = (found, None);
    for _ in 0..MOST_PRICES {
        let next = price.map_or_else(|| first_price(&found), |it: f64| it * HIGHER);
        let Some(model) = own.model.without_kinks(Kinks::Priced(next)) else { break };
        price = Some(next);
        found = near(&model, &found, options)?;
        if found.is_certified() && is_end(&found, options) {
            return Ok(Some(found));
        }
        if (options.stop)().is_break() {
            break;
        }
    }
    Ok(None)
}

/// The certified answer in which surfaces stand for kinks of states; nothing where what was found
/// is as good.
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
    Ok(Some(found).filter(Solution::is_certified))
}

/// Solves from what was found for other kinks.
fn near(model: &Model, found: &Solution, options: &Options) -> Result<Solution, Error> {
    let record = record(found);
    let start = if found.status().is_solved() { Start::Record(&record) } else { options.start };
    model.compile_as_it_is(None)?.solve(&Options { start, ..*options })
}

/// Whether it is an answer to the model with its kinks, or there is none, or it was stopped. What
/// is proved to have no solution has none with kinks either.
fn is_end(found: &Solution, options: &Options) -> bool {
    let is_infeasible = matches!(found.status(), Status::Infeasible) && found.outcome.is_impossible;
    let is_answer =
        || found.status().is_solved() && is_tight(&found.problem, &found.outcome.trajectory);
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
    let mut record = found.record();
    record.controls.retain(|it| !is_kink(it.0));
    record.free.retain(|it| !is_kink(it.0));
    record.nodes = None;
    record
}

/// An unknown that stands for a kink, with the other of its conditions; over time their integrals.
struct Gap {
    /// The lesser of `q` and `q + e`.
    least: f64,
    /// The larger of both.
    largest: f64,
    /// `e^2`
    square: f64,
    /// The part of the larger that the lesser may be.
    limit: f64,
    /// What is nothing, beside rounding.
    nothing: f64,
}

impl Gap {
    fn new(limit: f64, unit: f64) -> Self {
        Gap { least: 0.0, largest: 0.0, square: 0.0, limit, nothing: ROUNDING * unit }
    }

    fn add(&mut self, q: f64, row: f64, duration: f64) {
        self.least += q.min(row).max(0.0) * duration;
        self.largest += q.abs().max(row.abs()) * duration;
        self.square += (row - q).powi(2) * duration;
    }

    fn is_none(&self) -> bool {
        self.least <= (self.limit * self.largest).max(self.nothing)
    }
}

fn gaps(problem: &Problem, trajectory: &Trajectory) -> Vec<Gap> {
    let rows = path_conditions(problem, trajectory);
    let limit = if trajectory.nodes.is_some() { LOOSE } else { TIGHT };
    let gap = |(control, unknown): (&Variable, &Vec<f64>)| {
        let row = rows.iter().find(|it| is_kink(&it.name) && it.name == control.name)?;
        let time = &trajectory.time;
        let mut gap = Gap::new(limit, control.unit * (time[time.len() - 1] - time[0]));
        for ((q, row), pair) in unknown.iter().zip(&row.values[1..]).zip(time.windows(2)) {
            gap.add(*q, *row, pair[1] - pair[0]);
        }
        Some(gap)
    };
    let along = problem.controls.iter().zip(&trajectory.controls).filter_map(gap);
    along.chain(gaps_of_ends(problem, trajectory)).collect()
}

fn gaps_of_ends(problem: &Problem, trajectory: &Trajectory) -> Vec<Gap> {
    let unknowns = problem.unknowns.iter().map(|it| it.parameter);
    let unknowns = unknowns.filter(|at| is_kink(&problem.parameters[*at].name));
    let unknowns: Vec<usize> = unknowns.collect();
    if unknowns.is_empty() {
        return Vec::new();
    }
    let boundary = &*problem.boundary;
    let (layout, count) = (boundary.layout(), boundary.layout().x / 2);
    let mut ends = Columns::new(layout.point_inputs(), 1);
    for (at, column) in trajectory.states.iter().take(count).enumerate() {
        let first = layout.states().start + at;
        ends.column_mut(first)[0] = column[0];
        ends.column_mut(first + count)[0] = column[column.len() - 1];
    }
    let mut values = Columns::new(boundary.outputs(), 1);
    boundary.value(&ends, &trajectory.parameters, &mut values);
    let gap = |at: usize| {
        let parameter = &problem.parameters[at];
        let row =
            (1..boundary.outputs()).find(|row| *boundary.origin(*row).label == *parameter.name)?;
        let mut gap = Gap::new(TIGHT, parameter.unit);
        gap.add(trajectory.parameters[at], values.column(row)[0], 1.0);
        Some(gap)
    };
    unknowns.into_iter().filter_map(gap).collect()
}

/// Whether one of the two conditions on each unknown that stands for a kink is an equality: at all
/// times, or on average where controls are known by their means on intervals only.
pub(super) fn is_tight(problem: &Problem, trajectory: &Trajectory) -> bool {
    gaps(problem, trajectory).iter().all(Gap::is_none)
}

/// So high that what an answer gains by gaps counts little beside what they cost.
fn first_price(found: &Solution) -> f64 {
    let (time, trajectory) = (found.time(), &found.outcome.trajectory);
    let scale = trajectory.hamiltonian.scale * (time[time.len() - 1] - time[0]);
    let size = found.objective().abs().max(scale);
    let size = if size > NOTHING { size } else { 1.0 };
    let squares = gaps(&found.problem, trajectory).iter().map(|it| it.square).sum::<f64>();
    let price = PRICE * size / squares;
    if found.status().is_solved() && price.is_finite() { price } else { PRICE }
}

/// The answer without what stands for kinks.
fn in_words_of(own: &Compiled, mut found: Solution) -> Solution {
    let method = found.problem.method.clone();
    let problem = Problem { method, ..own.problem.clone() };
    let outcome = without(&found.problem, &problem, &found.outcome);
    let seen = Phases {
        model: found.model().meaning().clone(),
        chain: Chain::single(found.problem.clone()),
        outcome: ChainOutcome::single(found.outcome.clone()),
    };
    found.between_jumps.get_or_insert(seen);
    if let Some(it) = &mut found.certificate {
        it.arcs = in_words(std::mem::take(&mut it.arcs));
        it.switches.retain(|switch| !is_kink(&switch.surface));
    }
    found.of_model(own.model.clone(), problem, outcome)
}

/// Without the arcs of what stands for kinks; a condition is at its bound where one of its sides
/// is.
fn in_words(arcs: Vec<(String, Vec<Stretch>)>) -> Vec<(String, Vec<Stretch>)> {
    let mut own: Vec<(String, Vec<Stretch>)> = Vec::new();
    for (name, stretches) in arcs {
        let of = side_of(&name).map(str::to_owned);
        match own.iter_mut().find(|it| Some(&it.0) == of.as_ref()) {
            Some((_, known)) => *known = both(known, &stretches),
            None => own.push((of.unwrap_or(name), stretches)),
        }
    }
    own.retain(|it| !is_kink(&it.0));
    own
}

/// At a bound where one of two is.
fn both(one: &[Stretch], other: &[Stretch]) -> Vec<Stretch> {
    let ends = one.iter().chain(other).flat_map(|it| [it.from, it.to]);
    let mut times: Vec<f64> = ends.collect();
    times.sort_by(f64::total_cmp);
    times.dedup();
    let mut all: Vec<Stretch> = Vec::new();
    for pair in times.windows(2) {
        let [from, to] = [pair[0], pair[1]];
        let there = one.iter().chain(other).filter(|it| it.from <= from && to <= it.to);
        let bound = there.map(|it| it.arc).find(|it| *it != "free").unwrap_or("free");
        match all.last_mut().filter(|it| it.arc == bound) {
            Some(last) => last.to = to,
            None => all.push(Stretch { arc: bound, from, to }),
        }
    }
    all
}

/// What the true system with its kinks does with the controls of a certified answer.
fn replay_again(own: &mut Solution) {
    if !own.is_certified() {
        return;
    }
    let replay = own.verify().ok();
    let unknown = f64::INFINITY;
    let hamiltonian = &own.outcome.trajectory.hamiltonian;
    let time = own.time();
    let size = own.objective().abs().max(hamiltonian.scale * (time[time.len() - 1] - time[0]));
    let objective = |it: &Verification| {
        it.simulation.objective.map_or(unknown, |its| (its - own.objective()).abs() / size)
    };
    let violated = |it: &Verification| it.worst().map_or(0.0, |it| it.part);
    let figures = [
        ("replayed", replay.as_ref().and_then(Verification::state_gap).unwrap_or(unknown)),
        ("objective", replay.as_ref().map_or(unknown, objective)),
        ("conditions", replay.as_ref().map_or(unknown, violated)),
    ];
    for check in own.certificate.iter_mut().flat_map(|it| &mut it.checks) {
        let again = figures.iter().find(|it| it.0 == check.name);
        check.figure = again.map_or(check.figure, |it| check.figure.max(it.1));
    }
}

/// What was found, without what stands for kinks in the problem that was seen.
fn without(seen: &Problem, own: &Problem, outcome: &Outcome) -> Outcome {
    let is_shown = |name: &str| !is_kink(name);
    let controls: Vec<bool> = seen.controls.iter().map(|it| is_shown(&it.name)).collect();
    let surfaces: Vec<bool> = seen.surfaces.iter().map(|it| is_shown(&it.name)).collect();
    let its = &outcome.trajectory;
    let value = |name: &str| {
        let at = seen.parameters.iter().position(|it| it.name == name);
        at.map_or(f64::NAN, |at| its.parameters[at])
    };
    let mut trajectory = Trajectory {
        controls: kept(&its.controls, &controls),
        path_multipliers: with_sides(&*seen.path, 0, &its.path_multipliers, &|sum, it| {
            sum.iter_mut().zip(it).for_each(|(sum, it)| *sum += it);
        }),
        end_multipliers: with_sides(&*seen.boundary, 1, &its.end_multipliers, &|sum, it| {
            *sum += it
        }),
        switching: kept(&its.switching, &surfaces),
        parameters: own.parameters.iter().map(|it| value(&it.name)).collect(),
        ..its.clone()
    };
    trajectory.hamiltonian.violations = kept(&its.hamiltonian.violations, &controls);
    if let Some(nodes) = &mut trajectory.nodes {
        nodes.values = kept(&nodes.values, &controls);
    }
    Outcome {
        trajectory,
        sigma: kept(&outcome.sigma, &surfaces),
        modes: kept(&outcome.modes, &surfaces),
        ..outcome.clone()
    }
}

/// The multipliers of the outputs of a function from the first of them on, without those of what
/// stands for kinks; those of all sides of a condition are added up.
fn with_sides<T: Clone>(
    function: &dyn Function,
    first: usize,
    all: &[T],
    add: &dyn Fn(&mut T, &T),
) -> Vec<T> {
    let label = |row: usize| function.origin(first + row).label;
    let own: Vec<usize> = (0..all.len()).filter(|row| !is_kink(&label(*row))).collect();
    let mut kept: Vec<T> = own.iter().map(|row| all[*row].clone()).collect();
    for (row, multiplier) in all.iter().enumerate() {
        let name = label(row);
        let of = side_of(&name).and_then(|it| own.iter().position(|own| *label(*own) == *it));
        if let Some(of) = of {
            add(&mut kept[of], multiplier);
        }
    }
    kept
}

/// The entries that are to be kept; all that nothing is said of.
fn kept<T: Clone>(all: &[T], is_kept: &[bool]) -> Vec<T> {
    let is_kept = is_kept.iter().copied().chain(std::iter::repeat(true));
    all.iter().zip(is_kept).filter(|it| it.1).map(|it| it.0.clone()).collect()
}
