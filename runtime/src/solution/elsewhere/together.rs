//! Values of several controls at once, where no other value of one alone makes the Hamiltonian
//! less: of `u w^3` at 0 all values of one of the two are as good.

use super::super::lagrangian::Lagrangian;
use super::super::minimum::variables;
use super::{Best, Search, ladder};
use crate::random::Random;

/// So many combinations of the values that are tried of each.
const COMBINATIONS: usize = 64;
const SEED: u64 = 1;

/// The best combination so far.
struct Combination {
    /// The variables of the solution with it.
    v: Vec<f64>,
    /// What it gains on each interval.
    gains: Vec<f64>,
}

impl Search<'_> {
    /// The same as of each control `alone`, with those that belong together, on the intervals where
    /// none alone gains.
    pub(super) fn together(&self, alone: &[Best]) -> Vec<Best> {
        let (nothing, count) = (vec![None; self.own.len()], alone.len());
        let is_open = |k: usize| alone.iter().all(|best| best[k].is_none());
        let open: Vec<bool> = (0..self.own.len()).map(is_open).collect();
        if count < 2 || !open.contains(&true) {
            return vec![nothing; count];
        }
        let found = self.combination(&open);
        let Lagrangian { nlp, solution, .. } = self.lagrangian;
        let mut all = vec![nothing; count];
        for (control, best) in all.iter_mut().enumerate() {
            let is_better = |k: usize| open[k] && found.gains[k] > self.least;
            for (k, at) in variables(nlp, control).filter(|(k, _)| is_better(*k)) {
                let is_other = found.v[at] != solution.v[at];
                best[k] = is_other.then_some((found.v[at], found.gains[k]));
            }
        }
        all
    }

    /// The best of some combinations on each open interval, also if it gains nothing; then each
    /// control once more, with the others as they are in it.
    fn combination(&self, open: &[bool]) -> Combination {
        let Lagrangian { problem, solution, .. } = self.lagrangian;
        let ladders: Vec<Vec<f64>> =
            problem.controls.iter().map(|it| ladder(it.bounds, it.unit)).collect();
        let gain = |is_open: &bool| if *is_open { f64::NEG_INFINITY } else { f64::INFINITY };
        let gains = open.iter().map(gain).collect();
        let mut best = Combination { v: solution.v.clone(), gains };
        let mut random = Random(SEED);
        for _ in 0..COMBINATIONS {
            let mut v = solution.v.clone();
            for (control, ladder) in ladders.iter().enumerate().filter(|it| !it.1.is_empty()) {
                let place = 0.5 * (random.next() + 1.0) * ladder.len() as f64;
                self.set(control, ladder[(place as usize).min(ladder.len() - 1)], &mut v);
            }
            self.take(&v, &mut best);
        }
        for (control, ladder) in ladders.iter().enumerate() {
            for value in ladder {
                let mut v = best.v.clone();
                self.set(control, *value, &mut v);
                self.take(&v, &mut best);
            }
        }
        best
    }

    /// Takes over the controls of the intervals on which they gain more.
    fn take(&self, v: &[f64], best: &mut Combination) {
        let gains = self.gains(v);
        let is_more: Vec<bool> = gains.iter().zip(&best.gains).map(|(a, b)| a > b).collect();
        let Lagrangian { problem, nlp, .. } = self.lagrangian;
        for control in 0..problem.layout.u {
            variables(nlp, control).filter(|(k, _)| is_more[*k]).for_each(|(_, at)| {
                best.v[at] = v[at];
            });
        }
        for k in (0..gains.len()).filter(|k| is_more[*k]) {
            best.gains[k] = gains[k];
        }
    }
}
