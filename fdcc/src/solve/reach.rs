//! How far a condition at the ends can be met where nothing feasible was found: the others are
//! kept, and the best is made of that one, in solves of their own.

use super::multistart;
use super::report::{Options, Part, Start};
use super::solution::Solution;
use super::tuning::reach::{MOST_ITERATIONS, NOTHING, ROUNDING};
use crate::error::Error;
use fdcc_compiler::Model as Meaning;
use fdcc_runtime::nlp::Status;
use fdcc_runtime::problem::Bounds;

/// How near a condition comes to what it asks for, with all others met.
///
/// ```
/// let text = "time t in [0, 1]\nstate x start 0\ncontrol u in [-1, 1]
/// dynamics { x' = u }\nend x == 2\nminimize integral(u^2)";
/// let options = fdcc::Options::default();
/// let solution = fdcc::Model::from_text("far", text)?.solve(&options)?;
/// let reach = solution.reach(&options).expect("one condition stands in the way");
/// assert!((reach.value - 1.0).abs() < 1e-6 && reach.bound == 2.0 && reach.is_proved);
/// # Ok::<(), fdcc::Error>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Reach {
    /// The condition in the words of the model.
    pub condition: String,
    /// What it bounds, at its best; 0 where that is less than a solve can tell from 0.
    pub value: f64,
    /// The bound that this is to have.
    pub bound: f64,
    /// Whether nothing better is possible on this grid; else that was found near the guess.
    pub is_proved: bool,
}

/// From which side a bound is approached.
#[derive(Clone, Copy)]
enum Side {
    Below,
    Above,
}

impl Solution {
    /// How far the condition at the ends that stands against the equations most can be met; nothing
    /// where it is unknown which that is, where it can be met by itself, or where that was not
    /// found out. It is asked of the smoothed problem, with the widths of this solution.
    pub fn reach(&self, options: &Options) -> Option<Reach> {
        let meaning = self.model().meaning();
        let is_whole =
            meaning.phases.is_empty() && meaning.jumps.is_empty() && meaning.at_times.is_empty();
        let is_asked = is_whole && *self.status() == Status::Infeasible;
        let limiting = self.outcome.limiting.as_ref().filter(|_| is_asked)?;
        let origin = limiting.condition.as_ref().unwrap_or(&limiting.origin);
        let mut rows = 0..meaning.boundary.len();
        let row = rows.find(|row| self.problem.boundary.origin(row + 1) == *origin)?;
        let Bounds { lower, upper } = self.problem.boundary_bounds[row];
        let sides = [(Side::Below, lower), (Side::Above, upper)];
        let mut sides = sides.into_iter().filter(|(_, bound)| bound.is_finite());
        sides.find_map(|(side, bound)| self.approached(row, side, bound, options))
    }

    /// The best from one side, unless the bound is reached, or cannot be approached from there.
    fn approached(&self, row: usize, side: Side, bound: f64, options: &Options) -> Option<Reach> {
        let model = self.model().changed(|meaning| {
            self.approach(meaning, row, side);
            Ok::<(), Error>(())
        });
        let chain = model.ok()?.chain().ok()?;
        let options = Options { report: &|_| {}, starts: 1, start: Start::Guess, ..*options };
        let found = multistart::solve(&chain, None, &options, Part::default()).ok()?.into_single();
        let best = &found.outcome.solution;
        let value = found.problem.sense * best.objective;
        let is_short = (bound - value).abs() > NOTHING * bound.abs().max(value.abs());
        let is_found = best.status.is_solved() && is_short;
        let condition = self.problem.boundary.origin(row + 1).label.to_string();
        let value = if value.abs() > ROUNDING * bound.abs() { value } else { 0.0 };
        is_found.then_some(Reach { condition, value, bound, is_proved: best.global })
    }

    /// Makes a row of the conditions the objective, bounded from one side alone.
    fn approach(&self, meaning: &mut Meaning, row: usize, side: Side) {
        let condition = &mut meaning.boundary[row];
        meaning.objective = Some((condition.place.clone(), condition.value));
        match side {
            Side::Below => condition.range.lower = meaning.graph.number(f64::NEG_INFINITY),
            Side::Above => condition.range.upper = meaning.graph.number(f64::INFINITY),
        }
        meaning.method.max_iter = meaning.method.max_iter.min(MOST_ITERATIONS);
        meaning.sense = if matches!(side, Side::Below) { -1.0 } else { 1.0 };
        if !meaning.method.names_width() {
            let widest = self.outcome.sigma.iter().fold(0.0, |a: f64, it| a.max(*it));
            (meaning.method.exact, meaning.method.continuation) = (false, Vec::new());
            meaning.method.sigma = Some(widest).filter(|it| *it > 0.0);
        }
    }
}
