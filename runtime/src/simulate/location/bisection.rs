//! The root of a function of one variable.

/// Bisection and the Illinois rule by turns.
pub(crate) fn bisect(
    g: &mut dyn FnMut(f64) -> f64,
    [mut low, mut at_low]: [f64; 2],
    [mut high, mut at_high]: [f64; 2],
) -> f64 {
    for turn in 0..120 {
        let middle = if turn % 3 == 2 {
            0.5 * (low + high)
        } else {
            high - at_high * (high - low) / (at_high - at_low)
        };
        let middle = if middle > low && middle < high { middle } else { 0.5 * (low + high) };
        let value = g(middle);
        if value == 0.0 || high - low <= 2.0 * f64::EPSILON * high {
            return middle;
        }
        if value > 0.0 {
            (low, at_low, at_high) = (middle, value, 0.5 * at_high);
        } else {
            (high, at_high, at_low) = (middle, value, 0.5 * at_low);
        }
    }
    high
}
