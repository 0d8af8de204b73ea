//! What a caller is told while a solve runs, and how it can stop it.

use crate::executor::Executor;
use crate::record::Record;
use crate::solve::Solution;
use fdcc_runtime::nlp::{Progress, Stop};
use fdcc_runtime::problem::Origin;
use fdcc_runtime::solve::Level;
use std::ops::ControlFlow;

/// How to solve, besides what the `method` of the model says.
///
/// ```
/// use fdcc::{Model, Options, Status, Stop};
/// use std::ops::ControlFlow;
///
/// let model = Model::from_file("../models/block.fdc")?;
/// let options = Options { stop: &|| ControlFlow::Break(Stop::Interrupted), ..Options::default() };
/// assert_eq!(*model.solve(&options)?.status(), Status::Interrupted);
/// # Ok::<(), fdcc::Error>(())
/// ```
#[derive(Clone, Copy)]
pub struct Options<'a> {
    /// From how many starting points: that of `start`, and random variations of it. At least 1.
    pub starts: usize,
    /// The first of them.
    pub start: Start<'a>,
    /// Is told what happens, from several threads if several solves run.
    pub report: &'a (dyn Fn(&Report) + Sync),
    /// Is asked after every iteration whether to go on.
    pub stop: &'a (dyn Fn() -> ControlFlow<Stop> + Sync),
    /// Does independent solves at the same time.
    pub executor: Executor,
}

impl Default for Options<'_> {
    /// One start, the guess; nobody listens, nothing stops it; all processors.
    fn default() -> Self {
        Options {
            starts: 1,
            start: Start::Guess,
            report: &|_| {},
            stop: &|| ControlFlow::Continue(()),
            executor: Executor::default(),
        }
    }
}

/// Where a solve begins.
///
/// ```
/// # let text = "time t in [0, 1]\nstate x start 0\ncontrol u in [-1, 1]
/// # dynamics { x' = u }\nend x == 0.5\nminimize integral(u^2)";
/// use fdcc::{Model, Options, Start};
///
/// let model = Model::from_text("hop", text)?;
/// let coarse = model.with_method("N", 20)?.solve(&Options::default())?;
/// let record = coarse.record();
/// let fine = model.solve(&Options { start: Start::Record(&record), ..Options::default() })?;
/// assert!(fine.is_solved());
/// # Ok::<(), fdcc::Error>(())
/// ```
#[derive(Clone, Copy)]
pub enum Start<'a> {
    /// At the guess of the model.
    Guess,
    /// At a recorded solution, on any grid; what it lacks is guessed.
    Record(&'a Record<'a>),
    /// At another solution; with its multipliers if the grid is the same.
    Solution(&'a Solution),
    /// At what is left of another solution after the first interval of its grid. Where the grid is
    /// another one, or not uniform, as [`Start::Solution`].
    Later(&'a Solution),
}

/// Which of several solves a report is about; nothing of it where there is one.
///
/// ```
/// # let text = "time t in [0, 1]\nstate x start 0\ncontrol u in [-1, 1]
/// # dynamics { x' = u }\nend x == 0.5\nminimize integral(u^2)";
/// use fdcc::{Model, Options, Report};
/// use std::sync::Mutex;
///
/// let starts = Mutex::new(Vec::new());
/// let report = |report: &Report| {
///     if let Report::Ended(part, _) = report {
///         starts.lock().expect("nobody panics").push(part.start);
///     }
/// };
/// let options = Options { starts: 2, report: &report, ..Options::default() };
/// Model::from_text("hop", text)?.solve(&options)?;
/// assert_eq!(*starts.lock().expect("nobody panics"), [Some(0), Some(1)]);
/// # Ok::<(), fdcc::Error>(())
/// ```
#[derive(Clone, Copy, Debug, Default)]
pub struct Part<'a> {
    /// The jumps that happen in it.
    pub sequence: Option<&'a str>,
    /// The index of its starting point.
    pub start: Option<usize>,
}

/// What happens.
///
/// ```
/// # let text = "time t in [0, 1]\nstate x start 0\ncontrol u in [-1, 1]
/// # dynamics { x' = u }\nend x == 0.5\nminimize integral(u^2)";
/// use fdcc::{Model, Options, Report};
/// use std::sync::atomic::{AtomicUsize, Ordering};
///
/// let count = AtomicUsize::new(0);
/// let report = |report: &Report| {
///     if let Report::Iteration(..) = report {
///         count.fetch_add(1, Ordering::Relaxed);
///     }
/// };
/// let model = Model::from_text("hop", text)?.with_method("solver", "interior_point")?;
/// model.solve(&Options { report: &report, ..Options::default() })?;
/// assert!(count.into_inner() > 1);
/// # Ok::<(), fdcc::Error>(())
/// ```
#[derive(Clone, Copy)]
pub enum Report<'a> {
    /// One iteration of the solver.
    Iteration(Part<'a>, &'a Progress, Level<'a>),
    /// One of several solves for one answer ended.
    Ended(Part<'a>, &'a Ended),
    /// Several starts were stopped from outside.
    Stopped {
        /// How many came to their end.
        ended: usize,
        /// How many stopped on the way.
        stopped: usize,
        /// How many there were to be.
        starts: usize,
    },
}

/// How one of several solves ended.
///
/// ```
/// # let text = "time t in [0, 1]\nstate x start 0\ncontrol u in [-1, 1]
/// # dynamics { x' = u }\nend x == 0.5\nminimize integral(u^2)";
/// use fdcc::{Model, Options};
///
/// let options = Options { starts: 3, ..Options::default() };
/// let solution = Model::from_text("hop", text)?.solve(&options)?;
/// assert_eq!(solution.starts.len(), 3);
/// assert!(solution.starts.iter().all(|ended| ended.status == "solved"));
/// # Ok::<(), fdcc::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct Ended {
    /// As in files; see [`status_name`](crate::names::status_name).
    pub status: &'static str,
    /// Whether there is an objective worth telling.
    pub is_solved: bool,
    /// The objective as the model writes it, in SI.
    pub objective: f64,
    /// All iterations.
    pub iterations: usize,
    /// What of the model had no value, such as what a jump assigns, if that ended the solve.
    pub without_value: Option<Origin>,
}
