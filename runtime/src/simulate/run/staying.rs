//! States that come to a surface and stay on it although nothing holds them there: a stone that
//! lands without rebound.
//!
//! Where no selector of the surface acts on the right side, both sides have the same future, so
//! none has to be chosen: the mode goes on.

use super::Run;
use crate::simulate::mode::Mode;
use crate::simulate::steps::Step;
use crate::simulate::tuning::field::ON_SURFACE;
use crate::simulate::tuning::modes::TIE;
use crate::simulate::tuning::staying::AHEAD;

impl Run<'_> {
    /// Whether the state stays on a surface whose side nothing depends on.
    pub fn stays_beside(&mut self, surface: usize) -> bool {
        if !matches!(self.field.modes[surface], Mode::Below | Mode::Above) {
            return false;
        }
        let selectors = self.field.selectors.clone();
        let (rate, by_selector) = self.field.with_selectors(self.t, &self.x, &selectors);
        if by_selector.column(surface).iter().any(|entry| *entry != 0.0) {
            return false;
        }
        let normals = self.field.normals(self.t, &self.x);
        let slope = normals.by_state.row(surface);
        let terms: f64 = slope.iter().zip(&rate).map(|(d, f)| (d * f).abs()).sum();
        let largest = terms + normals.by_time[surface].abs();
        normals.rate(surface, &rate).abs() <= TIE * largest && self.is_there_still(surface)
    }

    /// Whether a short step ends on the surface.
    fn is_there_still(&mut self, surface: usize) -> bool {
        let [first, last] = self.field.system.interval;
        let h = (AHEAD * (last - first)).min(last - self.t);
        let end = Step::take(&mut self.field, self.t, &self.x, h).end;
        let normals = self.field.normals(self.t + h, &end);
        normals.psi[surface].abs() <= ON_SURFACE * normals.noise(surface, &end)
    }
}
