//! The watchdog: after many shortened steps, full steps are tried without asking the filter.
//!
//! Where the rows are very nonlinear, as at the edge of a smoothed layer, the filter may force tiny
//! steps although a full one would lead to a better region. A few full steps are taken; if
//! none of them is acceptable to the point where they began, the iteration returns to it
//! (Waechter & Biegler 2006, section 3.2).

use super::filter::Reference;
use super::iterate::{Iterate, Values};
use super::tuning::watchdog::{PATIENCE, SHORTENED, WATCHDOG_STEPS};

/// Where the watchdog steps began.
pub(super) struct Saved {
    pub(super) at: Iterate,
    pub(super) values: Values,
    pub(super) reference: Reference,
    pub(super) alpha: f64,
    left: usize,
}

/// Counts shortened steps, and keeps the point to return to.
#[derive(Default)]
pub(super) struct Watchdog {
    shortened: usize,
    pub(super) saved: Option<Saved>,
}

impl Watchdog {
    /// Notes how much of a step was kept, and whether it had been made shorter before.
    pub(super) fn note(&mut self, fraction: f64, is_cautious: bool) {
        self.shortened = if fraction < SHORTENED || is_cautious { self.shortened + 1 } else { 0 };
    }

    /// Whether it is time to begin.
    pub(super) fn is_due(&self) -> bool {
        self.saved.is_none() && self.shortened >= PATIENCE
    }

    pub(super) fn begin(&mut self, at: Iterate, values: Values, reference: Reference, alpha: f64) {
        self.saved = Some(Saved { at, values, reference, alpha, left: WATCHDOG_STEPS });
    }

    /// Uses up one watchdog step; `false` if there is none left.
    pub(super) fn take_step(&mut self) -> bool {
        match &mut self.saved {
            Some(saved) if saved.left > 0 => {
                saved.left -= 1;
                true
            }
            _ => false,
        }
    }

    /// Ends it; the point to return to, if it did not succeed.
    pub(super) fn end(&mut self) -> Option<Saved> {
        let saved = self.saved.take();
        if saved.is_some() {
            self.shortened = 0;
        }
        saved
    }
}
