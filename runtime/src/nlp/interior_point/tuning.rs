//! Every tuned number of the interior point method, by the file that uses it.
//!
//! Where nothing else is said, the value is Ipopt's default (Waechter & Biegler 2006, section 4,
//! and its options), or is justified by the decisions 8, 12, 22, 23, 26 and 30 in `docs/decisions`.

pub(crate) mod algorithm {
    /// Multipliers above this, relative to the objective, come from rows that depend on each other,
    /// unless these are nearly satisfied.
    pub(crate) const LARGEST_MULTIPLIER: f64 = 1e8;
    /// The largest violation of constraints that are nearly satisfied.
    pub(crate) const NEARLY_FEASIBLE: f64 = 1e-4;
    /// A step this small, relative to the iterate, is rounding.
    pub(crate) const TINY_STEP: f64 = 10.0 * f64::EPSILON;
    /// More steps of rounding than that in a row, at the last barrier parameter or because they
    /// were cut down to it, lead nowhere.
    pub(crate) const MOST_TINY_STEPS: usize = 5;
    /// A restoration phase that is stuck is begun anew so many times.
    pub(crate) const MOST_RESTARTS: usize = 4;
}

pub(crate) mod barrier {
    use crate::nlp::interior_point::barrier::UpdateRule;

    /// The rule of Fiacco and McCormick: `kappa_epsilon`, `kappa_mu`, `theta_mu` (equation 7).
    pub(crate) const MONOTONE: UpdateRule = UpdateRule { accuracy: 4.0, factor: 0.2, power: 1.2 };
    /// The rule after so many whole steps in a row.
    pub(crate) const SUPERLINEAR: UpdateRule =
        UpdateRule { accuracy: 100.0, factor: 0.05, power: 1.5 };
    /// See [`SUPERLINEAR`] (decision 26).
    pub(crate) const SUPERLINEAR_AFTER: usize = 2;
    /// A step is whole if this fraction of it is taken, at least.
    pub(crate) const WHOLE: f64 = 0.9;
    /// A parameter within this factor of the last is the last.
    pub(crate) const CLOSE: f64 = 10.0;
    /// The least fraction of the way to the boundary that a step may go, `tau_min`.
    pub(crate) const SMALLEST_FRACTION: f64 = 0.99;
    /// Bound multipliers stay within this factor of `mu / distance`.
    pub(crate) const MULTIPLIER_CORRIDOR: f64 = 1e10;
    /// Weight of the linear term that keeps variables with one bound only from running away.
    pub(crate) const DAMPING: f64 = 1e-5;
    /// The last parameter is so many times smaller than the tolerance (equation 7).
    pub(crate) const BELOW_TOLERANCE: f64 = 10.0;
    /// Products of distances whose logarithm is not taken yet: of two no product overflows.
    pub(crate) const PRODUCTS: std::ops::Range<f64> = 1e-70..1e70;
}

pub(crate) mod error_scaling {
    /// Multipliers of this average size are considered normal.
    pub(crate) const NORMAL_MULTIPLIER: f64 = 100.0;
}

pub(crate) mod filter {
    /// Margins of the filter, `gamma_theta` and `gamma_phi`.
    pub(crate) const VIOLATION_MARGIN: f64 = 1e-5;
    pub(crate) const OBJECTIVE_MARGIN: f64 = 1e-8;
    /// Sufficient decrease of the barrier function, `eta_phi`.
    pub(crate) const ARMIJO: f64 = 1e-4;
    /// The switching condition (equation 19): `delta`, `s_theta`, `s_phi`.
    pub(crate) const SWITCH_FACTOR: f64 = 1.0;
    pub(crate) const VIOLATION_POWER: f64 = 1.1;
    pub(crate) const SLOPE_POWER: f64 = 2.3;
    /// Safety factor of the smallest step (equation 23), `gamma_alpha`.
    pub(crate) const SMALLEST_STEP: f64 = 0.05;
    /// Violations that no point may have, and those below which the objective may decide, relative
    /// to that of the start: `theta_max`, `theta_min`.
    pub(crate) const LARGEST_VIOLATION: f64 = 1e4;
    pub(crate) const SMALL_VIOLATION: f64 = 1e-4;
    /// No step length is below this.
    pub(crate) const SMALLEST_ALPHA: f64 = 1e-14;
    /// What rounding makes of an objective, relative to it.
    pub(crate) const ROUNDING: f64 = 10.0 * f64::EPSILON;
}

pub(crate) mod inertia {
    /// Of the Hessian (algorithm IC): the first, least and largest, `delta_w`; the growth of the
    /// first and of others, and the decay from one factorisation to the next, `kappa_w`.
    pub(crate) const FIRST_REGULARIZATION: f64 = 1e-4;
    pub(crate) const SMALLEST_REGULARIZATION: f64 = 1e-20;
    pub(crate) const LARGEST_REGULARIZATION: f64 = 1e40;
    pub(crate) const FIRST_GROWTH: f64 = 100.0;
    pub(crate) const GROWTH: f64 = 8.0;
    pub(crate) const DECAY: f64 = 1.0 / 3.0;
    /// A line search that keeps less than the first fraction of a step raises the caution, one that
    /// keeps more than the second lowers it.
    pub(crate) const CUT_SHORT: f64 = 0.1;
    pub(crate) const NOT_CUT: f64 = 0.5;
    pub(crate) const CAUTION_GROWTH: f64 = 4.0;
    pub(crate) const MOST_CAUTION: f64 = 1.0;
    /// Of constraints, where the matrix is singular: `delta_c`.
    pub(crate) const ROW_REGULARIZATION: f64 = 1e-8;
    /// The same where rows depend on each other by their multipliers, although the inertia is
    /// right.
    pub(crate) const DEPENDENT_ROWS: f64 = 1e-6;
    /// How often the least regularisation is bracketed by half, in the logarithm, before directions
    /// are told apart by it.
    pub(crate) const BISECTIONS: usize = 3;
    /// The power of `mu` in the regularisation of constraints (`kappa_c`).
    pub(crate) const MU_POWER: f64 = 0.25;
}

pub(crate) mod initialisation {
    /// The first barrier parameter of a cold start, `mu_0`.
    pub(crate) const FIRST_MU: f64 = 0.1;
    /// How far inside of its bounds a start is moved: Ipopt's `bound_push` and `bound_frac`, cold
    /// and warm.
    pub(crate) const BOUND_PUSH: f64 = 1e-2;
    pub(crate) const WARM_START_BOUND_PUSH: f64 = 1e-5;
}

pub(crate) mod kkt {
    /// Refinement stops at this residual, relative to the right side.
    pub(crate) const REFINED: f64 = 1e-11;
    pub(crate) const MOST_REFINEMENTS: usize = 8;
    pub(crate) const HUGE: f64 = 1e3;
    /// A larger residual than this, relative to right side and solution, is no solution.
    pub(crate) const INACCURATE: f64 = 1e-5;
}

pub(crate) mod line_search {
    /// Second-order corrections at most, `p_max`, and what each has to leave of the violation at
    /// most, `kappa_soc`.
    pub(crate) const MOST_CORRECTIONS: usize = 4;
    pub(crate) const CORRECTION_DECREASE: f64 = 0.99;
}

pub(crate) mod fallback {
    /// An answer whose sizes are further than this from those that the solve was scaled by is begun
    /// anew, so often.
    pub(crate) const FAR: f64 = 8.0;
    pub(crate) const MOST_RESCALINGS: usize = 3;
    /// A point that is no minimum, though slope and curvature are those of one, is left so often.
    pub(crate) const MOST_FLAT_POINTS: usize = 20;
    /// With so many times the iterations of all before, at most.
    pub(crate) const MORE_WORK: usize = 2;
}

pub(crate) mod restoration {
    /// The price of elastic variables, `rho`.
    pub(crate) const RHO: f64 = 1e3;
    /// A restoration phase leaves at most so much of the violation,
    pub(crate) const REQUIRED_DECREASE: f64 = 0.9;
    /// and where it comes before everything else at most this.
    pub(crate) const FIRST_DECREASE: f64 = 1e-3;
    /// Bound multipliers after a restoration phase are at most this.
    pub(crate) const LARGEST_BOUND_MULTIPLIER: f64 = 1e3;
}

pub(crate) mod saddle {
    /// A point is left so often.
    pub(crate) const MOST_DEPARTURES: usize = 5;
    /// So many whole regularised steps in a row creep, if curvature gains so many times what the
    /// last of them does; where it does not, it is looked at again after so many times as many.
    pub(crate) const CREEPING_STEPS: usize = 20;
    pub(crate) const CREEPING: f64 = 100.0;
    pub(crate) const LONGER: usize = 2;
    /// Steps of the inverse iteration, at least, and at most where none with negative curvature is
    /// found.
    pub(crate) const ITERATIONS: usize = 8;
    pub(crate) const MOST_ITERATIONS: usize = 64;
    /// The same where all directions without curvature are as good: they stay together.
    pub(crate) const FEW_ITERATIONS: usize = 2;
    /// So many of them, with other signs of the quantities.
    pub(crate) const SIGN_PATTERNS: usize = 4;
    /// Steps where curvature says nothing, as parts of the sizes, from short to long.
    pub(crate) const SHORT_STEPS: [f64; 3] = [1e-3, 1e-2, 1e-1];
    /// A quantity that is smaller than this part of its nominal magnitude is 0: to a flat point
    /// steps come no nearer than by a root of the tolerance.
    pub(crate) const NOTHING: f64 = 1e-3;
    /// A bound that is farther away than this part of the size of a variable is not active.
    pub(crate) const AWAY: f64 = 1e-2;
    /// Curvature is negative if it is more than this part of its terms.
    pub(crate) const ROUNDING: f64 = 1e-9;
    /// A step along the direction has to gain this part of what curvature says.
    pub(crate) const LEAST_GAIN: f64 = 0.1;
    pub(crate) const MOST_HALVINGS: usize = 40;
    /// It may violate the rows so much.
    pub(crate) const LARGEST_VIOLATION: f64 = 1e-2;
    /// The barrier parameter afterwards, at least.
    pub(crate) const ROOM: f64 = 1e-4;
    /// How far entries of the first vector are spread, by multiples of the golden ratio.
    pub(crate) const SPREAD: f64 = 0.1;
    pub(crate) const GOLDEN: f64 = 0.618_033_988_749_895;
}

pub(crate) mod kinks {
    /// Both sides of a kink are looked at by this part of the sizes, farther than a solve comes
    /// near to it, and nearer than curvature tells.
    pub(crate) const BESIDE: f64 = 1e-6;
    /// Gradients differ where steps by all sizes are worth more than this part of the objective.
    pub(crate) const DIFFERENT: f64 = 1e-4;
    /// Steps along the way down, as parts of the sizes: rows with kinks do not follow.
    pub(crate) const SHORT_STEPS: [f64; 3] = [1e-5, 1e-4, 1e-3];
    /// From one of these on another attempt may begin.
    pub(crate) const LONG_STEPS: [f64; 3] = [1e-3, 1e-2, 1e-1];
}

pub(crate) mod termination {
    /// An error this small for this many iterations is acceptable.
    pub(crate) const ACCEPTABLE_ERROR: f64 = 1e-6;
    pub(crate) const ACCEPTABLE_ITERATIONS: usize = 100;
    /// The violation weighted with the multipliers may be so many times the tolerance.
    pub(crate) const MOST_WEIGHTED_VIOLATION: f64 = 1e3;
    /// Variables beyond this many times the farthest bound, at a point that is feasible relative to
    /// them, have left the problem.
    pub(crate) const DIVERGED: f64 = 1e10;
    /// A scaled objective below minus this has left it, too: an exponential function gets there
    /// before variables are far, and regularisation ends (`LARGEST_REGULARIZATION`) beyond it.
    pub(crate) const FALLEN: f64 = 1e30;
    /// What has left the problem has no end if the objective falls by this part of itself, so often
    /// in a row.
    pub(crate) const LEAST_FALL: f64 = 1e-2;
    pub(crate) const FALLS: usize = 10;
    /// The target is not lowered below this part of the tolerance, nor faster than that; lower ones
    /// are given up after so many iterations.
    pub(crate) const LEAST_TARGET: f64 = 1e-7;
    pub(crate) const FASTEST: f64 = 1e-2;
    pub(crate) const SLOWEST: f64 = 0.3;
    pub(crate) const PATIENCE: usize = 20;
}

pub(crate) mod watchdog {
    /// So many shortened steps in a row start the watchdog.
    pub(crate) const PATIENCE: usize = 10;
    /// So many watchdog steps, which are full, are taken without asking the filter.
    pub(crate) const WATCHDOG_STEPS: usize = 3;
    /// A step of which less than this is kept is shortened.
    pub(crate) const SHORTENED: f64 = 0.9;
}
