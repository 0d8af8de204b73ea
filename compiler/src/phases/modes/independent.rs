//! Conditions on the state at one time, of which none says what others say already: else the
//! Jacobian of the chain would lose rank. Whether a function is a sum of others is asked of their
//! values at points chosen once and for all.

use super::Modes;
use crate::expressions::graph::ExprId;
use crate::expressions::graph::evaluate::evaluate;
use crate::model::Symbol;
use crate::model::numbers::numbers;

/// What is left of a function that others add up to, for its size.
const NOTHING: f64 = 1e-10;

/// What some functions are at several points, as an orthonormal basis.
#[derive(Clone, Default)]
pub(super) struct Independent(Vec<Vec<f64>>);

impl Independent {
    /// Adds a function; `false` where the others add up to it.
    pub fn add(&mut self, modes: &Modes<'_>, function: ExprId) -> bool {
        let mut vector = modes.sampled(function);
        let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
        let size = dot(&vector, &vector).sqrt();
        for own in &self.0 {
            let part = dot(own, &vector);
            vector.iter_mut().zip(own).for_each(|(it, own)| *it -= part * own);
        }
        let rest = dot(&vector, &vector).sqrt();
        if rest <= NOTHING * size {
            return false;
        }
        vector.iter_mut().for_each(|it| *it /= rest);
        self.0.push(vector);
        true
    }
}

impl Modes<'_> {
    /// A function of the state at several points, more than there are conditions on it; the state
    /// at the last time is the same as the current one.
    fn sampled(&self, of: ExprId) -> Vec<f64> {
        let division = &self.between.division;
        let count = division.model.states.len();
        let Ok(params) = numbers(self.between.division.model) else { return Vec::new() };
        let at = |point: usize| {
            let input = |symbol: &Symbol| match *symbol {
                Symbol::State(at) | Symbol::AtEnd(at) => scattered(at, point + 1),
                // What follows for these parameters need not follow for others.
                Symbol::Param(_) => params.of(*symbol),
                Symbol::Free(at) => scattered(division.model.params.len() + at, 0),
                // What changes with time by itself is no sum of what does not.
                _ => scattered(count, point + 1),
            };
            let inputs: Vec<f64> = division.symbols.iter().map(input).collect();
            evaluate(&division.graph, &[of], &inputs, &[])[0]
        };
        (0..2 * count + 8).map(at).collect()
    }
}

/// A number between 0.5 and 1.5 that is in no simple relation to the others.
fn scattered(which: usize, point: usize) -> f64 {
    let (a, b) = (2f64.sqrt() * (which + 1) as f64, 3f64.sqrt() * (point + 1) as f64);
    0.5 + (7.0 * a * b + 5f64.sqrt() * a + b).fract()
}
