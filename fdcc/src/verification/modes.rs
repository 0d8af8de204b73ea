//! On which side of each surface a simulation is, and from when to when.

use fdcc_runtime::simulate::{Mode, Piece, Tape};

/// A time span in one mode of a surface.
///
/// ```
/// let model = fdcc::Model::from_file("../models/block.fdc")?;
/// let replay = model.solve(&fdcc::Options::default())?.verify()?;
/// let stays = &replay.stays[0];
/// assert!(stays.iter().all(|stay| stay.to > stay.from) && stays.len() >= 2);
/// println!("first {}", fdcc::modes::name(stays[0].mode));
/// # Ok::<(), fdcc::Error>(())
/// ```
pub struct Stay {
    /// On which side, or held.
    pub mode: Mode,
    /// When it begins, in SI.
    pub from: f64,
    /// When it ends, in SI.
    pub to: f64,
}

/// The spans of time of one surface, in order.
pub(super) fn stays(tape: &Tape, surface: usize) -> Vec<Stay> {
    let mut stays: Vec<Stay> = Vec::new();
    for piece in &tape.pieces {
        let Piece::Step { start, h, .. } = piece else { continue };
        let (from, to) = (start.time, start.time + h);
        let mode = tape.regimes[start.regime].modes[surface];
        match stays.last_mut().filter(|stay| name(stay.mode) == name(mode)) {
            Some(stay) => stay.to = to,
            None => stays.push(Stay { mode, from, to }),
        }
    }
    stays
}

/// For how long a surface is held.
pub fn held(stays: &[Stay]) -> f64 {
    let held = stays.iter().filter(|stay| name(stay.mode) == "held");
    held.fold(0.0, |sum, stay| sum + stay.to - stay.from) // `sum()` of nothing is -0
}

/// The name of a mode in files and tables.
pub fn name(mode: Mode) -> &'static str {
    match mode {
        Mode::Below => "below",
        Mode::Above => "above",
        Mode::Moving => "moving",
        Mode::Sliding | Mode::Held => "held",
    }
}
