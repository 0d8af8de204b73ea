//! Every tuned number of the solves of one problem, by the file that uses it: continuation, grid
//! sequencing, refinement and starts (decisions 16 and 21 in `docs/decisions`).

pub(crate) mod continuation {
    /// Widths on the way, relative to the one that is named.
    pub(crate) const WIDER: [f64; 3] = [8.0, 4.0, 2.0];
    /// The tolerance of a solve with another width on a coarse grid.
    pub(crate) const COARSE_GRID_TOLERANCE: f64 = 1e-2;
    /// The same where there is no coarse grid, and no finer one will put right what was found.
    pub(crate) const INTERMEDIATE_TOLERANCE: f64 = 1e-3;
    /// A solve on the way that takes longer leads nowhere.
    pub(crate) const MOST_ITERATIONS: usize = 300;
    pub(crate) const WIDE: f64 = 0.5;
    /// A guess or a failure on which the switching function is nearly 0 says nothing of its size:
    /// there are at least so many.
    pub(crate) const FEWEST_HALVINGS: f64 = 8.0;
    pub(crate) const MOST_HALVINGS: f64 = 12.0;
}

pub(crate) mod covariance {
    /// An unknown without two bounds is at least this part of its guess.
    pub(crate) const LEAST: f64 = 1e-2;
}

pub(crate) mod grid_sequencing {
    /// A grid of fewer intervals is not made coarser by half: it would say too little of the
    /// problem.
    pub(crate) const COARSE: usize = 250;
    /// The tolerance on the coarsest grid; from grid to grid it is `FINER` times as much, but never
    /// less than `CLOSE`: which of several close minima is found is decided on finer grids.
    pub(crate) const COARSEST: f64 = 1e-3;
    pub(crate) const FINER: f64 = 0.1;
    pub(crate) const CLOSE: f64 = 1e-5;
}

pub(crate) mod run {
    /// An attempt that ends with a smaller optimality error is not made again with fresh
    /// multipliers.
    pub(crate) const NEAR: f64 = 1e-7;
}

pub(crate) mod multistart {
    /// Relative size of a variation.
    pub(crate) const VARIATION: f64 = 0.3;
}

pub(crate) mod smoothing_widths {
    /// Smoothing widths relative to the size of the switching function.
    pub(crate) const FIRST_FACTOR: f64 = 0.1;
    pub(crate) const LAST_FACTOR: f64 = 0.01;
    /// Where the first cannot be solved.
    pub(crate) const THINNER: [f64; 3] = [0.1, 0.03, 0.01];
    /// So many times as wide where it cannot be solved over coarse grids, and the tolerance on the
    /// way.
    pub(crate) const WIDER: [f64; 3] = [8.0, 4.0, 2.0];
    pub(crate) const ROUGH: f64 = 1e-4;
    /// From one width to the next; after a failure the square root of it, and so on.
    pub(crate) const DECREASE: f64 = 0.3;
    pub(crate) const MOST_FAILURES: usize = 3;
    /// Without a guess of its size the first width is a fraction of its unit; where that cannot be
    /// solved it may be too thin, and so many times as much is tried.
    pub(crate) const WIDE: f64 = 1e3;
    /// How large the function is, is found out at most so often.
    pub(crate) const MOST_SIZINGS: usize = 3;
    /// A first width may be so many times the one that fits the size, or that part of it.
    pub(crate) const TOO_WIDE: f64 = 2.0;
    pub(crate) const TOO_THIN: f64 = 0.1;
    /// A function that is smaller than this, for its unit, is rounding: the guess rests on the
    /// surface.
    pub(crate) const ROUNDING: f64 = 1e-12;
    /// A function that shrinks below this with its layer is held: its size is that of the layer.
    pub(crate) const SHRUNK: f64 = 0.5;
    /// A step that takes longer than this is too long.
    pub(crate) const MOST_ITERATIONS: usize = 300;
}

pub(crate) mod warm_start {
    pub(crate) const LEAST: f64 = 1e-6;
    pub(crate) const FACTOR: f64 = 10.0;
}

pub(crate) mod refinement {
    /// More intervals than this are not tried.
    pub(crate) const MOST: usize = 20_000;
    pub(crate) const MOST_ROUNDS: usize = 30;
    /// Of a solve that may be given up.
    pub(crate) const MOST_ITERATIONS: usize = 500;
    /// The first stages that are added may gain little where the next gain much. So many times the
    /// least nodes may be foreseen and one more is still tried.
    pub(crate) const PATIENCE: f64 = 1.5;
}

pub(crate) mod controls {
    /// Relative to the range of the control.
    pub(crate) const ROUGH: f64 = 0.01;
    /// A control with a smaller range, relative to its size, rests.
    pub(crate) const FLAT: f64 = 1e-6;
}

pub(crate) mod error_estimate {
    pub(crate) const FEWEST_STEPS: usize = 4;
    pub(crate) const MOST_STEPS: usize = 256;
    /// The integration is accurate enough when twice the steps change the errors by this part of
    /// the tolerance.
    pub(crate) const ACCURATE: f64 = 0.05;
}

pub(crate) mod plan {
    /// Of what the tolerance allows, so much is planned for.
    pub(crate) const PLANNED: f64 = 0.7;
    /// An interval is divided into no more parts at a time: far from the limit errors fall in other
    /// ways.
    pub(crate) const MOST_PARTS: f64 = 4.0;
    /// More parts of an interval than that are not counted: an error may be larger than any number
    /// of them could lower.
    pub(crate) const BEYOND: f64 = 1e6;
    /// What gains no more than that by another stage is not smooth.
    pub(crate) const ROUGH: f64 = 0.3;
}
