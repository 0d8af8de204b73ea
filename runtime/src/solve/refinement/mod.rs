//! `N = auto`: solve, estimate the error of each step, refine the grid where it is large, and solve
//! again from there.
//!
//! The error of a step is the difference between its end and that of an accurate integration of the
//! same smoothed system from the same state with the same control ([`error_estimate`]). What is
//! refined is [`plan`]'s to say: intervals are divided, or, where the model leaves the order open,
//! all get more stages, which is taken back where it does not pay.

mod controls;
mod error_estimate;
mod mesh_transfer;
mod plan;

use super::run::is_lost;
use super::{ChainOutcome, Refusal, Watch, solve_chain, solve_near};
use crate::nlp::{Start, Status};
use crate::problem::{Chain, FIRST_GRID, Grid as Points, MOST_STAGES, Order, Problem};
use crate::solve::tuning::refinement::{MOST, MOST_ITERATIONS, MOST_ROUNDS, PATIENCE};
use crate::transcribe::chain::ChainNlp;
use error_estimate::step_errors;
use mesh_transfer::transferred;
use plan::Errors;

/// The finest grid of a phase on which a first solution is looked for.
const FINEST_FIRST: usize = 8 * FIRST_GRID;

/// A solution and the grids that it was found on.
pub struct Refined {
    /// The chain on its last grids.
    pub chain: Chain,
    /// Its solution.
    pub outcome: ChainOutcome,
    /// The sum of the errors of all steps of the phases whose grids were to be found, if there are
    /// any.
    pub error: Option<f64>,
}

/// Solves a chain, on grids of our own choice where its phases ask for that.
pub fn solve(chain: &Chain, start: Option<Start>, watch: &mut Watch) -> Result<Refined, Refusal> {
    if !chain.phases.iter().any(is_open) {
        let outcome = solve_chain(chain, start, watch)?;
        return Ok(Refined { chain: chain.clone(), outcome, error: None });
    }
    // First grid and its solution.
    let is_open: Vec<bool> = chain.phases.iter().map(is_open).collect();
    let (chain, outcome) = first(chain, start, watch)?;
    if !is_good(&outcome) {
        return Ok(Refined { chain, outcome, error: None });
    }
    // Errors of the steps; shorter intervals or more stages; the solution there from this one.
    let mut grid = Grid::new(chain, outcome, &is_open);
    for _ in 0..MOST_ROUNDS {
        let Some(next) = grid.refined(watch)? else { break };
        grid = next;
    }
    let error = Some(grid.open().map(|(_, errors)| errors.sum()).sum());
    Ok(Refined { chain: grid.chain, outcome: grid.outcome, error })
}

/// Whether the grid of a phase is to be found.
fn is_open(phase: &Problem) -> bool {
    phase.method.grid == Points::Auto
}

fn intervals(phase: &Problem) -> usize {
    phase.method.intervals()
}

/// The first grids that can be solved, with the solution. Few intervals may be too few for a
/// solution; then there are as many as where the order is given, and where nothing is found on
/// these, either, they are halved again and again: a coarse grid says nothing of the problem.
fn first(
    chain: &Chain,
    start: Option<Start>,
    watch: &mut Watch,
) -> Result<(Chain, ChainOutcome), Refusal> {
    let least = |chain: &Chain| {
        chain.phases.iter().filter(|it| is_open(it)).map(intervals).min().unwrap_or(FINEST_FIRST)
    };
    let is_few = least(chain) < FIRST_GRID;
    let trial = if is_few { on_trial(chain) } else { chain.clone() };
    let mut found = (chain.clone(), solve_chain(&trial, start.clone(), watch)?);
    if is_few && !is_good(&found.1) && !is_stopped(&found.1) {
        let factor = FIRST_GRID.div_ceil(least(chain));
        found = finer(chain, &start, found, factor, watch)?;
    }
    let mut factor = FIRST_GRID.div_ceil(least(chain)).max(1);
    while is_lost(&found.1.solution.status) && factor * least(chain) < FINEST_FIRST {
        factor *= 2;
        found = finer(chain, &start, found, factor, watch)?;
    }
    Ok(found)
}

/// The same from the same start with so many times the intervals in all phases whose grids are to
/// be found; `before` is what was tried.
fn finer(
    chain: &Chain,
    start: &Option<Start>,
    (_, before): (Chain, ChainOutcome),
    factor: usize,
    watch: &mut Watch,
) -> Result<(Chain, ChainOutcome), Refusal> {
    let times = |phase: &Problem| if is_open(phase) { factor } else { 1 };
    let parts: Parts = chain.phases.iter().map(|it| vec![times(it); intervals(it)]).collect();
    let finer = divided(chain, &parts);
    let (from, to) = (ChainNlp::new(chain), ChainNlp::new(&finer));
    let start = start.as_ref().map(|start| carried(&from, start, &to, &parts));
    let mut outcome = solve_chain(&finer, start, watch)?;
    outcome.solution.counts.add(&before.solution.counts);
    outcome.attempts = [before.attempts, outcome.attempts].concat();
    Ok((finer, outcome))
}

/// The same, to be given up soon: what takes long here is better done in another way.
fn on_trial(chain: &Chain) -> Chain {
    let mut chain = chain.clone();
    for phase in &mut chain.phases {
        phase.method.max_iter = phase.method.max_iter.min(MOST_ITERATIONS);
    }
    chain
}

fn is_good(outcome: &ChainOutcome) -> bool {
    outcome.solution.status.is_solved()
}

fn is_stopped(outcome: &ChainOutcome) -> bool {
    matches!(outcome.solution.status, Status::TimeLimit | Status::Interrupted)
}

/// Into how many parts each interval of each phase is divided.
type Parts = Vec<Vec<usize>>;

/// Grids that are solved.
struct Grid {
    chain: Chain,
    outcome: ChainOutcome,
    /// Of each phase whose grid is to be found.
    errors: Vec<Option<Errors>>,
}

impl Grid {
    /// Nothing is known yet of what more stages would gain.
    fn new(chain: Chain, outcome: ChainOutcome, is_open: &[bool]) -> Self {
        let of = |(phase, outcome): (&Problem, _)| {
            let steps = step_errors(phase, outcome);
            let gains = vec![0.0; steps.len()];
            Errors { scheme: phase.method.scheme, steps, gains }
        };
        let phases = chain.phases.iter().zip(&outcome.phases).zip(is_open);
        let errors = phases.map(|(phase, is_open)| is_open.then(|| of(phase))).collect();
        Grid { chain, outcome, errors }
    }

    /// The phases whose grids are to be found.
    fn open(&self) -> impl Iterator<Item = (&Problem, &Errors)> {
        let phases = self.chain.phases.iter().zip(&self.errors);
        phases.filter_map(|(phase, errors)| Some((phase, errors.as_ref()?)))
    }

    /// Those whose number of stages is open, too.
    fn raisable(&self) -> impl Iterator<Item = (&Problem, &Errors)> {
        self.open().filter(|(phase, _)| phase.method.order == Order::Auto)
    }

    /// The next grid; nothing if this one is good enough, or there is no better one.
    fn refined(&mut self, watch: &mut Watch) -> Result<Option<Grid>, Refusal> {
        let is_raised = self.raisable().next().is_some();
        let next = if is_raised { self.with_short_intervals(watch)? } else { None };
        if next.is_some() || self.is_enough() {
            return Ok(next);
        }
        let next = if is_raised { self.raised(watch)? } else { None };
        if next.is_some() {
            return Ok(next);
        }
        let of = |(phase, errors): (&Problem, &Option<Errors>)| match errors {
            Some(errors) => errors.parts(phase.method.tolerance),
            None => vec![1; intervals(phase)],
        };
        let parts: Parts = self.chain.phases.iter().zip(&self.errors).map(of).collect();
        self.divided(&parts, watch)
    }

    /// Shorter intervals where controls ask for them.
    fn with_short_intervals(&mut self, watch: &mut Watch) -> Result<Option<Grid>, Refusal> {
        let phases = self.chain.phases.iter().zip(&self.outcome.phases).zip(&self.errors);
        let of = |((phase, outcome), errors): ((&Problem, _), &Option<Errors>)| {
            let is_raised = errors.is_some() && phase.method.order == Order::Auto;
            if is_raised { controls::parts(phase, outcome) } else { vec![1; intervals(phase)] }
        };
        let parts: Parts = phases.map(of).collect();
        let is_whole = parts.iter().flatten().all(|parts| *parts == 1);
        if is_whole { Ok(None) } else { self.divided(&parts, watch) }
    }

    fn is_enough(&self) -> bool {
        self.open().all(|(phase, errors)| errors.sum() <= phase.method.tolerance)
    }

    /// When they are divided.
    fn nodes(&self) -> usize {
        self.open().map(|(phase, errors)| errors.nodes(phase.method.tolerance)).sum()
    }

    /// The best of the same intervals with more stages; nothing if fewer nodes are foreseen without
    /// them.
    fn raised(&mut self, watch: &mut Watch) -> Result<Option<Grid>, Refusal> {
        let now = self.raisable().map(|(phase, _)| phase.method.scheme.stages()).max();
        let best = self.raisable().map(|(it, errors)| errors.best_stages(it.method.tolerance));
        let (now, first) = (now.unwrap_or(MOST_STAGES), best.max().unwrap_or(MOST_STAGES));
        let mut tried: Vec<Grid> = Vec::new();
        for stages in (first..=MOST_STAGES).filter(|_| first > now) {
            let Some(next) = tried.last_mut().unwrap_or(self).with_stages(stages, watch)? else {
                break;
            };
            let (nodes, is_enough) = (next.nodes() as f64, next.is_enough());
            tried.push(next);
            // What a raise has shown is news for the grids before it, too.
            let least = tried.iter().map(Grid::nodes).fold(self.nodes(), usize::min) as f64;
            if is_enough || nodes > PATIENCE * least {
                break;
            }
        }
        let counts = tried.last().unwrap_or(self).outcome.solution.counts;
        self.outcome.solution.counts = counts;
        let best = tried.into_iter().min_by_key(|grid| (grid.nodes(), !grid.is_enough()));
        let mut best = best.filter(|best| best.nodes() <= self.nodes());
        best.iter_mut().for_each(|best| best.outcome.solution.counts = counts);
        Ok(best)
    }

    /// The same intervals with so many stages, and what they gain; nothing if they cannot be
    /// solved.
    fn with_stages(&mut self, stages: usize, watch: &mut Watch) -> Result<Option<Grid>, Refusal> {
        let mut chain = self.chain.clone();
        for (phase, errors) in chain.phases.iter_mut().zip(&self.errors) {
            if errors.is_some() && phase.method.order == Order::Auto {
                phase.method.scheme = phase.method.scheme.with_stages(stages);
            }
        }
        let whole: Parts = chain.phases.iter().map(|phase| vec![1; intervals(phase)]).collect();
        let outcome = self.again(&on_trial(&chain), &whole, watch)?;
        self.outcome.solution.counts = outcome.solution.counts;
        // What is solved is not given away for what is nearly solved.
        if !is_good(&outcome)
            || outcome.solution.status != Status::Solved
                && self.outcome.solution.status == Status::Solved
        {
            self.errors.iter_mut().flatten().for_each(|errors| errors.gains.fill(1.0));
            return Ok(None);
        }
        let mut next = Grid::new(chain, outcome, &self.is_open());
        for (before, after) in self.errors.iter_mut().zip(&mut next.errors) {
            let (Some(before), Some(after)) = (before, after) else { continue };
            if after.scheme.stages() > before.scheme.stages() {
                after.gains = before.gains_to(after);
            }
            before.gains.clone_from(&after.gains);
        }
        Ok(Some(next))
    }

    fn is_open(&self) -> Vec<bool> {
        self.errors.iter().map(Option::is_some).collect()
    }

    /// More intervals; nothing if they are too many, or cannot be solved: that is no reason to lose
    /// the answer on these.
    fn divided(&mut self, parts: &Parts, watch: &mut Watch) -> Result<Option<Grid>, Refusal> {
        if parts.iter().flatten().sum::<usize>() > MOST {
            return Ok(None);
        }
        let chain = divided(&self.chain, parts);
        let outcome = self.again(&chain, parts, watch)?;
        if !is_good(&outcome) {
            return Ok(None);
        }
        let mut next = Grid::new(chain, outcome, &self.is_open());
        let pairs = self.errors.iter().flatten().zip(next.errors.iter_mut().flatten());
        let open = parts.iter().zip(&self.errors).filter(|(_, errors)| errors.is_some());
        for ((before, after), (parts, _)) in pairs.zip(open) {
            after.gains = before.gains_of_parts(parts);
        }
        Ok(Some(next))
    }

    /// The solution on other grids, from that on these and with its widths.
    fn again(
        &self,
        chain: &Chain,
        parts: &Parts,
        watch: &mut Watch,
    ) -> Result<ChainOutcome, Refusal> {
        let (from, to) = (ChainNlp::new(&self.chain), ChainNlp::new(chain));
        let start = carried(&from, &Start::near(&self.outcome.solution), &to, parts);
        solve_near(chain, start, &self.outcome, watch)
    }
}

/// A start on other grids, phase by phase.
fn carried(from: &ChainNlp, start: &Start, to: &ChainNlp, parts: &Parts) -> Start {
    let phases = from.each().zip(to.each()).zip(from.shape().split(start)).zip(parts);
    let own = phases.map(|(((from, to), start), parts)| transferred(from, &start, to, parts));
    to.shape().joined(&own.collect::<Vec<_>>(), start)
}

fn divided(chain: &Chain, parts: &Parts) -> Chain {
    let mut finer = chain.clone();
    for (phase, parts) in finer.phases.iter_mut().zip(parts) {
        if is_open(phase) || parts.iter().any(|parts| *parts > 1) {
            phase.method.grid = divided_grid(phase, parts);
        }
    }
    finer
}

fn divided_grid(phase: &Problem, parts: &[usize]) -> Points {
    let times = phase.method.grid.times();
    let uniform = |k: usize| k as f64 / parts.len() as f64;
    let point = |k: usize| times.get(k).copied().unwrap_or_else(|| uniform(k));
    let mut mesh = Vec::new();
    for (k, parts) in parts.iter().enumerate() {
        let length = (point(k + 1) - point(k)) / *parts as f64;
        mesh.extend((0..*parts).map(|part| point(k) + part as f64 * length));
    }
    mesh.push(1.0);
    Points::Mesh(mesh)
}
