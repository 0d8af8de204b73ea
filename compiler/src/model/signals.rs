//! Signals that are given from outside, as parameters at points of equal distance.

use super::numbers::numbers;
use super::{Model, Symbol};
use fdcc_grammar::Diagnostic;

impl Model {
    /// Whether the first or the last time is chosen.
    pub fn chooses_times(&self) -> bool {
        let read = self.graph.inputs_of(&self.interval);
        read.into_iter().any(|at| matches!(self.symbols[at as usize], Symbol::Free(_)))
    }

    /// Takes over the values of parameters and the method of another meaning of the same text.
    ///
    /// # Errors
    ///
    /// Parameters without a value.
    pub fn take_values(&mut self, of: &Model) -> Result<(), Vec<Diagnostic>> {
        let numbers = numbers(of)?;
        let values = of.params.iter().enumerate();
        let values = values.map(|(at, it)| (it.place.name.clone(), numbers.of(Symbol::Param(at))));
        self.restore_params(&values.collect::<Vec<_>>());
        self.method = of.method.clone();
        self.magnitudes.clone_from(&of.magnitudes);
        Ok(())
    }

    /// Gives a signal values at its points, in SI; `at` is its place among all signals.
    pub fn give_signal(&mut self, at: usize, values: &[f64]) {
        let points = self.signals[at].points.clone();
        points.into_iter().zip(values).for_each(|(point, value)| self.give(point, *value));
    }

    /// Signals that are not given have the values of the text from this time on instead of those
    /// from the first time on.
    pub fn set_signal_time(&mut self, now: f64) {
        let first = numbers(self).map_or(0.0, |it| it.value(self, self.interval[0]));
        if let Some(at) = self.signal_time {
            self.give(at, now - first);
        }
    }
}
