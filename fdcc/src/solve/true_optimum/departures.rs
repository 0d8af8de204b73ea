//! Whether a hold is worth leaving, at the last time or for a moment inside of it.
//!
//! ```text
//! dJ/d delta = min over u of H, off the surface, where psi' leads there  -  H where it is held
//! ```
//!
//! Inside of a hold with the costates that are gradients of what is still to come (`costates.rs`):
//! a state that is off the surface by little comes back. At the last time with those that meet the
//! conditions there. Where both are the same, as where controls cost nothing, what leads away is of
//! second order, and a trial tells.

use super::insertion::{
    Candidate, Least, at_departure, at_point, hamiltonian_at, least, off, tried,
};
use super::minimum::controls_at;
use super::polynomials::polynomials;
use super::repair::is_nothing;
use super::signs::states_of;
use super::structure::Structure;
use super::tuning::certificate::WORTH;
use super::tuning::insertion::{PARTS_OF_HOLD, RELEASED};
use super::{Located, Search};
use fdcc_compiler::{Arc, Mode, PhaseOfModes, is_kink};

/// A surface that a phase holds.
struct HeldSurface<'l> {
    /// With the costates that are meant.
    located: &'l Located,
    /// The phase.
    phase: usize,
    /// One of the switches of the model.
    switch: usize,
    /// The place of its selector among the controls of the phase.
    selector: usize,
}

impl Search<'_> {
    /// Departures that the objective may fall by.
    pub(super) fn departures(&self, located: &Located) -> Vec<Candidate> {
        let gradients = located.with_gradients(self.model, self.problem);
        let last = located.structure.phases.len() - 1;
        let in_the_end = self.holds_of_phase(located, last).into_iter();
        let in_the_end = in_the_end.flat_map(|hold| self.at_the_end(&hold));
        let holds = (0..=last).flat_map(|j| self.holds_of_phase(&gradients, j));
        in_the_end.chain(holds.flat_map(|hold| self.inside(&hold))).collect()
    }

    /// What a phase holds, but for a `Dir` and kinks; nothing where it only touches a surface, or
    /// where limits are kept, of which the Hamiltonian knows nothing.
    fn holds_of_phase<'l>(&self, located: &'l Located, phase: usize) -> Vec<HeldSurface<'l>> {
        let PhaseOfModes { modes, contacts, .. } = &located.structure.phases[phase];
        let is_kept = contacts.iter().any(|it| *it != Arc::Free);
        if is_kept || is_nothing(&located.structure, phase) {
            return Vec::new();
        }
        let mut selector = self.model.controls.len();
        let mut holds = Vec::new();
        for (switch, it) in self.model.switches().iter().enumerate() {
            if modes[switch] != Mode::Held {
                continue;
            }
            if !it.is_ball && !is_kink(&it.place.name) {
                holds.push(HeldSurface { located, phase, switch, selector });
            }
            selector += it.surfaces.len();
        }
        holds
    }

    /// Those at the last time, unless conditions there keep the motion on the surface.
    fn at_the_end(&self, hold: &HeldSurface) -> Vec<Candidate> {
        let HeldSurface { located, phase, .. } = *hold;
        let point = located.outcome.phases[phase].trajectory.time.len() - 1;
        if self.is_given(hold.switch) {
            return Vec::new();
        }
        let off = hold.both_sides().into_iter();
        let is_joined = !hold.is_inside(point - 1);
        let known = off.filter_map(|off| {
            let slope = self.slope(hold, &off, point)?;
            let off = PhaseOfModes { is_joined, ..off };
            (slope < -WORTH).then(|| Candidate { slope, ..tried(phase + 1, off) })
        });
        known.collect()
    }

    /// Whether conditions at the end give all states that a surface reads.
    fn is_given(&self, switch: usize) -> bool {
        let surface = self.model.switches()[switch].surfaces.start;
        let equations = self.model.boundary.iter().filter(|it| it.range.lower == it.range.upper);
        let given: Vec<usize> = equations.flat_map(|it| states_of(self.model, it.value)).collect();
        let read = states_of(self.model, self.model.surfaces[surface].psi);
        read.iter().all(|state| given.contains(state))
    }

    /// Those inside of a hold whose selector is between its bounds, each at the time at which it
    /// gains most.
    fn inside(&self, hold: &HeldSurface) -> Vec<Candidate> {
        let points = hold.points_inside();
        let best = |off: PhaseOfModes| {
            let slopes = points.iter().filter_map(|it| Some((*it, self.slope(hold, &off, *it)?)));
            let slopes: Vec<(usize, f64)> = slopes.collect();
            let (point, slope) = *slopes.iter().min_by(|a, b| a.1.total_cmp(&b.1))?;
            let at = |point: usize| {
                let into = Some(hold.divided(point));
                Candidate { into, ..tried(hold.phase + 1, off.clone()) }
            };
            match slope {
                _ if slope < -WORTH => Some(Candidate { slope, ..at(point) }),
                _ if slope <= WORTH => Some(Candidate { is_doubtful: true, ..at(slopes[0].0) }),
                _ => None,
            }
        };
        hold.both_sides().into_iter().filter_map(best).collect()
    }

    /// The derivative of the objective by the duration of a departure at a grid point, for the size
    /// of the Hamiltonian; nothing where no control leads off the surface.
    fn slope(&self, hold: &HeldSurface, off: &PhaseOfModes, point: usize) -> Option<f64> {
        let HeldSurface { located, phase, switch, .. } = *hold;
        let outcome = &located.outcome.phases[phase];
        let size = located.size_of_phase(phase).max(located.least_size(self.model));
        let at = self.point(outcome, &|column| column[point]);
        let interval = point.min(outcome.trajectory.time.len() - 2);
        let controls = controls_at(&outcome.trajectory, interval, at.time);
        let own = &controls[..self.model.controls.len()];
        let leaving = at_departure(self.model, off, &at, &[switch])?;
        let starts = [None, Some(own)].into_iter();
        let values = starts.filter_map(|near| match least(&leaving, near, self.stop) {
            Least::Value(value, _) => Some(value),
            _ => None,
        });
        let leaving = values.min_by(f64::total_cmp)?;
        let held = &located.structure.phases[phase];
        let staying = hamiltonian_at(&at_point(self.model, held, &at)?, &controls);
        Some((leaving - staying) / size)
    }
}

impl HeldSurface<'_> {
    fn both_sides(&self) -> [PhaseOfModes; 2] {
        let own = &self.located.structure.phases[self.phase];
        [Mode::Above, Mode::Below].map(|mode| off(own, self.switch, mode))
    }

    /// A few grid points at which its selector is between its bounds.
    fn points_inside(&self) -> Vec<usize> {
        let count = self.located.outcome.phases[self.phase].trajectory.time.len() - 1;
        let points = PARTS_OF_HOLD.map(|part| (part * count as f64) as usize);
        points.into_iter().filter(|point| self.is_inside(*point)).collect()
    }

    /// Whether its selector is between its bounds on an interval.
    fn is_inside(&self, interval: usize) -> bool {
        let own = &self.located.outcome.phases[self.phase].trajectory;
        let pieces = polynomials(own, self.selector);
        let middle = 0.5 * (own.time[interval] + own.time[interval + 1]);
        pieces.get(interval).is_some_and(|it| it.at(middle).abs() < RELEASED)
    }

    /// The structure with the hold in two parts.
    fn divided(&self, point: usize) -> Structure {
        let mut other = self.located.structure.clone();
        let (own, time) = (
            &other.phases[self.phase],
            self.located.outcome.phases[self.phase].trajectory.time[point],
        );
        let mut behind =
            PhaseOfModes { jump: None, is_cut: false, is_joined: false, ..own.clone() };
        behind.touches.fill(Arc::Free);
        other.phases.insert(self.phase + 1, behind);
        other.times.insert(self.phase + 1, time);
        other
    }
}
