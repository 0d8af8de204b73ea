//! Surfaces that are touched inside of a step and not crossed.
//!
//! What touches a surface goes on where it was. But where the field behind the surface leads away
//! from it, the state could as well go there: a ball that comes to rest on top of a hill.

use super::Run;
use crate::simulate::location::touch::touched_exactly;
use crate::simulate::mode::Mode;
use crate::simulate::result::{Candidate, Status};
use crate::simulate::steps::Step;
use crate::simulate::tuning::field::ON_SURFACE;
use crate::simulate::tuning::modes::AHEAD;

impl Run<'_> {
    /// Ends at the first surface that is touched before a part of a step, and behind which the
    /// state could go on as well.
    pub fn pass_by(&mut self, step: &Step, until: f64) -> Result<(), Status> {
        let modes = self.field.modes.iter().zip(&self.field.acts).enumerate();
        let beside = modes.filter(|(_, (mode, acts))| **acts && mode.side() != 0.0);
        let beside: Vec<usize> = beside.map(|(surface, _)| surface).collect();
        let selectors = self.field.selectors.clone();
        let mut touched: Vec<(f64, usize)> = Vec::new();
        for surface in beside {
            let place = touched_exactly(&mut self.field, step, until, surface);
            touched.extend(place.map(|theta| (theta, surface)));
        }
        touched.sort_by(|a, b| a.0.total_cmp(&b.0));
        for (theta, surface) in touched {
            let mut there = step.clone();
            there.attempt(&mut self.field, theta * step.h);
            let time = step.t + there.h;
            if self.could_go_behind(surface, time, &there.end) {
                self.go(&there, [time, there.h], &there.end);
                self.record.point(self.t, &self.x);
                let sides = [1, -1].map(|side| Candidate { sides: vec![(surface, side)] });
                return Err(Status::NotUnique { surface, candidates: sides.into() });
            }
        }
        self.field.selectors = selectors;
        Ok(())
    }

    /// Whether a short step with the field behind a surface ends behind it.
    fn could_go_behind(&mut self, surface: usize, time: f64, x: &[f64]) -> bool {
        let own = self.field.modes[surface];
        let behind = if own == Mode::Below { Mode::Above } else { Mode::Below };
        let [first, last] = self.field.system.interval;
        let selectors = self.field.selectors.clone();
        self.field.set_mode(surface, behind);
        let h = AHEAD * (last - first);
        let Step { end, error, .. } = Step::take(&mut self.field, time, x, h);
        let normals = self.field.normals(time + h, &end);
        self.field.set_mode(surface, own);
        self.field.selectors = selectors;
        let far = behind.side() * normals.psi[surface];
        error <= 1.0 && far > ON_SURFACE * normals.noise(surface, &end)
    }
}
