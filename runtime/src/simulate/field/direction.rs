//! How the selectors of a [`Ball`] depend on the state.
//!
//! ```text
//! moving     s = psi/|psi|,   ds/dx = (I - s s')/|psi| dpsi/dx
//! departs   psi = 0: s is the direction in which it leaves, the limit of psi/|psi|
//! at rest    psi = 0 is kept: every component slides, and s solves the linear system of all
//!            sliding surfaces
//! ```
//!
//! [`Field::selectors_at`] gives the selectors of every mode.

use super::Field;
use crate::simulate::mode::Mode;
use crate::simulate::system::Ball;

/// The length of a vector.
pub(crate) fn length(vector: &[f64]) -> f64 {
    vector.iter().map(|value| value * value).sum::<f64>().sqrt()
}

impl<'a> Field<'a> {
    /// The ball that a surface is a component of.
    pub fn ball_of(&self, surface: usize) -> Option<&'a Ball> {
        self.system.balls.iter().find(|ball| ball.surfaces.contains(&surface))
    }

    /// The balls with a direction of motion.
    pub fn moving(&self) -> Vec<&'a Ball> {
        self.system
            .balls
            .iter()
            .filter(|ball| self.modes[ball.surfaces.start] == Mode::Moving)
            .collect()
    }

    /// Whether some ball leaves 0 at a time.
    pub fn departs(&self, t: f64) -> bool {
        self.moving().iter().any(|ball| self.departure[ball.surfaces.start] == t)
    }

    /// From now on a ball moves; it leaves 0 in a direction.
    pub fn depart(&mut self, ball: &Ball, t: f64, direction: &[f64]) {
        let size = length(direction);
        for (surface, s) in ball.surfaces.clone().zip(direction) {
            self.modes[surface] = Mode::Moving;
            self.departure[surface] = t;
            self.direction[surface] = s / size;
            self.selectors[surface] = s / size;
        }
    }

    /// From now on a ball, which is off 0, moves.
    pub fn set_moving(&mut self, ball: &Ball) {
        for surface in ball.surfaces.clone() {
            self.modes[surface] = Mode::Moving;
            self.departure[surface] = f64::NAN;
        }
    }

    /// Gives the selectors of all moving balls their values at a point.
    pub fn follow_directions(&mut self, t: f64, x: &[f64]) {
        let moving = self.moving();
        if moving.is_empty() {
            return;
        }
        let psi = self.psi(t, x);
        for ball in moving {
            let size = length(&psi[ball.surfaces.clone()]);
            let departs = self.departure[ball.surfaces.start] == t || size == 0.0;
            for surface in ball.surfaces.clone() {
                self.selectors[surface] =
                    if departs { self.direction[surface] } else { psi[surface] / size };
            }
        }
    }
}
