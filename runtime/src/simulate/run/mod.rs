//! The loop: steps of bounded error, events inside them, controls that jump between them.

mod advance;
mod arrival;
mod between;
mod events;
mod holding;
mod order;
mod pile;
mod record;
mod recorder;
mod sides;
mod staying;
mod touching;
mod zeno;

use super::controls::Controls;
use super::field::Field;
use super::location::extremes::Extremes;
use super::result::{Counts, Options, Simulation, Status};
use super::system::{System, value};
use super::tape::Cause;
use advance::Pace;
use holding::Rest;
use pile::Pile;
use record::Record;
use recorder::Writer;
use zeno::ZenoDetector;

/// A simulation on its way.
pub(crate) struct Run<'a> {
    pub field: Field<'a>,
    pub options: &'a Options,
    pub record: Record,
    pub tape: Writer,
    pub extremes: Extremes,
    pub t: f64,
    pub x: Vec<f64>,
    /// How often each jump has happened.
    pub jumps: Vec<usize>,
    /// The times of the last jumps of each kind.
    pub jump_times: Vec<ZenoDetector>,
    /// The states after the last jumps of each kind.
    pub piles: Vec<Pile>,
    /// How the state rests on each surface, or has rested last.
    pub rests: Vec<Option<Rest>>,
    /// The times of the last crossings of each surface.
    pub crossing_times: Vec<ZenoDetector>,
    /// Whether the modes at the beginning are known.
    pub has_begun: bool,
    /// How often in a row a surface was reached and nothing happened.
    pub idle: usize,
    /// How often modes were decided at one time, and when.
    pub decided: (usize, f64),
    /// How it goes on.
    pub pace: Pace,
    pub counts: Counts,
}

/// Simulates a system from its start to its last time, or as far as its trajectory is unique.
pub fn simulate(system: &System, controls: &Controls, options: &Options) -> Simulation {
    let mut run = Run::new(system, controls, options);
    let status = run.follow(controls).err().unwrap_or(Status::Completed);
    run.finish(status)
}

/// What controls of a system are at a time.
pub fn controls_at(system: &System, controls: &Controls, time: f64) -> Vec<f64> {
    let options = Options::default();
    let mut field = Field::new(system, controls, &options);
    field.use_controls_of(time);
    field.follow_controls(time);
    field.control().to_vec()
}

impl<'a> Run<'a> {
    fn new(system: &'a System, controls: &'a Controls, options: &'a Options) -> Self {
        let mut field = Field::new(system, controls, options);
        field.use_controls_of(system.interval[0]);
        Run {
            field,
            options,
            record: Record::new(options, system.layout.x),
            tape: Writer::new(options.tape),
            extremes: Extremes::new(if options.extremes {
                system.enclosures.path.len()
            } else {
                0
            }),
            t: system.interval[0],
            x: system.start.clone(),
            jumps: vec![0; system.jumps.len()],
            jump_times: vec![ZenoDetector::default(); system.jumps.len()],
            piles: vec![Pile::default(); system.jumps.len()],
            rests: system.surfaces.iter().map(|_| None).collect(),
            crossing_times: vec![ZenoDetector::default(); system.surfaces.len()],
            has_begun: false,
            idle: 0,
            decided: (0, f64::NAN),
            pace: Pace::new(system.layout.x, options.method()),
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
        self.field.find_rounding(self.t, &self.x);
        self.find_sides();
        self.find_sides_of_kinks();
        self.finite_here()?;
        self.stop(Cause::Start, |run| {
            let surfaces = run.surfaces_here();
            run.settle(surfaces)
        })?;
        self.has_begun = true;
        self.pace.h = self.first_length();
        Ok(())
    }

    fn change_controls(&mut self, time: f64) -> Result<(), Status> {
        self.stop(Cause::Controls, |run| {
            run.field.use_controls_of(time);
            run.find_sides_of_kinks();
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
        self.pace.is_continued = false;
        happens(self)?;
        self.field.tolerance.see(&self.x);
        if !matches!(cause, Cause::Controls) {
            self.field.find_least_sizes(self.t, &self.x);
        }
        if !matches!(cause, Cause::CrossesKink(_)) {
            self.find_sides_of_kinks();
        }
        self.tape.close(&mut self.field, self.t, &self.x);
        Ok(())
    }

    /// Whether right side and surfaces have values.
    pub fn finite_here(&mut self) -> Result<(), Status> {
        self.field.follow_directions(self.t, &self.x);
        let normals = self.field.normals(self.t, &self.x);
        let is_bad = |values: &[f64]| values.iter().position(|value| !value.is_finite());
        if let Some(surface) = is_bad(&normals.psi) {
            return Err(Status::NotFinite(self.field.system.switching.origin(surface)));
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
            orders: self.record.orders,
            end_time: self.t,
            end: self.x,
            objective: objective.first().copied().filter(|_| is_complete),
            counts: self.counts,
            extremes: self.extremes.0,
            tape: self.tape.finish(),
        }
    }
}
