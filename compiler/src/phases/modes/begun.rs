//! On which sides of the surfaces of jumps phases may begin, by what links say.
//!
//! A link hands the state over, so that `psi` at the first time of a phase is a function of other
//! ends. Its range follows from the bounds of these ends; and where the phase before says the same
//! of it at its last time, by a path condition or because a jump keeps it on one side, that holds.

use super::linked::Linked;
use crate::expressions::graph::{ExprId, evaluate_with};
use crate::expressions::interval::{Interval, Tape};
use crate::model::numbers::{Numbers, numbers};
use crate::model::{Begins, Model, Symbol};
use crate::phases::crossings::beginnings;
use crate::phases::path::has_both;
use crate::phases::turns::turns;
use fdcc_grammar::Diagnostic;
use fdcc_grammar::ast::Direction;

/// The model whose phases know where they may begin. `motion` are its phases as a simulation of the
/// guess goes through them, with the states at which they begin; none if nothing was simulated.
///
/// # Errors
///
/// A parameter without a value.
pub fn with_beginnings(model: &Model, motion: &[&Model]) -> Result<Model, Vec<Diagnostic>> {
    let (numbers, mut begun) = (numbers(model)?, model.clone());
    for phase in 0..model.phases.len() {
        let mut linked = Linked::new(model, &[], phase);
        let mut known = Vec::new();
        for other in (0..model.phases.len()).filter(|it| *it != phase) {
            known.extend(ends(&begun, other, &mut linked)?);
        }
        let own = &model.phases[phase].model;
        for (at, surface) in own.surfaces.iter().enumerate() {
            let psi = linked.at_start(model, phase, surface.psi);
            let told = known.iter().filter(|it| it.0 == psi).map(|it| it.1);
            let range = told.fold(reach(model, &numbers, &linked, psi), Interval::intersect);
            let guess = motion.get(phase).and_then(|it| at_first(it, it.surfaces[at].psi));
            let begins = Begins { range: [range.lower, range.upper], guess };
            if !range.is_empty() {
                begun.phases[phase].model.surfaces[at].begins = begins;
            }
        }
    }
    Ok(begun)
}

/// The range of a value over what links read.
fn reach(model: &Model, numbers: &Numbers, linked: &Linked, value: ExprId) -> Interval {
    let bounds = |range| {
        let bounds = numbers.bounds(model, range);
        Interval::new(bounds.lower, bounds.upper)
    };
    let of_phase = |phase: usize, input: u32| {
        let own = &model.phases[phase].model;
        match own.symbols[input as usize] {
            Symbol::State(at) | Symbol::AtStart(at) | Symbol::AtEnd(at) => {
                let range = own.states[at].range;
                let of = |bound| own.graph.as_number(bound);
                let [lower, upper] = [range.lower, range.upper].map(of);
                Interval::new(lower.unwrap_or(f64::NEG_INFINITY), upper.unwrap_or(f64::INFINITY))
            }
            _ => Interval::ALL,
        }
    };
    let one = |symbol: &Symbol| match *symbol {
        Symbol::Param(_) => Interval::point(numbers.of(*symbol)),
        Symbol::Free(at) => bounds(model.frees[at].range),
        Symbol::OfPhase { phase, input } => of_phase(phase, input),
        _ => Interval::ALL,
    };
    let domain: Vec<Interval> = linked.symbols.iter().map(one).collect();
    Tape::new(&linked.graph, &[value]).evaluate(&domain)[0]
}

/// What is known of values at the last time of a phase.
fn ends(
    model: &Model,
    phase: usize,
    linked: &mut Linked,
) -> Result<Vec<(ExprId, Interval)>, Vec<Diagnostic>> {
    let own = &model.phases[phase].model;
    let numbers = numbers(own)?;
    let mut known = Vec::new();
    for row in own.path.iter().chain(&own.boundary) {
        let bounds = numbers.bounds(own, row.range);
        let value = linked.at_end(model, phase, (&own.graph, row.value));
        known.push((value, Interval::new(bounds.lower, bounds.upper)));
    }
    for (jump, begins) in own.jumps.iter().zip(beginnings(own, &numbers)) {
        // It may always happen once more, and leads back to its side.
        let is_kept = jump.at_most.is_none()
            && !begins.may_be_beyond
            && !has_both(&own.jumps, jump)
            && turns(own, &numbers, jump) == Some(true);
        if is_kept {
            let psi = own.surfaces[jump.surface].psi;
            let value = linked.at_end(model, phase, (&own.graph, psi));
            known.push((
                value,
                match jump.direction {
                    Direction::Falling => Interval::new(0.0, f64::INFINITY),
                    Direction::Rising => Interval::new(f64::NEG_INFINITY, 0.0),
                },
            ));
        }
    }
    Ok(known)
}

/// A function of time and states where a phase begins that is simulated.
fn at_first(phase: &Model, value: ExprId) -> Option<f64> {
    let numbers = numbers(phase).ok()?;
    let mut graph = phase.graph.clone();
    let starts = |at: u32| match phase.symbols[at as usize] {
        Symbol::State(at) => phase.states[at].start,
        Symbol::Time => Some(phase.interval[0]),
        _ => None,
    };
    let begun = graph.substitute(&[value], &starts);
    let input = |at: u32| match phase.symbols[at as usize] {
        symbol @ (Symbol::Param(_) | Symbol::Free(_)) => numbers.of(symbol),
        _ => f64::NAN,
    };
    Some(evaluate_with(&graph, &begun, input, &[])[0]).filter(|it| it.is_finite())
}
