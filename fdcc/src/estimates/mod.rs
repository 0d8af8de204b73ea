//! What the estimates of a fit are worth: standard errors and correlations of the unknowns, what
//! remains of the measurements, and what they do not determine.
//!
//! Where a sum of squares `J = sum r^2` is minimised whose residuals are in standard deviations,
//! the estimates have the covariance
//!
//! ```text
//!     C = 2 H^-1      and in an unknown unit     C = 2 s^2 H^-1,    s^2 = J / (rows - directions)
//! ```
//!
//! with the Hessian `H` of the Lagrangian over the unknowns, all else following. That holds for
//! measurements with independent normal errors, of a model that is right, as far as it is linear in
//! the unknowns within their errors; a bound that is active holds its unknown. (Bard, Nonlinear
//! parameter estimation, 1974, chapter 7.)

use crate::{Phases, Solution};
use fdcc_compiler::{Model, Readings, Residuals, residuals};
use fdcc_runtime::nlp::Covariance;
use fdcc_runtime::problem::{Chain, Problem};
use fdcc_runtime::solution::terms_of_rows;
use fdcc_runtime::solve::{ChainOutcome, Outcome, covariance_of_chain};

/// What is known of the unknowns.
///
/// ```
/// use fdcc::{Model, Options};
///
/// let model = Model::from_file("../models/slider_fit.fdc")?.with_method("N", 40)?;
/// let solution = model.solve(&Options::default())?;
/// let estimates = solution.estimates().expect("squares over rows of data are minimised");
/// let mu = estimates.unknowns.iter().find(|it| it.name == "mu").expect("it is unknown");
/// assert!(mu.standard_error.is_some_and(|error| (mu.value - 0.3).abs() < 3.0 * error));
/// # Ok::<(), fdcc::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct Estimates {
    /// All unknowns of the model, in their order.
    pub unknowns: Vec<Estimate>,
    /// One row and one column for each of them; 0 beside what has no standard error.
    pub correlations: Vec<Vec<f64>>,
    /// Unknowns of which the data determine only some combination; one by itself has no influence.
    pub undetermined: Vec<Vec<String>>,
    /// What remains of the measurements, signal by signal.
    pub residuals: Vec<Residual>,
    /// How many measurements there are.
    pub rows: usize,
    /// How many there are more than directions in which the answer could change; none if there are
    /// no more, and where the answer was not shown to be a strict minimum.
    pub degrees_of_freedom: Option<usize>,
    /// Sum of the squares of all residuals.
    pub sum_of_squares: f64,
    /// The root of that over the degrees of freedom: about 1 where the model is right and the
    /// residuals are in standard deviations.
    pub deviation: Option<f64>,
    /// Whether the standard deviations of the measurements are known; else they are taken from what
    /// remains.
    pub is_known: bool,
    /// Whether the answer was shown to be a strict minimum in what the data determine and no bound
    /// holds; else nothing has a standard error.
    pub is_minimum: bool,
}

/// One unknown.
///
/// ```
/// let model = fdcc::Model::from_file("../models/slider_fit.fdc")?.with_method("N", 40)?;
/// let estimates = model.solve(&fdcc::Options::default())?.estimates().expect("it is a fit");
/// for it in &estimates.unknowns {
///     println!("{} {} +- {:?}", it.name, it.value, it.standard_error);
/// }
/// # assert!(estimates.unknowns.iter().all(|it| it.standard_error.is_some()));
/// # Ok::<(), fdcc::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct Estimate {
    /// Its name.
    pub name: String,
    /// Its value, in SI.
    pub value: f64,
    /// In its unit; none where the data or the model say too little.
    pub standard_error: Option<f64>,
    /// Whether a bound holds it.
    pub is_at_bound: bool,
}

/// What remains of a signal.
///
/// ```
/// let model = fdcc::Model::from_file("../models/slider_fit.fdc")?.with_method("N", 40)?;
/// let estimates = model.solve(&fdcc::Options::default())?.estimates().expect("it is a fit");
/// let [x, v] = &estimates.residuals[..] else { panic!("two signals were measured") };
/// assert_eq!((x.name.as_str(), v.name.as_str(), x.values.len()), ("x", "v", 21));
/// # Ok::<(), fdcc::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct Residual {
    /// The phase, if the model has any.
    pub phase: Option<String>,
    /// The signal or column, or the text of a sum.
    pub name: String,
    /// The data set.
    pub data: String,
    /// The time of each row.
    pub time: Vec<f64>,
    /// The signal less what was measured, times the root of the weight: their squares are added up.
    pub values: Vec<f64>,
    /// Whether something was measured in a row.
    pub is_measured: Vec<bool>,
    /// What was measured in each row; nothing where the sum is not of differences to a signal.
    pub measured: Option<Vec<f64>>,
    /// The difference to what was measured that makes the residual 1: its standard deviation, if
    /// the model has it. Beside `measured`.
    pub deviations: Option<Vec<f64>>,
}

impl Solution {
    /// What the estimates of a fit are worth; none where the answer is no solution, or what is
    /// minimised over rows of data is no sum of squares.
    pub fn estimates(&self) -> Option<Estimates> {
        let (residuals, is_known) = self.residuals();
        if residuals.is_empty() || !self.status().is_solved() {
            return None;
        }
        let measured = residuals.iter().flat_map(|it| &it.is_measured);
        let rows = measured.filter(|it| **it).count();
        let values = residuals.iter().flat_map(|it| &it.values);
        let sum_of_squares: f64 = values.map(|it| it * it).sum();
        let unknowns: Vec<(&str, f64)> = self.unknowns().collect();
        let unit = if is_known { 1.0 } else { sum_of_squares / rows.max(1) as f64 };
        let known = self.with_chain(|chain, outcome| covariance_of_chain(chain, outcome, unit));
        let directions = known.as_ref().map(|it| it.directions);
        let degrees_of_freedom =
            directions.and_then(|it| rows.checked_sub(it)).filter(|it| *it > 0);
        let deviation = degrees_of_freedom.map(|it| (sum_of_squares / it as f64).sqrt());
        let scale = if is_known { Some(1.0) } else { deviation };
        let errors = known.as_ref().map_or(Vec::new(), errors);
        let error = |at: usize| Some(errors.get(at).copied()?? * scale?);
        let estimate = |(at, (name, value)): (usize, &(&str, f64))| Estimate {
            name: (*name).into(),
            value: *value,
            standard_error: error(at),
            is_at_bound: known.as_ref().is_some_and(|it| it.is_at_bound[at]),
        };
        Some(Estimates {
            unknowns: unknowns.iter().enumerate().map(estimate).collect(),
            is_minimum: known.is_some(),
            undetermined: known.as_ref().map_or(Vec::new(), |it| undetermined(it, &unknowns)),
            correlations: known.map_or(Vec::new(), |it| correlations(&it, &errors)),
            residuals,
            rows,
            degrees_of_freedom,
            sum_of_squares,
            deviation,
            is_known,
        })
    }

    /// What remains of all signals, and whether their standard deviations are known.
    fn residuals(&self) -> (Vec<Residual>, bool) {
        if self.phases().is_empty() {
            return self.residuals_over_time(None);
        }
        let (mut all, mut is_known) = (Vec::new(), true);
        for (phase, part) in self.model().meaning().phases.iter().zip(self.phases()) {
            let (own, known) = part.residuals_over_time(Some(&phase.place.name));
            all.extend(own);
            is_known &= known;
        }
        (all, is_known)
    }

    /// Those of one phase of the model. Where switches divide its time each part of it has the same
    /// signals.
    fn residuals_over_time(&self, phase: Option<&str>) -> (Vec<Residual>, bool) {
        let Some(Phases { model, chain, outcome }) = &self.between_jumps else {
            return of_phase(self.model().meaning(), &self.problem, &self.outcome, phase);
        };
        if model.phases.is_empty() {
            return of_phase(model, &chain.phases[0], &outcome.phases[0], phase);
        }
        let parts = model.phases.iter().zip(&chain.phases).zip(&outcome.phases);
        let parts = parts.map(|((it, problem), own)| of_phase(&it.model, problem, own, phase));
        parts.reduce(followed).unwrap_or_default()
    }

    fn with_chain<T>(&self, act: impl FnOnce(&Chain, &ChainOutcome) -> T) -> T {
        match self.in_phases() {
            Some((_, chain, outcome)) => act(chain, outcome),
            None => {
                let outcome = ChainOutcome::single(self.outcome.clone());
                act(&Chain::single(self.problem.clone()), &outcome)
            }
        }
    }
}

/// Rows of each signal in one part of time, and in the next.
fn followed(
    (mut first, is_known): (Vec<Residual>, bool),
    next: (Vec<Residual>, bool),
) -> (Vec<Residual>, bool) {
    for (own, more) in first.iter_mut().zip(next.0) {
        own.time.extend(more.time);
        own.values.extend(more.values);
        own.is_measured.extend(more.is_measured);
        own.measured = both(own.measured.take(), more.measured);
        own.deviations = both(own.deviations.take(), more.deviations);
    }
    (first, is_known && next.1)
}

fn both(first: Option<Vec<f64>>, next: Option<Vec<f64>>) -> Option<Vec<f64>> {
    first.zip(next).map(|(first, next)| [first, next].concat())
}

/// Standard errors for residuals in standard deviations; none of what is not determined.
fn errors(known: &Covariance) -> Vec<Option<f64>> {
    let is_open = |at: &usize| known.undetermined.iter().any(|it| it.contains(at));
    let has_one = |at: &usize| !known.is_at_bound[*at] && !is_open(at);
    let error = |at: usize| (2.0 * known.inverse[at][at]).max(0.0).sqrt();
    (0..known.inverse.len()).map(|at| has_one(&at).then(|| error(at))).collect()
}

/// Of all pairs that have standard errors; 1 of each with itself.
fn correlations(known: &Covariance, errors: &[Option<f64>]) -> Vec<Vec<f64>> {
    let entry = |a: usize, b: usize| match errors[a].zip(errors[b]) {
        _ if a == b => 1.0,
        Some((one, other)) if one * other > 0.0 => 2.0 * known.inverse[a][b] / (one * other),
        _ => 0.0,
    };
    let all = 0..errors.len();
    all.clone().map(|a| all.clone().map(|b| entry(a, b)).collect()).collect()
}

/// The names of what is not determined, direction by direction; times of switches have none.
fn undetermined(known: &Covariance, unknowns: &[(&str, f64)]) -> Vec<Vec<String>> {
    let mut all = known.undetermined.clone();
    all.iter_mut().for_each(|it| it.retain(|at| *at < unknowns.len()));
    all.retain(|it| !it.is_empty());
    all.sort();
    let named = |it: &Vec<usize>| it.iter().map(|at| unknowns[*at].0.to_owned()).collect();
    all.iter().map(named).collect()
}

/// What remains in one phase.
fn of_phase(
    model: &Model,
    problem: &Problem,
    outcome: &Outcome,
    phase: Option<&str>,
) -> (Vec<Residual>, bool) {
    let all = residuals(model);
    let is_known = all.iter().all(|it| it.is_fit);
    let rows: Vec<_> = all.iter().map(|it| &it.rows).collect();
    let terms = terms_of_rows(problem, &outcome.solution, &outcome.trajectory.parameters, &rows);
    // Outside of all phases a signal is written with its phase.
    let own = |name: &str| -> String {
        let behind = phase.and_then(|phase| name.strip_prefix(phase)?.strip_prefix('.'));
        behind.unwrap_or(name).to_owned()
    };
    let of_rows = |all: &[f64], terms: &[(usize, f64)]| -> Vec<f64> {
        terms.iter().map(|(row, _)| all[*row]).collect()
    };
    let of_signal = all.iter().zip(terms).map(|(it, terms)| Residual {
        measured: it.readings.as_ref().map(|own| of_rows(&own.measured, &terms)),
        deviations: it.readings.as_ref().map(|own| of_rows(&deviations(own, &it.weights), &terms)),
        phase: phase.map(str::to_owned),
        name: own(&it.name),
        data: it.data.clone(),
        time: terms.iter().map(|(row, _)| it.rows.times[*row]).collect(),
        values: terms.iter().map(|(row, term)| term * it.weights[*row] * sign(it, *row)).collect(),
        is_measured: terms.iter().map(|(row, _)| it.weights[*row] > 0.0).collect(),
    });
    (of_signal.collect(), is_known)
}

/// A square may be written as that of the measurement less the signal.
fn sign(residuals: &Residuals, row: usize) -> f64 {
    residuals.readings.as_ref().map_or(1.0, |it| it.factors[row].signum())
}

/// By how much each measurement is off where its residual is 1.
fn deviations(readings: &Readings, weights: &[f64]) -> Vec<f64> {
    let factors = readings.factors.iter().zip(weights);
    factors.map(|(factor, weight)| 1.0 / (factor * weight).abs()).collect()
}
