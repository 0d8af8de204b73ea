//! What a picture of a solution needs besides its numbers: the units in which people see them, the
//! bounds, and the text that was solved.

use super::named::Named;
use super::plots::{Drawn, drawn};
use super::units::{Shown, Units};
use fdcc::{CostatesBefore, Solution};
use fdcc_runtime::problem::{Bounds, Problem, Variable};
use serde::Serialize;

/// What a path condition bounds, and by what.
#[derive(Clone, Debug, Serialize)]
pub struct PathCondition {
    bounds: [f64; 2],
    /// One for each grid point, with the control before it; none at the first.
    values: Vec<f64>,
}

/// Values just before a time.
#[derive(Clone, Debug, Serialize)]
pub struct Before {
    time: f64,
    values: Named<f64>,
}

/// A part of the document of a solve.
#[derive(Clone, Debug, Default, Serialize)]
pub struct Picture {
    /// The unit that the model declares for each name, and how many of SI it is; absent where the
    /// model has none.
    #[serde(skip_serializing_if = "Named::is_empty")]
    pub display_units: Named<Shown>,
    /// Lower and upper bound of each state and control that has one.
    pub bounds: Named<[f64; 2]>,
    /// The value of each path condition, and its lower and upper bound.
    #[serde(skip_serializing_if = "Named::is_empty")]
    pub path: Named<PathCondition>,
    /// The costates just before each jump and each switch that was located; the grid has those
    /// after them.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub costates_before: Vec<Before>,
    /// What the model says is to be drawn.
    #[serde(skip_serializing_if = "Named::is_empty")]
    pub plots: Named<Drawn>,
    /// The text of the model.
    pub source: String,
}

impl Picture {
    /// That of a solution.
    pub fn new(found: &Solution, units: &Units) -> Self {
        Picture {
            display_units: units.shown(),
            bounds: all_bounds(&found.problem),
            path: found.path_conditions().into_iter().map(condition).collect(),
            costates_before: found.costates_before().into_iter().map(Before::from).collect(),
            plots: drawn(found.plots()),
            source: found.model().source().text.to_string(),
        }
    }
}

/// Of each state and control that has one.
pub fn all_bounds(problem: &Problem) -> Named<[f64; 2]> {
    let shown = problem.states.iter().filter(|state| !state.hidden);
    shown.chain(&problem.controls).filter_map(bounds).collect()
}

fn bounds(variable: &Variable) -> Option<(String, [f64; 2])> {
    let is_bounded = variable.bounds.lower.is_finite() || variable.bounds.upper.is_finite();
    is_bounded.then(|| (variable.name.clone(), pair(&variable.bounds)))
}

fn pair(bounds: &Bounds) -> [f64; 2] {
    [bounds.lower, bounds.upper]
}

fn condition(it: fdcc::PathCondition) -> (String, PathCondition) {
    (it.name, PathCondition { bounds: pair(&it.bounds), values: it.values })
}

impl From<CostatesBefore> for Before {
    fn from(it: CostatesBefore) -> Self {
        Before { time: it.time, values: Named(it.values) }
    }
}
