//! How a moving ball comes to 0, in finite time, while its direction may turn faster and faster:
//!
//! ```text
//! |psi|' = s r,   |psi| s' = (I - s s') r,   r = dpsi/dx f + psi_t
//! ```
//!
//! So no step goes more than nine tenths of the way that is left, nor farther than an explicit step
//! is stable for `s' ~ -B s/|psi|`. Each takes a part of `|psi|`; the last `1e-12` of it is a
//! straight line.

use super::Run;
use crate::simulate::field::direction::length;
use crate::simulate::field::{Field, surface_rates};
use crate::simulate::mode::Mode;
use crate::simulate::result::{EventKind, Method, Status};
use crate::simulate::steps::Step;
use crate::simulate::system::Ball;
use crate::simulate::tape::{Cause, Rule};
use crate::simulate::tuning::arrival::{MOST_OF_WAY, NEAR, SAME_TIME, STABLE};

/// A ball on its way to 0.
pub(crate) struct Arrival<'a> {
    pub ball: &'a Ball,
    /// How long at the present rate.
    pub time: f64,
    /// How far a step may go.
    pub longest: f64,
    /// Whether what is left can be skipped.
    pub is_near: bool,
}

impl<'a> Field<'a> {
    /// The moving ball that is the first to reach 0, as things go at present; notes which steps are
    /// stable.
    pub fn next_arrival(&mut self, t: f64, x: &[f64]) -> Option<Arrival<'a>> {
        self.stable = f64::INFINITY;
        if self.moving().is_empty() || self.departs(t) {
            return None;
        }
        let selectors = self.selectors_at(t, x);
        let (rate, by_selector) = self.with_selectors(t, x, &selectors);
        let normals = self.normals(t, x);
        let mut first: Option<Arrival> = None;
        for ball in self.moving() {
            let own: Vec<usize> = ball.surfaces.clone().collect();
            let size = length(&normals.psi[ball.surfaces.clone()]);
            let (r, b) = surface_rates(&normals, &rate, &by_selector, &own);
            let stable = STABLE * size / b.norm();
            self.stable = self.stable.min(stable);
            let along = own.iter().zip(r.iter()).map(|(&i, r)| selectors[i] * r).sum::<f64>();
            let time = -size / along;
            if time > 0.0 && first.as_ref().is_none_or(|first| time < first.time) {
                let noise = own.iter().map(|&i| normals.noise(i, x)).fold(0.0, f64::max);
                let is_near = size <= NEAR * noise || time <= SAME_TIME * t.abs();
                first =
                    Some(Arrival { ball, time, longest: stable.min(MOST_OF_WAY * time), is_near });
            }
        }
        first
    }
}

impl Run<'_> {
    /// Goes the rest of the way to 0 and decides what follows.
    pub fn arrive(&mut self, arrival: &Arrival<'_>) -> Result<(), Status> {
        // At 0 there is no other direction than the one in which it came.
        let arriving = self.field.selectors_at(self.t, &self.x);
        arrival.ball.surfaces.clone().for_each(|i| self.field.direction[i] = arriving[i]);
        let mut step = Step::new(self.x.len());
        step.begin(&mut self.field, self.t, &self.x, Method::Explicit, false);
        (step.h, step.rule) = (arrival.time, Rule::Straight);
        let (rate, h) = (step.stages[0].clone(), step.h);
        let point = |theta: f64| {
            self.x.iter().zip(&rate).map(|(x, rate)| x + theta * h * rate).collect::<Vec<f64>>()
        };
        let (middle, mut end) = (point(0.5), point(1.0));
        self.project_to_zero(arrival.ball, &mut end);
        step.end_smoothly(&middle, &end, &rate);
        self.go(&step, [self.t + h, h], &end);
        self.pace.h = self.first_length();
        self.stop(Cause::Reaches(arrival.ball.surfaces.start), |run| {
            let mut surfaces = run.surfaces_here();
            surfaces.extend(arrival.ball.surfaces.clone());
            surfaces.sort_unstable();
            surfaces.dedup();
            run.settle(surfaces)
        })
    }

    /// Takes away what is left of a ball that is nearly 0.
    pub fn project_to_zero(&mut self, ball: &Ball, x: &mut [f64]) {
        ball.surfaces.clone().for_each(|surface| self.field.set_mode(surface, Mode::Sliding));
        self.field.project(self.t, x);
        ball.surfaces.clone().for_each(|surface| self.field.set_mode(surface, Mode::Moving));
    }

    /// A ball comes to rest or departs; one event for all of its components.
    pub fn change_ball(&mut self, ball: &Ball, next: Mode) {
        let first = ball.surfaces.start;
        let before = self.field.modes[first];
        let departs_already = before == Mode::Moving && self.field.departure[first] == self.t;
        let kind = match (before, next) {
            (_, Mode::Sliding) if !self.has_begun => Some(EventKind::StartsSliding),
            _ if !self.has_begun || departs_already => None,
            (Mode::Moving, Mode::Sliding) => Some(EventKind::EntersSliding),
            (Mode::Sliding, Mode::Moving) => Some(EventKind::LeavesUp),
            (Mode::Moving, Mode::Moving) => Some(EventKind::Passes),
            _ => None,
        };
        let margin = self.ball_margin(ball);
        match next {
            Mode::Moving => {
                let direction = self.field.direction[ball.surfaces.clone()].to_vec();
                self.field.depart(ball, self.t, &direction);
            }
            _ => ball.surfaces.clone().for_each(|surface| self.field.set_mode(surface, next)),
        }
        if let Some(kind) = kind {
            self.event(first, kind, margin);
        }
    }

    /// How steeply `|psi|` falls: the cosine between the field and the way to 0, of the direction
    /// in which it moved or, at rest, of the direction opposite to the selectors.
    fn ball_margin(&mut self, ball: &Ball) -> f64 {
        let mut selectors = self.field.selectors.clone();
        let sign = if self.field.modes[ball.surfaces.start] == Mode::Moving { 1.0 } else { -1.0 };
        let size = length(&selectors[ball.surfaces.clone()]);
        if size == 0.0 {
            return 1.0;
        }
        ball.surfaces.clone().for_each(|i| selectors[i] *= sign / size);
        let normals = self.field.normals(self.t, &self.x);
        let (rate, _) = self.field.with_selectors(self.t, &self.x, &selectors);
        let shown = rate.iter().zip(&self.field.system.states).filter(|(_, state)| !state.hidden);
        let speed = shown.map(|(rate, _)| rate * rate).sum::<f64>().sqrt();
        let largest = |i: usize| speed * normals.by_state.row(i).norm() + normals.by_time[i].abs();
        let largest = ball.surfaces.clone().map(largest).fold(0.0, f64::max);
        let falls: f64 = ball.surfaces.clone().map(|i| selectors[i] * normals.rate(i, &rate)).sum();
        if largest > 0.0 { falls.abs() / largest } else { 0.0 }
    }
}
