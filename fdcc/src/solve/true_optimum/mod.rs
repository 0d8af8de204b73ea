//! The optimum of the system that was written, with every switch located:
//! `docs/method/true-optimum.md`.
//!
//! ```text
//! structure   modes and arcs, read from the smoothed solution
//! solve       the chain of phases that they make: smooth inside, switching times unknown
//! repair      phases that shrank to nothing, arcs with a multiplier of the wrong sign
//! insert      a hold where a surface is crossed, or where the motion begins or ends on it
//! certify     everything that an optimum of the true system meets
//! ```

mod answer;
mod certificate;
mod contacts;
mod insertion;
mod minimum;
mod polynomials;
mod range;
mod repair;
mod replayed;
mod signs;
mod start;
mod structure;
mod tracks;
mod tuning;

pub(crate) use answer::Whole;
pub use certificate::{Certificate, Check, Stretch, Switch};
pub(crate) use contacts::Contacts;
pub(crate) use polynomials::beyond_bounds;
pub(crate) use range::ranges;
pub(crate) use repair::{is_attracted, wrong_sign};
pub(crate) use replayed::replayed;
pub(crate) use structure::variation;
pub(crate) use tuning::certificate as certificate_limits;

use fdcc_compiler::{Model, PhaseOfModes, compile_chain, limits, with_modes};
use fdcc_runtime::nlp::{Solution as NlpSolution, Status, Stop};
use fdcc_runtime::problem::{Chain, ControlShape, Grid, Method, Order, Problem, Scheme};
use fdcc_runtime::solve::{ChainOutcome, solve_chain};
use insertion::Candidate;
use start::Signals;
use std::ops::ControlFlow;
use structure::{NewArcs, Structure};
use tuning::certificate::{STATIONARY, WORTH};
use tuning::search::{
    BUDGET, FEWEST, FEWEST_ITERATIONS, FINER, GAIN, GAIN_OF_TRIAL, GRADES, INTERVALS,
    MOST_ITERATIONS, MOST_SOLVES, TOLERANCE, WORSE,
};

/// A structure with its optimum.
#[derive(Clone)]
pub(crate) struct Located {
    /// A model of several phases, none of which has surfaces.
    pub model: Model,
    pub chain: Chain,
    pub outcome: ChainOutcome,
    pub structure: Structure,
    /// By how much the objective falls with the duration of a hold that was not inserted, at most,
    /// for the size of the Hamiltonian.
    pub insertion: f64,
    /// By how much another control makes the Hamiltonian less, at most, for its size.
    pub gain: f64,
}

/// How a hold that was tried ended.
enum Trial {
    /// No optimum was found with it.
    Unsolved,
    NotBetter,
    Better(Box<Located>),
}

/// What a search needs to know.
struct Search<'s> {
    /// As it is written.
    written: &'s Model,
    /// What holds between its jumps.
    model: &'s Model,
    /// The smoothed problem.
    problem: &'s Problem,
    stop: &'s (dyn Fn() -> ControlFlow<Stop> + Sync),
    spent: &'s mut Spent,
}

/// What was done so far to locate an optimum.
#[derive(Default)]
pub(crate) struct Spent {
    solves: usize,
    /// Iterations of all solves, each times its intervals.
    work: usize,
}

/// Looks for the optimum of the true system near a smoothed solution; nothing where none is found.
/// `problem` and `model` are what holds between the jumps of what is `written`.
pub(crate) fn locate(
    [written, model]: [&Model; 2],
    problem: &Problem,
    smoothed: &Whole,
    stop: &(dyn Fn() -> ControlFlow<Stop> + Sync),
    spent: &mut Spent,
) -> Option<Located> {
    let mut search = Search { written, model, problem, stop, spent };
    let structure = Structure::of(problem, smoothed, limits(model).len());
    let first = search.repaired(structure, smoothed)?;
    let held = search.with_holds(first);
    let mut located = search.refined(held);
    located.gain = search.gain(&located);
    Some(located)
}

/// The same structure on intervals of half the length; nothing where these are short already.
/// The arguments are those of [`locate`].
pub(crate) fn on_half_intervals(
    [written, model]: [&Model; 2],
    problem: &Problem,
    located: &Located,
    stop: &(dyn Fn() -> ControlFlow<Stop> + Sync),
    spent: &mut Spent,
) -> Option<Located> {
    let mut search = Search { written, model, problem, stop, spent };
    let finer = search.solve(located.structure.halved()?, &located.whole(problem))?;
    let mut finer = Located { insertion: located.insertion, ..finer };
    finer.gain = search.gain(&finer);
    Some(finer)
}

impl Search<'_> {
    /// Solves, and mends the structure until nothing contradicts it.
    fn repaired(&mut self, structure: Structure, from: &Whole) -> Option<Located> {
        let located = self.first_solved(structure, from)?;
        self.mended(located)
    }

    /// Mends the structure until nothing new can be tried; what cannot be solved is passed over.
    fn mended(&mut self, mut located: Located) -> Option<Located> {
        let mut tried: Vec<Vec<PhaseOfModes>> = Vec::new();
        tried.push(located.structure.phases.clone());
        while let Some(structure) = self.other(&located, &tried) {
            tried.push(structure.phases.clone());
            let whole = located.whole(self.problem);
            let may_rise = structure.conditions() > located.structure.conditions()
                || structure.fineness() > located.structure.fineness();
            let better = self.solve(structure, &whole);
            located = better.filter(|it| may_rise || !it.is_worse(&located)).unwrap_or(located);
        }
        Some(located)
    }

    /// What a located answer asks for, and was not tried: a repair, then new arcs and touch points,
    /// then the latter alone, then that a surface is not touched.
    fn other(&self, located: &Located, tried: &[Vec<PhaseOfModes>]) -> Option<Structure> {
        let contacts = Contacts::new(self.model, located);
        let (own, phases) = (&located.structure, &located.outcome.phases);
        let repaired = repair::better(self.model, self.problem, located).into_iter();
        let arcs = |which| own.with_arcs(Some((self.problem, which)), &contacts, phases);
        let all = repaired
            .chain([arcs(NewArcs::All), arcs(NewArcs::Longest)])
            .chain([own.with_arcs(None, &contacts, phases)])
            .chain(repair::without_touches(own));
        all.into_iter().find(|it| !tried.contains(&it.phases))
    }

    /// Solves; where that fails, without arcs on holds, and then without ever longer phases: what a
    /// smoothed layer looks like need not be there.
    fn first_solved(&mut self, structure: Structure, from: &Whole) -> Option<Located> {
        let mut simpler = Some(structure);
        while let Some(structure) = simpler {
            if let Some(located) = self.solve(structure.clone(), from) {
                return Some(located);
            }
            simpler = structure.simpler();
        }
        None
    }

    /// With holds where they are worth having.
    fn with_holds(&mut self, mut located: Located) -> Located {
        located.insertion = 0.0;
        let candidates = self.candidates(&located).into_iter();
        for candidate in candidates.filter(|it| it.slope < -WORTH || it.is_forced) {
            match self.held(&located, &candidate) {
                Trial::Better(better) => return self.with_holds(*better),
                Trial::Unsolved if candidate.is_doubtful => {}
                _ if candidate.is_forced => located.insertion = f64::INFINITY,
                Trial::NotBetter if candidate.slope == f64::NEG_INFINITY => {}
                _ => located.insertion = located.insertion.max(-candidate.slope),
            }
        }
        located
    }

    /// With shorter intervals where the Hamiltonian is not what it should be.
    fn refined(&mut self, mut located: Located) -> Located {
        loop {
            let structure = located.structure.finer(self.problem, &located.outcome.phases);
            if structure.phases == located.structure.phases {
                return located;
            }
            let whole = located.whole(self.problem);
            match self.solve(structure, &whole) {
                Some(finer) => {
                    let insertion = located.insertion;
                    let finer = self.mended(finer).expect("it is solved");
                    located = Located { insertion, ..finer };
                }
                None => return located,
            }
        }
    }

    fn held(&mut self, located: &Located, candidate: &Candidate) -> Trial {
        let structure = located.structure.with_phase(candidate.before, candidate.held.clone());
        let is_better = |held: &Located| {
            if candidate.is_forced {
                return true;
            }
            let [own, its] = [held, located].map(|it| it.outcome.solution.objective);
            let is_known = candidate.slope > f64::NEG_INFINITY;
            let least = if is_known { GAIN } else { GAIN_OF_TRIAL };
            own < its - least * its.abs().max(located.objective_size())
        };
        let whole = located.whole(self.problem);
        let Some(first) = self.solve(structure, &whole) else { return Trial::Unsolved };
        // What is left out of it may have been worth little, but not nothing.
        let mended = self.mended(first.clone()).into_iter();
        let held = mended.chain([first]).find(is_better);
        held.map_or(Trial::NotBetter, |it| Trial::Better(Box::new(it)))
    }

    fn solve(&mut self, structure: Structure, from: &Whole) -> Option<Located> {
        self.spent.solves += 1;
        let is_spent = self.spent.solves > MOST_SOLVES || self.spent.work > BUDGET;
        if is_spent || (self.stop)().is_break() {
            return None;
        }
        let model = with_modes(self.written, &structure.phases).ok()?;
        let model = with_polynomials(model, &structure);
        let mut chain = compile_chain(&model).ok()?;
        let intervals: usize = chain.phases.iter().map(|it| it.method.intervals()).sum();
        for phase in &mut chain.phases {
            let left = (BUDGET - self.spent.work) / intervals;
            phase.method.max_iter = MOST_ITERATIONS.min(left.max(FEWEST_ITERATIONS));
        }
        let unknowns =
            self.problem.unknowns.iter().map(|it| from.outcome.trajectory.parameters[it.parameter]);
        let signals = Signals { from, unknowns: unknowns.collect() };
        let start = signals.start(self.model, &chain, &structure);
        let outcome = solve_chain(&chain, Some(start), &mut |_, _| (self.stop)()).ok()?;
        self.spent.work += outcome.solution.counts.iterations * intervals;
        let mut located = Located { model, chain, outcome, structure, insertion: 0.0, gain: 0.0 };
        located.structure.times = located.times();
        let own = &located.outcome.solution;
        is_stationary(own).then_some(located)
    }
}

impl Located {
    /// Whether another optimum was found, and a worse one.
    fn is_worse(&self, other: &Located) -> bool {
        let [own, its] = [self, other].map(|it| it.outcome.solution.objective);
        own > its + WORSE * its.abs().max(other.objective_size())
    }

    /// What the terms of the Hamiltonian add up to over time.
    pub fn objective_size(&self) -> f64 {
        let sizes = self.outcome.phases.iter().map(|it| it.trajectory.hamiltonian.scale);
        let [first, last] = self.structure.ends();
        sizes.fold(0.0, f64::max) * (last - first)
    }

    /// When phases begin; and the last time.
    fn times(&self) -> Vec<f64> {
        let phases = self.outcome.phases.iter().map(|it| &it.trajectory.time);
        let last = phases.clone().next_back().and_then(|it| it.last().copied());
        phases.map(|it| it[0]).chain(last).collect()
    }
}

/// Where a direction is flat the last digits may take more iterations than there are, or more
/// digits; what they are worth the certificate says.
fn is_stationary(found: &NlpSolution) -> bool {
    let has_ended = matches!(
        found.status,
        Status::Solved | Status::Acceptable | Status::IterationLimit | Status::NumericalFailure
    );
    has_ended && found.kkt_error.max(found.constraint_violation) <= STATIONARY
}

/// Gauss nodes keep off the ends of phases, where a surface is 0.
fn with_polynomials(mut model: Model, structure: &Structure) -> Model {
    polynomials(&mut model.method, 1.0, &structure.phases[0]);
    let [first, last] = structure.ends();
    let phases = model.phases.iter_mut().zip(&structure.phases);
    for ((phase, own), pair) in phases.zip(structure.times.windows(2)) {
        polynomials(&mut phase.model.method, (pair[1] - pair[0]) / (last - first), own);
    }
    model
}

/// Of equal intervals the first and the last are halved towards the ends again and again.
fn graded(intervals: usize) -> Grid {
    let step = 1.0 / intervals as f64;
    let begin = (0..GRADES).rev().map(|k| step * 0.5f64.powi(k + 1));
    let begin: Vec<f64> = begin.collect();
    let even = (1..intervals).map(|k| step * k as f64);
    let end = begin.iter().rev().map(|it| 1.0 - it);
    let inside = begin.iter().copied().chain(even).chain(end);
    Grid::Mesh([0.0].into_iter().chain(inside).chain([1.0]).collect())
}

/// `part` is that of the whole time.
fn polynomials(method: &mut Method, part: f64, phase: &PhaseOfModes) {
    let finer = if method.controls == ControlShape::Linear { FINER } else { 1 };
    let own = INTERVALS * part * f64::from(1 << phase.halvings);
    let intervals = (own.round() as usize).max(FEWEST) * finer;
    *method = Method {
        scheme: Scheme::Gauss(4),
        order: Order::Fixed,
        path_at_nodes: true,
        steps: 1,
        lagged: Vec::new(),
        grid: if phase.is_graded { graded(intervals) } else { Grid::Uniform(intervals) },
        tol: TOLERANCE,
        sigma: None,
        continuation: Vec::new(),
        ..method.clone()
    };
}
