//! What pictures of a solution show besides its columns: path conditions with their bounds, and
//! costates before jumps.

use super::Solution;
use super::true_optimum::path_at_ends;
use fdcc_runtime::problem::{Bounds, Problem, Variable};
use fdcc_runtime::solution::{Outcome, Trajectory};

/// A path condition along a solution; numbers are in SI.
///
/// ```
/// let model = fdcc::Model::from_text("hop", "time t in [0, 1]
/// state x start 0
/// control u in [-1, 1]
/// dynamics { x' = u }
/// path limit: x + u <= 1
/// end x == 0.5
/// minimize integral(u^2)")?;
/// let solution = model.solve(&fdcc::Options::default())?;
/// let limit = &solution.path_conditions()[0];
/// assert_eq!((limit.name.as_str(), limit.bounds.upper), ("limit", 1.0));
/// assert_eq!(limit.values.len(), solution.time().len());
/// # Ok::<(), fdcc::Error>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct PathCondition {
    /// As the model writes it.
    pub name: String,
    /// Within these.
    pub bounds: Bounds,
    /// One for each grid point, with the control before it; NaN at the first.
    pub values: Vec<f64>,
}

/// The costates just before a time.
///
/// ```
/// let model = fdcc::Model::from_text("hop", "time t in [0, 1]
/// state x start 0
/// control u in [-1, 1]
/// dynamics { x' = u }
/// at 0.5: x == 0.2
/// minimize integral(u^2)
/// method { N = 10 }")?;
/// let solution = model.solve(&fdcc::Options::default())?;
/// let before = &solution.costates_before()[0];
/// assert_eq!((before.time, before.values[0].0.as_str()), (0.5, "x"));
/// assert!((before.values[0].1 + 0.8).abs() < 1e-6, "the derivative of (0.2 - x)^2/0.5 at 0");
/// # Ok::<(), fdcc::Error>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct CostatesBefore {
    /// Of a jump, or of a switch that was located.
    pub time: f64,
    /// By the name of the state.
    pub values: Vec<(String, f64)>,
}

impl Solution {
    /// The path conditions at the grid points.
    pub fn path_conditions(&self) -> Vec<PathCondition> {
        path_conditions(&self.problem, &self.outcome.trajectory)
    }

    /// The costates just before each jump and each switch that was located;
    /// [`costate`](Solution::costate) has those after them.
    pub fn costates_before(&self) -> Vec<CostatesBefore> {
        let between = self.between_jumps.as_ref().filter(|_| self.phases().is_empty());
        let Some(between) = between else { return Vec::new() };
        let phases = between.chain.phases.iter().zip(&between.outcome.phases);
        let count = between.outcome.phases.len().saturating_sub(1);
        let before = |(phase, outcome)| self.last_costates(phase, outcome);
        phases.take(count).filter_map(before).collect()
    }

    fn last_costates(&self, phase: &Problem, outcome: &Outcome) -> Option<CostatesBefore> {
        let is_shown =
            |name: &str| self.problem.states.iter().any(|it| it.name == name && !it.hidden);
        let Trajectory { time, costates, .. } = &outcome.trajectory;
        let values = phase.states.iter().zip(costates).filter(|(state, _)| is_shown(&state.name));
        let last =
            |(state, column): (&Variable, &Vec<f64>)| Some((state.name.clone(), *column.last()?));
        Some(CostatesBefore { time: *time.last()?, values: values.filter_map(last).collect() })
    }
}

pub(super) fn path_conditions(problem: &Problem, trajectory: &Trajectory) -> Vec<PathCondition> {
    // What phases share has none, and the functions of one of them.
    if problem.path_bounds.is_empty() || trajectory.time.is_empty() {
        return Vec::new();
    }
    let values = path_at_ends(problem, trajectory);
    let condition = |(row, bounds): (usize, &Bounds)| {
        let values = std::iter::once(f64::NAN).chain(values.column(row).iter().copied());
        let name = problem.path.origin(row).label.to_string();
        PathCondition { name, bounds: *bounds, values: values.collect() }
    };
    problem.path_bounds.iter().enumerate().map(condition).collect()
}
