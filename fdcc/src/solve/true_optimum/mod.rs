//! The optimum of the system that was written, with every switch located: `docs/method/true-optimum.md`.
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
mod repair;
mod start;
mod structure;

pub use certificate::{Certificate, Check, Stretch, Switch};
pub(crate) use repair::{is_attracted, wrong_sign};
pub(crate) use structure::width;

use fdcc_compiler::{Model, compile_chain, with_modes};
use fdcc_runtime::nlp::{Status, Stop};
use fdcc_runtime::problem::{Chain, ControlShape, Grid, Method, Order, Problem, Scheme};
use fdcc_runtime::solution::Trajectory;
use fdcc_runtime::solve::{ChainOutcome, Outcome, solve_chain};
use start::Signals;
use std::ops::ControlFlow;
use structure::Structure;

/// So many structures are solved at most.
const MOST_SOLVES: usize = 14;
/// Intervals of the whole time; a phase has its part of them.
const INTERVALS: f64 = 40.0;
/// A phase has so many at least.
const FEWEST: usize = 6;
/// The tolerance of each solve.
const TOLERANCE: f64 = 1e-10;
/// More iterations are not worth it.
const MOST_ITERATIONS: usize = 300;
/// An objective has to fall by so much of its size, or a phase is not worth having.
const GAIN: f64 = 1e-9;

/// A structure with its optimum.
pub(crate) struct Located {
    /// A model of several phases, none of which has surfaces.
    pub model: Model,
    pub chain: Chain,
    pub outcome: ChainOutcome,
    pub structure: Structure,
    /// Whether every hold that was tried could be solved.
    pub is_tested: bool,
}

/// How a hold that was tried ended.
enum Trial {
    /// There is no place for one.
    Nowhere,
    /// No optimum was found with it.
    Unsolved,
    NotBetter,
    Better(Box<Located>),
}

/// What a search needs to know.
struct Search<'s> {
    model: &'s Model,
    /// The smoothed problem.
    problem: &'s Problem,
    stop: &'s (dyn Fn() -> ControlFlow<Stop> + Sync),
    solves: usize,
    /// Whether the last solve found no trajectory.
    was_infeasible: bool,
}

/// Looks for the optimum of the true system near a smoothed solution; nothing where none is found.
pub(crate) fn locate(
    model: &Model,
    problem: &Problem,
    smoothed: &Outcome,
    stop: &(dyn Fn() -> ControlFlow<Stop> + Sync),
) -> Option<Located> {
    let mut search = Search { model, problem, stop, solves: 0, was_infeasible: false };
    let structure = Structure::of(problem, smoothed);
    let first = search.repaired(structure, &smoothed.trajectory)?;
    Some(search.with_holds(first))
}

impl Search<'_> {
    /// Solves, and mends the structure until nothing contradicts it.
    fn repaired(&mut self, structure: Structure, from: &Trajectory) -> Option<Located> {
        let located = self.first_solved(structure, from)?;
        self.mended(located)
    }

    fn mended(&mut self, mut located: Located) -> Option<Located> {
        let mut is_new = true;
        loop {
            let mended = repair::better(self.model, self.problem, &located);
            // What was released is not taken for an arc again.
            is_new &= mended.is_none();
            let arcs = || located.structure.with_arcs(self.problem, &located.outcome.phases);
            let is_other = |it: &Structure| it.phases != located.structure.phases;
            let next = mended.or_else(|| Some(arcs()).filter(|it| is_new && is_other(it)));
            let Some(structure) = next else { return Some(located) };
            let trajectory = located.whole(self.problem).trajectory;
            match self.solve(structure, &trajectory) {
                Some(better) => located = better,
                None => return Some(located),
            }
        }
    }

    /// Solves; where that fails, without arcs on holds, and then without ever longer phases: what a
    /// smoothed layer looks like need not be there.
    fn first_solved(&mut self, structure: Structure, from: &Trajectory) -> Option<Located> {
        let mut simpler = Some(structure);
        while let Some(structure) = simpler {
            if let Some(located) = self.solve(structure.clone(), from) {
                return Some(located);
            }
            simpler = structure.simpler();
        }
        None
    }

    /// With holds where surfaces are crossed, if that is better: all of them, and each by itself
    /// where they cannot be solved together.
    fn with_holds(&mut self, located: Located) -> Located {
        match self.held(&located, None) {
            Trial::Better(better) => return self.with_holds(*better),
            Trial::Nowhere | Trial::NotBetter => return located,
            Trial::Unsolved => {}
        }
        let mut is_tested = true;
        for place in 0.. {
            match self.held(&located, Some(place)) {
                Trial::Better(better) => return self.with_holds(*better),
                Trial::Nowhere => break,
                Trial::NotBetter => {}
                Trial::Unsolved => is_tested = false,
            }
        }
        Located { is_tested, ..located }
    }

    fn held(&mut self, located: &Located, only: Option<usize>) -> Trial {
        let whole = located.whole(self.problem);
        let Some(structure) = repair::with_holds(self.model, located, &whole, only) else {
            return Trial::Nowhere;
        };
        let is_better = |held: &Located| {
            let [own, its] = [held, located].map(|it| it.outcome.solution.objective);
            own < its - GAIN * its.abs().max(1.0)
        };
        match self.solve(structure, &whole.trajectory) {
            // Nothing holds the surface there.
            None if self.was_infeasible => Trial::NotBetter,
            None => Trial::Unsolved,
            Some(held) if !is_better(&held) => Trial::NotBetter,
            Some(held) => match self.mended(held) {
                Some(mended) if is_better(&mended) => Trial::Better(Box::new(mended)),
                _ => Trial::NotBetter,
            },
        }
    }

    fn solve(&mut self, structure: Structure, from: &Trajectory) -> Option<Located> {
        self.solves += 1;
        self.was_infeasible = false;
        if self.solves > MOST_SOLVES || (self.stop)().is_break() {
            return None;
        }
        let model = with_modes(self.model, &structure.phases).ok()?;
        let model = with_polynomials(model, &structure);
        let chain = compile_chain(&model).ok()?;
        let unknowns = self.problem.unknowns.iter().map(|it| from.parameters[it.parameter]);
        let signals = Signals { trajectory: from, unknowns: unknowns.collect() };
        let start = signals.start(self.model, &chain, &structure);
        let outcome = solve_chain(&chain, Some(start), &mut |_, _| (self.stop)()).ok()?;
        self.was_infeasible = outcome.solution.status == Status::Infeasible;
        let mut located = Located { model, chain, outcome, structure, is_tested: true };
        located.structure.times = located.times();
        (located.outcome.solution.status == Status::Solved).then_some(located)
    }
}

impl Located {
    /// When phases begin; and the last time.
    fn times(&self) -> Vec<f64> {
        let phases = self.outcome.phases.iter().map(|it| &it.trajectory.time);
        let last = phases.clone().next_back().and_then(|it| it.last().copied());
        phases.map(|it| it[0]).chain(last).collect()
    }
}

/// Gauss nodes keep off the ends of phases, where a surface is 0.
fn with_polynomials(mut model: Model, structure: &Structure) -> Model {
    polynomials(&mut model.method, 1.0);
    let [first, last] = structure.ends();
    for (phase, pair) in model.phases.iter_mut().zip(structure.times.windows(2)) {
        polynomials(&mut phase.model.method, (pair[1] - pair[0]) / (last - first));
    }
    model
}

fn polynomials(method: &mut Method, part: f64) {
    let intervals = ((INTERVALS * part).round() as usize).max(FEWEST);
    *method = Method {
        scheme: Scheme::Gauss(4),
        order: Order::Fixed,
        controls: ControlShape::Polynomial,
        path_at_nodes: true,
        steps: 1,
        lagged: Vec::new(),
        grid: Grid::Uniform(intervals),
        tol: TOLERANCE,
        max_iter: MOST_ITERATIONS,
        sigma: None,
        continuation: Vec::new(),
        ..method.clone()
    };
}
