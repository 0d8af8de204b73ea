//! An objective of measured data along a trajectory of which only samples are known.

use super::numbers::{Numbers, numbers};
use super::{Model, Symbol};
use crate::expressions::graph::evaluate;

/// What is known of a trajectory; states, then integrals.
pub struct Along<'t> {
    /// At the first and at the last time.
    pub ends: [&'t [f64]; 2],
    /// At a time between them.
    pub at: &'t dyn Fn(f64) -> Option<&'t [f64]>,
}

impl Model {
    /// The times of all rows that the objective reads, ascending, within the time of the model.
    pub fn times_of_rows(&self) -> Vec<f64> {
        let Ok(numbers) = numbers(self) else { return Vec::new() };
        let [first, last] = self.interval.map(|end| numbers.value(self, end));
        let all = self.sums.iter().flat_map(|sum| self.row_times(&numbers, sum));
        let mut times: Vec<f64> = all.map(|time| time.max(first).min(last)).collect();
        times.sort_by(f64::total_cmp);
        times.dedup();
        times
    }

    /// The value of the objective; nothing where that reads more than parameters, states and
    /// integrals.
    pub fn objective_along(&self, along: &Along) -> Option<f64> {
        let (_, value) = self.objective.as_ref()?;
        let numbers = numbers(self).ok()?;
        let sums = (0..self.sums.len()).map(|at| self.sum_along(&numbers, at, along));
        let sums: Option<Vec<f64>> = sums.collect();
        let sums = sums?;
        let states = self.states.len();
        self.evaluated(&numbers, *value, &|symbol| match symbol {
            Symbol::AtStart(at) => along.ends[0].get(at).copied(),
            Symbol::AtEnd(at) => along.ends[1].get(at).copied(),
            Symbol::Integral(at) => along.ends[1].get(states + at).copied(),
            Symbol::Sum(at) => Some(sums[at]),
            _ => None,
        })
    }

    /// The value of the objective if all states were 0: of measured data the sum of the squares of
    /// what was measured.
    pub fn objective_at_rest(&self) -> Option<f64> {
        let rest = vec![0.0; self.states.len() + self.integrals.len()];
        let value = self.objective_along(&Along { ends: [&rest, &rest], at: &|_| Some(&rest) });
        value.filter(|it| it.is_finite())
    }

    fn sum_along(&self, numbers: &Numbers, at: usize, along: &Along) -> Option<f64> {
        let sum = &self.sums[at];
        let [first, last] = self.interval.map(|end| numbers.value(self, end));
        let columns = &self.tables[sum.table].columns;
        let term = |(row, time): (usize, f64)| {
            let states = (along.at)(time.max(first).min(last))?;
            self.evaluated(numbers, sum.term, &|symbol| match symbol {
                Symbol::Time => Some(time),
                Symbol::State(at) => states.get(at).copied(),
                Symbol::Column(table, column) if table == sum.table => Some(columns[column][row]),
                _ => None,
            })
        };
        let [before, behind] = sum.is_shared;
        // A row between two phases belongs to the second.
        let is_own = |time: f64| (!before || time >= first) && (!behind || time < last);
        let rows = self.row_times(numbers, sum).into_iter().enumerate();
        rows.filter(|it| is_own(it.1)).map(term).sum()
    }

    /// A value over parameters, unknowns and what else has a meaning.
    fn evaluated(
        &self,
        numbers: &Numbers,
        value: crate::expressions::graph::ExprId,
        meaning: &dyn Fn(Symbol) -> Option<f64>,
    ) -> Option<f64> {
        let mut inputs = numbers.inputs().to_vec();
        for input in self.graph.inputs_of(&[value]) {
            let symbol = self.symbols[input as usize];
            if !matches!(symbol, Symbol::Param(_) | Symbol::Free(_)) {
                inputs[input as usize] = meaning(symbol)?;
            }
        }
        Some(evaluate(&self.graph, &[value], &inputs, &[])[0])
    }
}
