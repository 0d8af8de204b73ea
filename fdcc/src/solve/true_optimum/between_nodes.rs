//! Shorter intervals where controls, and limits on which they act, leave their bounds between the
//! nodes of a few intervals: where a control is steep inside of a phase.

use super::contacts::Contacts;
use super::minimum::interpolation;
use super::polynomials::{Polynomial, polynomials};
use super::range::{Range, ranges};
use super::structure::Structure;
use super::tuning::between_nodes::{FEW, MOST_PLACES, PART, PARTS};
use super::tuning::structure::BEYOND;
use super::{Located, Search};
use fdcc_runtime::problem::Columns;
use fdcc_runtime::solution::Trajectory;

impl Search<'_> {
    /// The structure with shorter intervals there; nothing where that is nowhere, or in many
    /// places, or was done often enough.
    pub(super) fn sharpened(&self, located: &Located) -> Option<Structure> {
        let allowed = PART * self.problem.method.accuracy.map_or(BEYOND, |it| 0.5 * it);
        let contacts = Contacts::new(self.model, located);
        let ranges = ranges(&self.problem.controls, &located.outcome.phases);
        let mut other = located.structure.clone();
        for (j, phase) in other.phases.iter_mut().enumerate() {
            let all = violations(&ranges, &contacts, j);
            let trajectory = &located.outcome.phases[j].trajectory;
            let wrong: Vec<usize> = (0..all.len()).filter(|k| all[*k] > allowed).collect();
            if wrong.len() as f64 > FEW * all.len() as f64 {
                return None;
            }
            let runs = wrong.chunk_by(|a, b| a + 1 == *b);
            let worst =
                runs.filter_map(|it| it.iter().max_by(|a, b| all[**a].total_cmp(&all[**b])));
            phase.steep.extend(worst.map(|k| middle(trajectory, *k)));
            if phase.steep.len() > MOST_PLACES {
                return None;
            }
        }
        (other.phases != located.structure.phases).then_some(other)
    }
}

/// The middle of an interval, in parts of 2^16 of the duration of its phase.
fn middle(Trajectory { time, .. }: &Trajectory, k: usize) -> u16 {
    let [first, last] = [time[0], time[time.len() - 1]];
    let part = (0.5 * (time[k] + time[k + 1]) - first) / (last - first);
    (part * f64::from(u16::MAX)).round() as u16
}

/// By how much controls and limits leave their bounds on each interval, for their ranges.
fn violations(ranges: &[Range], contacts: &Contacts, j: usize) -> Vec<f64> {
    let trajectory = &contacts.located.outcome.phases[j].trajectory;
    let mut most = vec![0.0; trajectory.time.len() - 1];
    for (at, range) in ranges.iter().enumerate() {
        let pieces = polynomials(trajectory, at);
        let own = pieces.iter().map(|it| it.violation(range.bounds) / range.width);
        most.iter_mut().zip(own).for_each(|(most, own): (&mut f64, f64)| *most = most.max(own));
    }
    let of_controls = |limit: &usize| contacts.limits[*limit].order == Some(0);
    for limit in (0..contacts.limits.len()).filter(of_controls) {
        let own = of_limit(contacts, j, limit);
        most.iter_mut().zip(own).for_each(|(most, own)| *most = most.max(own));
    }
    most
}

fn of_limit(contacts: &Contacts, j: usize, limit: usize) -> Vec<f64> {
    let (problem, row) = (&contacts.located.chain.phases[j], contacts.row(j, limit));
    let trajectory = &contacts.located.outcome.phases[j].trajectory;
    let points = points(trajectory, problem.path.layout().point_inputs());
    let mut values = Columns::new(problem.path.outputs(), points.count());
    problem.path.value(&points, &trajectory.parameters, &mut values);
    let off = |value: &f64| problem.path_bounds[row].violation(*value) / contacts.ranges[limit];
    let each = values.column(row).chunks(PARTS);
    each.map(|it| it.iter().map(off).fold(0.0, f64::max)).collect()
}

/// The inputs of path conditions at some points of each interval.
fn points(trajectory: &Trajectory, inputs: usize) -> Columns {
    let time = &trajectory.time;
    let [first, last] = [time[0], time[time.len() - 1]];
    let controls: Vec<Vec<Polynomial>> =
        (0..trajectory.controls.len()).map(|at| polynomials(trajectory, at)).collect();
    let mut points = Columns::new(inputs, PARTS * (time.len() - 1));
    for k in 0..time.len() - 1 {
        for part in 0..PARTS {
            let (at, within) = (PARTS * k + part, (part as f64 + 0.5) / PARTS as f64);
            let now = time[k] + within * (time[k + 1] - time[k]);
            let state = interpolation(time, (k, within));
            let states = trajectory.states.iter().map(|column| state(column));
            let control = |(own, pieces): (&Vec<f64>, &Vec<Polynomial>)| {
                pieces.get(k).map_or(own[k], |it| it.at(now))
            };
            let controls = trajectory.controls.iter().zip(&controls).map(control);
            let all = [(now - first) / (last - first)].into_iter().chain(states).chain(controls);
            all.enumerate().for_each(|(input, value)| points.column_mut(input)[at] = value);
        }
    }
    points
}
