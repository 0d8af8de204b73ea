//! Path conditions of a phase and their derivatives, at the ends of each interval.

use super::polynomials::polynomials;
use fdcc_runtime::problem::{Columns, Problem};
use fdcc_runtime::solution::Trajectory;

/// A path condition at the beginning of each interval.
pub(super) fn path_values(problem: &Problem, trajectory: &Trajectory, row: usize) -> Vec<f64> {
    let points = points(problem, trajectory);
    let mut values = Columns::new(problem.path.outputs(), points.count());
    problem.path.value(&points, &trajectory.parameters, &mut values);
    values.column(row).to_vec()
}

/// A path condition at the last time.
pub(super) fn value_at_end(problem: &Problem, trajectory: &Trajectory, row: usize) -> f64 {
    let mut point = Columns::new(problem.path.layout().point_inputs(), 1);
    point.column_mut(0)[0] = 1.0;
    for (at, column) in trajectory.states.iter().chain(&trajectory.controls).enumerate() {
        point.column_mut(1 + at)[0] = column[column.len() - 1];
    }
    let mut values = Columns::new(problem.path.outputs(), 1);
    problem.path.value(&point, &trajectory.parameters, &mut values);
    values.column(row)[0]
}

/// The inputs of path conditions at the beginning of each interval.
pub(super) fn points(problem: &Problem, trajectory: &Trajectory) -> Columns {
    let count = trajectory.time.len() - 1;
    let mut points = Columns::new(problem.path.layout().point_inputs(), count);
    let time = &trajectory.time;
    let (first, duration) = (time[0], time[count] - time[0]);
    // Intervals need not be equal.
    for k in (0..count).filter(|_| duration > 0.0) {
        points.column_mut(0)[k] = (time[k] - first) / duration;
    }
    for (at, column) in trajectory.states.iter().chain(&trajectory.controls).enumerate() {
        points.column_mut(1 + at).copy_from_slice(&column[..count]);
    }
    points
}

/// The derivative of a path condition by a control, at the beginning of each interval.
pub(super) fn slopes(
    problem: &Problem,
    trajectory: &Trajectory,
    row: usize,
    control: usize,
) -> Vec<f64> {
    let (path, count) = (&*problem.path, trajectory.time.len() - 1);
    let layout = *path.layout();
    let points = points(problem, trajectory);
    let pattern = path.jacobian_pattern();
    let mut values = Columns::new(path.outputs(), count);
    let mut jacobian = Columns::new(pattern.entries.len(), count);
    path.jacobian(&points, &trajectory.parameters, &mut values, &mut jacobian);
    let place = (row as u32, (layout.controls().start + control) as u32);
    match pattern.entries.iter().position(|it| *it == place) {
        Some(entry) => jacobian.column(entry).to_vec(),
        None => vec![0.0; count],
    }
}

/// All path conditions at the end of each interval.
pub(crate) fn path_at_ends(problem: &Problem, trajectory: &Trajectory) -> Columns {
    let (path, time) = (&*problem.path, &trajectory.time);
    let [first, last] = [time[0], time[time.len() - 1]];
    let mut inputs = Columns::new(path.layout().point_inputs(), time.len() - 1);
    for (tau, time) in inputs.column_mut(0).iter_mut().zip(&time[1..]) {
        *tau = (time - first) / (last - first);
    }
    for (at, column) in trajectory.states.iter().take(problem.layout.x).enumerate() {
        inputs.column_mut(1 + at).copy_from_slice(&column[1..]);
    }
    for at in 0..trajectory.controls.len() {
        let column = controls_at_ends(trajectory, at);
        inputs.column_mut(1 + problem.layout.x + at).copy_from_slice(&column);
    }
    let mut values = Columns::new(path.outputs(), time.len() - 1);
    path.value(&inputs, &trajectory.parameters, &mut values);
    values
}

/// A control at the end of each interval.
fn controls_at_ends(trajectory: &Trajectory, control: usize) -> Vec<f64> {
    let (time, nodes) = (&trajectory.time, trajectory.nodes.as_ref());
    let intervals = time.len() - 1;
    match nodes {
        Some(nodes) if nodes.time.len() == time.len() => nodes.values[control][1..].to_vec(),
        Some(nodes) if nodes.time.len() % intervals == 0 => {
            let pieces = polynomials(trajectory, control).into_iter();
            pieces.map(|piece| piece.at(piece.ends[1])).collect()
        }
        _ => trajectory.controls[control].clone(),
    }
}
