//! All steps from the first time to the last.

use super::field::Field;
use super::rule::Grid;
use super::step::FixedStep;
use crate::problem::Origin;
use crate::simulate::{Controls, System, value};
use nalgebra::DVector;

/// Why a system cannot be stepped through.
#[derive(Clone, Debug, PartialEq)]
pub enum Failure {
    /// A rule of fixed steps knows no resets.
    Jumps,
    /// The complementarity problem of a step knows intervals, not the ball of a `Dir`.
    Directions,
    /// There is nothing to differentiate.
    NoObjective,
    /// Something has no value.
    NotFinite {
        /// When.
        time: f64,
        /// What.
        origin: Origin,
    },
    /// Newton's method found no end of a step.
    NotConverged {
        /// From 0.
        step: usize,
        /// When.
        time: f64,
    },
    /// The equations of a step have no unique solution, to first order.
    Singular {
        /// From 0.
        step: usize,
        /// When.
        time: f64,
    },
}

/// What the steps computed.
pub struct Stepped {
    /// One more than steps.
    pub time: Vec<f64>,
    /// One column for each state, integrals last.
    pub states: Vec<Vec<f64>>,
    /// One column for each surface: selectors of the last evaluation in each step.
    pub selectors: Vec<Vec<f64>>,
    /// The objective, if there is one.
    pub objective: Option<f64>,
    pub(super) taken: Vec<FixedStep>,
    pub(super) start: DVector<f64>,
}

impl Stepped {
    pub(super) fn end(&self) -> &DVector<f64> {
        self.taken.last().map_or(&self.start, |step| &step.end)
    }
}

/// Steps through a system.
pub fn step_through(system: &System, controls: &Controls, grid: &Grid) -> Result<Stepped, Failure> {
    if !system.jumps.is_empty() {
        return Err(Failure::Jumps);
    }
    if !system.balls.is_empty() {
        return Err(Failure::Directions);
    }
    let field = Field::new(system, controls);
    let start = field.start();
    let (mut x, mut taken) = (start.clone(), Vec::<FixedStep>::with_capacity(grid.count()));
    for index in 0..grid.count() {
        let step = FixedStep::take(&field, grid, index, x, taken.last())?;
        x = step.end.clone();
        taken.push(step);
    }
    let points = || std::iter::once(&start).chain(taken.iter().map(|step| &step.end));
    let state = |i: usize| points().map(|x| x[i]).collect();
    let selector = |i: usize| taken.iter().map(|step| step.new.s[i]).collect();
    Ok(Stepped {
        time: (0..=grid.count()).map(|index| field.time(grid.tau(index, 0.0))).collect(),
        states: (0..start.len()).map(state).collect(),
        selectors: (0..system.surfaces.len()).map(selector).collect(),
        objective: value(&*system.objective, &ends(&start, &x), &field.parameters).pop(),
        taken,
        start,
    })
}

/// `[x(start), x(end)]`
pub(super) fn ends(start: &DVector<f64>, end: &DVector<f64>) -> Vec<f64> {
    start.iter().chain(end.iter()).copied().collect()
}
