//! FDC0402: a duration that the optimiser may choose must stay above 0.
//!
//! With `D = tf - t0` affine in the unknowns, its least value over their bounds is
//! `D(0) + sum_i min(c_i lower_i, c_i upper_i)`.

use super::Facts;
use crate::differentiate::derivative;
use crate::graph::evaluate;
use crate::model::Symbol;
use crate::resolve::{text, walk};
use fdcc_grammar::ast::{Expr, ItemKind, Sense};
use fdcc_grammar::{Code, Diagnostic};

/// Reports unknowns that may make the duration 0 or negative.
pub(crate) fn check(facts: &mut Facts<'_, '_>, found: &mut Vec<Diagnostic>) {
    let meaning = &mut *facts.meaning;
    let duration = meaning.graph.sub(meaning.interval[1], meaning.interval[0]);
    let mut unknowns = Vec::new();
    let mut inputs: Vec<f64> = vec![0.0; meaning.symbols.len()];
    for at in 0..meaning.symbols.len() {
        match meaning.symbols[at] {
            Symbol::Param(index) => inputs[at] = meaning.param_values[index],
            Symbol::Free(index) => unknowns.push((at as u32, index)),
            _ => {}
        }
    }
    let mut least = evaluate(&meaning.graph, &[duration], &inputs, &[])[0];
    let mut involved = Vec::new();
    for (input, index) in unknowns {
        let slope = derivative(&mut meaning.graph, duration, input);
        let slope = meaning.numeric(slope);
        let range = meaning.model.frees[index].range;
        let ends = [range.lower, range.upper].map(|end| meaning.numeric(end));
        if slope != 0.0 {
            least += (slope * ends[0]).min(slope * ends[1]);
            involved.push((index, slope, ends));
        }
    }
    if least > 0.0 || least.is_nan() {
        return;
    }
    for (index, slope, ends) in involved {
        // The end of its range that shortens the time is to blame.
        let worst = if slope > 0.0 { ends[0] } else { -ends[1] };
        if worst <= 0.0 {
            found.push(unbounded(facts, index, worst));
        }
    }
}

fn unbounded(facts: &Facts<'_, '_>, index: usize, worst: f64) -> Diagnostic {
    let free = &facts.meaning.model.frees[index];
    let name = &free.place.name;
    let (message, label) = match worst == 0.0 {
        true => (format!("free time `{name}` may become 0"), "may become 0"),
        false => (format!("free time `{name}` has no lower bound"), "may become 0 or negative"),
    };
    let mut found = Diagnostic::new(Code::NoDuration, message, free.place.span, label);
    if let Some(span) = objective(facts).and_then(|value| walk::mention(value, name)) {
        found = found.label(span, "and the objective pulls it down");
    }
    found.help(format!("give it a range that excludes 0, for example `{}`", repaired(facts, index)))
}

/// What is minimised.
fn objective<'a>(facts: &Facts<'a, '_>) -> Option<&'a Expr> {
    facts.tree.items.iter().find_map(|item| match &item.kind {
        ItemKind::Objective { sense: Sense::Minimize, value, .. } => Some(value),
        _ => None,
    })
}

/// `free T in [0.1, 60] guess 6`: ten times the guess should be long enough.
fn repaired(facts: &Facts<'_, '_>, index: usize) -> String {
    let free = &facts.meaning.model.frees[index];
    let name = &free.place.name;
    let upper = facts.meaning.numeric(free.range.upper);
    let guess = free.guess.map(|guess| facts.meaning.numeric(guess)).filter(|guess| *guess > 0.0);
    let longest = if upper.is_finite() { upper } else { guess.map_or(100.0, |guess| 10.0 * guess) };
    let range = format!("free {name} in [0.1, {}]", text::number(longest));
    guess.map_or(range.clone(), |guess| format!("{range} guess {}", text::number(guess)))
}
