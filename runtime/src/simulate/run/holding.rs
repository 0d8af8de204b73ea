//! `then hold SURFACE`: after a jump the state rests on a surface.
//!
//! The states that the jump resets and that move the surface stand still, so that `psi = 0` and
//! `psi' = 0` go on to hold. Another jump after which one of the two does not hold takes the state
//! off the surface: it moves again, and the jumps of the surface may act again. What comes back
//! and is not reset any more rests there again.

use super::Run;
use super::pile::Pile;
use super::zeno::ZenoDetector;
use crate::simulate::field::{Field, correct};
use crate::simulate::mode::Mode;
use crate::simulate::modes::Next;
use crate::simulate::result::{EventKind, Status};
use crate::simulate::system::Jump;
use crate::simulate::tuning::field::ON_SURFACE;
use crate::simulate::tuning::holding::PARTED;
use crate::simulate::tuning::normals::ROUNDING;

/// How a state rests on a surface, or did.
pub(crate) struct Rest {
    /// The jump after which it does.
    jump: usize,
    /// The side from which it came.
    side: Mode,
    /// The states that stand still meanwhile.
    still: Vec<usize>,
}

impl Run<'_> {
    /// Jumps pile up: the state rests on a surface, if the model says so, or the simulation ends.
    /// While a state has no limit that can be told yet, jumps go on, but for the last of them.
    pub fn reach_zeno_point(
        &mut self,
        jump: usize,
        limit_time: f64,
        is_last: bool,
    ) -> Result<(), Status> {
        let Jump { surface, then_hold, .. } = self.field.system.jumps[jump];
        let end = |unsettled| Status::Zeno { jump: Some(jump), surface, limit_time, unsettled };
        let is_before_the_end = limit_time < self.field.system.interval[1];
        let Some(held) = then_hold.filter(|_| is_before_the_end) else { return Err(end(None)) };
        match self.state_at_limit(jump, held, limit_time) {
            Ok(x) => {
                let before = self.x.clone();
                self.t = limit_time;
                self.x = x;
                self.come_to_rest(jump, held, before);
                Ok(())
            }
            Err(state) if is_last => Err(end(Some(state))),
            Err(_) => Ok(()),
        }
    }

    /// The state where jumps pile up, or one that comes to nothing. What will stand still need not
    /// have settled: rest is its limit.
    fn state_at_limit(&mut self, jump: usize, held: usize, time: f64) -> Result<Vec<f64>, usize> {
        let rate = self.field.rate(self.t, &self.x);
        let (pushes, rest) = (self.pushes(held), time - self.t);
        let Field { system, tolerance, .. } = &self.field;
        let is_reset = |i: usize| system.jumps.iter().any(|it| it.resets.contains(&i));
        let stops = |i: usize| pushes[i] != 0.0 && system.jumps[jump].resets.contains(&i);
        let limit = |i: usize| {
            let straight = self.x[i] + rest * rate[i];
            let size = tolerance.sizes[i].max(self.x[i].abs());
            match self.piles[jump].limit(i, size) {
                Some(limit) if rest > 0.0 => Ok(limit),
                None if is_reset(i) && !stops(i) => Err(i),
                _ => Ok(straight),
            }
        };
        (0..self.x.len()).map(limit).collect()
    }

    /// The state rests from now on.
    pub fn come_to_rest(&mut self, jump: usize, held: usize, before: Vec<f64>) {
        self.hold(jump, held);
        self.event_from(before, held, EventKind::EntersSliding, 0.0);
    }

    /// The surface that is held after a jump without rebound: it would follow upon itself for
    /// ever, with nothing between that comes to the surface.
    pub fn rest_of_one_jump(&mut self, jump: usize) -> Option<usize> {
        let Jump { surface, then_hold, .. } = self.field.system.jumps[jump];
        let last = self.record.events.last()?;
        let is_again = last.time == self.t && last.kind == EventKind::Jump(jump);
        then_hold.filter(|_| is_again && !self.moves(surface))
    }

    /// Whether `psi'` is more than rounding.
    fn moves(&mut self, surface: usize) -> bool {
        let speed = self.speed(surface);
        let sizes = self.field.tolerance.sizes.clone();
        let terms: f64 =
            self.pushes(surface).iter().zip(sizes).map(|(by, size)| (by * size).abs()).sum();
        speed.abs() > ON_SURFACE * ROUNDING * terms
    }

    /// `psi'` at the present state.
    fn speed(&mut self, surface: usize) -> f64 {
        let rate = self.field.rate(self.t, &self.x);
        self.field.normals(self.t, &self.x).rate(surface, &rate)
    }

    /// Brings the state to rest on a surface: the states that the jump resets and that move the
    /// surface stand still from now on.
    pub fn hold(&mut self, jump: usize, surface: usize) {
        let of = &self.field.system.jumps[jump];
        let back = if of.is_falling { Mode::Above } else { Mode::Below };
        let side = if of.surface == surface { back } else { self.field.modes[surface] };
        let still = self.bring_to_rest(jump, surface);
        self.rests[surface] = Some(Rest { jump, side, still });
        self.field.set_mode(surface, Mode::Held);
        let normals = self.field.normals(self.t, &self.x);
        self.field.slack[surface] = PARTED * normals.noise(surface, &self.x);
        self.find_what_stands_still();
    }

    /// Newton's steps to `psi = 0` and `psi' = 0`; the states that keep it so as long as they stand
    /// still. Those that keep another surface stay as they are.
    fn bring_to_rest(&mut self, jump: usize, surface: usize) -> Vec<usize> {
        let resets = self.field.system.jumps[jump].resets.clone();
        let held = self.field.held.clone();
        let mut still: Vec<usize> = Vec::new();
        for _ in 0..5 {
            let normals = self.field.normals(self.t, &self.x);
            let mut slope: Vec<f64> = normals.by_state.row(surface).iter().copied().collect();
            held.iter().for_each(|&i| slope[i] = 0.0);
            correct(&mut self.x, &slope, normals.psi[surface]);
            let rate = self.field.rate(self.t, &self.x);
            let mut pushes = self.pushes(surface);
            still =
                resets.iter().copied().filter(|&i| pushes[i] != 0.0 || slope[i] != 0.0).collect();
            let is_free = |i: &usize| resets.contains(i) && !held.contains(i);
            (0..pushes.len()).filter(|i| !is_free(i)).for_each(|i| pushes[i] = 0.0);
            correct(&mut self.x, &pushes, normals.rate(surface, &rate));
        }
        still
    }

    /// How `psi'` changes with the states.
    fn pushes(&mut self, surface: usize) -> Vec<f64> {
        let normals = self.field.normals(self.t, &self.x);
        let by_state = self.field.by_state(self.t, &self.x);
        (normals.by_state.row(surface) * by_state).iter().copied().collect()
    }

    fn find_what_stands_still(&mut self) {
        let modes = &self.field.modes;
        let rests = self.rests.iter().zip(modes).filter(|(_, mode)| **mode == Mode::Held);
        let mut held: Vec<usize> =
            rests.filter_map(|(rest, _)| rest.as_ref()).flat_map(|it| it.still.clone()).collect();
        held.sort_unstable();
        held.dedup();
        self.field.held = held;
    }

    /// What a jump has taken off a surface rests there no longer.
    pub fn end_rests(&mut self, before: &[f64]) {
        for surface in 0..self.rests.len() {
            if self.field.modes[surface] != Mode::Held {
                continue;
            }
            let Some(side) = self.side_after_rest(surface, before) else { continue };
            self.field.set_mode(surface, side);
            if let Some(rest) = &self.rests[surface] {
                self.jump_times[rest.jump] = ZenoDetector::default();
                self.piles[rest.jump] = Pile::default();
            }
        }
        self.find_what_stands_still();
    }

    /// The side of a surface where a jump has taken the state, if it rests there no longer. One
    /// that is still on the surface begins where it came from, so that a push into the surface is
    /// an impact.
    fn side_after_rest(&mut self, surface: usize, before: &[f64]) -> Option<Mode> {
        let normals = self.field.normals(self.t, &self.x);
        let side = |value: f64| if value > 0.0 { Mode::Above } else { Mode::Below };
        if normals.psi[surface].abs() > self.field.slack[surface] {
            return Some(side(normals.psi[surface]));
        }
        let speed = self.speed(surface);
        let rate = self.field.rate(self.t, before);
        let was = self.field.normals(self.t, before).rate(surface, &rate);
        let moves = speed != was && self.moves(surface);
        let came_from = self.rests[surface].as_ref().map(|rest| rest.side);
        let is_side = |side: &Mode| matches!(side, Mode::Above | Mode::Below);
        moves.then(|| came_from.filter(is_side).unwrap_or(side(speed)))
    }

    /// What would cross a surface on which it has rested before, and which no jump turns back,
    /// rests there again; whether there is any.
    pub fn rest_again(&mut self, next: &[Next]) -> bool {
        let crossed = next.iter().filter(|it| !it.rests).find_map(|it| {
            let rest = self.rests[it.surface].as_ref()?;
            let is_back = self.field.modes[it.surface] == rest.side
                && matches!(
                    (rest.side, it.mode),
                    (Mode::Above, Mode::Below) | (Mode::Below, Mode::Above)
                );
            is_back.then_some((rest.jump, it.surface))
        });
        let Some((jump, surface)) = crossed else { return false };
        let margin = self.margin(surface);
        let before = self.x.clone();
        self.hold(jump, surface);
        self.event_from(before, surface, EventKind::EntersSliding, margin);
        true
    }
}
