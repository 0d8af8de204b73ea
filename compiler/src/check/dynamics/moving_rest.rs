//! FDC0313: `then hold` on a surface that leaves what rests on it behind.
//!
//! The states that the jump resets stand still then. So `psi'` has to stay where it is without
//! them: it may depend neither on time, nor on a control, nor on a state that moves by itself.

use crate::check::facts::Facts;
use crate::expressions::graph::ExprId;
use crate::expressions::graph::derivative::derivative;
use crate::model::Symbol;
use crate::resolve::elaborator::Elaborator;
use fdcc_grammar::ast::ItemKind;
use fdcc_grammar::{Code, Diagnostic};

/// Reports holds that cannot last.
pub(crate) fn check(facts: &mut Facts<'_, '_>, found: &mut Vec<Diagnostic>) {
    for at in 0..facts.meaning.model.jumps.len() {
        let jump = &facts.meaning.model.jumps[at];
        let (name, still) = (jump.place.name.clone(), states(&jump.resets));
        let Some(surface) = jump.then_hold else { continue };
        let Some(mover) = mover(facts.meaning, surface, &still) else { continue };
        let held = facts.items.iter().find_map(|item| match &item.kind {
            ItemKind::Jump { name: own, then_hold, .. } if own.name == name => then_hold.as_ref(),
            _ => None,
        });
        let Some(held) = held else { continue };
        let message = format!("`{}` leaves behind what rests on it", held.name);
        let why = format!(
            "what `{name}` resets stands still then, but how fast `{}` changes depends on {mover}",
            held.name
        );
        found.push(Diagnostic::new(Code::MovingRest, message, held.span, why).help(
            "write the motion relative to the surface: the height above it as a state, and the \
             speed relative to it, which is 0 at rest",
        ));
    }
}

fn states(resets: &[(usize, ExprId)]) -> Vec<usize> {
    resets.iter().map(|it| it.0).collect()
}

/// What changes `psi'` while some states stand still.
fn mover(meaning: &mut Elaborator<'_>, surface: usize, still: &[usize]) -> Option<String> {
    let psi = meaning.surfaces[surface].psi?;
    if meaning.known_rates.len() < meaning.model.states.len() {
        return None;
    }
    let inputs = meaning.symbols.iter().copied().enumerate();
    let states: Vec<(usize, u32)> = inputs
        .filter_map(|(input, symbol)| match symbol {
            Symbol::State(at) => Some((at, input as u32)),
            _ => None,
        })
        .collect();
    let mut terms = Vec::new();
    if let Some(time) = meaning.symbols.iter().position(|it| *it == Symbol::Time) {
        terms.push(derivative(&mut meaning.graph, psi, time as u32));
    }
    for &(at, input) in &states {
        let slope = derivative(&mut meaning.graph, psi, input);
        let rate = meaning.model.states[at].rate;
        let is_moved = !still.contains(&at);
        terms.extend(is_moved.then(|| meaning.graph.mul(slope, rate)));
    }
    let speed = meaning.graph.sum(&terms);
    let reads = |meaning: &Elaborator<'_>, of: ExprId| -> Vec<Symbol> {
        let inputs = meaning.graph.inputs_of(&[of]);
        inputs.into_iter().map(|at| meaning.symbols[at as usize]).collect()
    };
    let rests = |it: &Symbol| matches!(it, Symbol::State(at) if still.contains(at));
    let moves = |it: &Symbol| match *it {
        Symbol::Time => Some("time".to_owned()),
        Symbol::Control(at) => Some(format!("`{}`", meaning.model.controls[at].place.name)),
        Symbol::State(at) if !still.contains(&at) => {
            let state = &meaning.model.states[at];
            let is_zero = meaning.graph.as_number(state.rate) == Some(0.0);
            let is_driven = reads(meaning, state.rate).iter().any(rests);
            (!is_zero && !is_driven).then(|| format!("`{}`, which moves on", state.place.name))
        }
        _ => None,
    };
    reads(meaning, speed).iter().find_map(moves)
}
