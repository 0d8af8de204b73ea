//! What is asked of long vectors at every iteration. Neighbours belong to different sums, which
//! share registers and do not wait for one another.

/// Sums that are kept at a time.
const WIDTH: usize = 8;
type Stretch = [f64; WIDTH];

/// The largest absolute value; infinite, or not a number, where some value is.
pub(super) fn largest(values: &[f64]) -> f64 {
    let mut most = Largest::default();
    stretches(values).for_each(|stretch| most.add(stretch));
    most.value()
}

/// The same of `a + b - c`.
pub(super) fn largest_sum([a, b]: [&[f64]; 2], c: &[f64]) -> f64 {
    let mut most = Largest::default();
    for ((a, b), c) in stretches(a).zip(stretches(b)).zip(stretches(c)) {
        let mut sum = [0.0; WIDTH];
        for i in 0..WIDTH {
            sum[i] = a[i] + b[i] - c[i];
        }
        most.add(sum);
    }
    most.value()
}

/// The sum of the absolute values.
pub(super) fn sum_of_sizes(values: &[f64]) -> f64 {
    let mut sums = [0.0; WIDTH];
    for stretch in stretches(values) {
        for i in 0..WIDTH {
            sums[i] += stretch[i].abs();
        }
    }
    sums.iter().sum()
}

/// The sum of the products.
pub(super) fn dot(a: &[f64], b: &[f64]) -> f64 {
    let mut sums = [0.0; WIDTH];
    for (a, b) in stretches(a).zip(stretches(b)) {
        for i in 0..WIDTH {
            sums[i] += a[i] * b[i];
        }
    }
    sums.iter().sum()
}

/// `target += factor * step`
pub(super) fn add_scaled(target: &mut [f64], step: &[f64], factor: f64) {
    target.iter_mut().zip(step).for_each(|(value, d)| *value += factor * d);
}

/// Whether all are numbers.
pub(super) fn are_finite(values: &[f64]) -> bool {
    let mut nothing = [0.0; WIDTH];
    for stretch in stretches(values) {
        for i in 0..WIDTH {
            nothing[i] += stretch[i] * 0.0;
        }
    }
    nothing == [0.0; WIDTH]
}

/// The numbers one stretch after the other; the last is filled up with zeros.
#[inline(always)]
fn stretches(values: &[f64]) -> impl Iterator<Item = Stretch> {
    let (whole, rest) = values.as_chunks::<WIDTH>();
    let mut last = [0.0; WIDTH];
    last[..rest.len()].copy_from_slice(rest);
    whole.iter().copied().chain([last])
}

#[derive(Default)]
struct Largest {
    most: Stretch,
    /// Zeros, or not a number where a value was infinite or not a number.
    nothing: Stretch,
}

impl Largest {
    #[inline(always)]
    fn add(&mut self, values: Stretch) {
        for i in 0..WIDTH {
            self.nothing[i] += values[i] * 0.0;
        }
        for i in 0..WIDTH {
            let size = values[i].abs();
            // Passes over what is not a number.
            self.most[i] = if size > self.most[i] { size } else { self.most[i] };
        }
    }

    fn value(self) -> f64 {
        let most = self.most.into_iter().fold(0.0, f64::max);
        let is_finite = self.nothing == [0.0; WIDTH];
        if is_finite || most == f64::INFINITY { most } else { f64::NAN }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Wherever it stands: in a whole stretch or in the rest.
    #[test]
    fn what_is_not_finite_is_noticed() {
        for place in 0..19 {
            let mut values: Vec<f64> = (0..19).map(|i| f64::from(i) - 9.5).collect();
            assert!(
                (largest(&values), sum_of_sizes(&values), are_finite(&values)) == (9.5, 90.5, true)
            );
            values[place] = f64::NAN;
            assert!(largest(&values).is_nan() && !are_finite(&values));
            assert!(largest_sum([&[0.0; 19], &values], &[0.0; 19]).is_nan());
            values[place] = f64::NEG_INFINITY;
            assert!(largest(&values) == f64::INFINITY && !are_finite(&values));
        }
    }
}
