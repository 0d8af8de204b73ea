//! Points on kinks of the functions of surfaces: `psi = x + max(0, y)` where `y` is 0, which may be
//! a surface itself.
//!
//! What is to come depends on the slopes behind the kink, on the side to which the motion leads. So
//! each choice is judged by the slopes on its own side.

use super::Corner;
use crate::simulate::tuning::modes::TIE;

impl Corner<'_, '_> {
    /// Takes the slopes of the surfaces on the sides of their kinks to which a rate leads.
    pub(super) fn go_behind_bends(&mut self, rate: &[f64], selectors: &[f64]) {
        let first = self.field.modes.len();
        if self.bends.is_empty() && !self.turns {
            return;
        }
        let (kinks, mut selectors) = (self.field.kinks(self.t, self.x), selectors.to_vec());
        for &kink in &self.bends {
            let side = if kinks.rate(kink, rate) > 0.0 { 1.0 } else { -1.0 };
            (selectors[first + kink], self.field.selectors[first + kink]) = (side, side);
        }
        self.normals = self.field.normals_with(self.t, self.x, &selectors);
    }

    /// Whether all selectors lead to the same sides of the kinks, so that one linear problem is all
    /// there is.
    pub(super) fn is_one_piece(&mut self) -> bool {
        if self.turns || self.bends.is_empty() {
            return !self.turns;
        }
        let kinks = self.field.kinks(self.t, self.x);
        let mut selectors = self.field.selectors.clone();
        self.surfaces.iter().for_each(|&i| selectors[i] = 0.0);
        let (rate, by_selector) = self.field.with_selectors(self.t, self.x, &selectors);
        self.bends.iter().all(|&kink| {
            let slope = kinks.by_state.row(kink) * &by_selector;
            let most: f64 = self.surfaces.iter().map(|&i| slope[i].abs()).sum();
            kinks.rate(kink, &rate).abs() > (1.0 + TIE) * most
        })
    }
}
