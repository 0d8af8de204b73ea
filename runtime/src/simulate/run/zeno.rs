//! Jumps that accumulate: intervals `d, d q, d q^2, ...` with `q < 1` end after `d q / (1 - q)`.

use crate::simulate::tuning::zeno::{CLEAR, FAST, NEAR, REGULAR, REMEMBERED, STEADY};

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
        if self.last.len() > REMEMBERED {
            self.last.remove(0);
        }
        let Some(&[a, b, c, d]) = self.last.last_chunk() else {
            return is_small.then_some(time);
        };
        let [first, second, third] = [b - a, c - b, d - c];
        if third <= 0.0 {
            return (third == 0.0 && second == 0.0).then_some(time);
        }
        let (before, ratio) = (second / first, third / second);
        let rest = third * ratio / (1.0 - ratio);
        // Intervals of equal length are as irregular as their times are rounded.
        let is_known = third >= CLEAR * f64::EPSILON * time.abs() && self.falls(ratio);
        let is_near = is_small || is_known && rest <= NEAR * span;
        (is_near && is_steady(before, ratio)).then_some(time + rest)
    }

    /// Whether intervals fall by more than chance: those that fall slowly for a long time.
    fn falls(&self, ratio: f64) -> bool {
        let intervals: Vec<f64> = self.last.windows(2).map(|pair| pair[1] - pair[0]).collect();
        let ratios: Vec<f64> = intervals.windows(2).map(|pair| pair[1] / pair[0]).collect();
        let is_long = self.last.len() == REMEMBERED;
        ratio <= FAST || is_long && ratios.windows(2).all(|pair| is_steady(pair[0], pair[1]))
    }
}

/// Whether two ratios of intervals that follow each other are those of a geometric series.
fn is_steady(before: f64, ratio: f64) -> bool {
    let change = (ratio - before).abs();
    1.0 - ratio > REGULAR && change <= (STEADY * ratio).min(0.5 * (1.0 - ratio))
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

    /// However long they are looked at: a chance that is small comes true.
    #[test]
    fn regular_jumps_with_rounded_times_do_not_pile_up() {
        let (mut detector, mut bits) = (ZenoDetector::default(), 1_u64);
        for k in 0..1_000_000 {
            bits = bits.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
            let rounding = (bits >> 33) as f64 / f64::from(1_u32 << 31);
            let time = 1e-13 * (f64::from(k) + 0.01 * rounding);
            assert!(detector.limit(time, 10.0, false).is_none(), "{k}");
        }
    }
}
