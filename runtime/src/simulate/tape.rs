//! What a simulation did, piece by piece, so that it can be differentiated: steps, and stops
//! between them.
//!
//! Between two stops the modes, the states that stand still and the segment of the controls do not
//! change; that is a [`Regime`]. A stop is an event, a change of the controls, or both ends of the
//! simulation's first instant.

use super::mode::Mode;
use super::result::EventKind;

/// Steps and stops in the order of time.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Tape {
    /// What the pieces refer to.
    pub regimes: Vec<Regime>,
    /// In the order of time; without gaps.
    pub pieces: Vec<Piece>,
}

/// What does not change between two stops.
#[derive(Clone, Debug, PartialEq)]
pub struct Regime {
    /// One for each surface.
    pub modes: Vec<Mode>,
    /// States that stand still.
    pub held: Vec<usize>,
    /// Which segment of the controls is followed; none where controls are the guess.
    pub segment: Option<usize>,
}

/// An instant.
#[derive(Clone, Debug, PartialEq)]
pub struct Instant {
    /// When.
    pub time: f64,
    /// The state, integrals last.
    pub state: Vec<f64>,
    /// All selectors; those of sliding surfaces keep the state there.
    pub selectors: Vec<f64>,
    /// The place of the regime in [`Tape::regimes`].
    pub regime: usize,
}

/// A stop that would have been, had the state come the least bit nearer.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Touch {
    /// Which.
    pub of: Cause,
    /// When.
    pub time: f64,
}

/// One piece of a simulation.
#[derive(Clone, Debug, PartialEq)]
pub enum Piece {
    /// A step of a method; one that meets an event ends there.
    Step {
        /// Before the step.
        start: Instant,
        /// Its length.
        h: f64,
        /// The state after it, projected to the sliding surfaces.
        end: Vec<f64>,
        /// How it was taken.
        rule: Rule,
        /// The states at the stages of an implicit rule, nearly.
        stages: Vec<Vec<f64>>,
        /// What it almost ended at.
        touches: Vec<Touch>,
    },
    /// What happens at one time.
    Event {
        /// Why.
        cause: Cause,
        /// Before it.
        before: Instant,
        /// After it; later than `before` where jumps accumulate and the model says what follows.
        after: Instant,
        /// What happens, in this order.
        changes: Vec<Change>,
    },
}

impl Piece {
    /// When it ends.
    pub fn end_time(&self) -> f64 {
        match self {
            Piece::Step { start, h, .. } => start.time + h,
            Piece::Event { after, .. } => after.time,
        }
    }

    /// What comes after it.
    pub fn end(&self) -> Instant {
        match self {
            Piece::Step { start, h, end, .. } => {
                Instant { time: start.time + h, state: end.clone(), ..start.clone() }
            }
            Piece::Event { after, .. } => after.clone(),
        }
    }
}

/// How a step was taken.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Rule {
    /// The explicit pair of Dormand and Prince.
    #[default]
    Explicit,
    /// Radau IIA of order 5.
    Radau,
    /// Collocation at five Radau points, near the 0 of a ball.
    Collocation,
    /// The last of the way of a ball to 0, shorter than rounding.
    Straight,
}

/// Why there is a stop.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Cause {
    /// The first time.
    Start,
    /// The next segment of the controls.
    Controls,
    /// The state reaches a surface.
    Reaches(usize),
    /// The selector of a sliding surface reaches the end of its interval.
    Leaves(usize),
    /// The surfaces that the state slides on cease to attract.
    Repels,
    /// The state crosses a kink of the right side.
    CrossesKink(usize),
}

/// One change at a stop.
#[derive(Clone, Debug, PartialEq)]
pub struct Change {
    /// At which surface.
    pub surface: usize,
    /// What.
    pub kind: EventKind,
    /// How far from grazing.
    pub margin: f64,
    /// After it.
    pub after: Instant,
}
