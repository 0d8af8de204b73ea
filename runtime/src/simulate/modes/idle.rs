//! Surfaces on which nothing depends but jumps: they choose nothing. What the others choose says on
//! which side of each the state goes on, or that it stays there: a block that a wall has stopped
//! and friction holds.

use super::{Choice, Corner, Next};
use crate::simulate::mode::Mode;
use crate::simulate::steps::Step;
use crate::simulate::tuning::field::ON_SURFACE;
use crate::simulate::tuning::modes::{AHEAD, TIE};

impl Corner<'_, '_> {
    /// Where idle surfaces are left behind, once the others have chosen.
    pub(super) fn beside(&mut self, choice: &Choice, idle: &[usize]) -> Vec<Next> {
        if idle.is_empty() {
            return Vec::new();
        }
        self.bends = self.field.bends_here(self.t, self.x, idle);
        let later = self.a_moment_later(choice, idle);
        let rate = self.rate(&choice.s);
        self.go_on_beside(choice, idle.iter().zip(&later), rate.as_slice());
        let next = |(&surface, later): (&usize, Option<f64>)| {
            let now = self.normals.rate(surface, rate.as_slice());
            let slopes = self.normals.by_state.row(surface);
            let terms: f64 = slopes.iter().zip(rate.iter()).map(|(d, f)| (d * f).abs()).sum();
            let is_clear = now.abs() > TIE * (terms + self.normals.by_time[surface].abs());
            let present = self.field.modes[surface];
            let is_beside = matches!(present, Mode::Below | Mode::Above);
            let side = |value: f64| if value > 0.0 { Mode::Above } else { Mode::Below };
            match later.filter(|_| !is_clear) {
                Some(psi) => Next { surface, mode: side(psi), rests: false },
                None if is_clear => Next { surface, mode: side(now), rests: false },
                None => {
                    let mode = if is_beside { present } else { Mode::Above };
                    Next { surface, mode, rests: true }
                }
            }
        };
        idle.iter().zip(later).map(next).collect()
    }

    /// Takes the slopes of the surfaces on the sides of each other, and of their kinks, to which
    /// the motion leads.
    fn go_on_beside<'i>(
        &mut self,
        choice: &Choice,
        later: impl Iterator<Item = (&'i usize, &'i Option<f64>)>,
        rate: &[f64],
    ) {
        let mut selectors = self.field.selectors.clone();
        self.surfaces.iter().zip(choice.s.iter()).for_each(|(&i, s)| selectors[i] = *s);
        later.for_each(|(&i, psi)| selectors[i] = psi.map_or(selectors[i], f64::signum));
        self.turns = true;
        self.go_behind_bends(rate, &selectors);
    }

    /// The functions of surfaces after a short step, unless it ends on them.
    fn a_moment_later(&mut self, choice: &Choice, surfaces: &[usize]) -> Vec<Option<f64>> {
        let [first, last] = self.field.system.interval;
        let h = (AHEAD * (last - first)).min(last - self.t);
        let (t, x) = (self.t, self.x);
        let (psi, normals, end) = self.with_modes_of(choice, |field| {
            let end = Step::take(field, t, x, h).end;
            (field.psi_on_its_sides(t + h, &end), field.normals(t + h, &end), end)
        });
        let off =
            |&i: &usize| (psi[i].abs() > ON_SURFACE * normals.noise(i, &end)).then_some(psi[i]);
        surfaces.iter().map(off).collect()
    }
}
