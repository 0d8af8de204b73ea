//! The times at which a replay is looked at: the grid, and between its points.

use crate::record::Record;
use fdcc_runtime::simulate::Controls;

const POINTS_OF_INTERVAL: usize = 8;
/// Few intervals of a high order are long.
const FEWEST_POINTS: usize = 4000;

/// Points in each of so many intervals.
pub(crate) fn points_of_one(intervals: usize) -> usize {
    POINTS_OF_INTERVAL.max(FEWEST_POINTS / intervals.max(1))
}

/// The points, and the controls there.
pub(crate) struct Points<'a> {
    pub times: Vec<f64>,
    controls: &'a Controls,
    /// How many points are in an interval.
    count: usize,
}

impl<'a> Points<'a> {
    /// The controls have a segment for each interval of the grid.
    pub fn new(record: &Record, controls: &'a Controls, [first, last]: [f64; 2]) -> Self {
        let mut grid: Vec<f64> = record.time.to_vec();
        let end = grid.len() - 1;
        // The grid has been rounded at its ends.
        (grid[0], grid[end]) = (first, last);
        let count = points_of_one(end);
        let inside = |pair: &[f64]| {
            let (from, length) = (pair[0], pair[1] - pair[0]);
            (0..count).map(move |j| from + length * j as f64 / count as f64)
        };
        let times = grid.windows(2).flat_map(inside).chain([last]).collect();
        Points { times, controls, count }
    }

    /// The controls at a time, as they are at a point; at a grid point those of the interval that
    /// ends there, as a transcription has it.
    pub fn control(&self, point: usize, time: f64) -> Vec<f64> {
        self.controls.values(Some(point.saturating_sub(1) / self.count), time)
    }
}
