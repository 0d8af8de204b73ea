//! What an event does: modes change, jumps reset the state, jumps that accumulate end the run or
//! hold a surface.

use super::Run;
use crate::simulate::field::direction::length;
use crate::simulate::location::Condition;
use crate::simulate::mode::Mode;
use crate::simulate::modes::decide;
use crate::simulate::result::{Event, EventKind, Status};
use crate::simulate::tuning::events::{AT_EXIT, CLEAR, MOST_AT_ONCE, SMALL_WAY};
use crate::simulate::tuning::field::{MOMENT, ON_SURFACE};
use std::collections::BTreeSet;

impl Run<'_> {
    /// What follows where a condition ceases to hold.
    pub fn handle(&mut self, condition: Condition) -> Result<(), Status> {
        self.record.point(self.t, &self.x);
        match condition {
            Condition::Leaves(surface) => self.leave(surface),
            Condition::CrossesKink(kink) => self.cross_kink(kink)?,
            Condition::Reaches(surface) => self.reach(surface)?,
            Condition::Parts(surface) => return Err(Status::NotHeld { surface }),
        }
        Ok(())
    }

    /// The right side goes on as it was; where the function of a surface bends that the state is
    /// on, the mode behind the kink may be another.
    fn cross_kink(&mut self, kink: usize) -> Result<(), Status> {
        self.field.cross_kink(kink);
        self.field.crossed = Some(kink);
        let surfaces = self.surfaces_here();
        let bends = !self.field.bends_here(self.t, &self.x, &surfaces).is_empty();
        let settled = if bends { self.settle(surfaces) } else { Ok(()) };
        self.field.crossed = None;
        settled
    }

    /// A surface holds the state no longer.
    fn leave(&mut self, surface: usize) {
        let selectors = self.field.selectors_at(self.t, &self.x);
        if let Some(ball) = self.field.ball_of(surface) {
            let range = ball.surfaces.clone();
            self.field.direction[range.clone()].copy_from_slice(&selectors[range]);
            self.change_ball(ball, Mode::Moving);
        } else {
            self.change(surface, if selectors[surface] > 0.0 { Mode::Above } else { Mode::Below });
        }
    }

    /// The state comes to a surface.
    fn reach(&mut self, surface: usize) -> Result<(), Status> {
        let mut surfaces = self.surfaces_here();
        if !surfaces.contains(&surface) {
            surfaces.push(surface);
            surfaces.sort_unstable();
        }
        let before = self.record.events.len();
        self.settle(surfaces)?;
        self.idle = if self.record.events.len() == before { self.idle + 1 } else { 0 };
        let jump = self.field.system.jumps.iter().position(|jump| jump.surface == surface);
        // It jumps, but less than rounding shows.
        match jump.filter(|_| self.idle > MOST_AT_ONCE) {
            Some(jump) => self.reach_zeno_point(jump, self.t, true),
            None => Ok(()),
        }
    }

    /// The surfaces that the state is on.
    pub fn surfaces_here(&mut self) -> Vec<usize> {
        self.stop_what_turns_at_once();
        self.field.find_rounding(self.t, &self.x);
        let normals = self.field.normals(self.t, &self.x);
        let is_zero = |i: usize| normals.psi[i].abs() <= ON_SURFACE * normals.noise(i, &self.x);
        let is_here = |i: &usize| match self.field.modes[*i] {
            Mode::Sliding => true,
            Mode::Held => false,
            Mode::Below | Mode::Above => is_zero(*i),
            Mode::Moving => {
                self.field.ball_of(*i).is_some_and(|ball| ball.surfaces.clone().all(is_zero))
            }
        };
        (0..self.field.modes.len()).filter(is_here).collect()
    }

    /// Puts moving balls at 0 that are so near to it that they leave it, or turn, within what
    /// rounding makes of the time: no step can follow that.
    fn stop_what_turns_at_once(&mut self) {
        if self.field.moving().is_empty() || self.field.departs(self.t) {
            return;
        }
        let [first, last] = self.field.system.interval;
        let moment = MOMENT * first.abs().max(last.abs());
        let rate = self.field.rate(self.t, &self.x);
        let normals = self.field.normals(self.t, &self.x);
        for ball in self.field.moving() {
            let of = |value: &dyn Fn(usize) -> f64| -> f64 {
                length(&ball.surfaces.clone().map(value).collect::<Vec<f64>>())
            };
            if of(&|i| normals.psi[i]) <= moment * of(&|i| normals.rate(i, &rate)) {
                let mut x = std::mem::take(&mut self.x);
                self.project_to_zero(ball, &mut x);
                self.x = x;
            }
        }
    }

    /// Decides the modes at a point on some surfaces, with the jumps that follow.
    pub fn settle(&mut self, mut surfaces: Vec<usize>) -> Result<(), Status> {
        let known = self.record.events.len();
        let (count, time) = self.decided;
        self.decided = (if time == self.t { count + 1 } else { 0 }, self.t);
        if self.decided.0 > MOST_AT_ONCE {
            let surface = surfaces.first().copied().unwrap_or(0);
            return Err(Status::NotUnique { surface, candidates: Vec::new() });
        }
        for _ in 0..MOST_AT_ONCE {
            surfaces.retain(|&surface| !self.stays_beside(surface));
            let next = decide(&mut self.field, self.t, &self.x, &surfaces)?;
            let crossed = next.iter().filter(|it| !it.rests);
            let due = crossed.clone().filter_map(|it| self.jump_at(it.surface, it.mode));
            let due: Vec<usize> = due.collect();
            self.note_orders(&due);
            let jump = due.first().copied();
            if jump.is_none() && self.rest_again(&next) {
                surfaces = self.surfaces_here();
                continue;
            }
            let Some(jump) = jump else {
                crossed.for_each(|it| self.change(it.surface, it.mode));
                let at_rest = next.iter().filter(|it| it.rests);
                at_rest.for_each(|it| self.field.set_mode(it.surface, it.mode));
                let mut x = std::mem::take(&mut self.x);
                self.field.project(self.t, &mut x);
                self.x = x;
                return self.end_of_crossings(known);
            };
            match self.rest_of_one_jump(jump) {
                Some(held) => self.come_to_rest(jump, held, self.x.clone()),
                None => self.jump(jump, known)?,
            }
            surfaces = self.surfaces_here();
        }
        let jump = self
            .field
            .system
            .jumps
            .iter()
            .position(|jump| surfaces.contains(&jump.surface))
            .unwrap_or(0);
        self.reach_zeno_point(jump, self.t, true)
    }

    /// A surface that is crossed ever faster ends the simulation like jumps that accumulate; of all
    /// events the first ones are known.
    fn end_of_crossings(&mut self, known: usize) -> Result<(), Status> {
        let [first, last] = self.field.system.interval;
        let is_crossing =
            |event: &&Event| matches!(event.kind, EventKind::CrossesUp | EventKind::CrossesDown);
        let crossings = self.record.events[known..].iter().filter(is_crossing);
        let crossed: BTreeSet<usize> = crossings.map(|event| event.surface).collect();
        for surface in crossed {
            let limit = self.crossing_times[surface].limit(self.t, last - first, false);
            if let Some(limit_time) = limit {
                return Err(Status::Zeno { jump: None, surface, limit_time, unsettled: None });
            }
        }
        Ok(())
    }

    /// The jump of a surface that is about to be crossed. A state that starts on a surface may have
    /// come from either side, until it has jumped there.
    fn jump_at(&self, surface: usize, next: Mode) -> Option<usize> {
        let has_come =
            self.has_begun || self.record.events.iter().any(|event| event.surface == surface);
        let is_falling = match (next, self.field.modes[surface], has_come) {
            (Mode::Below, Mode::Above, _) | (Mode::Below, _, false) => true,
            (Mode::Above, Mode::Below, _) | (Mode::Above, _, false) => false,
            _ => return None,
        };
        let jumps = self.field.system.jumps.iter().enumerate();
        let mut fitting = jumps.filter(|(at, jump)| {
            let is_left = jump.at_most.is_none_or(|limit| (self.jumps[*at] as f64) < limit);
            jump.surface == surface && jump.is_falling == is_falling && is_left
        });
        fitting.next().map(|(at, _)| at)
    }

    /// Resets the state. Afterwards every surface that the state is not on has the side where the
    /// state is. What has happened already at this stop, since `known` events, says nothing of
    /// jumps that pile up in time: bodies that touch may pass an impact to and fro.
    fn jump(&mut self, jump: usize, known: usize) -> Result<(), Status> {
        let kind = EventKind::Jump(jump);
        let is_again = self.record.events[known..].iter().any(|event| event.kind == kind);
        let of = &self.field.system.jumps[jump];
        let surface = of.surface;
        let margin = self.margin(surface);
        let after = self.field.reset(jump, self.t, &self.x);
        let before = std::mem::replace(&mut self.x, after);
        self.field.tolerance.jump(&before, &self.x);
        self.jumps[jump] += 1;
        let sides = [Mode::Above, Mode::Below];
        let [back, onward] = if of.is_falling { sides } else { [sides[1], sides[0]] };
        self.field.set_mode(surface, back);
        self.find_sides();
        self.find_sides_of_kinks();
        self.end_rests(&before);
        if self.goes_through(surface, onward) {
            self.field.set_mode(surface, onward);
        }
        self.event_from(before, surface, EventKind::Jump(jump), margin);
        let is_last = of.at_most.is_some_and(|limit| self.jumps[jump] as f64 >= limit);
        if let Some(held) = of.then_hold.filter(|_| is_last) {
            self.hold(jump, held);
            self.record.point(self.t, &self.x);
        }
        if is_last || is_again {
            return Ok(());
        }
        let [first, last] = self.field.system.interval;
        let is_small = self.is_small(jump, surface);
        self.piles[jump].note(&self.x);
        match self.jump_times[jump].limit(self.t, last - first, is_small) {
            Some(limit) => {
                let is_known = is_small && self.piles[jump].is_known();
                self.reach_zeno_point(jump, limit, is_known)
            }
            None => Ok(()),
        }
    }

    /// Whether the state goes so little away from the surface between two jumps that rounding will
    /// soon hide it.
    fn is_small(&mut self, jump: usize, surface: usize) -> bool {
        let normals = self.field.normals(self.t, &self.x);
        let rate = self.field.rate(self.t, &self.x);
        let speed = normals.rate(surface, &rate).abs();
        let way = speed * self.jump_times[jump].since_last(self.t);
        // What comes to rest at once goes nowhere, and does not come back.
        speed > 0.0 && way <= SMALL_WAY * normals.noise(surface, &self.x)
    }

    /// Whether a state that is still on a surface after a reset moves on to the other side,
    /// whichever field acts.
    fn goes_through(&mut self, surface: usize, onward: Mode) -> bool {
        if !self.surfaces_here().contains(&surface) {
            return false;
        }
        let normals = self.field.normals(self.t, &self.x);
        let mut selectors = self.field.selectors.clone();
        [-1.0, 1.0].into_iter().all(|side| {
            selectors[surface] = side;
            let (rate, _) = self.field.with_selectors(self.t, &self.x, &selectors);
            onward.side() * normals.rate(surface, &rate) > CLEAR * normals.rounding(surface, &rate)
        })
    }

    /// Changes a mode and notes the event.
    fn change(&mut self, surface: usize, next: Mode) {
        if let Some(ball) = self.field.ball_of(surface) {
            return if surface == ball.surfaces.start {
                self.change_ball(ball, next)
            };
        }
        let before = self.field.modes[surface];
        let kind = match (before, next) {
            (_, Mode::Sliding) if !self.has_begun => Some(EventKind::StartsSliding),
            _ if !self.has_begun => None,
            (Mode::Below, Mode::Above) => Some(EventKind::CrossesUp),
            (Mode::Above, Mode::Below) => Some(EventKind::CrossesDown),
            (Mode::Below | Mode::Above, Mode::Sliding) => Some(EventKind::EntersSliding),
            (Mode::Sliding, Mode::Above) => Some(EventKind::LeavesUp),
            (Mode::Sliding, Mode::Below) => Some(EventKind::LeavesDown),
            _ => None,
        };
        let margin = self.margin(surface);
        self.field.set_mode(surface, next);
        if let Some(kind) = kind {
            self.event(surface, kind, margin);
        }
    }

    /// Notes an event that leaves the state as it is.
    pub fn event(&mut self, surface: usize, kind: EventKind, margin: f64) {
        self.event_from(self.x.clone(), surface, kind, margin);
    }

    pub fn event_from(&mut self, before: Vec<f64>, surface: usize, kind: EventKind, margin: f64) {
        let event = Event { time: self.t, surface, kind, margin, before, after: self.x.clone() };
        self.tape.change(&mut self.field, &event);
        self.record.events.push(event);
        self.record.point(self.t, &self.x);
    }

    /// The least `|d f + psi_t| / (|d| |f| + |psi_t|)` of the fields on both sides; at an exit that
    /// of the side not taken, for the other is tangent there.
    pub fn margin(&mut self, surface: usize) -> f64 {
        let normals = self.field.normals(self.t, &self.x);
        let mut selectors = self.field.selectors.clone();
        let own = selectors[surface];
        let mut cosines = [-1.0, 1.0].map(|side| {
            selectors[surface] = side;
            let (rate, _) = self.field.with_selectors(self.t, &self.x, &selectors);
            let shown =
                rate.iter().zip(&self.field.system.states).filter(|(_, state)| !state.hidden);
            let size = shown.map(|(rate, _)| rate * rate).sum::<f64>().sqrt()
                * normals.by_state.row(surface).norm();
            let largest = size + normals.by_time[surface].abs();
            if largest > 0.0 { normals.rate(surface, &rate).abs() / largest } else { 0.0 }
        });
        cosines.sort_by(f64::total_cmp);
        let is_exit = self.field.modes[surface] == Mode::Sliding && own.abs() > 1.0 - AT_EXIT;
        if is_exit { cosines[1] } else { cosines[0] }
    }
}
