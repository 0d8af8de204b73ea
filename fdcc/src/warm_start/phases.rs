//! An earlier solution cut at jumps, or at other times: an earlier solution of each phase.

use super::{normalised, widths};
use crate::record::{Record, find, number, whole};
use fdcc_runtime::nlp::Start;
use fdcc_runtime::problem::{Chain, Problem};
use fdcc_runtime::solve::warm_start::{Earlier, from_earlier};
use std::ops::Range;

/// The start from the solution, whose jumps are those of the chain; nothing if it is not whole.
/// `between` is what holds between the jumps.
pub(crate) fn start(record: &Record, between: &Problem, chain: &Chain) -> Option<Start> {
    let cut = Cut { record, between, chain, first: [0; 2] };
    Some(from_earlier(chain, &cut.phases(chain.phases.len())?))
}

/// The same of a model with phases: `between` has the problem of each, without its jumps and
/// with all unknowns, and into how many phases of the chain it is divided.
pub(crate) fn start_in_phases(
    record: &Record,
    between: &[(&Problem, usize)],
    chain: &Chain,
) -> Option<Start> {
    let (mut all, mut first) = (Vec::new(), [0; 2]);
    for (between, count) in between {
        let record = record.phases.iter().find(|it| *it.model == *between.name)?;
        let cut = Cut { record, between, chain, first };
        all.extend(cut.phases(*count)?);
        first = [first[0] + count, first[1] + count - 1];
    }
    Some(from_earlier(chain, &all))
}

/// The intervals of each phase, which begins at the time of a jump.
fn intervals(record: &Record, phases: usize) -> Option<Vec<Range<usize>>> {
    let last = record.time.len().checked_sub(1)?;
    let mut begins = vec![0];
    for jump in &record.jumps {
        // A phase has an interval at least, which may be of no length.
        let first = begins[begins.len() - 1] + 1;
        let later = record.time.get(first..last)?.iter().position(|time| *time == jump.time)?;
        begins.push(first + later);
    }
    let ends = begins[1..].iter().copied().chain([last]);
    let all: Vec<Range<usize>> = begins.iter().copied().zip(ends).map(|(a, b)| a..b).collect();
    (all.len() == phases).then_some(all)
}

/// The start from a solution without jumps, whose phases begin where its grid is nearest to some
/// ascending times; nothing if it is not whole.
pub(crate) fn start_at(
    record: &Record,
    times: &[f64],
    between: &Problem,
    chain: &Chain,
) -> Option<Start> {
    let last = record.time.len().checked_sub(1)?;
    let distance = |k: &usize, time: f64| (record.time[*k] - time).abs();
    let nearest =
        |time: &f64| (1..last).min_by(|a, b| distance(a, *time).total_cmp(&distance(b, *time)));
    let inner: Vec<usize> = times.iter().map(nearest).collect::<Option<_>>()?;
    let begins: Vec<usize> = std::iter::once(0).chain(inner).chain([last]).collect();
    let intervals: Vec<Range<usize>> = begins.windows(2).map(|pair| pair[0]..pair[1]).collect();
    if !record.jumps.is_empty() || intervals.iter().any(Range::is_empty) {
        return None;
    }
    let cut = Cut { record, between, chain, first: [0; 2] };
    let phases = intervals.into_iter().enumerate().map(|(j, own)| cut.phase(j, own));
    Some(from_earlier(chain, &phases.collect::<Vec<_>>()))
}

/// A solution of several pieces.
struct Cut<'s> {
    record: &'s Record<'s>,
    between: &'s Problem,
    chain: &'s Chain,
    /// Of the chain, how many phases and jumps are those of other phases of the model.
    first: [usize; 2],
}

impl Cut<'_> {
    /// So many, with a jump between each two; nothing if it has other jumps.
    fn phases(&self, count: usize) -> Option<Vec<Earlier>> {
        let intervals = intervals(self.record, count)?;
        Some(intervals.into_iter().enumerate().map(|(j, own)| self.phase(j, own)).collect())
    }

    fn phase(&self, j: usize, intervals: Range<usize>) -> Earlier {
        let (record, problem) = (self.record, &self.chain.phases[self.first[0] + j]);
        let times = &record.time[intervals.start..=intervals.end];
        let shown = self.between.states.iter().filter(|state| !state.hidden);
        let own =
            |of: &[(&str, &[f64])], name: &str| whole(find(of, name)?.get(intervals.clone())?);
        let state = |name: &str| {
            let mut column = own(&record.states, name)?;
            column.push(self.end(j, intervals.end, name)?);
            Some(column)
        };
        let mut states: Vec<Option<Vec<f64>>> = shown.map(|it| state(&it.name)).collect();
        states.resize(problem.states.len(), None);
        let controls = problem.controls.iter();
        Earlier {
            times: normalised(times),
            states,
            controls: controls.map(|it| own(&record.controls, &it.name)).collect(),
            unknowns: problem.unknowns.iter().map(|it| self.unknown(it.parameter)).collect(),
            widths: widths(record, problem),
            pieces: Vec::new(),
        }
    }

    /// A phase ends with the state before the jump.
    fn end(&self, j: usize, point: usize, name: &str) -> Option<f64> {
        match self.record.jumps.get(j) {
            Some(jump) => number(&jump.before, name),
            None => {
                find(&self.record.states, name)?.get(point).copied().filter(|it| it.is_finite())
            }
        }
    }

    /// The unknowns of the model, then the times of the jumps.
    fn unknown(&self, parameter: usize) -> Option<f64> {
        let at = self.chain.unknowns.iter().position(|it| it.parameter == parameter)?;
        match at.checked_sub(self.between.unknowns.len()) {
            Some(jump) => {
                let own = self.record.jumps.get(jump.checked_sub(self.first[1])?);
                own.map(|it| it.time).filter(|it| it.is_finite())
            }
            None => number(&self.record.free, &self.between.parameters[parameter].name),
        }
    }
}
