//! Every tuned number of a simulation, by the file that uses it. Those of steps are the ones of
//! Hairer, Norsett & Wanner (I) and Hairer & Wanner (II); the others are our own, far from where
//! results would depend on them.

pub(crate) mod options {
    /// The relative tolerance of a step where none is given.
    pub(crate) const RTOL: f64 = 1e-10;
}

pub(crate) mod controls {
    /// What is outside a segment by less than this part of it is inside but for rounding.
    pub(crate) const ROUNDING: f64 = 1e-9;
}

pub(crate) mod field {
    /// Newton's method on the selectors ends with a relative change of this.
    pub(crate) const SOLVED: f64 = 1e-13;
    /// A state is on its surfaces at this part of their rounding errors.
    pub(crate) const PROJECTED: f64 = 0.1;
    /// A part of the largest time that steps can follow.
    pub(crate) const MOMENT: f64 = 1e-14;
    /// A state is on a surface within so many times its rounding error.
    pub(crate) const ON_SURFACE: f64 = 10.0;
}

pub(crate) mod normals {
    /// What rounding makes of a sum, as a part of its terms.
    pub(crate) const ROUNDING: f64 = 1e-14;
}

pub(crate) mod tolerance {
    /// The absolute tolerance as a part of the size of a state.
    pub(crate) const PART: f64 = 1e-12;
    /// What is left of the size of a state after a step in which it was smaller: an oscillator
    /// keeps most of its amplitude where it passes 0, and what decays is as small as it has become.
    pub(crate) const KEPT: f64 = 0.9;
    /// A state counts at least as this part of how far its rate, whatever the selectors, could take
    /// it in the whole time: what leaves 0 may grow so slowly that no step is short enough.
    pub(crate) const REACHED: f64 = 1e-9;
    /// The same of what hardly moves, relative to how large it can become, or to the largest state.
    pub(crate) const LEAST: f64 = 1e-60;
    /// What is smaller than this, such as the tail of a pulse, is soon too small for its digits; so
    /// is this part of what can never become as large as 1.
    pub(crate) const SMALLEST: f64 = 1e-280;
    /// Selectors that solve a linear system are known so well.
    pub(crate) const SOLVED: f64 = 1e-13;
    /// So many states may pass on to each other that they are uncertain.
    pub(crate) const PASSES: usize = 3;
}

pub(crate) mod departure {
    /// Newton's method is given up after so many iterations.
    pub(crate) const MOST_ITERATIONS: usize = 20;
    /// Where in the step the dense output is compared with the collocation polynomial, and what the
    /// difference weighs in the error.
    pub(crate) const INSIDE: f64 = 0.25;
    pub(crate) const INSIDE_WEIGHT: f64 = 0.01;
    /// Newton's method ends with a change of this, in units of the tolerance.
    pub(crate) const CONVERGED: f64 = 0.01;
}

pub(crate) mod radau {
    /// What the last steps leave of error, all within the tolerance, is estimated at this much at
    /// most.
    pub(crate) const INHERITED: f64 = 2.0;
    pub(crate) const MOST_ITERATIONS: usize = 10;
    /// The error of a step whose equations were not solved: the next is less than half as long.
    pub(crate) const NOT_SOLVED: f64 = 16.0;
    /// Newton's method ends where the error that is left is less than this over the tolerance, or
    /// the root of the tolerance, at most this (Hairer, Wanner II, IV.8).
    pub(crate) const ROUNDING: f64 = 10.0 * f64::EPSILON;
    pub(crate) const MOST_REST: f64 = 0.03;
    /// What is left after the first iteration, relative to its change.
    pub(crate) const FIRST_RATE: f64 = 10.0;
}

pub(crate) mod location {
    /// What rounding may make of `1 - |s|`.
    pub(crate) const SELECTOR_NOISE: f64 = 1e-12;
    /// A shorter part of a step is not told from its beginning.
    pub(crate) const SHORTEST: f64 = 1e-12;
    /// What is sooner in a step, and by so many roundings of its time, needs a shorter one.
    pub(crate) const SOON: f64 = 1e-10;
    pub(crate) const ROUNDINGS: f64 = 1e3;
    /// The second point of the secant method, relative to the first.
    pub(crate) const SECANT_OFFSET: f64 = 1e-6;
    /// It stays within this part of the first.
    pub(crate) const NEAR: f64 = 1e-3;
}

pub(crate) mod touch {
    /// What is smaller than this part of its terms is touched: a derivative is in doubt there.
    pub(crate) const TOUCHING: f64 = 1e-9;
    /// So many parts of one step are looked at.
    pub(crate) const MOST_PARTS: usize = 1000;
}

pub(crate) mod search {
    /// More parts than this of one step are looked at in shorter steps.
    pub(crate) const MOST_PARTS: usize = 1000;
    /// What stays within this many times its rounding errors stays at 0, and does not fail.
    pub(crate) const FLAT: f64 = 1000.0;
    /// Polynomials of degree 4 that stay within rounding errors have rates of 32 of them at most
    /// (A. A. Markov); what has this many, at one of these parts of a step, turns too often.
    pub(crate) const FAR: f64 = 100.0;
    pub(crate) const SAMPLES: [f64; 3] = [0.1, 0.37, 0.83];
    /// The lowest value of a shallow part is found with so many sections by the golden ratio.
    pub(crate) const SECTIONS: usize = 40;
    pub(crate) const GOLDEN: f64 = 0.618_033_988_749_895;
    /// The values at the ends of a part agree with the rates between to this part of them.
    pub(crate) const SLACK: f64 = 1e-9;
    /// Rounding of times, relative to them.
    pub(crate) const ROUNDING: f64 = 8.0 * f64::EPSILON;
}

pub(crate) mod hidden {
    /// A pulse may move a state unseen by this part of its way since the beginning,
    pub(crate) const PART: f64 = 1e-2;
    /// or by so many tolerances of a step, as the curve is no more exact,
    pub(crate) const TOLERANCES: f64 = 100.0;
    /// or by this part of what bounds over the whole step allow: what has not moved has no way,
    pub(crate) const LEAST_OF_WHOLE: f64 = 1e-4;
    /// or by so many times what rounding makes of its rate, the width of bounds at a point.
    pub(crate) const ROUNDINGS: f64 = 4.0;
    /// So many parts are looked at, whatever they hide.
    pub(crate) const EVEN_PARTS: usize = 16;
    /// Beyond them only one that hides this part of all that is hidden, and no more than so many.
    pub(crate) const STANDS_OUT: f64 = 0.2;
    pub(crate) const MOST_PARTS: usize = 80;
}

pub(crate) mod discontinuity {
    /// How far beside a change of sign a function is looked at, in the least parts of a step that
    /// differ, and so many times as far for comparison.
    pub(crate) const DISTANCE: f64 = 64.0;
    pub(crate) const FARTHER: f64 = 16.0;
    /// What is above so many times rounding is not 0.
    pub(crate) const CLEAR: f64 = 4.0;
    /// What does not fall to this part from far to near is not on the way to 0; even a cube root
    /// falls to 0.4.
    pub(crate) const FALLS: f64 = 0.7;
}

pub(crate) mod extremes {
    /// How exact an extreme is, as a part of the values near it.
    pub(crate) const EXACT: f64 = 1e-9;
    /// And as a part of the terms that cancel there: what is held at 0 has no greatest value.
    pub(crate) const EXACT_OF_TERMS: f64 = 1e-13;
    /// More parts than this of one step are not looked at.
    pub(crate) const MOST_PARTS: usize = 1000;
}

pub(crate) mod modes {
    /// What is smaller than this part of the largest entry of a matrix is 0.
    pub(crate) const ROUNDING: f64 = 1e-10;
    /// Rates below this part of what they are made of are 0.
    pub(crate) const TIE: f64 = 1e-11;
    /// Beyond this many surfaces at a point, combinations are too many to list.
    pub(crate) const MOST_COMBINED: usize = 6;
    /// The iteration on the selectors ends with a change of this.
    pub(crate) const CONVERGED: f64 = 1e-13;
    /// A selector this near to the end of its interval is there.
    pub(crate) const AT_END: f64 = 1e-12;
    /// A look ahead, as a part of the whole time.
    pub(crate) const AHEAD: f64 = 1e-5;
}

pub(crate) mod ball {
    /// Eigenvalues below this part of the diagonal are 0 by rounding.
    pub(crate) const SINGULAR: f64 = 1e-13;
    /// Sweeps over several balls at one point.
    pub(crate) const MOST_SWEEPS: usize = 200;
    /// Multipliers that change by less than this part of the largest possible have settled.
    pub(crate) const SETTLED: f64 = 1e-15;
}

pub(crate) mod complementarity {
    /// Beyond this many surfaces at a point principal minors are too many to look at.
    pub(crate) const MOST_MINORS: usize = 12;
    /// Minors below this part of what their size allows are 0 by rounding.
    pub(crate) const SINGULAR: f64 = 1e-13;
    /// Smaller pivots are 0 by rounding, and ratios that differ by less are ties.
    pub(crate) const PIVOT: f64 = 1e-12;
}

pub(crate) mod advance {
    /// The explicit pair is stable for `h |lambda|` up to about 3.3. With small tolerances the slow
    /// part of a stiff solution keeps it well below that, but a solution that is not stiff farther
    /// still: this much at a tolerance of 1e-10.
    pub(crate) const BORDER: f64 = 3.25;
    pub(crate) const SMALL_BORDER: f64 = 1.0;
    /// So many steps at the border, not interrupted by so many off it, make a system stiff.
    pub(crate) const STIFF_AFTER: usize = 15;
    pub(crate) const NOT_STIFF_AFTER: usize = 6;
    /// A trajectory of more numbers than this, a quarter of a gigabyte, is of no use to anybody.
    pub(crate) const MOST_NUMBERS: usize = 1 << 25;
    /// After so many kinks at one time the next step passes over them: what stays on a kink but for
    /// rounding crosses it for ever.
    pub(crate) const MOST_BENDS: usize = 8;
    /// A step of the explicit pair may be off by this part of what the tolerances of the other
    /// states make of its own.
    pub(crate) const SHARE: f64 = 0.01;
    /// Below this the explicit pair takes steps of the same length without any doubt.
    pub(crate) const NOT_STIFF: f64 = 0.5;
    /// The tolerance of [`SMALL_BORDER`], and the power of the tolerance that the border grows
    /// with: 1 over the order of the pair.
    pub(crate) const BORDER_RTOL: f64 = 1e-10;
    pub(crate) const BORDER_POWER: f64 = 0.2;
    /// With which power of its length the error of a step falls.
    pub(crate) const EXPLICIT_ORDER: f64 = 5.0;
    pub(crate) const STIFF_ORDER: f64 = 4.0;
    /// Of the length that an error allows so much is taken; at most so much shorter or longer than
    /// the last, and errors below this count as this (Hairer, Norsett, Wanner I, II.4).
    pub(crate) const SAFETY: f64 = 0.9;
    pub(crate) const MOST_SHRINKING: f64 = 0.1;
    pub(crate) const MOST_GROWTH: f64 = 5.0;
    pub(crate) const LEAST_ERROR: f64 = 1e-10;
    /// A step that hides something ends before it, but keeps at least, and loses at least so much
    /// of its length.
    pub(crate) const BEFORE_HIDDEN: [f64; 2] = [0.1, 0.5];
    /// Of the first length (Hairer, Norsett, Wanner I, II.4, (4.14)): sizes below this say nothing,
    /// then it is this part of the time; else the state changes by this part; rates below this are
    /// none; and the second guess is at most so many times the first.
    pub(crate) const NO_SIZE: f64 = 1e-5;
    pub(crate) const LEAST_PART: f64 = 1e-6;
    pub(crate) const CHANGE: f64 = 0.01;
    pub(crate) const NO_RATE: f64 = 1e-15;
    pub(crate) const MOST_LONGER: f64 = 100.0;
    /// Times that differ by less than this part of them are one.
    pub(crate) const SAME_TIME: f64 = 4.0 * f64::EPSILON;
    /// What is left of the time, relative to a step that is wanted, when it is taken at once.
    pub(crate) const NO_REST: f64 = 1e-12;
    /// Steps are too short where so many of them are still one time.
    pub(crate) const STUCK: f64 = 1e3;
}

pub(crate) mod arrival {
    /// `|psi|` below this many times its rounding errors is as good as 0.
    pub(crate) const NEAR: f64 = 100.0;
    /// A step is stable if it is no longer than this in units of `|psi|/|B|`.
    pub(crate) const STABLE: f64 = 3.0;
    /// An arrival sooner than this part of the time is now.
    pub(crate) const SAME_TIME: f64 = 16.0 * f64::EPSILON;
    /// No step goes farther than this part of the way that is left.
    pub(crate) const MOST_OF_WAY: f64 = 0.9;
}

pub(crate) mod events {
    /// More jumps than this at one time never end, nor does what reaches a surface so often without
    /// leaving it, nor what is decided anew so often.
    pub(crate) const MOST_AT_ONCE: usize = 100;
    /// A way between two jumps of so many rounding errors will soon be hidden by them.
    pub(crate) const SMALL_WAY: f64 = 1e3;
    /// A rate of so many rounding errors has a sign.
    pub(crate) const CLEAR: f64 = 1e4;
    /// A selector this near to 1 leaves its surface.
    pub(crate) const AT_EXIT: f64 = 1e-6;
}

pub(crate) mod holding {
    /// A surface has moved away from what rests on it by so many rounding errors: what rests is as
    /// exact as a step, not as rounding.
    pub(crate) const PARTED: f64 = 1e5;
}

pub(crate) mod pile {
    /// The states after so many jumps tell two ratios of their changes.
    pub(crate) const REMEMBERED: usize = 4;
    /// A change of this part of a state is rounding.
    pub(crate) const NOTHING: f64 = 1e-13;
    /// How exact a limit has to be, as a part of the state.
    pub(crate) const SETTLED: f64 = 1e-10;
}

pub(crate) mod staying {
    /// A look ahead, as a part of the whole time.
    pub(crate) const AHEAD: f64 = 1e-5;
}

pub(crate) mod between {
    /// A straight line may be off by this part of how far a state has moved: less than the width of
    /// the line in a picture.
    pub(crate) const STRAIGHT: f64 = 0.002;
    /// It is looked at these parts of its length: a curve may cross it in the middle.
    pub(crate) const SEEN: [f64; 2] = [0.25, 0.75];
    /// With so many numbers a picture has all that can be seen, and steps alone are noted.
    pub(crate) const ENOUGH: usize = 1_000_000;
    /// Halves of halves of one step.
    pub(crate) const MOST_HALVINGS: usize = 8;
}

pub(crate) mod zeno {
    /// What is left may be at most this part of the whole time before the limit is believed.
    pub(crate) const NEAR: f64 = 1e-6;
    /// How much two successive ratios may differ.
    pub(crate) const STEADY: f64 = 0.02;
    /// A ratio of successive intervals this near to 1 is that of jumps which go on for ever.
    pub(crate) const REGULAR: f64 = 1e-6;
    /// The times of so many jumps tell a series whose intervals fall slowly from equal ones;
    pub(crate) const REMEMBERED: usize = 9;
    /// three ratios are enough below this.
    pub(crate) const FAST: f64 = 0.7;
    /// Intervals of fewer roundings of a time are not known.
    pub(crate) const CLEAR: f64 = 1e3;
}
