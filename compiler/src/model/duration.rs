//! Phases whose ends are both chosen: that the last time is not before the first is a condition.

use super::numbers::numbers;
use super::{Constraint, Model, Place, Range, Symbol};
use crate::expressions::graph::derivative::derivative;
use crate::expressions::graph::evaluate;

impl Model {
    /// Adds that condition, here and in each phase, where bounds do not say it.
    pub(crate) fn durations_as_conditions(&mut self) {
        self.phases.iter_mut().for_each(|it| it.model.durations_as_conditions());
        if !self.may_run_backwards() {
            return;
        }
        let [first, last] = self.interval;
        let value = self.graph.sub(last, first);
        let range =
            Range { lower: self.graph.number(0.0), upper: self.graph.number(f64::INFINITY) };
        let place = Place { name: format!("duration of {}", self.name), ..Place::default() };
        self.boundary.push(Constraint { place, value, range });
    }

    /// Whether unknowns may have values within their bounds with which time does not go on. With
    /// `D = tf - t0` affine in the unknowns, its least value is
    /// `D(0) + sum_i min(c_i lower_i, c_i upper_i)`.
    fn may_run_backwards(&self) -> bool {
        let Ok(numbers) = numbers(self) else { return false };
        let mut graph = self.graph.clone();
        let duration = graph.sub(self.interval[1], self.interval[0]);
        let mut inputs = numbers.inputs().to_vec();
        let mut least = 0.0;
        let mut is_chosen = false;
        for input in graph.inputs_of(&[duration]) {
            let Symbol::Free(at) = self.symbols[input as usize] else { continue };
            let slope = derivative(&mut graph, duration, input);
            let bounds = numbers.bounds(self, self.frees[at].range);
            let slope = evaluate(&graph, &[slope], &inputs, &[])[0];
            least += (slope * bounds.lower).min(slope * bounds.upper);
            (inputs[input as usize], is_chosen) = (0.0, true);
        }
        let rest = evaluate(&graph, &[duration], &inputs, &[])[0];
        is_chosen && (least + rest <= 0.0 || (least + rest).is_nan())
    }
}
