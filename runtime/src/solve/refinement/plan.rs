//! What is done where the errors of the steps are too large: intervals are divided, or the order is
//! raised on all of them.
//!
//! With an error `e_k ~ C_k h_k^(p+1)` for a scheme of order `p`, dividing interval `k` into `m_k`
//! parts leaves `e_k / m_k^p`; the sum of all is at the tolerance with the fewest intervals where
//! `m_k` is in proportion to `e_k^(1/(p+1))`.
//!
//! One more stage multiplies `e_k` by a gain `g_k`, where the solution is smooth over the interval:
//! by about `(h_k/R_k)^2`, where `R_k` is its scale there; at a kink or in a layer shorter than the
//! interval it gains nothing. That ratio of two local errors tells smooth from rough (Gui and
//! Babuska, Numer. Math. 49 (1986) 659-683); each raise measures it, dividing into `m` parts
//! divides it by `m^2`, and before the first raise the best is hoped for. The number of stages is
//! that for which the fewest nodes, intervals times stages, are foreseen.

use crate::problem::{MOST_STAGES, Scheme};
use crate::solve::tuning::plan::{BEYOND, MOST_PARTS, PLANNED, ROUGH};

/// A grid with the errors of its steps.
#[derive(Clone, Debug)]
pub(super) struct Errors {
    pub(super) scheme: Scheme,
    pub(super) steps: Vec<f64>,
    /// By how much one more stage multiplies each.
    pub(super) gains: Vec<f64>,
}

impl Errors {
    pub(super) fn sum(&self) -> f64 {
        self.steps.iter().sum()
    }

    /// Into how many parts each interval is divided.
    pub(super) fn parts(&self, tolerance: f64) -> Vec<usize> {
        let parts = self.ideal(tolerance).into_iter();
        parts.map(|parts| parts.ceil().min(MOST_PARTS) as usize).collect()
    }

    /// The same without a limit, and before it is rounded.
    fn ideal(&self, tolerance: f64) -> Vec<f64> {
        if self.sum() <= tolerance {
            return vec![1.0; self.steps.len()];
        }
        let (p, q) = (self.scheme.order() as f64, 1.0 / (self.scheme.order() as f64 + 1.0));
        let shares: f64 = self.steps.iter().map(|error| error.powf(q)).sum();
        let factor = (shares / (PLANNED * tolerance)).powf(1.0 / p);
        self.steps.iter().map(|error| (factor * error.powf(q)).max(1.0)).collect()
    }

    /// Intervals times stages when they are divided until the tolerance is met. Where the solution
    /// is rough, most halvings leave the error in one of the halves.
    pub(super) fn nodes(&self, tolerance: f64) -> usize {
        let order = self.scheme.order() as f64;
        let parts = self.ideal(tolerance).into_iter().zip(&self.gains).map(|(parts, gain)| {
            let halvings = (order + 1.0) * parts.log2();
            if *gain > ROUGH { parts.max(1.0 + halvings) } else { parts }
        });
        self.scheme.stages() * parts.map(|parts| parts.min(BEYOND).ceil() as usize).sum::<usize>()
    }

    /// The number of stages for which the fewest nodes are foreseen, at least that of now.
    pub(super) fn best_stages(&self, tolerance: f64) -> usize {
        let all = self.scheme.stages()..=MOST_STAGES;
        all.min_by_key(|stages| self.raised(*stages).nodes(tolerance)).unwrap_or(MOST_STAGES)
    }

    /// What is foreseen with more stages.
    fn raised(&self, stages: usize) -> Errors {
        let more = (stages - self.scheme.stages()) as i32;
        let pairs = self.steps.iter().zip(&self.gains);
        let steps = pairs.map(|(error, gain)| error * gain.powi(more)).collect();
        Errors { scheme: self.scheme.with_stages(stages), steps, gains: self.gains.clone() }
    }

    /// The gains of one more stage that `after`, on the same intervals with more, has shown.
    pub(super) fn gains_to(&self, after: &Errors) -> Vec<f64> {
        let each = 1.0 / (after.scheme.stages() - self.scheme.stages()) as f64;
        let gain = |(before, after): (&f64, &f64)| {
            if after < before { (after / before).powf(each) } else { 1.0 }
        };
        self.steps.iter().zip(&after.steps).map(gain).collect()
    }

    /// The gains on the parts of the intervals.
    pub(super) fn gains_of_parts(&self, parts: &[usize]) -> Vec<f64> {
        let pairs = self.gains.iter().zip(parts);
        pairs.flat_map(|(gain, parts)| vec![gain / (parts * parts) as f64; *parts]).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn errors(stages: usize, steps: &[f64], gains: &[f64]) -> Errors {
        Errors { scheme: Scheme::Radau(stages), steps: steps.to_vec(), gains: gains.to_vec() }
    }

    fn of_order(scheme: Scheme, steps: &[f64]) -> Errors {
        Errors { scheme, steps: steps.to_vec(), gains: vec![0.0; steps.len()] }
    }

    #[test]
    fn equal_errors_are_divided_equally_and_none_not_at_all() {
        assert_eq!(of_order(Scheme::ImplicitEuler, &[1e-3; 10]).parts(5e-3 / 0.7), [2; 10]);
        assert_eq!(of_order(Scheme::Midpoint, &[0.0, 1.0]).parts(1e-6), [1, 4]);
        assert_eq!(of_order(Scheme::RungeKutta4, &[1e-9; 4]).parts(1e-3), [1; 4]);
    }

    /// What is left of the sum is what was planned, where nothing is cut.
    #[test]
    fn the_sum_that_is_left_is_what_was_planned() {
        let steps: Vec<f64> = (1..=40).map(|k| 1e-3 * f64::from(k * k)).collect();
        let tolerance = 0.05 * steps.iter().sum::<f64>();
        let parts = of_order(Scheme::Midpoint, &steps).parts(tolerance);
        let left: f64 =
            steps.iter().zip(&parts).map(|(error, parts)| error / (parts * parts) as f64).sum();
        assert!(
            parts.iter().all(|parts| *parts <= 4) && left < 1.6 * tolerance,
            "{parts:?} {left}"
        );
    }

    #[test]
    fn errors_beyond_measure_are_counted_as_many_nodes() {
        assert_eq!(errors(2, &[1e300; 50], &[1.0; 50]).nodes(1e-3), 2 * 50 * 1_000_000);
    }

    /// Errors that stages lower on all intervals ask for stages; errors that they do not lower, on
    /// a few, ask for division.
    #[test]
    fn smooth_errors_ask_for_stages_and_rough_ones_for_division() {
        assert_eq!(errors(3, &[1e-5; 10], &[1e-3; 10]).best_stages(1e-6), 4);
        assert_eq!(errors(3, &[1e-5; 10], &[1e-3; 10]).best_stages(1e-9), 5);
        let (mut steps, mut gains) = ([1e-12; 10], [1e-3; 10]);
        (steps[4], gains[4]) = (1e-3, 0.9);
        assert_eq!(errors(3, &steps, &gains).best_stages(1e-6), 3);
    }

    /// `e = C (h/R)^(2s)`: one more stage multiplies by `(h/R)^2`, on half the interval by a
    /// quarter of that.
    #[test]
    fn gains_are_those_of_the_theory() {
        let error = |h: f64, stages: i32| (h / 2.0).powi(2 * stages);
        let (two, four) =
            (errors(2, &[error(1.0, 2)], &[0.0]), errors(4, &[error(1.0, 4)], &[0.0]));
        let gains = two.gains_to(&four);
        assert!((gains[0] - 0.25).abs() < 1e-15);
        let known = Errors { gains, ..four };
        assert_eq!(known.gains_of_parts(&[2]), [0.0625; 2]);
        assert!((error(0.5, 5) / error(0.5, 4) - 0.0625).abs() < 1e-15);
    }
}
