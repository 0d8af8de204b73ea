//! The rate at which an error falls: the slope of a straight line through its logarithm.

/// Least squares fit of `log(error) = constant + rate * log(size)`.
pub fn rate(sizes: &[f64], errors: &[f64]) -> f64 {
    assert_eq!(sizes.len(), errors.len(), "one error for each size");
    let mean =
        |values: &[f64]| values.iter().map(|value| value.ln()).sum::<f64>() / values.len() as f64;
    let (middle, level) = (mean(sizes), mean(errors));
    let offsets: Vec<(f64, f64)> = sizes
        .iter()
        .zip(errors)
        .map(|(size, error)| (size.ln() - middle, error.ln() - level))
        .collect();
    offsets.iter().map(|(x, y)| x * y).sum::<f64>()
        / offsets.iter().map(|(x, _)| x * x).sum::<f64>()
}

#[cfg(test)]
mod tests {
    use super::rate;

    #[test]
    fn a_power_has_its_exponent_as_rate() {
        let sizes = [0.1, 0.05, 0.02];
        assert!((rate(&sizes, &sizes.map(|h: f64| 3.0 * h.powf(1.5))) - 1.5).abs() < 1e-12);
    }
}
