//! What a caller is told while a solve runs, and how it can stop it.

use crate::executor::Executor;
use crate::record::Record;
use crate::solve::Solution;
use fdcc_runtime::nlp::{Progress, Stop};
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
#[derive(Clone, Copy)]
pub enum Start<'a> {
    /// At the guess of the model.
    Guess,
    /// At a recorded solution, on any grid; what it lacks is guessed.
    Record(&'a Record<'a>),
    /// At another solution; with its multipliers if the grid is the same.
    Solution(&'a Solution),
}

/// Which of several solves a report is about; nothing of it where there is one.
#[derive(Clone, Copy, Debug, Default)]
pub struct Part<'a> {
    /// The jumps that happen in it.
    pub sequence: Option<&'a str>,
    /// The index of its starting point.
    pub start: Option<usize>,
}

/// What happens.
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
}
