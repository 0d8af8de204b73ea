//! On which side of each surface the state is, at the start and after a jump, and of each kink.
//!
//! The function of a surface may have a kink that is another surface, `abs(x) - 1` beside `x`. It
//! is known once the side of that one is.

use super::Run;
use crate::simulate::mode::Mode;
use crate::simulate::steps::Step;
use crate::simulate::tuning::field::ON_SURFACE;
use crate::simulate::tuning::modes::AHEAD;

impl Run<'_> {
    /// Gives every surface that the state is not on the side of the state.
    pub fn find_sides(&mut self) {
        let given = self.field.modes.clone();
        // Each pass is right for one more surface whose function has a kink on another one.
        for _ in 0..=given.len() {
            let before = self.field.modes.clone();
            self.look_at_sides(&given);
            if self.field.modes == before {
                return;
            }
        }
    }

    /// The sides, as far as those of kinks are known; what is on a surface keeps the mode that was
    /// given.
    fn look_at_sides(&mut self, given: &[Mode]) {
        self.find_sides_of_kinks();
        self.field.find_rounding(self.t, &self.x);
        let normals = self.field.normals(self.t, &self.x);
        for (i, &mode) in given.iter().enumerate() {
            let psi = normals.psi[i];
            let is_off = psi.abs() > ON_SURFACE * normals.noise(i, &self.x);
            match self.field.ball_of(i) {
                Some(ball) if is_off => self.field.set_moving(ball),
                None if is_off && mode != Mode::Held => {
                    self.field.set_mode(i, if psi > 0.0 { Mode::Above } else { Mode::Below });
                }
                None if self.field.modes[i] != mode => self.field.set_mode(i, mode),
                _ => {}
            }
        }
    }

    /// Finds on which side of each kink the state is. Along one to which the rate is tangent, a
    /// short step tells it: what rises from rest is above.
    pub fn find_sides_of_kinks(&mut self) {
        let (t, field) = (self.t, &mut self.field);
        let tangent = field.find_sides_of_kinks(t, &self.x);
        let [begin, last] = field.system.interval;
        let h = (AHEAD * (last - begin)).min(last - t);
        if tangent.is_empty() || h <= 0.0 {
            return;
        }
        let before = (field.selectors.clone(), field.evaluations);
        let Step { end, error, .. } = Step::take(field, t, &self.x, h);
        let later = field.kinks(t + h, &end);
        (field.selectors, field.evaluations) = before;
        let rises = |kink: &usize| later.psi[*kink] > ON_SURFACE * later.noise(*kink, &end);
        let first = field.modes.len();
        for kink in tangent.into_iter().filter(|kink| error <= 1.0 && rises(kink)) {
            field.selectors[first + kink] = 1.0;
        }
    }
}
