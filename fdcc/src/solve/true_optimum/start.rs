//! Where the solve of a structure begins: signals of an earlier answer, cut at its switches.

use super::Whole;
use super::structure::Structure;
use fdcc_compiler::Model;
use fdcc_runtime::problem::Problem;
use fdcc_runtime::solve::warm_start::Earlier;

/// Signals of a whole trajectory.
pub(super) struct Signals<'t> {
    pub from: &'t Whole,
    /// The unknowns of the model.
    pub unknowns: Vec<f64>,
    /// The times of all switches, which are unknowns of the chain behind those of the model.
    pub switches: &'t [f64],
}

impl Signals<'_> {
    /// Where the next of these problems begin, one for each phase of the structure of a model.
    pub fn phases<'p>(
        &self,
        model: &Model,
        problems: &mut impl Iterator<Item = &'p Problem>,
        structure: &Structure,
    ) -> Vec<Earlier> {
        let phases = structure.times.windows(2).zip(problems);
        phases.map(|(ends, problem)| self.phase(model, problem, ends)).collect()
    }

    fn phase(&self, model: &Model, problem: &Problem, ends: &[f64]) -> Earlier {
        let own = &self.from.outcome.trajectory;
        let inside = own.time.iter().copied().filter(|time| *time > ends[0] && *time < ends[1]);
        let times: Vec<f64> = [ends[0]].into_iter().chain(inside).chain([ends[1]]).collect();
        let shown = model.states.len();
        let jump = self.from.jumps.iter().find(|it| it.1.time == ends[1]);
        let state = |i: usize| {
            let column = own.states.get(i)?;
            // An integral that became a state is 0 where a phase begins.
            let before = if i < shown { 0.0 } else { linear(&own.time, column, ends[0]) };
            let at = |time: &f64| linear(&own.time, column, *time) - before;
            let mut values: Vec<f64> = times.iter().map(at).collect();
            // At the time of a jump a trajectory has the state behind it.
            if let (Some((_, jump)), Some(last)) = (jump.filter(|_| i < shown), values.last_mut()) {
                *last = jump.before[i];
            }
            Some(values)
        };
        let control = |i: usize| {
            let column = own.controls.get(i).filter(|_| i < model.controls.len())?;
            let middle = times.windows(2).map(|pair| 0.5 * (pair[0] + pair[1]));
            Some(middle.map(|time| column[interval(&own.time, time)]).collect())
        };
        let unknown = |parameter: usize| {
            let at = parameter - model.params.len();
            match at.checked_sub(model.frees.len()) {
                Some(switch) => self.switches.get(switch).copied(),
                None => self.unknowns.get(at).copied(),
            }
        };
        let duration = ends[1] - ends[0];
        Earlier {
            states: (0..problem.states.len()).map(state).collect(),
            controls: (0..problem.controls.len()).map(control).collect(),
            unknowns: problem.unknowns.iter().map(|it| unknown(it.parameter)).collect(),
            widths: Vec::new(),
            pieces: self.from.pieces(ends),
            times: times.iter().map(|time| (time - ends[0]) / duration).collect(),
        }
    }
}

fn interval(times: &[f64], time: f64) -> usize {
    times.partition_point(|it| *it <= time).saturating_sub(1).min(times.len() - 2)
}

fn linear(times: &[f64], column: &[f64], time: f64) -> f64 {
    let k = interval(times, time);
    let length = times[k + 1] - times[k];
    // Of a phase without a duration both ends are the same.
    let part = if length > 0.0 { (time - times[k]) / length } else { 0.0 };
    column[k] + part * (column[k + 1] - column[k])
}
