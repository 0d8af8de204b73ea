//! An earlier solution with jumps, cut at them, for the problem in which its phases are side by
//! side.

use super::{normalised, widths};
use crate::record::{Record, find, number, whole};
use fdcc_runtime::nlp::Start;
use fdcc_runtime::problem::{Chain, Problem};
use fdcc_runtime::solve::warm_start::{Earlier, from_earlier};

/// The start from the solution, whose jumps are those of the problem; nothing if it is not whole.
/// `between` is what holds between the jumps.
pub(crate) fn start(record: &Record, between: &Problem, problem: &Problem) -> Option<Start> {
    let phases = record.jumps.len() + 1;
    let intervals = (record.time.len().checked_sub(1)?) / phases;
    let cut = Cut { record, phases, intervals };
    let shown = between.states.iter().filter(|state| !state.hidden);
    let states = cut.all(shown.map(|state| cut.state(&state.name)).collect());
    let controls =
        cut.all(between.controls.iter().map(|control| cut.control(&control.name)).collect());
    let names = between.unknowns.iter().map(|unknown| &between.parameters[unknown.parameter].name);
    let mut unknowns: Vec<Option<f64>> = names.map(|name| number(&record.free, name)).collect();
    unknowns.extend(cut.durations());
    let times = normalised(record.time.get(..=intervals)?);
    (intervals * phases + 1 == record.time.len() && cut.is_at_jumps()).then(|| {
        let widths = widths(record, problem);
        let earlier = Earlier { times, states, controls, unknowns, widths };
        from_earlier(&Chain::single(problem.clone()), &[earlier])
    })
}

/// A solution of several phases with so many intervals each.
struct Cut<'s> {
    record: &'s Record<'s>,
    phases: usize,
    intervals: usize,
}

/// One column for each phase.
type Columns = Vec<Option<Vec<f64>>>;

impl Cut<'_> {
    /// Whether the phases begin where jumps happen: a surface that was crossed without a jump ended
    /// a phase, too.
    fn is_at_jumps(&self) -> bool {
        let begins = self.record.time.iter().step_by(self.intervals.max(1)).skip(1);
        self.record.jumps.iter().zip(begins).all(|(jump, begin)| jump.time == *begin)
    }

    /// Those of the first phase, then those of the second, and so on.
    fn all(&self, signals: Vec<Columns>) -> Columns {
        (0..self.phases).flat_map(|j| signals.iter().map(move |phases| phases[j].clone())).collect()
    }

    /// A phase ends with the state before the jump.
    fn state(&self, name: &str) -> Columns {
        let end = |j: usize| match self.record.jumps.get(j) {
            Some(jump) => number(&jump.before, name),
            None => find(&self.record.states, name)?.last().copied().filter(|it| it.is_finite()),
        };
        let phase = |j| {
            let mut column = self.phase(&self.record.states, name, j)?;
            column.push(end(j)?);
            Some(column)
        };
        (0..self.phases).map(phase).collect()
    }

    fn control(&self, name: &str) -> Columns {
        (0..self.phases).map(|j| self.phase(&self.record.controls, name, j)).collect()
    }

    /// What begins at the grid points of a phase; nothing if there is a hole in it.
    fn phase(&self, of: &[(&str, &[f64])], name: &str, j: usize) -> Option<Vec<f64>> {
        whole(find(of, name)?.get(j * self.intervals..(j + 1) * self.intervals)?)
    }

    /// Of all phases but the last.
    fn durations(&self) -> impl Iterator<Item = Option<f64>> {
        let ends = self.record.jumps.iter().map(|jump| jump.time);
        let begins = self.record.time.first().copied().into_iter().chain(ends.clone());
        begins.zip(ends).map(|(begin, end)| Some(end - begin).filter(|it| it.is_finite()))
    }
}
