//! The JSON document of a solve: the contract that people script against.

use super::certificate::Certificate;
use super::convergence::Convergence;
use super::derivatives::Derivative;
use super::estimates::{Estimates, Residual};
use super::hamiltonian_check::HamiltonianCheck;
use super::method_used::MethodUsed;
use super::modes::{Span, spans_of};
use super::named::Named;
use super::optimality::Optimality;
use super::phases::Phase;
use super::picture::Picture;
use super::reach::{LargestViolation, Reach};
use super::tried::{Ended, Family, Happened, Tried};
use super::units::Units;
use super::verification::Verification;
use crate::command;
use crate::version::VERSION;
use fdcc::Solution;
use fdcc_runtime::nlp::{self, Status};
use fdcc_runtime::problem::{Function, Variable};
use fdcc_runtime::solution;
use serde::{Deserialize, Serialize};

/// One solve. Numbers are written so that they read back to the same bits.
#[derive(Clone, Debug, Serialize)]
pub struct Document {
    pub fdcc: String,
    pub model: String,
    /// The arguments that it was run with; absent where there is no command line.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub command: Vec<String>,
    pub source_sha256: String,
    pub status: String,
    pub objective: f64,
    /// Whether the optimum is proved to be global.
    pub global: bool,
    pub free: Named<f64>,
    pub params: Named<f64>,
    pub method: MethodUsed,
    pub iterations: usize,
    pub kkt_error: f64,
    pub constraint_violation: f64,
    pub regularizations: usize,
    pub counts: Counts,
    pub seconds: Seconds,
    pub time: Vec<f64>,
    pub states: Named<Vec<f64>>,
    pub controls: Named<Vec<f64>>,
    /// The values that define controls that are not constant on each interval.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub control_nodes: Option<ControlNodes>,
    pub costates: Named<Vec<f64>>,
    /// What the objective changes by with the bound of each path constraint, per time; one for each
    /// interval.
    pub path_multipliers: Named<Vec<f64>>,
    /// What the objective changes by with the bound of each condition at the ends.
    pub end_multipliers: Named<f64>,
    /// The same of each condition at a time between the ends.
    #[serde(skip_serializing_if = "Named::is_empty")]
    pub at_multipliers: Named<f64>,
    /// One for each interval.
    pub hamiltonian: Vec<f64>,
    /// The sum of the errors of all steps, where the grid was refined.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub step_errors: Option<f64>,
    /// What the Hamiltonian has to be, and how far it is from that.
    pub hamiltonian_check: HamiltonianCheck,
    /// The derivative of the optimal objective by each parameter.
    #[serde(skip_serializing_if = "Named::is_empty")]
    pub sensitivities: Named<f64>,
    /// How the optimum moves with the parameters that were asked for.
    #[serde(skip_serializing_if = "Named::is_empty")]
    pub derivatives: Named<Derivative>,
    pub report: Named<Vec<f64>>,
    pub surfaces: Named<Vec<Span>>,
    /// What holds in each phase, where the model has any: then all signals are theirs.
    #[serde(skip_serializing_if = "Named::is_empty")]
    pub phases: Named<Phase>,
    /// The jumps, in their order; the grid has the states after them.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub jumps: Vec<Happened>,
    /// What was tried, where the model has jumps.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub sequences: Vec<Tried>,
    /// Whether the model allows more jumps than were tried.
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    pub sequences_left_out: bool,
    /// How each of several starts ended, in their order; absent where there was one.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub starts: Vec<Ended>,
    /// To which optima of the system that was written they lead; absent where these were not
    /// looked for.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub families: Vec<Family>,
    /// What the estimates of a fit are worth; absent where no squares over rows of data are
    /// minimised.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub estimates: Option<Estimates>,
    /// What remains of each signal that was measured.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub residuals: Vec<Residual>,
    /// The units of the values; absent where the model has none.
    #[serde(skip_serializing_if = "Units::is_empty")]
    pub units: Units,
    /// What shows that it is an optimum of the true system, or why it is not shown; absent where
    /// nobody looked for one.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub certificate: Option<Certificate>,
    #[serde(flatten)]
    pub picture: Picture,
    /// How the solve went; absent where there were several, or none that iterates.
    #[serde(skip_serializing_if = "Convergence::is_empty")]
    pub convergence: Convergence,
    /// What contradicts that it is an optimum; absent where nothing is claimed to be one.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub optimality: Option<Optimality>,
    /// What the controls do on the true system; absent where they were not replayed.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub verification: Option<Verification>,
    /// How far the condition in the way can be met; only where nothing feasible was found.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub reach: Option<Reach>,
    /// What is violated most; only where nothing feasible was found.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub largest_violation: Option<LargestViolation>,
}

/// The values between which a control is linear, or through which it is a polynomial on each
/// interval.
#[derive(Clone, Debug, Serialize)]
pub struct ControlNodes {
    pub time: Vec<f64>,
    pub values: Named<Vec<f64>>,
}

impl ControlNodes {
    fn new(controls: &[Variable], nodes: &solution::ControlNodes) -> Self {
        ControlNodes {
            time: nodes.time.clone(),
            values: named_columns(controls.iter().zip(&nodes.values)),
        }
    }
}

/// Work done.
#[derive(Clone, Debug, Serialize)]
pub struct Counts {
    pub factorizations: usize,
    pub evaluations: usize,
    pub derivatives: usize,
    pub restorations: usize,
}

impl Counts {
    fn new(counts: &nlp::Counts) -> Self {
        Counts {
            factorizations: counts.factorizations,
            evaluations: counts.values,
            derivatives: counts.derivatives,
            restorations: counts.restorations,
        }
    }
}

/// Wall-clock times: the only entries that differ between two runs.
#[derive(Clone, Copy, Debug, Default, Serialize, Deserialize)]
pub struct Seconds {
    pub compile: f64,
    pub solve: f64,
    pub total: f64,
}

impl Document {
    pub fn new(found: &Solution, source_sha256: &str, units: Units, seconds: Seconds) -> Self {
        let (problem, outcome) = (&found.problem, &found.outcome);
        let (solution, trajectory) = (&outcome.solution, &outcome.trajectory);
        let shown = |columns: &[Vec<f64>]| {
            named_columns(problem.states.iter().zip(columns).filter(|(state, _)| !state.hidden))
        };
        let nodes = trajectory.nodes.as_ref();
        let report = problem.report_names.iter().cloned().zip(trajectory.report.iter().cloned());
        let claims = problem.has_objective && found.status().is_solved();
        Document {
            fdcc: VERSION.to_string(),
            model: problem.name.clone(),
            command: command::given(),
            source_sha256: source_sha256.to_string(),
            status: found.status_name().to_string(),
            objective: found.objective(),
            global: solution.global,
            free: Named::of(found.unknowns()),
            params: Named::of(found.parameters()),
            method: MethodUsed::new(found),
            iterations: solution.counts.iterations,
            kkt_error: measured(&solution.status, solution.kkt_error),
            constraint_violation: measured(&solution.status, solution.constraint_violation),
            regularizations: solution.counts.regularizations,
            counts: Counts::new(&solution.counts),
            seconds,
            time: trajectory.time.clone(),
            states: shown(&trajectory.states),
            controls: named_columns(problem.controls.iter().zip(&trajectory.controls)),
            control_nodes: nodes.map(|nodes| ControlNodes::new(&problem.controls, nodes)),
            costates: shown(&trajectory.costates),
            path_multipliers: labelled(&*problem.path, 0, &trajectory.path_multipliers),
            end_multipliers: labelled(&*problem.boundary, 1, &trajectory.end_multipliers),
            at_multipliers: found.at_multipliers().into_iter().collect(),
            hamiltonian: trajectory.hamiltonian.values.clone(),
            step_errors: found.step_errors,
            hamiltonian_check: HamiltonianCheck::new(&problem.controls, &trajectory.hamiltonian),
            sensitivities: Named::default(),
            derivatives: Named::default(),
            report: report.collect(),
            surfaces: spans_of(problem, outcome),
            phases: Named::default(),
            jumps: found.jumps.iter().map(Happened::from).collect(),
            sequences: found.sequences.iter().map(Tried::from).collect(),
            sequences_left_out: found.sequences_left_out,
            starts: found.starts.iter().map(Ended::from).collect(),
            families: found.families.iter().map(Family::from).collect(),
            picture: Picture::new(found, &units),
            estimates: None,
            residuals: Vec::new(),
            units,
            convergence: Convergence::default(),
            optimality: claims.then(|| Optimality::new(&found.optimality(None))),
            certificate: certificate(found),
            verification: None,
            reach: None,
            largest_violation: largest_violation(found),
        }
    }

    /// The same with the documents of its phases.
    pub fn with_phases(mut self, found: &Solution) -> Self {
        let seconds = self.seconds;
        let phase = |own: &Solution| {
            let units = Units::from(own.model());
            let document = Document::new(own, &self.source_sha256, units, seconds);
            (own.problem.name.clone(), Phase(document))
        };
        self.phases = found.phases().iter().map(phase).collect();
        if !self.phases.is_empty() {
            self.method.n = self.phases.0.iter().map(|(_, phase)| phase.0.method.n).sum();
        }
        self
    }

    /// Whether it is shown to be a local optimum of the true system.
    pub fn is_certified(&self) -> bool {
        self.certificate.as_ref().is_some_and(|it| it.certified)
    }

    /// Whether the replay confirms it and nothing contradicts that it is an optimum.
    pub fn is_confirmed(&self) -> bool {
        let is_contradicted = self.optimality.as_ref().is_some_and(|it| it.contradicted);
        self.verification.as_ref().is_some_and(|it| it.confirmed) && !is_contradicted
    }

    /// The states before the jumps at a grid point, which has those after them.
    pub fn befores(&self, point: usize) -> impl Iterator<Item = &Named<f64>> {
        let nearest = |time: f64| {
            let distance = |k: &usize| (self.time[*k] - time).abs();
            (0..self.time.len()).min_by(|a, b| distance(a).total_cmp(&distance(b)))
        };
        self.jumps
            .iter()
            .filter(move |jump| nearest(jump.time) == Some(point))
            .map(|jump| &jump.before)
    }
}

fn certificate(found: &Solution) -> Option<Certificate> {
    found.certificate.as_ref().map(|it| Certificate::new(it, is_smooth(found)))
}

/// What is violated most, where nothing feasible was found.
fn largest_violation(found: &Solution) -> Option<LargestViolation> {
    let limiting = found.outcome.limiting.as_ref();
    let is_infeasible = found.outcome.solution.status == Status::Infeasible;
    limiting.filter(|_| is_infeasible).map(LargestViolation::from)
}

/// Where an expression has no value, no error was measured.
fn measured(status: &Status, error: f64) -> f64 {
    if matches!(status, Status::NotFinite(_)) { f64::NAN } else { error }
}

/// Whether nothing switches and nothing jumps, in any of its phases.
fn is_smooth(found: &Solution) -> bool {
    let mut all = found.phases().iter().chain([found]);
    all.all(|it| it.problem.surfaces.is_empty() && it.model().meaning().jumps.is_empty())
}

/// By the words that the outputs of a function have in the model, from the first on that counts.
fn labelled<T: Clone>(function: &dyn Function, first: usize, values: &[T]) -> Named<T> {
    let label =
        |(row, value): (usize, &T)| (function.origin(first + row).label.to_string(), value.clone());
    values.iter().enumerate().map(label).collect()
}

fn named_columns<'a>(
    columns: impl Iterator<Item = (&'a Variable, &'a Vec<f64>)>,
) -> Named<Vec<f64>> {
    columns.map(|(control, column)| (control.name.clone(), column.clone())).collect()
}
