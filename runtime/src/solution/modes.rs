//! What a smoothed trajectory says about each surface: below, held or above, and from when to when.
//!
//! The layer is `|psi| <= sigma`. A passage from one side of it to the other is a crossing, cut at
//! the zero of `psi`; any longer stay inside counts as held. The true system has the last word.

/// Where the trajectory is, relative to a surface.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Mode {
    /// `psi < 0`
    Below,
    /// `psi` stays in the smoothed layer.
    Held,
    /// `psi > 0`
    Above,
}

/// A time span in one mode.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Span {
    /// The mode.
    pub mode: Mode,
    /// First time.
    pub from: f64,
    /// Last time.
    pub to: f64,
}

/// A stay in the layer of fewer grid points than this is not called held.
const SHORTEST_STAY: usize = 3;

/// The modes of one surface along a grid.
pub fn modes(time: &[f64], psi: &[f64], sigma: f64) -> Vec<Span> {
    let mut mode: Vec<Mode> = psi.iter().map(|psi| side(*psi, sigma)).collect();
    let mut start = 0;
    while start < mode.len() {
        let length = mode[start..].iter().take_while(|m| **m == mode[start]).count();
        if mode[start] == Mode::Held {
            resolve_stay(&mut mode, psi, start, start + length);
        }
        start += length;
    }
    spans(time, &mode)
}

fn side(psi: f64, sigma: f64) -> Mode {
    match psi {
        _ if psi > sigma => Mode::Above,
        _ if psi < -sigma => Mode::Below,
        _ => Mode::Held,
    }
}

/// Turns a passage or a touch into the modes before and after it.
fn resolve_stay(mode: &mut [Mode], psi: &[f64], start: usize, end: usize) {
    let inside = &psi[start..end];
    let rises = inside.windows(2).all(|pair| pair[1] >= pair[0]);
    let falls = inside.windows(2).all(|pair| pair[1] <= pair[0]);
    let before = start.checked_sub(1).map(|i| psi[i] > 0.0);
    let after = psi.get(end).map(|psi| *psi > 0.0);
    let passes = before.is_some() && after.is_some() && before != after && (rises || falls);
    if passes || end - start < SHORTEST_STAY {
        for i in start..end {
            mode[i] = if psi[i] > 0.0 { Mode::Above } else { Mode::Below };
        }
    }
}

fn spans(time: &[f64], mode: &[Mode]) -> Vec<Span> {
    let mut spans: Vec<Span> = Vec::new();
    for (t, mode) in time.iter().zip(mode) {
        match spans.last_mut() {
            Some(last) if last.mode == *mode => last.to = *t,
            Some(last) => {
                last.to = *t;
                spans.push(Span { mode: *mode, from: *t, to: *t });
            }
            None => spans.push(Span { mode: *mode, from: *t, to: *t }),
        }
    }
    spans
}

#[cfg(test)]
mod tests {
    use super::*;

    fn named(psi: &[f64]) -> Vec<Mode> {
        let time: Vec<f64> = (0..psi.len()).map(|k| k as f64).collect();
        modes(&time, psi, 0.1).iter().map(|span| span.mode).collect()
    }

    #[test]
    fn a_passage_is_a_crossing_and_a_stay_is_held() {
        assert_eq!(named(&[-1.0, -0.05, 0.0, 0.05, 1.0]), [Mode::Below, Mode::Above]);
        assert_eq!(
            named(&[-1.0, -0.05, -0.04, -0.05, -1.0]),
            [Mode::Below, Mode::Held, Mode::Below]
        );
        assert_eq!(named(&[0.0, 0.0, 0.0, 0.5]), [Mode::Held, Mode::Above]);
        assert_eq!(named(&[1.0, 0.05, 1.0]), [Mode::Above]);
    }
}
