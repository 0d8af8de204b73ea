//! What states come to where jumps pile up: from jump to jump each changes by `d, d q, d q^2, ...`,
//! `|q| < 1`, and comes to `d q/(1 - q)` farther on (A. C. Aitken, Proc. R. Soc. Edinburgh 46,
//! 1926). What changes otherwise, such as a count of the jumps, comes to nothing.

use crate::simulate::tuning::pile::{NOTHING, REMEMBERED, SETTLED};

/// The states after the last jumps of one kind.
#[derive(Clone, Debug, Default)]
pub(crate) struct Pile(Vec<Vec<f64>>);

impl Pile {
    /// Notes the state after a jump.
    pub fn note(&mut self, x: &[f64]) {
        self.0.push(x.to_vec());
        if self.0.len() > REMEMBERED {
            self.0.remove(0);
        }
    }

    /// Whether there are enough to tell a limit.
    pub fn is_known(&self) -> bool {
        self.0.len() == REMEMBERED
    }

    /// The limit of a state that has been as large as `size`; none where there is none, or none
    /// that can be told yet.
    pub fn limit(&self, state: usize, size: f64) -> Option<f64> {
        let values: Vec<f64> = self.0.iter().map(|x| x[state]).collect();
        let changes: Vec<f64> = values.windows(2).map(|pair| pair[1] - pair[0]).collect();
        let now = *values.last()?;
        let [.., change] = changes[..] else { return None };
        if change.abs() <= NOTHING * size {
            return Some(now);
        }
        let &[first, second, third] = changes.last_chunk()?;
        let (before, ratio) = (second / first, third / second);
        let rest = third * ratio / (1.0 - ratio);
        // What the ratio may still change by makes so much of the rest.
        let doubt = third * (ratio - before) / (1.0 - ratio).powi(2);
        let is_settled = ratio.abs() < 1.0 && doubt.abs() <= SETTLED * size;
        is_settled.then_some(now + rest)
    }
}

#[cfg(test)]
mod tests {
    use super::Pile;

    fn limit(of: impl Fn(i32) -> f64) -> Option<f64> {
        let mut pile = Pile::default();
        (0..12).for_each(|k| pile.note(&[of(k)]));
        pile.limit(0, 1.0)
    }

    #[test]
    fn what_falls_like_a_geometric_series_has_its_limit() {
        assert!((limit(|k| 2.0 - 0.5_f64.powi(k)).expect("it has one") - 2.0).abs() < 1e-14);
        assert!(limit(|k| 0.95_f64.powi(k)).expect("it has one").abs() < 1e-13);
        assert!(limit(|k| (-0.5_f64).powi(k)).expect("it has one").abs() < 1e-15);
        assert_eq!(limit(|_| 3.0), Some(3.0));
    }

    #[test]
    fn what_goes_on_for_ever_has_none() {
        assert_eq!(limit(f64::from), None);
        assert_eq!(limit(|k| (-1.0_f64).powi(k)), None);
        assert_eq!(limit(|k| 1.01_f64.powi(k)), None);
        assert_eq!(limit(|k| 1.0 / f64::from(k + 1)), None, "too slow to be told");
    }
}
