//! The best answer of all that were looked for, before it is a [`Solution`](super::Solution).

use super::report::Ended;
use super::true_optimum::Joint;
use crate::names::status_name;
use fdcc_compiler::Model;
use fdcc_runtime::nlp::Status;
use fdcc_runtime::problem::{Chain, Problem};
use fdcc_runtime::solution::phases;
use fdcc_runtime::solve::{ChainOutcome, Outcome};

/// The best answer, and what else was tried.
#[derive(Clone)]
pub(super) struct Found {
    pub problem: Problem,
    pub outcome: Outcome,
    pub step_errors: Option<f64>,
    pub starts: Vec<Ended>,
    pub jumps: Vec<Jump>,
    pub sequences: Vec<Sequence>,
    pub is_cut: bool,
    pub phases: Option<Phases>,
    /// Which jumps and crossings happen, one between each two of these phases.
    pub events: Vec<usize>,
    /// The answers with the next best sequences of jumps.
    pub next: Vec<Found>,
}

/// A jump of a solution.
///
/// ```
/// let model = fdcc::Model::from_file("../models/bounce.fdc")?.with_method("N", 20)?;
/// let solution = model.solve(&fdcc::Options::default())?;
/// for jump in &solution.jumps {
///     assert_eq!((jump.name.as_str(), jump.before.len(), jump.after.len()), ("bounce", 3, 3));
/// }
/// # Ok::<(), fdcc::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct Jump {
    /// Its name.
    pub name: String,
    /// When it happens.
    pub time: f64,
    /// All states before it.
    pub before: Vec<(String, f64)>,
    /// All states after it.
    pub after: Vec<(String, f64)>,
}

/// A sequence of jumps that was tried: how the solve ended in which exactly these happen.
///
/// ```
/// let model = fdcc::Model::from_file("../models/bounce.fdc")?.with_method("N", 20)?;
/// let solution = model.solve(&fdcc::Options::default())?;
/// let words: Vec<&str> = solution.sequences.iter().map(|it| it.words.as_str()).collect();
/// assert!(words.contains(&"no jump") && words.contains(&"bounce"));
/// assert_eq!(solution.sequences.iter().filter(|it| it.is_answer).count(), 1);
/// # Ok::<(), fdcc::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct Sequence {
    /// The names of the jumps, in their order.
    pub jumps: Vec<String>,
    /// The surfaces that are crossed against the direction of their jumps.
    pub crosses: Vec<String>,
    /// Both in their order: `no jump`, or `bounce, crossing of rim`.
    pub words: String,
    /// Whether the answer has it.
    pub is_answer: bool,
    /// How its solve ended.
    pub ended: Ended,
}

/// What was solved in place of a model with jumps, with conditions at times, or with located
/// switches: its phases, all at once.
///
/// ```
/// let model = fdcc::Model::from_file("../models/bounce.fdc")?.with_method("N", 20)?;
/// let solution = model.solve(&fdcc::Options::default())?;
/// let phases = solution.between_jumps.as_ref().expect("the model has a jump");
/// assert!(phases.chain.phases.len() > solution.jumps.len());
/// # Ok::<(), fdcc::Error>(())
/// ```
#[derive(Clone)]
pub struct Phases {
    /// A model of several phases, or of one piece if nothing jumps.
    pub model: Model,
    /// Its problems, each on the grid of the answer.
    pub chain: Chain,
    /// The solution of these.
    pub outcome: ChainOutcome,
}

impl From<Joint> for Phases {
    fn from(Joint { model, chain, outcome }: Joint) -> Self {
        Phases { model, chain, outcome }
    }
}

impl Found {
    pub fn new(problem: Problem, outcome: Outcome) -> Self {
        Found {
            problem,
            outcome,
            step_errors: None,
            starts: Vec::new(),
            jumps: Vec::new(),
            sequences: Vec::new(),
            is_cut: false,
            phases: None,
            events: Vec::new(),
            next: Vec::new(),
        }
    }
}

/// The best answer to one chain of phases.
#[derive(Clone)]
pub(super) struct FoundChain {
    pub chain: Chain,
    pub outcome: ChainOutcome,
    pub step_errors: Option<f64>,
    pub starts: Vec<Ended>,
    /// Answers of other starts with other objectives, the best one first.
    pub others: Vec<(Chain, ChainOutcome)>,
    /// Of a model with jumps in its phases, which are one trajectory each.
    pub divided: Option<Box<Divided>>,
}

/// How the phases of a model are divided at their jumps, and what else was tried.
#[derive(Clone)]
pub(super) struct Divided {
    /// The model, whose phases know where they may begin.
    pub written: Model,
    /// All that was solved at once.
    pub whole: Phases,
    /// Of each phase.
    pub pieces: Vec<Pieces>,
    pub sequences: Vec<Sequence>,
    pub is_cut: bool,
    /// The answers with the next best sequences of jumps.
    pub next: Vec<FoundChain>,
}

/// A phase of a model as it is divided at its jumps.
#[derive(Clone)]
pub(super) struct Pieces {
    /// Which jumps and crossings happen, one between each two pieces.
    pub events: Vec<usize>,
    /// The same, with the states on both sides.
    pub happened: Vec<phases::Jump>,
    /// What was solved of it.
    pub phases: Phases,
}

impl FoundChain {
    /// The other answers to a problem of one phase.
    pub fn other_singles(&mut self) -> Vec<Found> {
        let others = std::mem::take(&mut self.others).into_iter();
        let single = |(mut chain, outcome): (Chain, ChainOutcome)| {
            Found::new(chain.phases.swap_remove(0), outcome.into_single())
        };
        others.map(single).collect()
    }

    /// Whether it can be used.
    pub fn is_solved(&self) -> bool {
        self.outcome.solution.status.is_solved()
    }

    /// That of a problem of one phase.
    pub fn into_single(mut self) -> Found {
        let FoundChain { step_errors, starts, .. } = self;
        let problem = self.chain.phases.swap_remove(0);
        Found { step_errors, starts, ..Found::new(problem, self.outcome.into_single()) }
    }
}

impl Ended {
    /// How a solve ended.
    pub(super) fn of(chain: &Chain, outcome: &ChainOutcome) -> Self {
        let ChainOutcome { solution, is_impossible, .. } = outcome;
        let without_value = match &solution.status {
            Status::NotFinite(place) if !place.origin.label.is_empty() => {
                Some(place.origin.clone())
            }
            _ => None,
        };
        Ended {
            status: status_name(&solution.status, *is_impossible),
            is_solved: solution.status.is_solved(),
            objective: chain.phases[0].sense * solution.objective,
            iterations: solution.counts.iterations,
            without_value,
        }
    }
}
