//! One step of the explicit pair where every selector is given and no control changes: most steps
//! of most tapes. Its stages keep their Jacobians as the compiled function gives them, sparse and
//! in one piece of memory; the equations are those of [`super::step`].

use super::linearisation::Lineariser;
use crate::problem::Columns;
use crate::simulate::dormand_prince::{A, C, STAGES};
use crate::simulate::{Instant, Mode, Regime, Rule};
use nalgebra::{DMatrix, DVector};

/// Stages that enter the end of the step; its weights are the last row of the tableau.
const USED: usize = STAGES - 1;

/// A step, linearised.
pub(crate) struct SparseStep<'l> {
    h: f64,
    pattern: &'l [(u32, u32)],
    /// One block for each stage, in the order of the pattern.
    entries: Vec<f64>,
    states: usize,
    /// How many of `(u, p)` there are.
    inputs: usize,
}

/// What an entry of the pattern is the derivative by.
enum By {
    State(usize),
    Input(usize),
    /// Time, or a selector, which does not move.
    Constant,
}

impl<'l> SparseStep<'l> {
    /// Whether a step is of this sort.
    pub fn fits(lineariser: &Lineariser, regime: &Regime, rule: Rule) -> bool {
        let is_given = |mode: &Mode| matches!(mode, Mode::Below | Mode::Above);
        let is_plain = regime.held.is_empty() && regime.modes.iter().all(is_given);
        is_plain && rule == Rule::Explicit && !lineariser.is_curved(regime)
    }

    /// Takes the step again.
    pub fn new(lineariser: &Lineariser<'l>, regime: &Regime, start: &Instant, h: f64) -> Self {
        let flow = &*lineariser.system.flow;
        let pattern: &[(u32, u32)] = &flow.jacobian_pattern().entries;
        let states = start.state.len();
        let mut entries = Vec::with_capacity(USED * pattern.len());
        let mut rates = [const { Vec::new() }; USED];
        let results = &mut *lineariser.results.borrow_mut();
        let at = DVector::from_column_slice(&start.state);
        let mut table = lineariser.table(regime, &start.selectors, start.time, &at);
        for stage in 0..USED {
            move_to(&mut table, start, h, stage, &rates);
            let [values, derivatives] = &mut *results;
            flow.jacobian(&table, &lineariser.parameters, values, derivatives);
            rates[stage] = first_row(values);
            entries.extend((0..pattern.len()).map(|entry| derivatives.column(entry)[0]));
        }
        SparseStep { h, pattern, entries, states, inputs: lineariser.inputs(regime) }
    }

    /// The entries of a stage: row, what by, value.
    fn stage(&self, stage: usize) -> impl Iterator<Item = (usize, By, f64)> {
        let values = &self.entries[stage * self.pattern.len()..][..self.pattern.len()];
        self.pattern.iter().zip(values).map(|(&(row, column), value)| {
            let by = match (column as usize).checked_sub(1) {
                Some(at) if at < self.states => By::State(at),
                Some(at) if at < self.states + self.inputs => By::Input(at - self.states),
                _ => By::Constant,
            };
            (row as usize, by, *value)
        })
    }

    /// The derivative of the end.
    pub fn forward(&self, s: &DMatrix<f64>, w: &DMatrix<f64>) -> DMatrix<f64> {
        let mut slopes: Vec<DMatrix<f64>> = Vec::with_capacity(USED);
        for stage in 0..USED {
            let at = self.combined(s, &slopes, stage);
            let mut slope = DMatrix::zeros(s.nrows(), s.ncols());
            for (row, by, value) in self.stage(stage) {
                for column in 0..s.ncols() {
                    match by {
                        By::State(state) => slope[(row, column)] += value * at[(state, column)],
                        By::Input(input) => slope[(row, column)] += value * w[(input, column)],
                        By::Constant => {}
                    }
                }
            }
            slopes.push(slope);
        }
        self.combined(s, &slopes, USED)
    }

    /// `S + h sum_j a_j K_j` with a row of the tableau.
    fn combined(&self, s: &DMatrix<f64>, slopes: &[DMatrix<f64>], row: usize) -> DMatrix<f64> {
        let mut sum = s.clone();
        for (weight, slope) in A[row].iter().zip(slopes).filter(|(weight, _)| **weight != 0.0) {
            sum.zip_apply(slope, |sum, slope| *sum += self.h * weight * slope);
        }
        sum
    }

    /// The adjoint before the step and the derivative by `(u, p)`.
    pub fn adjoint(&self, after: &DVector<f64>) -> (DVector<f64>, DVector<f64>) {
        let mut pulled = [const { Vec::new() }; USED];
        let (mut before, mut inputs) = (after.clone(), DVector::zeros(self.inputs));
        for stage in (0..USED).rev() {
            let kappa = |row: usize, pulled: &[Vec<f64>; USED]| {
                let later = (stage + 1..USED).map(|later| A[later][stage] * pulled[later][row]);
                self.h * (A[USED][stage] * after[row] + later.sum::<f64>())
            };
            let kappa: Vec<f64> = (0..self.states).map(|row| kappa(row, &pulled)).collect();
            let mut mu = vec![0.0; self.states];
            for (row, by, value) in self.stage(stage) {
                match by {
                    By::State(state) => mu[state] += value * kappa[row],
                    By::Input(input) => inputs[input] += value * kappa[row],
                    By::Constant => {}
                }
            }
            before.iter_mut().zip(&mu).for_each(|(before, mu)| *before += mu);
            pulled[stage] = mu;
        }
        (before, inputs)
    }
}

/// Time and state of a stage.
fn move_to(table: &mut Columns, start: &Instant, h: f64, stage: usize, rates: &[Vec<f64>; USED]) {
    table.column_mut(0)[0] = start.time + C[stage] * h;
    for (row, x) in start.state.iter().enumerate() {
        let moved: f64 = (0..stage).map(|before| A[stage][before] * rates[before][row]).sum();
        table.column_mut(1 + row)[0] = x + h * moved;
    }
}

fn first_row(values: &Columns) -> Vec<f64> {
    (0..values.columns()).map(|column| values.column(column)[0]).collect()
}
