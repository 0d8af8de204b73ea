//! The race car of Section 7 of Stewart & Anitescu (2005): solved smoothed, and its controls
//! replayed on the true system. What it is judged by is written out by hand.

use std::f64::consts::PI;

use fdcc_compiler::compile_simulation;
use fdcc_runtime::simulate::{Controls, Options, Simulation, Status, simulate};

use crate::Solved;
use crate::models::{changed, load, text_of};

/// Intervals of the grid.
pub const STEPS: usize = 1000;

/// So many points of the replay are looked at in each interval.
pub const POINTS: usize = 8;

/// Of the track.
pub const HALF_WIDTH: f64 = 0.25;

const STATES: [&str; 5] = ["pos.x", "pos.y", "vel.x", "vel.y", "th"];

/// Positions, velocities and the angle over time.
pub struct Run {
    /// Ascending.
    pub time: Vec<f64>,
    states: Vec<Vec<f64>>,
}

impl Run {
    /// How many times there are.
    pub fn points(&self) -> usize {
        self.time.len()
    }

    /// `x y vx vy th` at a point.
    pub fn at(&self, k: usize) -> [f64; 5] {
        [0, 1, 2, 3, 4].map(|state| self.states[state][k])
    }

    /// Along the car and across it.
    pub fn velocity(&self, k: usize) -> [f64; 2] {
        let [_, _, vx, vy, th] = self.at(k);
        let (sin, cos) = th.sin_cos();
        [cos * vx + sin * vy, cos * vy - sin * vx]
    }

    /// From the target to the end.
    pub fn miss(&self) -> [f64; 2] {
        let [x, y, ..] = self.at(self.points() - 1);
        [x - 3.0 * PI, y + PI]
    }

    /// `10 |miss|^2 + T`
    pub fn objective(&self) -> f64 {
        let [x, y] = self.miss();
        10.0 * (x * x + y * y) + self.time[self.points() - 1]
    }

    /// By how much the track is left at worst, and when.
    pub fn outside(&self) -> (f64, f64) {
        let violation = |k: usize| {
            let [x, y, ..] = self.at(k);
            (y - centre_line(x)).abs() - HALF_WIDTH
        };
        let all = (0..self.points()).map(|k| (violation(k), self.time[k]));
        all.fold((f64::NEG_INFINITY, 0.0), |most, next| if next.0 > most.0 { next } else { most })
    }
}

/// The middle of the track.
pub fn centre_line(x: f64) -> f64 {
    match x {
        x if x <= PI => x.sin(),
        x if x <= 2.0 * PI => PI - x,
        x => -PI - x.sin(),
    }
}

/// A solution of the smoothed problem, and what its controls do to the true car.
pub struct Race {
    /// The width of the layer.
    pub sigma: f64,
    /// The solution.
    pub solved: Solved,
    /// Its states.
    pub planned: Run,
    /// The simulation with its controls.
    pub replay: Simulation,
    /// Its states, at [`POINTS`] times as many points.
    pub driven: Run,
}

impl Race {
    /// Solves and replays.
    pub fn new(sigma: f64) -> Self {
        let (width, steps) = (sigma.to_string(), STEPS.to_string());
        let solved = Solved::of(load("racecar", &[], &[("sigma", &width), ("N", &steps)]));
        let states = STATES.map(|name| solved.state(name).to_vec()).to_vec();
        let planned = Run { time: solved.outcome.trajectory.time.clone(), states };
        let replay = replay(&solved);
        let driven = Run { time: replay.time.clone(), states: replay.states.clone() };
        Race { sigma, solved, planned, replay, driven }
    }

    /// `lambda^T f` of the smoothed system at the beginning of an interval; -1 where the duration
    /// is optimal.
    pub fn hamiltonian(&self, k: usize) -> f64 {
        let costate = STATES.map(|name| self.solved.costate(name)[k]);
        let [.., vx, vy, th] = self.planned.at(k);
        let [along, across] = self.planned.velocity(k);
        let [a, s] = ["a", "s"].map(|name| self.solved.control(name)[k]);
        let (sin, cos) = th.sin_cos();
        let friction = -across / across.hypot(self.sigma);
        let flow = [vx, vy, a * cos - friction * sin, a * sin + friction * cos, s * along];
        costate.iter().zip(flow).map(|(lambda, f)| lambda * f).sum()
    }

    /// `2 alpha (x(T) - target)^T v(T)`, which is -1 where the end is optimal.
    pub fn transversality(&self) -> f64 {
        let ([x, y], [_, _, vx, vy, _]) = (self.planned.miss(), self.planned.at(STEPS));
        20.0 * (x * vx + y * vy)
    }

    /// The part of the intervals on which a control is at a bound.
    pub fn at_bound(&self, name: &str) -> f64 {
        let values = self.solved.control(name);
        values.iter().filter(|value| value.abs() > 1.999).count() as f64 / values.len() as f64
    }

    /// How far the car is from its plan.
    pub fn apart(&self, time: f64) -> f64 {
        let k = self.planned.time.partition_point(|other| *other < time);
        let ([x, y, ..], [u, v, ..]) = (self.planned.at(k), self.driven.at(k * POINTS));
        (x - u).hypot(y - v)
    }
}

fn replay(solved: &Solved) -> Simulation {
    let duration = solved.value("T");
    let mut model = changed(&text_of("racecar"), &[], &[]);
    model.set_free("T", duration);
    let system = compile_simulation(&model).expect("the model can be simulated");
    let at = |k: usize, count: usize| duration * k as f64 / count as f64;
    let times = (0..STEPS).map(|k| at(k, STEPS)).collect();
    let rows =
        solved.control("a").iter().zip(solved.control("s")).map(|(a, s)| vec![*a, *s]).collect();
    let points = (0..=STEPS * POINTS).map(|k| at(k, STEPS * POINTS)).collect();
    let options = Options { times: points, tape: true, ..Options::default() };
    let found = simulate(&system, &Controls::Held { times, rows, is_stretched: true }, &options);
    assert!(matches!(found.status, Status::Completed), "{:?}", found.status);
    found
}
