//! A trajectory at one time, as Hamiltonians are formed of it.

use fdcc_compiler::Point;
use fdcc_runtime::problem::Problem;
use fdcc_runtime::solution::Trajectory;

/// The trajectory of a phase where `value` tells what a column is; so many states are those of the
/// model, and `problem` is what is smoothed of that.
pub(super) fn point_of(
    own: &Trajectory,
    (problem, states): (&Problem, usize),
    value: &dyn Fn(&[f64]) -> f64,
) -> Point {
    let all = |columns: &[Vec<f64>]| columns.iter().map(|it| value(it)).collect::<Vec<f64>>();
    let (mut x, mut costates) = (all(&own.states), all(&own.costates));
    x.truncate(states);
    let integrals = costates.split_off(states);
    let unknowns = problem.unknowns.iter().map(|it| own.parameters[it.parameter]);
    Point { time: value(&own.time), states: x, costates, integrals, unknowns: unknowns.collect() }
}
