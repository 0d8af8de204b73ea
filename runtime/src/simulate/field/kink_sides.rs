//! On which side of each kink of the right side the state is.
//!
//! The right side is continuous there, so a side that is wrong by rounding does no harm. On the
//! kink itself the side is the one to which the state goes.

use super::Field;
use crate::simulate::tuning::field::ON_SURFACE;
use crate::simulate::tuning::modes::TIE;

impl Field<'_> {
    /// -1 below a kink, 1 above.
    pub fn side_of(&self, kink: usize) -> f64 {
        self.selectors[self.modes.len() + kink]
    }

    /// The state crosses a kink.
    pub fn cross_kink(&mut self, kink: usize) {
        let place = self.modes.len() + kink;
        self.selectors[place] = -self.selectors[place];
    }

    /// The kinks that a point is on and at which functions of some surfaces bend: their slopes are
    /// others on both sides. One that has just been crossed is among them, however it is rounded.
    pub fn bends_here(&mut self, t: f64, x: &[f64], surfaces: &[usize]) -> Vec<usize> {
        let (kinks, first) = (self.kinks(t, x), self.modes.len());
        let is_on = |field: &Self, kink: usize| {
            field.crossed == Some(kink)
                || kinks.psi[kink].abs() <= ON_SURFACE * kinks.noise(kink, x)
        };
        let here: Vec<usize> = (0..kinks.psi.len()).filter(|kink| is_on(self, *kink)).collect();
        here.into_iter().filter(|kink| self.bends_at(first + kink, (t, x), surfaces)).collect()
    }

    /// Whether functions of some surfaces that a point is on bend at others of them.
    pub fn bend_each_other(&mut self, t: f64, x: &[f64], surfaces: &[usize]) -> bool {
        surfaces.len() > 1 && surfaces.iter().any(|&at| self.bends_at(at, (t, x), surfaces))
    }

    /// Whether functions of surfaces have other slopes on both sides of what has this selector.
    pub fn bends_at(&mut self, place: usize, (t, x): (f64, &[f64]), surfaces: &[usize]) -> bool {
        let [below, above] = [-1.0, 1.0].map(|side| {
            let mut selectors = self.selectors.clone();
            selectors[place] = side;
            self.normals_with(t, x, &selectors)
        });
        let differs = |&i: &usize| {
            below.by_time[i] != above.by_time[i] || below.by_state.row(i) != above.by_state.row(i)
        };
        surfaces.iter().any(differs)
    }

    /// Finds the sides anew; the kinks that a point is on and to which its rate is tangent.
    pub fn find_sides_of_kinks(&mut self, t: f64, x: &[f64]) -> Vec<usize> {
        let first = self.modes.len();
        let mut tangent = Vec::new();
        // Each pass is right for one more kink inside others.
        for _ in 0..self.system.kinks.outputs() {
            let kinks = self.kinks(t, x);
            let rate = self.rate(t, x);
            tangent.clear();
            for kink in 0..kinks.psi.len() {
                let is_off = kinks.psi[kink].abs() > ON_SURFACE * kinks.noise(kink, x);
                let ahead = if is_off { kinks.psi[kink] } else { kinks.rate(kink, &rate) };
                if !is_off && ahead.abs() <= TIE * kinks.speed(kink, &rate) {
                    tangent.push(kink);
                }
                self.selectors[first + kink] = if ahead > 0.0 { 1.0 } else { -1.0 };
            }
        }
        tangent
    }
}
