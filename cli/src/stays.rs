//! On which side of each surface a simulation is, and from when to when.

use fdcc_runtime::modes::{self, Span};
use fdcc_runtime::simulate::{Mode, Piece, Tape};

/// The spans of time of one surface, in order.
pub fn stays(tape: &Tape, surface: usize) -> Vec<Span> {
    let mut stays: Vec<Span> = Vec::new();
    for piece in &tape.pieces {
        let Piece::Step { start, h, .. } = piece else { continue };
        let (from, to) = (start.time, start.time + h);
        let mode = side(tape.regimes[start.regime].modes[surface]);
        match stays.last_mut().filter(|stay| stay.mode == mode) {
            Some(stay) => stay.to = to,
            None => stays.push(Span { mode, from, to }),
        }
    }
    stays
}

/// For how long a surface is held.
pub fn held(stays: &[Span]) -> f64 {
    stays.iter().filter(|stay| stay.mode == modes::Mode::Held).map(|stay| stay.to - stay.from).sum()
}

fn side(mode: Mode) -> modes::Mode {
    match mode {
        Mode::Below => modes::Mode::Below,
        Mode::Above => modes::Mode::Above,
        Mode::Sliding | Mode::Held => modes::Mode::Held,
    }
}
