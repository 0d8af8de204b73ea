//! What is asked of long vectors at every iteration, so that no operation has to wait for the one before.

/// Numbers of a stretch whose sum is independent of those of other stretches.
const STRETCH: usize = 16;

/// The largest absolute value; what is not a number is larger than all numbers.
pub(super) fn largest(values: &[f64]) -> f64 {
    const WIDTH: usize = 8;
    if !are_finite(values) {
        return largest_of(values.iter().copied());
    }
    let mut most = [0.0; WIDTH];
    let stretches = values.chunks_exact(WIDTH);
    let rest = largest_of(stretches.remainder().iter().copied());
    for stretch in stretches {
        for (most, value) in most.iter_mut().zip(stretch) {
            let size = value.abs();
            *most = if size > *most { size } else { *most };
        }
    }
    most.into_iter().fold(rest, f64::max)
}

/// The same of numbers that are not in memory. Numbers without sign are ordered as their bits are, and what is not a number comes last.
pub(super) fn largest_of(values: impl IntoIterator<Item = f64>) -> f64 {
    f64::from_bits(values.into_iter().fold(0, |largest, value| largest.max(value.abs().to_bits())))
}

/// The sum of the absolute values.
pub(super) fn sum_of_sizes(values: &[f64]) -> f64 {
    values.chunks(STRETCH).map(|stretch| stretch.iter().map(|value| value.abs()).sum::<f64>()).sum()
}

/// Whether all are numbers.
pub(super) fn are_finite(values: &[f64]) -> bool {
    values.chunks(STRETCH).all(|stretch| stretch.iter().map(|value| value * 0.0).sum::<f64>() == 0.0)
}
