//! An answer in the words of the model that has the kinks.

use super::found::Phases;
use super::phases::Whole;
use super::true_optimum::Stretch;
use super::{Compiled, Solution};
use crate::model::frame;
use fdcc_compiler::{is_kink, side_of};
use fdcc_runtime::problem::{Chain, Function, Problem};
use fdcc_runtime::solution::{ChainOutcome, Outcome, Trajectory};

/// The answer without what stands for kinks.
pub(super) fn in_words_of(own: &Compiled, mut found: Solution) -> Solution {
    if let Some(it) = &mut found.certificate {
        it.arcs = in_words(std::mem::take(&mut it.arcs));
        it.switches.retain(|switch| !is_kink(of_phase(&switch.surface).1));
    }
    match found.whole.take() {
        Some(whole) => of_phases(own, found, whole),
        None => of_one_piece(own, found),
    }
}

/// Phase by phase: the chain of the model with the grids and the signals of what was found.
fn of_phases(own: &Compiled, mut found: Solution, whole: Whole) -> Solution {
    let seen = Phases {
        model: found.model().meaning().clone(),
        chain: whole.chain.clone(),
        outcome: whole.outcome.clone(),
    };
    found.between_jumps.get_or_insert(seen);
    let Whole { mut chain, mut outcome } = whole;
    let all = chain.phases.iter_mut().zip(&mut outcome.phases).zip(&own.chain.phases);
    for ((seen, outcome), own) in all {
        let problem = Problem { method: seen.method.clone(), ..own.clone() };
        *outcome = without(seen, &problem, outcome);
        *seen = problem;
    }
    chain = Chain { phases: chain.phases, ..own.chain.clone() };
    let models = own.model.phases().into_iter().zip(&chain.phases).zip(&outcome.phases);
    for (part, ((model, problem), outcome)) in found.parts.iter_mut().zip(models) {
        let own = part.clone().of_model(model, problem.clone(), outcome.clone());
        *part = own;
    }
    let problem = frame(&chain);
    let kept = found.outcome.trajectory.parameters.len().min(problem.parameters.len());
    found.outcome.trajectory.parameters.truncate(kept);
    found.whole = Some(Whole { chain, outcome });
    let outcome = found.outcome.clone();
    found.of_model(own.model.clone(), problem, outcome)
}

fn of_one_piece(own: &Compiled, mut found: Solution) -> Solution {
    let method = found.problem.method.clone();
    let problem = Problem { method, ..own.problem.clone() };
    let outcome = without(&found.problem, &problem, &found.outcome);
    let seen = Phases {
        model: found.model().meaning().clone(),
        chain: Chain::single(found.problem.clone()),
        outcome: ChainOutcome::single(found.outcome.clone()),
    };
    found.between_jumps.get_or_insert(seen);
    found.of_model(own.model.clone(), problem, outcome)
}

/// Without the arcs of what stands for kinks; a condition is at its bound where one of its sides
/// is.
fn in_words(arcs: Vec<(String, Vec<Stretch>)>) -> Vec<(String, Vec<Stretch>)> {
    let mut own: Vec<(String, Vec<Stretch>)> = Vec::new();
    for (name, stretches) in arcs {
        let (phase, side) = of_phase(&name);
        let of = side_of(side).map(|it| format!("{phase}{it}"));
        match own.iter_mut().find(|it| Some(&it.0) == of.as_ref()) {
            Some((_, known)) => *known = both(known, &stretches),
            None => own.push((of.unwrap_or(name), stretches)),
        }
    }
    own.retain(|it| !is_kink(of_phase(&it.0).1));
    own
}

/// A name, after what says of which phase it is.
fn of_phase(name: &str) -> (&str, &str) {
    let at = name.find('.').map_or(0, |at| at + 1);
    if is_kink(&name[at..]) { name.split_at(at) } else { ("", name) }
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
