//! One solve of a structure: of the phases of given modes of a model, or of all phases of a model
//! with phases at once, of which one has another structure than before.

use super::slices::{Slice, slices};
use super::start::Signals;
use super::structure::Structure;
use super::tuning::between_nodes::GRADES as GRADES_INSIDE;
use super::tuning::certificate::{NEARLY_STATIONARY, ROUNDING, STATIONARY, WORTH_NOTHING};
use super::tuning::search::{
    BUDGET, FEWEST, FEWEST_ITERATIONS, FINER, GRADES, INTERVALS, MOST_ITERATIONS, MOST_KNOTS,
    MOST_SOLVES, NEAR_END, ROOM_OF_KINKS, TOLERANCE,
};
use super::{Located, Search, Whole};
use fdcc_compiler::{
    Model, PhaseOfModes, compile_chain, is_kink, with_modes, with_modes_in_phases,
};
use fdcc_runtime::nlp::{Solution as NlpSolution, Start, Status};
use fdcc_runtime::problem::{Chain, ControlShape, Grid, Method, Order, Problem, Scheme};
use fdcc_runtime::solve::warm_start::from_earlier;
use fdcc_runtime::solve::{ChainOutcome, solve_chain};
use std::sync::Arc;

/// What was solved.
pub(crate) struct Joint {
    /// A model of several phases, none of which has surfaces.
    pub model: Model,
    pub chain: Chain,
    pub outcome: ChainOutcome,
}

/// A phase as it is written.
#[derive(Clone, Copy)]
pub(crate) struct Part<'s> {
    pub written: &'s Model,
    /// What holds between its jumps.
    pub model: &'s Model,
    /// The smoothed problem, with the unknowns of the whole.
    pub problem: &'s Problem,
}

/// A phase among those of a model.
#[derive(Clone, Copy)]
pub(super) struct Among<'s> {
    pub whole: &'s Model,
    pub parts: &'s [Part<'s>],
    /// Which of them it is.
    pub own: usize,
}

/// A phase with the structure that it is to have, and where its solve begins.
pub(super) struct Planned<'p> {
    part: Part<'p>,
    structure: &'p Structure,
    from: &'p Whole,
}

/// What decides how a solve ends.
#[derive(PartialEq)]
pub(super) struct Attempt {
    phases: Vec<PhaseOfModes>,
    times: Vec<f64>,
    /// Of which phase of a model with phases.
    of: Option<usize>,
    /// The objective where it begins.
    from: f64,
}

impl<'s> Search<'s> {
    /// A stationary answer; nothing where none is found, none was found before, or all work is
    /// spent.
    pub(super) fn solve(&mut self, structure: Structure, from: &Whole) -> Option<Located> {
        let Structure { phases, times } = structure.clone();
        let (of, begin) = (self.among.map(|it| it.own), from.outcome.solution.objective);
        let attempt = Attempt { phases, times, of, from: begin };
        if self.spent.lost.contains(&attempt) {
            return None;
        }
        let found = self.ended(structure, from);
        let found = found.filter(|it| is_stationary(&it.outcome.solution));
        if found.is_none() {
            self.spent.lost.push(attempt);
        }
        found
    }

    /// Where the solve ended.
    pub(super) fn ended(&mut self, structure: Structure, from: &Whole) -> Option<Located> {
        let phases = self.among.map_or(1, |it| it.parts.len());
        self.spent.solves += 1;
        let is_spent =
            self.spent.solves > phases * MOST_SOLVES || self.spent.work > phases * BUDGET;
        if is_spent || (self.stop)().is_break() {
            return None;
        }
        let planned = self.planned(&structure, from);
        let model = with_polynomials(self.divided(&planned)?, &planned);
        let mut chain = compile_chain(&model).ok()?;
        let intervals: usize = chain.phases.iter().map(|it| it.method.intervals()).sum();
        for phase in &mut chain.phases {
            let left = (phases * BUDGET - self.spent.work) / intervals;
            phase.method.max_iter = MOST_ITERATIONS.min(left.max(FEWEST_ITERATIONS));
        }
        let start = start(&planned, &chain);
        let outcome = solve_chain(&chain, Some(start), &mut |_, _| (self.stop)()).ok()?;
        self.spent.work += outcome.solution.counts.iterations * intervals;
        Some(self.located(Joint { model, chain, outcome }, &planned))
    }

    /// All phases, in the order of the model.
    pub(super) fn planned<'p>(&self, structure: &'p Structure, from: &'p Whole) -> Vec<Planned<'p>>
    where
        's: 'p,
    {
        let own = Part { written: self.written, model: self.model, problem: self.problem };
        let mut all = vec![Planned { part: own, structure, from }];
        if let Some(Among { parts, own, .. }) = self.among {
            let others = parts.iter().enumerate().filter(|it| it.0 != own);
            let others = others.zip(&from.beside).map(|((_, part), (structure, from))| Planned {
                part: *part,
                structure,
                from,
            });
            all.extend(others);
            all[..=own].rotate_left(1);
        }
        all
    }

    fn divided(&self, planned: &[Planned]) -> Option<Model> {
        let Some(among) = self.among else {
            return with_modes(self.written, &planned[0].structure.phases).ok();
        };
        let structures: Vec<&[PhaseOfModes]> =
            planned.iter().map(|it| &it.structure.phases[..]).collect();
        with_modes_in_phases(among.whole, &structures).ok()
    }

    /// What was found for the phase, with what was found for the others.
    pub(super) fn located(&self, joint: Joint, planned: &[Planned]) -> Located {
        let written = self.among.map_or(0, |it| it.whole.links.len());
        let counts = planned.iter().map(|it| it.structure.phases.len());
        let slices = slices((&joint.model, written), &joint.chain, counts);
        let joint = Arc::new(joint);
        let own = slices.iter().zip(planned);
        let mut all: Vec<Located> = own.map(|(slice, it)| of_slice(slice, &joint, it)).collect();
        let own = all.remove(self.among.map_or(0, |it| it.own));
        Located { beside: all, ..own }
    }

    /// Where a solve begins that differs in the structure of this phase.
    pub(super) fn whole(&self, located: &Located) -> Whole {
        let mut whole = located.whole(self.problem);
        if let Some(Among { parts, own, .. }) = self.among {
            let others = parts.iter().enumerate().filter(|it| it.0 != own).map(|it| it.1);
            let others = others.zip(&located.beside);
            whole.beside =
                others.map(|(part, it)| (it.structure.clone(), it.whole(part.problem))).collect();
        }
        whole
    }
}

fn of_slice(slice: &Slice, joint: &Arc<Joint>, of: &Planned) -> Located {
    let mut outcome = slice.outcome(&joint.chain, &joint.outcome);
    let models = &joint.model.phases;
    let added = match &models[models.len().min(slice.phases.start)..] {
        [first, ..] if slice.phases.len() > 1 => first.model.boundary.len(),
        [only, ..] => only.model.boundary.len() - of.part.model.boundary.len(),
        [] => joint.model.boundary.len() - of.part.model.boundary.len(),
    };
    // The multipliers of conditions that nobody wrote are told to nobody.
    let starts = outcome.phases[0].trajectory.end_multipliers.drain(..added).collect();
    let mut located = Located {
        joint: Arc::clone(joint),
        chain: slice.chain(&joint.chain),
        outcome,
        structure: of.structure.clone(),
        beside: Vec::new(),
        starts,
        insertion: f64::INFINITY,
        gain: f64::INFINITY,
        loss: f64::INFINITY,
        others: Vec::new(),
    };
    located.structure.times = located.times();
    located
}

impl Planned<'_> {
    fn has_kinks(&self) -> bool {
        self.part.model.controls.iter().any(|it| is_kink(&it.place.name))
    }
}

fn start(planned: &[Planned], chain: &Chain) -> Start {
    let times = planned.iter().flat_map(|it| {
        let times = &it.structure.times;
        times[1..times.len() - 1].iter().copied()
    });
    let switches: Vec<f64> = times.collect();
    let mut problems = chain.phases.iter();
    let mut phases = Vec::new();
    for Planned { part, structure, from } in planned {
        let own = &from.outcome.trajectory.parameters;
        let unknowns = part.problem.unknowns.iter().map(|it| own[it.parameter]).collect();
        let signals = Signals { from, unknowns, switches: &switches };
        phases.extend(signals.phases(part.model, &mut problems, structure));
    }
    let mut start = from_earlier(chain, &phases);
    let is_kinked = match planned {
        [only] => !only.from.is_exact && only.has_kinks(),
        _ => false,
    };
    if let Some(warm) = start.warm.as_mut().filter(|_| is_kinked) {
        warm.mu = warm.mu.map(|mu| mu.max(ROOM_OF_KINKS));
    }
    start
}

/// Where a direction is flat the last digits may take more iterations than there are, or more
/// digits; what they are worth the certificate says. What is called solved meets its conditions for
/// the size of their terms.
pub(super) fn is_stationary(found: &NlpSolution) -> bool {
    let error = found.kkt_error;
    match found.status {
        Status::Solved => error <= STATIONARY,
        Status::Acceptable | Status::IterationLimit | Status::NumericalFailure => {
            // The error is for the size of the multipliers. What these say can still be gained is
            // not, and where they are large without a reason it tells nothing but rounding.
            let is_told = found.improvement <= WORTH_NOTHING || error <= ROUNDING;
            is_told && error.max(found.constraint_violation) <= STATIONARY
        }
        _ => false,
    }
}

/// Whether nothing more can be gained there that would count: where two switches come together the
/// last digits are slow.
pub(super) fn is_nearly_stationary(found: &NlpSolution) -> bool {
    found.kkt_error.max(found.constraint_violation) <= NEARLY_STATIONARY
}

/// Gauss nodes keep off the ends of phases, where a surface is 0.
fn with_polynomials(mut model: Model, planned: &[Planned]) -> Model {
    let Planned { part, structure, .. } = planned[0];
    let knots = part.model.knots();
    polynomials(
        &mut model.method,
        structure.ends(),
        structure.ends(),
        &structure.phases[0],
        &knots,
    );
    let mut phases = model.phases.iter_mut();
    for Planned { part, structure, .. } in planned {
        let knots = part.model.knots();
        let all = structure.phases.iter().zip(structure.times.windows(2)).zip(&mut phases);
        for ((own, pair), phase) in all {
            let method = &mut phase.model.method;
            polynomials(method, structure.ends(), [pair[0], pair[1]], own, &knots);
        }
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

/// Equal intervals, as far as the times inside of a phase allow at which formulas change.
fn between(knots: &[f64], [first, last]: [f64; 2], intervals: usize) -> Grid {
    let part = |knot: &f64| (knot - first) / (last - first);
    let inside = knots.iter().map(part).filter(|it| (NEAR_END..1.0 - NEAR_END).contains(it));
    let ends: Vec<f64> = [0.0].into_iter().chain(inside).chain([1.0]).collect();
    if ends.len() == 2 || ends.len() > MOST_KNOTS {
        return Grid::Uniform(intervals);
    }
    let mut all = vec![0.0];
    for pair in ends.windows(2) {
        let count = ((pair[1] - pair[0]) * intervals as f64).ceil().max(1.0) as usize;
        let step = (pair[1] - pair[0]) / count as f64;
        all.extend((1..count).map(|k| pair[0] + step * k as f64).chain([pair[1]]));
    }
    Grid::Mesh(all)
}

/// Intervals that are nearer to a time inside than they are long are halved, again and again.
fn around(grid: Grid, at: u16) -> Grid {
    let at = f64::from(at) / f64::from(u16::MAX);
    let mut all = match grid {
        Grid::Mesh(all) => all,
        Grid::Uniform(count) => (0..=count).map(|k| k as f64 / count as f64).collect(),
        other => return other,
    };
    for _ in 0..GRADES_INSIDE {
        let is_near = |pair: &&[f64]| {
            let distance = (pair[0] - at).max(at - pair[1]).max(0.0);
            distance < pair[1] - pair[0]
        };
        let middles: Vec<f64> =
            all.windows(2).filter(is_near).map(|pair| 0.5 * (pair[0] + pair[1])).collect();
        all.extend(middles);
        all.sort_by(f64::total_cmp);
    }
    Grid::Mesh(all)
}

/// `ends` are those of the whole time, `own` those of the phase.
fn polynomials(
    method: &mut Method,
    ends: [f64; 2],
    own: [f64; 2],
    phase: &PhaseOfModes,
    knots: &[f64],
) {
    let part = (own[1] - own[0]) / (ends[1] - ends[0]);
    let finer = if method.controls == ControlShape::Linear { FINER } else { 1 };
    let count = INTERVALS * part * f64::from(1 << phase.halvings);
    let intervals = (count.round() as usize).max(FEWEST) * finer;
    let even = || between(knots, own, intervals);
    let grid = if phase.is_graded { graded(intervals) } else { even() };
    *method = Method {
        scheme: Scheme::Gauss(4),
        order: Order::Fixed,
        path_at_nodes: true,
        steps: 1,
        lagged: Vec::new(),
        grid: phase.steep.iter().fold(grid, |grid, at| around(grid, *at)),
        tol: TOLERANCE,
        sigma: None,
        continuation: Vec::new(),
        ..method.clone()
    };
}
