//! An earlier solution with jumps, cut at them, for the problem in which its pieces are side by
//! side.

use super::normalised;
use crate::output::named::Named;
use crate::output::saved::{Column, Saved, SavedJump};
use fdcc_runtime::nlp::Start;
use fdcc_runtime::problem::Problem;
use fdcc_runtime::solve::warm_start::Earlier;
use fdcc_runtime::solve::warm_start::from_earlier;

/// The start from the solution, whose jumps are those of the problem; nothing if it is not whole.
/// `between` is what holds between the jumps.
pub fn start(saved: &Saved, between: &Problem, problem: &Problem) -> Option<Start> {
    let pieces = saved.jumps.len() + 1;
    let intervals = (saved.time.len().checked_sub(1)?) / pieces;
    let cut = Cut { saved, pieces, intervals };
    let shown = between.states.iter().filter(|state| !state.hidden);
    let states = cut.all(shown.map(|state| cut.state(&state.name)).collect());
    let controls =
        cut.all(between.controls.iter().map(|control| cut.control(&control.name)).collect());
    let names = between.unknowns.iter().map(|unknown| &between.parameters[unknown.parameter].name);
    let mut unknowns: Vec<Option<f64>> =
        names.map(|name| saved.free.get(name).copied().flatten()).collect();
    unknowns.extend(cut.lengths());
    let times = normalised(saved.time.get(..=intervals)?);
    (intervals * pieces + 1 == saved.time.len() && cut.is_at_jumps()).then(|| {
        from_earlier(
            problem,
            &Earlier { times, states, controls, unknowns, widths: saved.widths(problem) },
        )
    })
}

/// A solution of several pieces with so many intervals each.
struct Cut<'s> {
    saved: &'s Saved,
    pieces: usize,
    intervals: usize,
}

/// One column for each piece.
type Columns = Vec<Option<Vec<f64>>>;

impl Cut<'_> {
    /// Whether the pieces begin where jumps happen: a surface that was crossed without a jump ended
    /// a piece, too.
    fn is_at_jumps(&self) -> bool {
        let begins = self.saved.time.iter().step_by(self.intervals.max(1)).skip(1);
        self.saved.jumps.iter().zip(begins).all(|(jump, begin)| jump.time == *begin)
    }

    /// Those of the first piece, then those of the second, and so on.
    fn all(&self, signals: Vec<Columns>) -> Columns {
        (0..self.pieces).flat_map(|j| signals.iter().map(move |pieces| pieces[j].clone())).collect()
    }

    /// A piece ends with the state before the jump.
    fn state(&self, name: &str) -> Columns {
        let end = |j: usize| match self.saved.jumps.get(j) {
            Some(SavedJump { before, .. }) => before.get(name).copied().flatten(),
            None => self.saved.states.get(name)?.last().copied().flatten(),
        };
        let piece = |j| {
            let mut column = self.piece(&self.saved.states, name, j)?;
            column.push(end(j)?);
            Some(column)
        };
        (0..self.pieces).map(piece).collect()
    }

    fn control(&self, name: &str) -> Columns {
        (0..self.pieces).map(|j| self.piece(&self.saved.controls, name, j)).collect()
    }

    /// What begins at the grid points of a piece; nothing if there is a hole in it.
    fn piece(&self, of: &Named<Column>, name: &str, j: usize) -> Option<Vec<f64>> {
        of.get(name)?.get(j * self.intervals..(j + 1) * self.intervals)?.iter().copied().collect()
    }

    /// Of all pieces but the last.
    fn lengths(&self) -> impl Iterator<Item = Option<f64>> {
        let ends = self.saved.jumps.iter().map(|jump| jump.time);
        let begins = self.saved.time.first().copied().into_iter().chain(ends.clone());
        begins.zip(ends).map(|(begin, end)| Some(end? - begin?))
    }
}
