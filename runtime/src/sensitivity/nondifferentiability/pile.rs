//! States that the jumps of a pile change, all of them together: what they come to is known, but
//! not what it depends on.

use super::TOUCHING;
use super::kink::{Kink, KinkMet};
use crate::sensitivity::linearised::linearisation::Lineariser;
use crate::simulate::{Instant, Piece, Tape};

/// The first state that jumps which pile up move elsewhere than straight on, unless the surface
/// alone says where it comes to rest.
pub(crate) fn moved_by_pile(lineariser: &Lineariser, tape: &Tape) -> Option<Kink> {
    tape.pieces.iter().find_map(|piece| {
        let Piece::Event { before, after, changes, .. } = piece else { return None };
        let all: Vec<&Instant> =
            [before].into_iter().chain(changes.iter().map(|it| &it.after)).collect();
        let pair = all.windows(2).find(|pair| pair[1].time > pair[0].time)?;
        let (gap, rate) = (pair[1].time - pair[0].time, lineariser.rate_at_instant(tape, pair[0]));
        let [was, held] = [before, after].map(|at| &tape.regimes[at.regime].held);
        // One that stands still is where the surface has it; several share what is left.
        let stopped = held.iter().filter(|it| !was.contains(it)).count();
        let is_moved = |i: &usize| {
            let [from, to] = [pair[0], pair[1]].map(|at| at.state[*i]);
            let off = (to - from - gap * rate[*i]).abs();
            (stopped > 1 || !held.contains(i)) && off > TOUCHING * largest(tape, *i)
        };
        let state = (0..before.state.len()).find(is_moved)?;
        let of = lineariser.system.states[state].origin.clone();
        Some(Kink { of, met: KinkMet::ByPile(pair[1].time) })
    })
}

/// How large a state is anywhere.
fn largest(tape: &Tape, state: usize) -> f64 {
    let sizes = tape.pieces.iter().map(|piece| piece.end().state[state].abs());
    sizes.fold(0.0, f64::max)
}
