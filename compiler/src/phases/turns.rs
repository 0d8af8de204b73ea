//! Whether the state turns back at a jump, or goes on through its surface.

use super::hold::approach;
use crate::expressions::graph::evaluate_with;
use crate::model::numbers::Numbers;
use crate::model::{Jump, Model, Symbol};

/// So many states are looked at: a factor that is the same at all of them is one everywhere.
const LOOKED_AT: usize = 5;
/// A factor is the same but for its last digits.
const ROUNDING: f64 = 1e-9;

/// Whether the speed at which the surface of a jump is approached has the other sign behind it, at
/// the values of the parameters and the guesses of the unknowns; nothing where that depends on the
/// state, or the surface is another one behind the jump.
pub(super) fn turns(model: &Model, numbers: &Numbers, jump: &Jump) -> Option<bool> {
    let (mut graph, psi) = (model.graph.clone(), model.surfaces[jump.surface].psi);
    let rate = approach(model, &mut graph, psi);
    let reset = |input: u32| {
        let of = |it: &&(usize, _)| model.symbols[input as usize] == Symbol::State(it.0);
        jump.resets.iter().find(of).map(|it| it.1)
    };
    let [moved, after] = graph.substitute(&[psi, rate], &reset)[..] else { return None };
    let factor = |k: usize| {
        let input = |at: u32| match model.symbols[at as usize] {
            symbol @ (Symbol::Param(_) | Symbol::Free(_)) => numbers.of(symbol),
            // Any numbers that have nothing to do with each other.
            _ => (f64::from(at + 1) * (k + 1) as f64).sin(),
        };
        let values = evaluate_with(&graph, &[rate, after], input, &[]);
        values[1] / values[0]
    };
    let first = factor(0);
    let is_same = |k: usize| (factor(k) - first).abs() <= ROUNDING * first.abs();
    let is_factor = moved == psi && first.is_finite() && (1..LOOKED_AT).all(is_same);
    (is_factor && first != 0.0).then_some(first < 0.0)
}
