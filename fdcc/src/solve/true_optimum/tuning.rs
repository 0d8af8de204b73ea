//! Every tuned number of the search for the true optimum, by the file that uses it, and every limit
//! of its certificate.

pub(super) mod search {
    /// So many structures are solved at most.
    pub(crate) const MOST_SOLVES: usize = 36;
    /// No solve is begun after so many iterations of all, each times its intervals.
    pub(crate) const BUDGET: usize = 200_000;
    /// Intervals of the whole time; a phase has its part of them.
    pub(crate) const INTERVALS: f64 = 40.0;
    /// A phase has so many at least.
    pub(crate) const FEWEST: usize = 6;
    /// A graded phase has its first and its last interval halved so often.
    pub(crate) const GRADES: i32 = 10;
    /// So many times as many where controls are linear on them.
    pub(crate) const FINER: usize = 4;
    /// A time at which formulas change that is nearer than this to the end of a phase, for its
    /// duration, is there; with more of them than so many intervals go over them.
    pub(crate) const NEAR_END: f64 = 1e-6;
    pub(crate) const MOST_KNOTS: usize = 500;
    /// The tolerance of each solve.
    pub(crate) const TOLERANCE: f64 = 1e-10;
    /// The barrier parameter of a solve that begins at a smoothed answer of one piece with kinks:
    /// where its arcs end is not known yet, and costs that are straight lines do not say it near a
    /// corner. Phases that share their times say it, and would be moved away from it.
    pub(crate) const ROOM_OF_KINKS: f64 = 1e-3;
    /// A solve that is begun has so many at least.
    pub(crate) const FEWEST_ITERATIONS: usize = 20;
    /// More iterations are not worth it.
    pub(crate) const MOST_ITERATIONS: usize = 250;
    /// So many structures that were passed by are looked at where the last one is not certified.
    pub(crate) const MOST_ALTERNATIVES: usize = 4;
    /// The phases of a model are mended one after the other so often.
    pub(crate) const MOST_ROUNDS: usize = 4;
    /// A structure without new conditions is another optimum where the objective rises by so much.
    pub(crate) const WORSE: f64 = 1e-5;
    /// Controls jump inside of a phase where its trajectory is wrong by less than this part of what
    /// it was without.
    pub(crate) const SMOOTHER: f64 = 0.1;
    /// An objective may rise by so much of its size with shorter intervals, which forbid what was
    /// gained between the nodes of longer ones; by more where another optimum was found.
    pub(crate) const WORSE_IF_FINER: f64 = 0.02;
    /// An objective has to fall by so much of its size, or a phase is not worth having.
    pub(crate) const GAIN: f64 = 1e-9;
    /// The same where nothing but a trial says that it is: other intervals gain a little, too.
    pub(crate) const GAIN_OF_TRIAL: f64 = 1e-7;
}

pub(super) mod polish {
    /// The tolerance of the last solve of an answer.
    pub(crate) const TOLERANCE: f64 = 1e-12;
    /// It begins where another has ended.
    pub(crate) const MOST_ITERATIONS: usize = 20;
}

pub(super) mod structure {
    /// The Hamiltonian of a phase has at least this part of the size that it has in another.
    pub(crate) const PART_OF_LARGEST: f64 = 1e-8;
    /// What multipliers are compared with, has at least this part of its size in another phase.
    pub(crate) const PART_AT_REST: f64 = 1e-3;
    /// A shorter phase, for the whole time, is dropped.
    pub(crate) const SHORTEST: f64 = 0.004;
    /// So is one of fewer intervals of the grid.
    pub(crate) const FEWEST_INTERVALS: f64 = 1.6;
    /// A phase that is shorter than this, for the whole time, may be a mistake.
    pub(crate) const SHORT: f64 = 0.15;
    /// What a phase that is tried begins with, for the whole time.
    pub(crate) const TRIED: f64 = 0.01;
    /// But with no more than this part of the phases beside it.
    pub(crate) const TRIED_BESIDE: f64 = 0.2;
    /// Arcs that follow each other may overlap by so much of the shorter one.
    pub(crate) const OVERLAP: f64 = 0.25;
    /// Switches that are nearer than this part of a step are one.
    pub(crate) const SAME_SWITCH: f64 = 0.25;
    /// An arc that was not seen, of a control that is at its bound at an end, begins with this part
    /// of an interval.
    pub(crate) const AT_END: f64 = 0.1;
    /// An arc of a control has so many steps at least.
    pub(crate) const SHORTEST_ARC: f64 = 1.5;
    /// The Hamiltonian may change by so much of its size, on average over the time.
    pub(crate) const INACCURATE: f64 = 1e-6;
    /// The objective may lose so much of its size by the controls of a phase.
    pub(crate) const LOSS: f64 = 1e-7;
    /// A control may leave its bounds by so much of its width between nodes.
    pub(crate) const BEYOND: f64 = 5e-7;
    /// Intervals are halved so often where nothing tells how accurate a trajectory is.
    pub(crate) const HALVINGS: u32 = 2;
    /// Intervals are halved so often at most where something is rough.
    pub(crate) const MOST_HALVINGS: u32 = 3;
    /// All of them are halved so often where nothing is wrong but states and conditions of the
    /// replay.
    pub(crate) const MOST_OF_ALL: u32 = 5;
}

pub(super) mod polynomials {
    /// An interval is looked at in so many parts.
    pub(crate) const PARTS: usize = 32;
    /// A control that is nearer than this to its bound, for their distance, where a phase begins or
    /// ends may have an arc there.
    pub(crate) const AT_BOUND: f64 = 1e-6;
    /// A control jumps where it changes by more than this part of its width within an interval.
    pub(crate) const JUMP: f64 = 0.5;
    /// A control that is farther than this from a straight line, for the distance of its bounds, on
    /// such a part of the intervals is rough.
    pub(crate) const ROUGH: f64 = 0.01;
    pub(crate) const PART_ROUGH: f64 = 0.3;
}

pub(super) mod between_nodes {
    /// Path conditions are looked at in so many points of each interval.
    pub(crate) const PARTS: usize = 8;
    /// This part of what is allowed is, as the sizes of conditions are less than their ranges.
    pub(crate) const PART: f64 = 0.1;
    /// Where more than this part of the intervals is wrong all are halved.
    pub(crate) const FEW: f64 = 0.2;
    /// Intervals get shorter towards so many places of a phase.
    pub(crate) const MOST_PLACES: usize = 12;
    /// So often are intervals halved towards such a place.
    pub(crate) const GRADES: usize = 4;
}

pub(super) mod tracks {
    /// A control is at a bound that is nearer than this, for the distance of its bounds.
    pub(crate) const AT_BOUND: f64 = 1e-3;
    /// A free piece between opposite bounds that is not longer than the shortest arc times this is
    /// a switch.
    pub(crate) const SWITCH: f64 = 1.5;
}

pub(super) mod contacts {
    /// A multiplier is none that is worth less than this, over the range of its limit, of the size
    /// of the Hamiltonian.
    pub(crate) const NONE: f64 = 1e-5;
    /// Nor is one that is less than this part of the largest on its phase: the barrier has left it.
    pub(crate) const NONE_OF_LARGEST: f64 = 1e-5;
    /// A limit is near its bound where it is nearer than this part of its range, at one end of an
    /// interval.
    pub(crate) const NEAR_BOUND: f64 = 0.02;
    /// A path condition on which controls act at once has this part of its bound as its range at
    /// least.
    pub(crate) const OF_BOUND: f64 = 0.1;
    /// It is at its bound where all of its values are nearer than this part of its range.
    pub(crate) const SEEN: f64 = 1e-5;
    /// A limit with two derivatives or more that is active on fewer intervals is touched.
    pub(crate) const FEWEST_OF_ARC: usize = 4;
    /// Where the motion is on a surface for so many intervals, it is held.
    pub(crate) const FEWEST_OF_HOLD: usize = 2;
    /// A surface is touched where the motion turns nearer to it than this part of its range.
    pub(crate) const TOUCHED: f64 = 1e-4;
    /// So many intervals beside an arc or a touch point belong to it.
    pub(crate) const NEAR: usize = 2;
}

pub(super) mod signs {
    /// At the end of an arc a multiplier is the polynomial through its values on so many intervals;
    /// that through one less tells how uncertain it is.
    pub(crate) const POINTS: usize = 4;
    /// A multiplier at one time that is worth less than this part of the objective's size, over the
    /// range of its limit, is rounding.
    pub(crate) const NO_IMPULSE: f64 = 1e-6;
}

pub(super) mod repair {
    /// A shorter phase, for the whole time, has shrunk to nothing.
    pub(crate) const NOTHING: f64 = 1e-5;
}

pub(super) mod on_surfaces {
    /// A surface is 0 that is smaller than this part of what a unit of each state makes of it.
    pub(crate) const NOTHING: f64 = 1e-12;
    /// A multiplier counts over this part of that at least,
    pub(crate) const PRESSED: f64 = 1e-3;
    /// where the motion is nearer to the surface than this part of its range,
    pub(crate) const ON: f64 = 1e-5;
    /// on so many intervals.
    pub(crate) const FEWEST: usize = 3;
}

pub(super) mod across_surfaces {
    /// A surface is reached where it is smaller than this, for its largest value: what the barrier
    /// of a solve leaves of it where no force pulls.
    pub(crate) const NEAR: f64 = 1e-4;
    /// The motion ends on the surface of a jump where it is smaller than this, for its range.
    pub(crate) const ON_IT: f64 = 1e-6;
}

pub(super) mod kink_pushes {
    /// A costate is continuous where it jumps by less than this part of its largest value.
    pub(crate) const CONTINUOUS: f64 = 1e-3;
}

pub(super) mod insertion {
    /// A surface is 0 where it is smaller than this, for its largest value.
    pub(crate) const ON_SURFACE: f64 = 1e-7;
    /// A selector that is farther from its bounds than this lets nothing leave.
    pub(crate) const SETTLED: f64 = 1e-6;
    /// A hold whose selector is larger than this may be left for a moment.
    pub(crate) const RELEASED: f64 = 0.999;
    /// A neighbour is looked at by this part of an interval inside of it.
    pub(crate) const INSIDE: f64 = 1e-7;
    /// A hold is left after these parts of it; in the middle where all are as good.
    pub(crate) const PARTS_OF_HOLD: [f64; 3] = [0.5, 0.1, 0.9];
}

pub(super) mod range {
    /// A control that is 0 throughout has this part of its unit.
    pub(crate) const LEAST_OF_UNIT: f64 = 1e-3;
    /// Other values are tried up to so many times its width.
    pub(crate) const FAR: f64 = 10.0;
    /// So many of them, and one more.
    pub(crate) const SAMPLES: usize = 4;
}

pub(super) mod minimum {
    /// Where the Hamiltonian of a phase is looked at, as parts of its time.
    pub(crate) const PARTS: [f64; 13] =
        [0.0, 0.08, 0.15, 0.24, 0.32, 0.41, 0.5, 0.59, 0.68, 0.76, 0.85, 0.92, 1.0];
    /// The same on its first interval, and mirrored on its last: between nodes, where a control
    /// that is steep at an end differs most from a polynomial.
    pub(crate) const BESIDE: [f64; 2] = [0.035, 0.2];
    /// Between grid points states and costates are polynomials through so many of them.
    pub(crate) const POINTS: usize = 4;
    /// A minimum at a distance of more than this part of the width of a control is not near.
    pub(crate) const FAR: f64 = 0.1;
    /// Of more controls not all combinations of their ends are tried.
    pub(crate) const MOST_TOGETHER: usize = 4;
}

/// The largest figures of a certificate.
pub(crate) mod certificate {
    /// An answer whose optimality error is larger is none.
    pub(crate) const STATIONARY: f64 = 1e-7;
    /// Where the solver came to no end: what the multipliers say can still be gained, for the size
    /// of the objective, or else the optimality error.
    pub(crate) const WORTH_NOTHING: f64 = 1e-6;
    pub(crate) const ROUNDING: f64 = 1e-9;
    /// What a trial has gained is known where its optimality error is not larger.
    pub(crate) const NEARLY_STATIONARY: f64 = 1e-5;
    /// A hold is tried where the objective falls with its duration by more than this, for the size
    /// of the Hamiltonian.
    pub(crate) const WORTH: f64 = 1e-5;
    /// A slope of the Hamiltonian by a control that is at a bound may have the wrong sign by so
    /// much, for the size of the Hamiltonian and the distance of the bounds.
    pub(crate) const WRONG_SIGN: f64 = 1e-5;
    /// Another control may make the Hamiltonian less by so much of its size.
    pub(crate) const GAIN: f64 = 1e-5;
    /// So may the multiplier of a limit that is at its bound, for its largest value.
    pub(crate) const CONTACT: f64 = 1e-4;
    /// The replay may differ by so much, for how far each state moves; so may conditions and bounds
    /// be violated.
    pub(crate) const REPLAYED: f64 = 1e-6;
    /// This part of the sum of the squares of all measurements is a size of an objective of them:
    /// what a thousandth of each makes.
    pub(crate) const MEASURED: f64 = 1e-6;
    /// A control that is nearer than this part of its width to a bound throughout a phase is there.
    pub(crate) const SEEN: f64 = 1e-6;
    /// So may a replay of controls that come a moment earlier or later.
    pub(crate) const TIMING: f64 = 1e-2;
    /// Inside of a phase the Hamiltonian of an autonomous system may change by so much of its size.
    pub(crate) const HAMILTONIAN: f64 = 1e-4;
    /// For so much of the time plan and replay may be in different modes.
    pub(crate) const MODES: f64 = 1e-4;
}

pub(super) mod switches {
    /// An event of the replay is that of a switch where their times differ by at most this, for the
    /// duration.
    pub(crate) const SAME_TIME: f64 = 1e-4;
}

pub(super) mod costates {
    /// Surfaces and conditions say the same where less than this is left of one beside the others,
    /// for its size.
    pub(crate) const SAME: f64 = 1e-10;
    /// A motion begins or ends on a surface that is smaller than this there, for its largest value.
    pub(crate) const ON_SURFACE: f64 = 1e-7;
}
