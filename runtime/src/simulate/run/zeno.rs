//! Jumps that accumulate: intervals `d, d q, d q^2, ...` with `q < 1` end after `d q / (1 - q)`.

use crate::simulate::tuning::zeno::{NEAR, REGULAR, STEADY};

/// The times of the last jumps of one kind.
#[derive(Clone, Debug, Default)]
pub(crate) struct ZenoDetector {
    last: Vec<f64>,
}

impl ZenoDetector {
    /// The time since the last jump.
    pub fn since_last(&self, time: f64) -> f64 {
        self.last.last().map_or(f64::INFINITY, |last| time - last)
    }

    /// Notes a jump; the limit time once the jumps accumulate. Jumps so small that rounding will
    /// soon hide them are believed at once.
    pub fn limit(&mut self, time: f64, span: f64, is_small: bool) -> Option<f64> {
        self.last.push(time);
        if self.last.len() > 4 {
            self.last.remove(0);
        }
        let Ok([a, b, c, d]) = <[f64; 4]>::try_from(self.last.as_slice()) else {
            return is_small.then_some(time);
        };
        let [first, second, third] = [b - a, c - b, d - c];
        if third <= 0.0 {
            return (third == 0.0 && second == 0.0).then_some(time);
        }
        let (before, ratio) = (second / first, third / second);
        let rest = third * ratio / (1.0 - ratio);
        let change = (ratio - before).abs();
        let is_steady =
            1.0 - ratio > REGULAR && change <= (STEADY * ratio).min(0.5 * (1.0 - ratio));
        (is_steady && (is_small || rest <= NEAR * span)).then_some(time + rest)
    }
}

#[cfg(test)]
mod tests {
    use super::ZenoDetector;

    #[test]
    fn halving_intervals_end_at_twice_the_first() {
        let mut detector = ZenoDetector::default();
        let limit = (0..40).find_map(|k| detector.limit(2.0 - 0.5_f64.powi(k), 1.0, false));
        assert!((limit.expect("they accumulate") - 2.0).abs() < 1e-14);
    }

    /// However long the whole time is, and however the times are rounded.
    #[test]
    fn nearly_regular_jumps_do_not_pile_up() {
        let mut detector = ZenoDetector::default();
        let rounded = |k: u32| f64::from(k) + 1e-9 * f64::from(k * k * 7919 % 13);
        assert!((0..100).all(|k| detector.limit(rounded(k), 2e302, false).is_none()));
    }

    #[test]
    fn regular_jumps_do_not_pile_up() {
        let mut detector = ZenoDetector::default();
        assert!((0..100).all(|k| detector.limit(1e-7 * f64::from(k), 1.0, false).is_none()));
    }
}
