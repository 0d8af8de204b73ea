//! Numbers that look random and are the same on every run.

/// A linear congruential generator (D. E. Knuth, MMIX).
pub(crate) struct Random(pub(crate) u64);

impl Random {
    /// Uniform in [-1, 1].
    pub(crate) fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (self.0 >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }

    #[cfg(test)]
    pub(crate) fn vector(&mut self, length: usize) -> Vec<f64> {
        (0..length).map(|_| self.next()).collect()
    }

    #[cfg(test)]
    pub(crate) fn below(&mut self, end: usize) -> usize {
        ((self.next() + 1.0) / 2.0 * end as f64) as usize
    }
}
