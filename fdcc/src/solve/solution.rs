//! What came out of a solve, asked in the words of the model.

use super::families::Family;
use super::found::{Found, Jump, Phases, Sequence};
use super::phases::Whole;
use super::report::{Ended, Options};
use super::true_optimum::{Certificate, Located};
use super::tuning::search::INFEASIBLE;
use super::tuning::solution::{NOT_UNIQUE, NOTHING};
use crate::error::Error;
use crate::model::Model;
use crate::names::status_name;
use crate::record::{JumpRecord, NodesRecord, Record, Settings};
use crate::verification::{Verification, verify};
use fdcc_compiler::{compile_by_parameters, compile_chain_by_parameters, parameters_on_kinks};
use fdcc_grammar::Diagnostic;
use fdcc_runtime::nlp::Status;
use fdcc_runtime::problem::{Chain, Problem, Variable};
use fdcc_runtime::solution::by_parameters;
use fdcc_runtime::solve::{ChainOutcome, Outcome, by_parameters_of_chain, with_other_multipliers};
use std::ops::ControlFlow;
use std::sync::Arc;

/// A solution, or the best iterate where there is none; numbers are in SI.
///
/// ```
/// use fdcc::{Model, Options, Start};
///
/// let model = Model::from_text("hop", "time t in [0, 1]
/// state x start 0
/// control u in [-1, 1]
/// param w = 1
/// dynamics { x' = u }
/// end x == 0.5
/// minimize integral(w * u^2)")?;
/// let solution = model.solve(&Options::default())?;
/// assert!(solution.is_solved());
/// assert!((solution.objective() - 0.25).abs() < 1e-8);
/// let x = solution.state("x").expect("it is declared");
/// assert!(x.len() == solution.time().len() && (x[x.len() - 1] - 0.5).abs() < 1e-8);
///
/// // From here with another parameter, with all multipliers.
/// let options = Options { start: Start::Solution(&solution), ..Options::default() };
/// let next = model.with("w", 2)?.solve(&options)?;
/// assert!((next.objective() - 0.5).abs() < 1e-8);
/// # Ok::<(), fdcc::Error>(())
/// ```
#[derive(Clone)]
pub struct Solution {
    model: Model,
    /// The problem on the grid of the answer. Of a model with jumps, what holds between them.
    pub problem: Problem,
    /// The answer as the solver has it.
    pub outcome: Outcome,
    /// The sum of the errors of all steps, where the grid was refined.
    pub step_errors: Option<f64>,
    /// How the solves from several starting points ended.
    pub starts: Vec<Ended>,
    /// To which optima of the system that was written they lead, if these were looked for.
    pub families: Vec<Family>,
    /// The jumps of the answer.
    pub jumps: Vec<Jump>,
    /// All sequences of jumps that were tried.
    pub sequences: Vec<Sequence>,
    /// Whether the model allows more jumps than were tried.
    pub sequences_left_out: bool,
    /// What the solver saw of a model with jumps, or with conditions at times.
    pub between_jumps: Option<Phases>,
    /// What was checked of the optimum of the true system; nothing where nobody looked for one.
    pub certificate: Option<Certificate>,
    /// What holds at the ends add to [`Self::sensitivities`].
    pub(super) of_holds: Vec<f64>,
    /// Of a phase whether links read the first and the last value of each control.
    pub(super) linked: Vec<[bool; 2]>,
    /// Those of its phases.
    pub(super) parts: Vec<Solution>,
    /// What the solver saw of a model with phases.
    pub(super) whole: Option<Whole>,
    /// The certified optimum with its structure, for the next one.
    pub(super) located: Option<Arc<Located>>,
}

impl Solution {
    pub(super) fn new(model: Model, found: Found) -> Self {
        Solution {
            model,
            problem: found.problem,
            outcome: found.outcome,
            step_errors: found.step_errors,
            starts: found.starts,
            families: Vec::new(),
            jumps: found.jumps,
            sequences: found.sequences,
            sequences_left_out: found.is_cut,
            between_jumps: found.phases,
            certificate: None,
            of_holds: Vec::new(),
            linked: Vec::new(),
            parts: Vec::new(),
            whole: None,
            located: None,
        }
    }

    /// The answer to the smoothed problem where no optimum of the true system is certified: stopped
    /// where the search for one was stopped.
    pub(super) fn missed(self, certificate: Certificate, options: &Options) -> Self {
        if !self.status().is_solved() {
            return self;
        }
        let ControlFlow::Break(stop) = (options.stop)() else {
            return Solution { certificate: Some(certificate), ..self };
        };
        let mut stopped = self;
        stopped.outcome.solution.status = stop.into();
        stopped.certificate = Some(Certificate::nothing_located("finished"));
        stopped
    }

    /// The same answer in the words of another model.
    pub(super) fn of_model(self, model: Model, problem: Problem, outcome: Outcome) -> Self {
        Solution { model, problem, outcome, ..self }
    }

    /// The model that was solved.
    pub fn model(&self) -> &Model {
        &self.model
    }

    /// Whether a solve that begins elsewhere may end better: it found nothing feasible, which is
    /// not proved to be impossible, or the guess has no value.
    pub(super) fn may_be_found_elsewhere(&self) -> bool {
        let is_free = !self.problem.controls.is_empty() || !self.problem.unknowns.is_empty();
        match self.status() {
            Status::Infeasible => is_free && !self.outcome.is_impossible,
            Status::IterationLimit => {
                is_free && self.outcome.solution.constraint_violation > INFEASIBLE
            }
            Status::NotFinite(_) => self.outcome.solution.counts.iterations == 0,
            _ => false,
        }
    }

    /// How the solve ended.
    pub fn status(&self) -> &Status {
        &self.outcome.solution.status
    }

    /// The same in one word, as in files; `uncertified` where the true system was asked for and
    /// this is an answer to the smoothed problem.
    pub fn status_name(&self) -> &'static str {
        match self.is_uncertified() {
            true => "uncertified",
            false => status_name(self.status(), self.outcome.is_impossible),
        }
    }

    /// Whether it is what was asked for: solved, or nearly as accurately; and certified where
    /// nothing was to be smoothed.
    pub fn is_solved(&self) -> bool {
        self.status().is_solved() && !self.is_uncertified()
    }

    fn is_uncertified(&self) -> bool {
        self.status().is_solved() && self.certificate.is_some() && !self.is_certified()
    }

    /// The objective as the model writes it: what is maximised is not negated.
    pub fn objective(&self) -> f64 {
        self.problem.sense * self.outcome.solution.objective
    }

    /// The grid: one more point than intervals.
    pub fn time(&self) -> &[f64] {
        &self.outcome.trajectory.time
    }

    /// A state at all grid points; part of a vector as `pos.x`. After a jump where one happens.
    pub fn state(&self, name: &str) -> Option<&[f64]> {
        column(&self.problem.states, &self.outcome.trajectory.states, name)
    }

    /// A control on all intervals.
    pub fn control(&self, name: &str) -> Option<&[f64]> {
        column(&self.problem.controls, &self.outcome.trajectory.controls, name)
    }

    /// The first value of each control, and for how long it is meant: what a closed loop applies.
    pub fn first_controls(&self) -> (Vec<f64>, f64) {
        let first = |column: &Vec<f64>| column.first().copied().unwrap_or(f64::NAN);
        let duration = self.time()[1] - self.time()[0];
        (self.outcome.trajectory.controls.iter().map(first).collect(), duration)
    }

    /// The derivative of the objective by a state, at all grid points.
    pub fn costate(&self, name: &str) -> Option<&[f64]> {
        column(&self.problem.states, &self.outcome.trajectory.costates, name)
    }

    /// The multipliers of a path constraint, one for each interval and per time: what the objective
    /// changes by with its bound. The name is the text of the constraint.
    pub fn path_multiplier(&self, name: &str) -> Option<&[f64]> {
        let all = &self.outcome.trajectory.path_multipliers;
        let label = |row: &usize| *self.problem.path.origin(*row).label == *name;
        (0..all.len()).find(label).map(|row| all[row].as_slice())
    }

    /// The multiplier of a condition at the ends: what the objective changes by with its bound. The
    /// name is the text of the condition.
    pub fn end_multiplier(&self, name: &str) -> Option<f64> {
        let all = &self.outcome.trajectory.end_multipliers;
        let label = |row: &usize| *self.problem.boundary.origin(row + 1).label == *name;
        (0..all.len()).find(label).map(|row| all[row])
    }

    /// The value of a parameter or of an unknown.
    pub fn value(&self, name: &str) -> Option<f64> {
        let at = self.problem.parameters.iter().position(|it| it.name == name)?;
        Some(self.outcome.trajectory.parameters[at])
    }

    /// The unknowns that were found, by name.
    pub fn unknowns(&self) -> impl Iterator<Item = (&str, f64)> {
        self.problem.unknowns.iter().map(|unknown| self.parameter(unknown.parameter))
    }

    /// The parameters that were given, by name; widths of surfaces are none.
    pub fn parameters(&self) -> impl Iterator<Item = (&str, f64)> {
        let is_given = |at: &usize| {
            self.problem.unknowns.iter().all(|unknown| unknown.parameter != *at)
                && self.problem.surfaces.iter().all(|surface| surface.sigma != *at)
        };
        (0..self.problem.parameters.len()).filter(is_given).map(|at| self.parameter(at))
    }

    fn parameter(&self, at: usize) -> (&str, f64) {
        (&self.problem.parameters[at].name, self.outcome.trajectory.parameters[at])
    }

    /// Whether it is shown to be a local optimum of the system that was written.
    pub fn is_certified(&self) -> bool {
        self.certificate.as_ref().is_some_and(Certificate::is_certified)
    }

    /// Whether the smoothing widths were chosen by the solver, as small as it could.
    pub fn has_chosen_widths(&self) -> bool {
        let method = &self.problem.method;
        let is_open = method.sigma.is_none() && method.continuation.is_empty();
        is_open
            && self.status().is_solved()
            && !self.outcome.sigma.is_empty()
            && !self.is_certified()
    }

    /// What a replay and another solve need of it, lent.
    pub fn record(&self) -> Record<'_> {
        let (problem, trajectory) = (&self.problem, &self.outcome.trajectory);
        let states = pairs(&problem.states, &trajectory.states);
        let shown = states.into_iter().zip(&problem.states).filter(|(_, state)| !state.hidden);
        let nodes = trajectory.nodes.as_ref().map(|nodes| NodesRecord {
            time: &nodes.time,
            values: pairs(&problem.controls, &nodes.values),
        });
        Record {
            model: &problem.name,
            free: self.unknowns().collect(),
            params: self.parameters().collect(),
            settings: self.settings(),
            time: &trajectory.time,
            states: shown.map(|(pair, _)| pair).collect(),
            controls: pairs(&problem.controls, &trajectory.controls),
            nodes,
            jumps: self.jumps.iter().map(jump).collect(),
            phases: self.parts.iter().map(|part| self.record_of(part)).collect(),
        }
    }

    fn settings(&self) -> Settings<'_> {
        let (method, sigma) = (&self.problem.method, &self.outcome.sigma);
        let surfaces = self.problem.surfaces.iter().map(|it| it.name.as_str());
        Settings {
            scheme: Some(method.scheme),
            controls: Some(method.controls),
            intervals: Some(method.intervals()),
            sigma: sigma.first().copied(),
            sigmas: surfaces.zip(sigma.iter().copied()).collect(),
            sigma_chosen: self.has_chosen_widths(),
            kernel: Some(&method.kernel),
        }
    }

    /// Replays the controls on the true system, from event to event.
    ///
    /// # Errors
    ///
    /// A model that cannot be simulated, or an iterate with numbers that are not finite.
    pub fn verify(&self) -> Result<Verification, Error> {
        verify(self.model.meaning(), &self.problem, &self.record())
    }

    /// What the solver saw of a model of several phases, or with jumps.
    pub(crate) fn in_phases(&self) -> Option<(&fdcc_compiler::Model, &Chain, &ChainOutcome)> {
        let between = self.between_jumps.as_ref().map(|it| (&it.model, &it.chain, &it.outcome));
        let whole = self.whole.as_ref();
        between.or(whole.map(|it| (self.model.meaning(), &it.chain, &it.outcome)))
    }

    /// The derivative of the optimal objective by each parameter, by its multipliers; nothing
    /// without an objective, NaN where that has a kink, or where conditions that depend on each
    /// other leave open what each of them is worth.
    pub fn sensitivities(&self) -> Vec<(&str, f64)> {
        let params = &self.model.meaning().params;
        if params.is_empty() || !self.problem.has_objective {
            return Vec::new();
        }
        let single;
        let (model, chain, outcome) = match self.in_phases() {
            Some((model, chain, outcome)) => (model, chain.clone(), outcome),
            None => {
                single = ChainOutcome::single(self.outcome.clone());
                (self.model.meaning(), Chain::single(self.problem.clone()), &single)
            }
        };
        let names = params.iter().map(|param| param.place.name.as_str());
        let mut found = by_multipliers(model, &chain, outcome).unwrap_or_default();
        found.iter_mut().zip(&self.of_holds).for_each(|(sum, more)| *sum += more);
        for at in parameters_on_kinks(self.model.meaning()) {
            found.iter_mut().skip(at).take(1).for_each(|it| *it = f64::NAN);
        }
        names.zip(found).collect()
    }
}

/// The derivatives of the Lagrangian by all parameters.
fn slopes(
    model: &fdcc_compiler::Model,
    chain: &Chain,
    outcome: &ChainOutcome,
) -> Result<Vec<f64>, Vec<Diagnostic>> {
    if !model.phases.is_empty() {
        let by = compile_chain_by_parameters(model)?;
        return Ok(by_parameters_of_chain(chain, outcome, &by));
    }
    let by = compile_by_parameters(model)?;
    let Outcome { solution, trajectory, .. } = &outcome.phases[0];
    Ok(by_parameters(&chain.phases[0], solution, &trajectory.parameters, &by))
}

/// The derivatives of an optimum, by its multipliers; NaN of what depends on which of several sets
/// of multipliers these are.
fn by_multipliers(
    model: &fdcc_compiler::Model,
    chain: &Chain,
    outcome: &ChainOutcome,
) -> Result<Vec<f64>, Vec<Diagnostic>> {
    let mut found = slopes(model, chain, outcome)?;
    let other = with_other_multipliers(chain, outcome);
    let others = other.map(|it| slopes(model, chain, &it)).transpose()?;
    let nothing = NOTHING * outcome.solution.objective.abs();
    let parameters = &chain.phases[0].parameters;
    for ((own, other), it) in found.iter_mut().zip(others.into_iter().flatten()).zip(parameters) {
        let size = if it.value == 0.0 { it.unit } else { it.value.abs() };
        let least = (NOT_UNIQUE * own.abs().max(other.abs())).max(nothing / size);
        if (*own - other).abs() > least {
            *own = f64::NAN;
        }
    }
    Ok(found)
}

fn jump(it: &Jump) -> JumpRecord<'_> {
    let before = it.before.iter().map(|(name, value)| (name.as_str(), *value)).collect();
    JumpRecord { jump: &it.name, time: it.time, before }
}

fn pairs<'s>(variables: &'s [Variable], columns: &'s [Vec<f64>]) -> Vec<(&'s str, &'s [f64])> {
    variables.iter().map(|it| it.name.as_str()).zip(columns.iter().map(Vec::as_slice)).collect()
}

fn column<'s>(variables: &[Variable], columns: &'s [Vec<f64>], name: &str) -> Option<&'s [f64]> {
    let at = variables.iter().position(|it| it.name == name)?;
    columns.get(at).map(Vec::as_slice)
}
