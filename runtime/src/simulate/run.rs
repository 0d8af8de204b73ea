//! The loop: steps of bounded error, events inside them, controls that jump between them.

use super::ball::{blocks, is_unique};
use super::controls::Controls;
use super::field::{Field, surface_rates};
use super::locate;
use super::record::Record;
use super::result::{Counts, Options, Simulation, Status};
use super::step::Step;
use super::system::{System, value};
use super::tape::{Cause, Writer};
use super::zeno::Pile;
use crate::problem::Origin;

/// The first step, and the one after a ball came to 0, as a part of the whole time.
const FIRST_STEP: f64 = 1e-3;

/// A simulation on its way.
pub(super) struct Run<'a> {
    pub field: Field<'a>,
    pub options: &'a Options,
    pub record: Record,
    pub tape: Writer,
    pub t: f64,
    pub x: Vec<f64>,
    /// How often each jump has happened.
    pub jumps: Vec<usize>,
    /// The times of the last jumps of each kind.
    pub piles: Vec<Pile>,
    /// The times of the last crossings of each surface.
    pub crossings: Vec<Pile>,
    /// Whether the modes at the beginning are known.
    pub has_begun: bool,
    /// The next step.
    h: f64,
    counts: Counts,
}

/// Simulates a system from its start to its last time, or as far as its trajectory is unique.
pub fn simulate(system: &System, controls: &Controls, options: &Options) -> Simulation {
    let mut run = Run::new(system, controls, options);
    let status = run.follow(controls).err().unwrap_or(Status::Completed);
    run.finish(status)
}

impl<'a> Run<'a> {
    fn new(system: &'a System, controls: &'a Controls, options: &'a Options) -> Self {
        let mut field = Field::new(system, controls);
        field.use_controls_of(system.interval[0]);
        Run {
            field,
            options,
            record: Record::new(options, system.layout.x),
            tape: Writer::new(options.tape),
            t: system.interval[0],
            x: system.start.clone(),
            jumps: vec![0; system.jumps.len()],
            piles: vec![Pile::default(); system.jumps.len()],
            crossings: vec![Pile::default(); system.surfaces.len()],
            has_begun: false,
            h: FIRST_STEP * (system.interval[1] - system.interval[0]),
            counts: Counts::default(),
        }
    }

    fn follow(&mut self, controls: &Controls) -> Result<(), Status> {
        let [first, last] = self.field.system.interval;
        self.record.point(self.t, &self.x);
        self.begin()?;
        let mut stops = controls.breaks(first, last);
        stops.push(last);
        for stop in stops {
            while self.t < stop {
                self.advance(stop)?;
            }
            if stop < last {
                self.change_controls(stop)?;
            }
        }
        Ok(())
    }

    /// Finds the modes at the first time.
    fn begin(&mut self) -> Result<(), Status> {
        self.find_sides();
        self.finite_here()?;
        self.stop(Cause::Start, |run| {
            let surfaces = run.surfaces_here();
            run.settle(surfaces)
        })?;
        self.has_begun = true;
        Ok(())
    }

    fn change_controls(&mut self, time: f64) -> Result<(), Status> {
        self.stop(Cause::Controls, |run| {
            run.field.use_controls_of(time);
            let surfaces = run.surfaces_here();
            run.settle(surfaces)
        })
    }

    /// A stop, with what happens there.
    pub fn stop(
        &mut self,
        cause: Cause,
        happens: impl FnOnce(&mut Self) -> Result<(), Status>,
    ) -> Result<(), Status> {
        self.tape.open(cause, &mut self.field, self.t, &self.x);
        happens(self)?;
        self.tape.close(&mut self.field, self.t, &self.x);
        Ok(())
    }

    /// One accepted step towards `stop`, or up to the first event in it.
    fn advance(&mut self, stop: f64) -> Result<(), Status> {
        let rest = stop - self.t;
        let fall = self.field.fall(self.t, &self.x);
        if let Some(fall) = fall.as_ref().filter(|fall| fall.is_near && fall.time <= rest) {
            self.h = FIRST_STEP * (self.field.system.interval[1] - self.field.system.interval[0]);
            return self.land(fall);
        }
        let longest = fall.map_or(rest, |fall| rest.min(fall.longest));
        let is_longest = self.h >= longest * (1.0 - 1e-12);
        let step = self.accepted(if is_longest { longest } else { self.h })?;
        let found = locate::first(&mut self.field, &step, self.options);
        self.counts.steps += 1;
        if let Some(found) = found {
            self.go(&step, [step.t + found.h, found.h], found.state);
            self.h = self.h.max(0.1 * step.h);
            return self.stop(found.condition.into(), |run| run.handle(found.condition));
        }
        if let Some(theta) = self.attraction_ends(&step) {
            let h = theta * step.h;
            self.go(&step, [step.t + h, h], step.at(theta));
            self.record.point(self.t, &self.x);
            return self.stop(Cause::Repels, |run| {
                let surfaces = run.surfaces_here();
                run.settle(surfaces)
            });
        }
        let time = if step.h >= rest * (1.0 - 1e-12) { stop } else { step.t + step.h };
        self.go(&step, [time, step.h], step.end.clone());
        self.record.point(self.t, &self.x);
        Ok(())
    }

    /// Goes to the state at a time, `h` after the beginning of a step.
    pub fn go(&mut self, step: &Step, [time, h]: [f64; 2], end: Vec<f64>) {
        self.record.inside(step, time);
        (self.t, self.x) = (time, end);
        self.field.project(self.t, &mut self.x);
        if h > 0.0 {
            self.tape.step(&mut self.field, step, h, &self.x);
        }
    }

    /// A step whose error is small enough; chooses the length of the next.
    fn accepted(&mut self, mut h: f64) -> Result<Step, Status> {
        loop {
            if self.counts.steps + self.counts.rejected >= self.options.max_steps {
                return Err(Status::StepLimit);
            }
            let selectors = self.field.selectors.clone();
            let step = Step::take(&mut self.field, self.t, &self.x, h, self.options);
            let factor = if step.error.is_finite() { 0.9 * step.error.max(1e-10).powf(-0.2) } else { 0.1 };
            let next = h * factor.clamp(0.1, 5.0);
            if step.error <= 1.0 {
                self.h = next;
                return Ok(step);
            }
            self.field.selectors = selectors;
            self.counts.rejected += 1;
            h = next;
            if h <= 4.0 * f64::EPSILON * self.t.abs().max(h * 1e3).max(f64::MIN_POSITIVE) {
                return Err(self.stuck());
            }
        }
    }

    /// Why steps become too short: the sliding ends to be unique, or something grows beyond all bounds.
    fn stuck(&mut self) -> Status {
        let surfaces = self.surfaces_here();
        if let Err(status) = self.settle(surfaces).and_then(|()| self.finite_here()) {
            return status;
        }
        let rate = self.field.rate(self.t, &self.x);
        let growth = |i: &usize| (rate[*i] / (1.0 + self.x[*i].abs())).abs();
        let worst = (0..self.x.len()).max_by(|i, j| growth(i).total_cmp(&growth(j)));
        Status::NotFinite(worst.map_or_else(Origin::default, |row| self.field.system.flow.origin(row)))
    }

    /// Where in a step the surfaces that the state slides on cease to attract, to rounding.
    fn attraction_ends(&mut self, step: &Step) -> Option<f64> {
        let is_sliding = !self.field.sliding().is_empty();
        if !is_sliding || self.attracts(step, 1.0) || !self.attracts(step, 0.0) {
            return None;
        }
        let (mut low, mut high) = (0.0, 1.0);
        while high - low > 2.0 * f64::EPSILON {
            let middle = 0.5 * (low + high);
            if self.attracts(step, middle) { low = middle } else { high = middle }
        }
        Some(high)
    }

    fn attracts(&mut self, step: &Step, theta: f64) -> bool {
        let (t, x) = (step.t + theta * step.h, step.at(theta));
        let sliding = self.field.sliding();
        let normals = self.field.normals(t, &x);
        self.field.follow_directions(t, &x);
        let selectors = self.field.selectors.clone();
        let (rate, by_selector) = self.field.with_selectors(t, &x, &selectors);
        let b = surface_rates(&normals, &rate, &by_selector, &sliding).1;
        is_unique(&b, &blocks(&self.field.system.balls, &sliding))
    }

    /// Whether right side and surfaces have values.
    fn finite_here(&mut self) -> Result<(), Status> {
        self.field.follow_directions(self.t, &self.x);
        let normals = self.field.normals(self.t, &self.x);
        let is_bad = |values: &[f64]| values.iter().position(|value| !value.is_finite());
        if let Some(surface) = is_bad(&normals.psi) {
            return Err(Status::NotFinite(self.field.system.guards.origin(surface)));
        }
        let selectors = self.field.selectors.clone();
        let (rate, _) = self.field.with_selectors(self.t, &self.x, &selectors);
        match is_bad(&rate) {
            Some(row) => Err(Status::NotFinite(self.field.system.flow.origin(row))),
            None => Ok(()),
        }
    }

    fn finish(mut self, status: Status) -> Simulation {
        self.record.last(self.t, &self.x);
        let system = self.field.system;
        let ends: Vec<f64> = system.start.iter().chain(&self.x).copied().collect();
        let objective = value(&*system.objective, &ends, &system.parameter_values());
        let is_complete = matches!(status, Status::Completed);
        self.counts.evaluations = self.field.evaluations;
        Simulation {
            status,
            time: self.record.time,
            states: self.record.states,
            events: self.record.events,
            end_time: self.t,
            end: self.x,
            objective: objective.first().copied().filter(|_| is_complete),
            counts: self.counts,
            tape: self.tape.finish(),
        }
    }
}
