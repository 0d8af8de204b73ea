//! Every tuned number of what all solvers of a nonlinear program share, by the file that uses it:
//! measures of an answer, scaling, multiplier estimates, covariances and convex programs (decisions
//! 27, 30 and 36 in `docs/decisions`).

pub(crate) mod assessment {
    /// The improvement that may be left, in units of the tolerance: 1e-6 at the default tolerance
    /// of 1e-8.
    pub(crate) const IMPROVEMENT: f64 = 100.0;
    /// The defects of a state may add up to so many times the tolerance: a contradiction between
    /// start and end is small in each interval, and as large as ever in all of them together.
    pub(crate) const SPREAD: f64 = 10.0;
    /// What is aimed at is so much less, where that can be had.
    pub(crate) const AIM: f64 = 0.1;
    /// The same of what is acceptable.
    pub(crate) const ACCEPTABLE_VIOLATION: f64 = 1e-6;
    pub(crate) const ACCEPTABLE_IMPROVEMENT: f64 = 1e-4;
    /// What is smaller than this part of its declared unit is nothing.
    pub(crate) const NOTHING: f64 = 1e-6;
    /// The same of the objective: where it falls to 0 like a fourth power nothing else says when
    /// that is near enough.
    pub(crate) const NO_OBJECTIVE: f64 = 1e-8;
    /// Where a quantity is 0 at some time, terms of the objective have this part of the size that
    /// it has at others.
    pub(crate) const PART: f64 = 1e-2;
}

pub(crate) mod multiplier_estimate {
    /// What is nearer to its bound than this is at it: an interior point method keeps away a
    /// little.
    pub(crate) const NEAR: f64 = 1e-5;
    pub(crate) const WEIGHTLESS: f64 = 1e8;
    /// What rows that depend on each other are shifted by, so that they share their multiplier.
    pub(crate) const SHIFT: f64 = 1e-8;
}

pub(crate) mod covariance {
    /// Distances from bounds, and multipliers, are at least this.
    pub(crate) const TINY: f64 = 1e-20;
    /// What does not hold a variable within so many times its size does not hold it.
    pub(crate) const SOFT: f64 = 100.0;
    /// Where a solution may be anywhere along some direction it moves as little as it can: springs
    /// are these parts of what changes the objective by its size when a variable moves by its own.
    pub(crate) const SOFTNESS: [f64; 4] = [0.0, 1e-10, 1e-9, 1e-8];
    /// What changes by more where these are up to twice as stiff, by multiples of the golden ratio,
    /// depends on them.
    pub(crate) const SETTLED: f64 = 1e-3;
    /// A part of its size by which a variable does not move.
    pub(crate) const NOT_MOVED: f64 = 1e-10;
    pub(crate) const GOLDEN: f64 = 0.618_033_988_749_895;
    /// What a bound holds is held by a spring so much stiffer than the rest.
    pub(crate) const HARD: f64 = 1e12;
    /// A variable is at a bound if it is as near as this part of its size.
    pub(crate) const NEAR: f64 = 1e-4;
    /// What is nearer than this part of its size is as near as that: else a multiplier that is
    /// rounding would hold it.
    pub(crate) const CLOSE: f64 = 1e-12;
    /// A variable is at least this part of the width of its bounds.
    pub(crate) const LEAST: f64 = 1e-2;
    /// A row that gives way by less than this part of what it does without equations follows from
    /// these.
    pub(crate) const IMPLIED: f64 = 1e-10;
    /// A smaller component of a direction does not belong to it.
    pub(crate) const SMALL: f64 = 0.1;
}

pub(crate) mod other_multipliers {
    /// How soft rows are, beside the springs of their variables.
    pub(crate) const SOFT: f64 = 1e-10;
    /// A row that gives way by as much is not active.
    pub(crate) const OFF: f64 = 1e20;
    /// Each makes what is no dependence as many times smaller as rows are soft.
    pub(crate) const STEPS: usize = 2;
    /// Of a random combination of rows a dependence leaves at least this part.
    pub(crate) const LARGEST: f64 = 1e-4;
    /// What a dependence adds up to, as a part of its terms, is less than this: of an unstable
    /// plant rows are nearly dependent, and multipliers are large, but unique.
    pub(crate) const WRONG: f64 = 1e-11;
    /// No multiplier of an inequality loses more than this part of what it is.
    pub(crate) const SHORT: f64 = 0.5;
}

pub(crate) mod factors {
    /// Quantities up to this size, and down to its inverse, are moderate.
    pub(crate) const MODERATE: f64 = 16.0;
    /// The same of gradients of rows.
    pub(crate) const MODERATE_GRADIENT: f64 = 100.0;
    /// The least and the largest gradient of the objective.
    pub(crate) const LEAST_OBJECTIVE: f64 = 1.0;
    pub(crate) const LARGEST_OBJECTIVE: f64 = 100.0;
    /// Sizes and slopes below this are none.
    pub(crate) const SMALLEST: f64 = 1e-30;
    /// Rows are not scaled down below this.
    pub(crate) const LEAST_FACTOR: f64 = 1e-8;
    /// Factors of the objective beyond this over its unit, or below its inverse, come from slopes
    /// that are rounding.
    pub(crate) const LARGEST_FACTOR: f64 = 1e12;
}

pub(crate) mod nominal {
    /// Multiples of it spread evenly between 0 and 1.
    pub(crate) const GOLDEN: f64 = 0.618_033_988_749_895;
    /// A guess below this is small.
    pub(crate) const SMALL: f64 = 1.0 / 16.0;
    /// A quantity with a small guess has at least this part of its range.
    pub(crate) const LEAST_PART: f64 = 1e-2;
    /// A range of more units is no statement about a size.
    pub(crate) const LONGEST_RANGE: f64 = 1e4;
    /// A guess, or an estimate, below this part of its unit is rounding (decision 58).
    pub(crate) const NO_SIZE: f64 = 1e-15;
    /// What is smaller than this part of its unit at an answer may be rounding.
    pub(crate) const LEAST_ANSWER: f64 = 1e-4;
    /// Estimates beyond so many units, or below its inverse, are rounding or poles.
    pub(crate) const LARGEST_ESTIMATE: f64 = 1e8;
    /// The same where nothing else led to a solution.
    pub(crate) const LARGEST_ASKED_FOR: f64 = 1e15;
}

pub(crate) mod farkas {
    /// A slope that is less than this part of its terms is what rounding makes of 0.
    pub(crate) const ROUNDING: f64 = 1e-13;
    /// The sum has to be above 0 by this part of its terms.
    pub(crate) const MARGIN: f64 = 1e-9;
    /// Multipliers are moved so often: once, and again for what rounding left.
    pub(crate) const REPAIRS: usize = 4;
    /// The weight of a multiplier that is 0, which stays 0.
    pub(crate) const NOT_USED: f64 = 1e-20;
}

pub(crate) mod convex {
    /// What of a ray is smaller than this part of it is rounding.
    pub(crate) const RAY_ROUNDING: f64 = 1e-9;
    /// The same of its curvature.
    pub(crate) const FLAT_RAY: f64 = 1e-12;
    /// The tolerance of the conic solver, relative to that asked for, and the least.
    pub(crate) const CONIC_TOLERANCE: f64 = 0.1;
    pub(crate) const LEAST_CONIC_TOLERANCE: f64 = 1e-10;
}

pub(crate) mod convexity {
    /// Exact elimination of a larger block would take too long.
    pub(crate) const LARGEST_EXACT: usize = 60;
    /// A larger block is not looked at.
    pub(crate) const LARGEST: usize = 600;
}
