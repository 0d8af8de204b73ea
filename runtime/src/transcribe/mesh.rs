//! The grid over normalised time.

use crate::problem::Method;

/// Grid points `0 = tau_0 < ... < tau_N = 1`.
#[derive(Clone, Debug)]
pub(crate) struct Mesh {
    intervals: usize,
    /// Nothing where all intervals have one length.
    points: Option<Vec<f64>>,
}

impl Mesh {
    pub(crate) fn new(method: &Method) -> Self {
        let points = Some(method.grid.times().to_vec()).filter(|times| !times.is_empty());
        Mesh { intervals: method.intervals(), points }
    }

    /// The time at which this part of interval `k` has passed.
    pub(crate) fn at(&self, k: usize, part: f64) -> f64 {
        match &self.points {
            None => (k as f64 + part) / self.intervals as f64,
            Some(points) if k == self.intervals => points[k],
            Some(points) => points[k] + part * (points[k + 1] - points[k]),
        }
    }

    /// The interval in which a time is, and which part of it has passed; the first and the last
    /// one go on.
    pub(crate) fn find(&self, tau: f64) -> (usize, f64) {
        let k = match &self.points {
            None => (tau * self.intervals as f64) as usize,
            Some(points) => points.partition_point(|point| *point <= tau).saturating_sub(1),
        };
        let k = k.min(self.intervals - 1);
        (k, (tau - self.at(k, 0.0)) / (self.at(k, 1.0) - self.at(k, 0.0)))
    }

    /// The length of interval `k`, relative to that of a uniform grid.
    pub(crate) fn relative(&self, k: usize) -> f64 {
        self.points
            .as_ref()
            .map_or(1.0, |points| (points[k + 1] - points[k]) * self.intervals as f64)
    }

    /// All relative lengths; nothing where they are 1.
    pub(crate) fn all_relative(&self) -> Option<Vec<f64>> {
        self.points.as_ref().map(|_| (0..self.intervals).map(|k| self.relative(k)).collect())
    }
}
