//! What a simulation is asked for and what it says: plain data.

use super::tape::Tape;
use super::tuning::options::RTOL;
use crate::nlp::Stop;
use crate::problem::Origin;
use std::fmt;
use std::ops::ControlFlow;
use std::sync::Arc;

/// How to simulate.
#[derive(Clone, Debug)]
pub struct Options {
    /// Relative tolerance of one step.
    pub rtol: f64,
    /// Absolute tolerance of one step; if there is none, a part of the size that each state has
    /// had so far.
    pub atol: Option<f64>,
    /// Which method takes the steps.
    pub integrator: Integrator,
    /// The longest step; infinite if only the tolerances limit it.
    pub max_step: f64,
    /// From each of these times on, ascending, no step is longer than the number beside it.
    pub paces: Vec<[f64; 2]>,
    /// The most steps, rejected ones included.
    pub max_steps: usize,
    /// Times at which states are wanted, ascending; all steps and events if there are none.
    pub times: Vec<f64>,
    /// Whether to report points between steps, too, where no times are wanted: so many that
    /// straight lines between all of them are off by no more than a part of 500 of how far a state
    /// has moved.
    pub points_between: bool,
    /// Whether to note what derivatives need.
    pub tape: bool,
    /// Whether to find the extremes of path conditions.
    pub extremes: bool,
    /// Who may stop it.
    pub watch: Watch,
}

/// Asked before each step whether to go on; by default nobody is.
#[derive(Clone, Default)]
pub struct Watch(Option<Arc<dyn Fn() -> ControlFlow<Stop> + Send + Sync>>);

impl Watch {
    /// A watch that asks this.
    pub fn new(ask: impl Fn() -> ControlFlow<Stop> + Send + Sync + 'static) -> Self {
        Watch(Some(Arc::new(ask)))
    }

    pub(crate) fn ask(&self) -> Result<(), Status> {
        match self.0.as_ref().map(|ask| ask()) {
            Some(ControlFlow::Break(stop)) => Err(Status::Stopped(stop)),
            _ => Ok(()),
        }
    }
}

impl fmt::Debug for Watch {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(if self.0.is_some() { "Watch(..)" } else { "Watch" })
    }
}

/// A method for one step.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Method {
    /// The explicit pair of Dormand and Prince.
    #[default]
    Explicit,
    /// The implicit method Radau IIA of order 5, for stiff systems.
    Stiff,
}

/// Which method takes the steps.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Integrator {
    /// The explicit one until a mode turns out to be stiff.
    #[default]
    Automatic,
    /// Always the explicit one.
    Explicit,
    /// Always the stiff one.
    Stiff,
}

impl Options {
    /// The longest step from a time on.
    pub(crate) fn longest_from(&self, time: f64) -> f64 {
        let behind = self.paces.partition_point(|it| it[0] <= time);
        let own = behind.checked_sub(1).map_or(f64::INFINITY, |at| self.paces[at][1]);
        let mut longest = own.min(self.max_step);
        for [begin, pace] in &self.paces[behind..] {
            if begin - time >= longest {
                break;
            }
            longest = longest.min(begin - time + pace);
        }
        longest
    }

    /// The method of the first step.
    pub(crate) fn method(&self) -> Method {
        match self.integrator {
            Integrator::Automatic | Integrator::Explicit => Method::Explicit,
            Integrator::Stiff => Method::Stiff,
        }
    }
}

impl Default for Options {
    fn default() -> Self {
        Options {
            rtol: RTOL,
            atol: None,
            integrator: Integrator::Automatic,
            max_step: f64::INFINITY,
            paces: Vec::new(),
            max_steps: 1_000_000,
            times: Vec::new(),
            points_between: false,
            tape: false,
            extremes: false,
            watch: Watch::default(),
        }
    }
}

/// What happens at an event.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum EventKind {
    /// From below a surface to above it.
    CrossesUp,
    /// From above a surface to below it.
    CrossesDown,
    /// The state reaches a surface and stays on it.
    EntersSliding,
    /// The state leaves a surface that it slid on, upwards.
    LeavesUp,
    /// The state leaves a surface that it slid on, downwards.
    LeavesDown,
    /// A `Dir` goes through 0 without coming to rest.
    Passes,
    /// A reset; the index is that of the jump.
    Jump(usize),
    /// The state is on a surface at the beginning and stays on it.
    StartsSliding,
}

/// An event.
#[derive(Clone, Debug)]
pub struct Event {
    /// When.
    pub time: f64,
    /// At which surface.
    pub surface: usize,
    /// What.
    pub kind: EventKind,
    /// How far from grazing: the cosine between a field and the normal of its surface, the least of
    /// those that meet.
    pub margin: f64,
    /// The state before it.
    pub before: Vec<f64>,
    /// The state after it.
    pub after: Vec<f64>,
}

/// Two jumps of different surfaces at one time, which lead elsewhere in the other order.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Order {
    /// When.
    pub time: f64,
    /// The one that acts first, as its surface is declared first, and the other.
    pub jumps: [usize; 2],
}

/// One way to go on where there are several: the sides of the surfaces that meet.
#[derive(Clone, Debug, PartialEq)]
pub struct Candidate {
    /// A surface and its side: -1 below, 1 above, 0 sliding.
    pub sides: Vec<(usize, i8)>,
}

/// How a simulation ended.
#[derive(Clone, Debug)]
pub enum Status {
    /// The last time was reached.
    Completed,
    /// There are several continuations, or none that can be told.
    NotUnique {
        /// The surface.
        surface: usize,
        /// The continuations.
        candidates: Vec<Candidate>,
    },
    /// Infinitely many jumps or crossings in finite time.
    Zeno {
        /// The jump; none if a surface is crossed ever faster.
        jump: Option<usize>,
        /// The surface.
        surface: usize,
        /// When they accumulate.
        limit_time: f64,
        /// A state that the jumps change for ever, so that it has no value then.
        unsettled: Option<usize>,
    },
    /// Something has no value, or grows beyond all bounds.
    NotFinite(Origin),
    /// A switching function jumps over 0: its surface has no normal there.
    Discontinuous {
        /// The surface.
        surface: usize,
    },
    /// A surface moves away from the state that a jump lets rest on it.
    NotHeld {
        /// The surface.
        surface: usize,
    },
    /// Too many steps.
    StepLimit,
    /// The caller stopped it.
    Stopped(Stop),
}

/// Work done.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Counts {
    /// Accepted steps.
    pub steps: usize,
    /// Rejected steps.
    pub rejected: usize,
    /// Steps of the stiff method among the accepted ones.
    pub stiff: usize,
    /// Evaluations of the right side.
    pub evaluations: usize,
}

/// A value, and where it is taken.
#[derive(Clone, Debug, PartialEq)]
pub struct Extreme {
    /// The value.
    pub value: f64,
    /// The time.
    pub time: f64,
    /// The state, integrals last.
    pub state: Vec<f64>,
}

/// A simulation, as far as it came.
#[derive(Clone, Debug)]
pub struct Simulation {
    /// How it ended.
    pub status: Status,
    /// Times of `states`; at a jump the same time twice.
    pub time: Vec<f64>,
    /// One column for each state, integrals last.
    pub states: Vec<Vec<f64>>,
    /// In the order of time.
    pub events: Vec<Event>,
    /// Where the order of events at one time matters.
    pub orders: Vec<Order>,
    /// Last time that was reached.
    pub end_time: f64,
    /// State there, integrals last.
    pub end: Vec<f64>,
    /// The objective, if there is one and the last time was reached.
    pub objective: Option<f64>,
    /// Work done.
    pub counts: Counts,
    /// The least, then the greatest value of each path condition, if asked for.
    pub extremes: Vec<[Extreme; 2]>,
    /// What derivatives need, if asked for; without the stop at which a simulation fails.
    pub tape: Option<Tape>,
}
