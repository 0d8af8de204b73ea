//! A model with conditions at times between its ends: time is divided there, and the answer is one
//! trajectory again.

use super::found::{Found, FoundChain, Phases};
use super::located::grid;
use super::report::{Options, Part};
use super::{Solution, multistart};
use crate::error::Error;
use crate::record::Record;
use crate::replay::Replay;
use crate::warm_start;
use fdcc_compiler::{Model, compile_chain, ends_at, with_times};
use fdcc_runtime::nlp;
use fdcc_runtime::problem::{Chain, Method, Problem};
use fdcc_runtime::solution::phases::joined;

/// Solves; `between` is the problem without these conditions.
pub(super) fn solve(
    model: &Model,
    between: &Problem,
    earlier: Option<&Record>,
    options: &Options,
) -> Result<Found, Error> {
    let divided = with_times(model).map_err(Error::Model)?;
    let chain = compile_chain(&divided).map_err(Error::Model)?;
    let start = earlier.and_then(|it| start(it, model, between, &chain));
    let found = multistart::solve(&chain, start, options, Part::default())?;
    let FoundChain { chain, mut outcome, step_errors, starts, .. } = found;
    if !model.has_order_of_times() {
        // A proof says something of this order only.
        outcome.is_impossible = false;
        outcome.solution.global = false;
    }
    let (whole, _) = joined(between, &chain, &outcome);
    let method = Method { grid: grid(&whole.trajectory.time), ..between.method.clone() };
    let problem = Problem { method, ..between.clone() };
    let phases = Some(Phases { model: divided, chain, outcome });
    Ok(Found { step_errors, starts, phases, ..Found::new(problem, whole) })
}

impl Solution {
    /// What the objective changes by with the bound of each condition at a time, as written; none
    /// where the model has no such conditions.
    ///
    /// ```
    /// let model = fdcc::Model::from_text("via", "time t in [0, 1]
    /// state x start 0
    /// control u in [-9, 9]
    /// dynamics { x' = u }
    /// at 0.5: x == 1
    /// minimize integral(u^2)")?;
    /// // The effort is 2 x^2.
    /// let found = model.solve(&fdcc::Options::default())?.at_multipliers();
    /// assert!(found[0].0 == "at 0.5: x == 1" && (found[0].1 - 4.0).abs() < 1e-6);
    /// # Ok::<(), fdcc::Error>(())
    /// ```
    pub fn at_multipliers(&self) -> Vec<(String, f64)> {
        let at_times = &self.model().meaning().at_times;
        let Some(Phases { chain, outcome, .. }) = &self.between_jumps else { return Vec::new() };
        let labels = chain.links.iter().flat_map(|link| {
            (0..link.bounds.len())
                .map(|row| link.function.origin(row + 1).label.to_string())
                .collect::<Vec<_>>()
        });
        let labels: Vec<String> = labels.collect();
        let rows = &outcome.solution.multipliers.constraints;
        let own = &rows[rows.len().saturating_sub(labels.len())..];
        let is_written = |it: &(String, f64)| {
            at_times.iter().flat_map(|at| &at.rows).any(|row| row.place.name == it.0)
        };
        let all = labels.into_iter().zip(own.iter().map(|it| -self.problem.sense * it));
        all.filter(is_written).collect()
    }
}

/// The earlier solution, cut at the times that it has.
fn start(earlier: &Record, model: &Model, between: &Problem, chain: &Chain) -> Option<nlp::Start> {
    let mut own = model.clone();
    Replay::new(earlier, model).ok()?.adapt(&mut own);
    let times: Vec<f64> = ends_at(&own).ok()?.into_iter().map(|it| it.0).collect();
    let is_its = times.len() + 1 == chain.phases.len();
    warm_start::phases::start_at(earlier, &times, between, chain).filter(|_| is_its)
}
