//! What is checked of a located answer before it is called an optimum of the true system.

use super::Solution;
use super::other_modes::other_modes;
use super::timing::gap_of_a_moment;
use super::true_optimum::certificate_limits::{
    CONTACT, GAIN, HAMILTONIAN, MEASURED, MODES, REPLAYED, SEEN, STATIONARY, TIMING, WORTH,
    WRONG_SIGN,
};
use super::true_optimum::{
    Certificate, Check, Contacts, Located, Range, Stretch, beyond_bounds, is_attracted,
    jumps_in_the_end, ranges, variations, wrong_sign,
};
use crate::verification::Verification;
use fdcc_compiler::{Arc, Model, PhaseOfModes, limits};
use fdcc_runtime::problem::{Problem, Variable};
use fdcc_runtime::solve::Outcome;

/// Of a located answer with its replay; `model` is what holds between jumps, `between` the smoothed
/// problem of that.
pub(super) fn certificate(
    located: &Located,
    model: &Model,
    between: &Problem,
    solution: &Solution,
    replay: Option<&Verification>,
) -> Certificate {
    let own = &located.outcome.solution;
    let check = |name, figure, limit| Check { name, figure, limit };
    let unknown = f64::INFINITY;
    let violation = |it: &Verification| it.worst().map_or(0.0, |condition| condition.part.abs());
    let objective = |it: &Verification| other_objective(located, solution, it);
    let phases = 0..located.structure.phases.len();
    let trajectories = located.outcome.phases.iter().map(|it| &it.trajectory);
    let ranges = ranges(&between.controls, &located.outcome.phases);
    let beyond = trajectories.map(|it| beyond_bounds(&ranges, it)).fold(0.0, f64::max);
    let is_held = phases.clone().all(|j| is_attracted(model, located, j));
    let accuracy = accuracy(between);
    let checks = vec![
        check("stationary", own.kkt_error, STATIONARY),
        check("second order", f64::from(u8::from(own.is_saddle)), 0.0),
        check("replayed", replay.and_then(Verification::state_gap).unwrap_or(unknown), accuracy),
        check("objective", replay.map_or(unknown, objective), accuracy),
        check("conditions", replay.map_or(unknown, violation), accuracy),
        check("modes", replay.map_or(unknown, |it| other_modes(model, solution, it)), MODES),
        check("timing", gap_of_a_moment(solution), TIMING),
        check("bounds", beyond, accuracy),
        check("arcs", wrong_sign(between, located).map_or(0.0, |it| it.part.max(0.0)), WRONG_SIGN),
        check("contacts", wrong_contact(between, model, located), CONTACT),
        check("holds", f64::from(u8::from(!is_held)), 0.0),
        check("insertion", located.insertion, WORTH),
        check("minimum", located.gain, GAIN),
        check("controls", located.loss, accuracy),
        check("hamiltonian", hamiltonian(located), HAMILTONIAN),
    ];
    let switches = located.switches(model, between, replay);
    let impulses = Contacts::new(model, located).impulses(between.sense);
    Certificate { checks, switches, arcs: arcs(between, model, located), impulses }
}

/// By how much replays may differ from what was planned.
pub(super) fn accuracy(problem: &Problem) -> f64 {
    problem.method.accuracy.unwrap_or(REPLAYED)
}

/// The difference between the objective of the replay and that of the plan, for its size; infinite
/// where the replay does not reach the end.
fn other_objective(located: &Located, solution: &Solution, replay: &Verification) -> f64 {
    let own = solution.objective();
    let size = own.abs().max(size_of_objective(located, solution.model().meaning()));
    match replay.simulation.objective {
        Some(its) => (its - own).abs() / size,
        None if solution.problem.has_objective => f64::INFINITY,
        None => 0.0,
    }
}

/// Beside its value; of measured data as much as a small part of each measurement makes.
pub(super) fn size_of_objective(located: &Located, model: &Model) -> f64 {
    let measured = || model.objective_at_rest().map_or(0.0, |it| MEASURED * it.abs());
    if model.objective_reads_sums() { measured() } else { located.objective_size() }
}

/// How wrong the sign of the multiplier of a state or a path condition at its bound is; infinite
/// where the motion is kept from a jump, or on one side of a surface that it is on, or pushed onto
/// a kink.
fn wrong_contact(between: &Problem, model: &Model, located: &Located) -> f64 {
    let contacts = Contacts::new(model, located);
    let wrong = contacts.wrong_sign().map_or(0.0, |it| it.part.max(0.0));
    let is_kept = contacts.is_at_jump() || jumps_in_the_end(&located.structure);
    let is_on_edge = || contacts.stays_on_a_surface() || contacts.is_pushed_onto_a_kink();
    if between.has_objective && (is_kept || is_on_edge()) { f64::INFINITY } else { wrong }
}

/// What each control does, and each state and path condition that is at a bound anywhere; where it
/// only touches the bound, for no time.
fn arcs(between: &Problem, model: &Model, located: &Located) -> Vec<(String, Vec<Stretch>)> {
    let controls = between.controls.iter().enumerate();
    let contacts = Contacts::new(model, located);
    let ranges = ranges(&between.controls, &located.outcome.phases);
    let of_control = |(at, it): (usize, &Variable)| {
        let seen = |j: usize, arc: Arc| match arc {
            Arc::Free => seen_arc(&located.outcome.phases[j], at, &ranges[at]),
            arc => arc,
        };
        (
            it.name.clone(),
            stretches(located, &|j, phase| (vec![(0.0, seen(j, phase.arcs[at]))], Arc::Free)),
        )
    };
    let mut all: Vec<(String, Vec<Stretch>)> = controls.map(of_control).collect();
    let mut conditions = model.path.iter();
    for (at, limit) in limits(model).into_iter().enumerate() {
        let name = match limit.state {
            Some(state) => model.states[state].place.name.clone(),
            None => conditions.next().map_or(String::new(), |it| it.place.name.clone()),
        };
        let own = stretches(located, &|j, phase| (contacts.seen(j, at), phase.touches[at]));
        if own.len() > 1 || own.iter().any(|it| it.arc != "free") {
            all.push((name, own));
        }
    }
    all
}

/// What a control does throughout a phase, by its values at the nodes.
fn seen_arc(phase: &Outcome, control: usize, Range { bounds, width, .. }: &Range) -> Arc {
    let Some(nodes) = &phase.trajectory.nodes else { return Arc::Free };
    let is_at =
        |bound: f64| nodes.values[control].iter().all(|it| (it - bound).abs() < SEEN * width);
    match () {
        () if is_at(bounds.lower) => Arc::Lower,
        () if is_at(bounds.upper) => Arc::Upper,
        () => Arc::Free,
    }
}

/// What holds from which parts of a phase on, and where it begins.
type InPhase = (Vec<(f64, Arc)>, Arc);

/// From what each phase has along it, and where it begins.
fn stretches(located: &Located, of: &dyn Fn(usize, &PhaseOfModes) -> InPhase) -> Vec<Stretch> {
    let mut all: Vec<Stretch> = Vec::new();
    let structure = &located.structure;
    for ((j, phase), pair) in structure.phases.iter().enumerate().zip(structure.times.windows(2)) {
        let (along, begin) = of(j, phase);
        let (first, begin) = (arc_name(along[0].1), arc_name(begin));
        let goes_on = all.last().is_some_and(|it| it.arc == begin);
        if begin != "free" && first == "free" && !goes_on {
            all.push(Stretch { arc: begin, from: pair[0], to: pair[0] });
        }
        let ends = along.iter().skip(1).map(|it| it.0).chain([1.0]);
        for ((from, arc), to) in along.iter().zip(ends) {
            let [from, to] = [*from, to].map(|part| pair[0] + part * (pair[1] - pair[0]));
            match all.last_mut().filter(|it| it.arc == arc_name(*arc)) {
                Some(stretch) => stretch.to = to,
                None => all.push(Stretch { arc: arc_name(*arc), from, to }),
            }
        }
    }
    all
}

fn arc_name(arc: Arc) -> &'static str {
    match arc {
        Arc::Lower => "min",
        Arc::Free => "free",
        Arc::Upper => "max",
    }
}

/// By how much of its size the Hamiltonian changes inside of phases, over the whole time.
fn hamiltonian(located: &Located) -> f64 {
    let [first, last] = located.structure.ends();
    variations(&located.outcome.phases).fold(0.0, f64::max) / (last - first)
}
