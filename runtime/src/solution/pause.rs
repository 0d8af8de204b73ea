//! What a pause on a surface would gain: a condition of every optimum that the multipliers of a
//! thin layer do not hide.
//!
//! Where time itself does not matter, a trajectory that meets a surface which can hold it may rest
//! there. A pause of length `dt` costs `dt` times the Hamiltonian of resting, and `dt` less for all
//! else costs `-dt` times the Hamiltonian that is the same all the time:
//!
//! ```text
//!     gain  =  H - min_u [ L(x, u) + p . f(x, u, s) ],     s such that psi' = 0
//! ```
//!
//! At an optimum there is none. `f` is tangent to the surface, so what a step through the layer has
//! lost of the costate, its part across the surface, does not count. `s` is found in the layer, on
//! the way of the interval that passes it; of controls only parts of that of the interval are
//! tried, so a gain is certain and its absence is not.

use super::trajectory::{Trajectory, sample};
use crate::problem::{Columns, Problem};

/// Points across a layer.
const SAMPLES: usize = 41;
/// Controls that are tried, as parts of that of the interval.
const PARTS: [f64; 5] = [0.0, 0.25, 0.5, 0.75, 1.0];
/// The whole time, times this, is a step that tells the rate of a switching function.
const STEP: f64 = 1e-6;
/// More passages are not looked at.
const MOST: usize = 100;

/// The largest gain per time, below 0 where a pause costs; nothing where no surface is met that can
/// hold, or nothing is known of the Hamiltonian.
pub(crate) fn gain(problem: &Problem, trajectory: &Trajectory) -> Option<f64> {
    let target =
        problem.sense * trajectory.hamiltonian.target().filter(|_| problem.has_objective)?;
    let intervals = 0..trajectory.time.len() - 1;
    let surfaces = 0..problem.surfaces.len();
    let places =
        surfaces.flat_map(|surface| intervals.clone().map(move |interval| (surface, interval)));
    let passages = places.filter_map(|place| Passage::new(problem, trajectory, place)).take(MOST);
    let rests: Vec<f64> = passages
        .flat_map(|it| PARTS.iter().filter_map(|part| it.rest(*part)).collect::<Vec<_>>())
        .collect();
    rests.into_iter().reduce(f64::min).map(|least| target - least)
}

/// An interval at one end of which at least a surface is not in its layer, and that reaches or
/// passes it.
struct Passage<'a> {
    problem: &'a Problem,
    trajectory: &'a Trajectory,
    surface: usize,
    interval: usize,
    /// Switching function at both ends.
    psi: [f64; 2],
    sigma: f64,
}

impl<'a> Passage<'a> {
    fn new(
        problem: &'a Problem,
        trajectory: &'a Trajectory,
        (surface, interval): (usize, usize),
    ) -> Option<Self> {
        let psi = &trajectory.switching[surface];
        let psi = [psi[interval], psi[interval + 1]];
        let sigma = trajectory.parameters[problem.surfaces[surface].sigma];
        let is_outside = psi.iter().any(|psi| psi.abs() > sigma);
        let is_met = psi[0].min(psi[1]) < sigma && psi[0].max(psi[1]) > -sigma;
        (is_outside && is_met).then_some(Passage {
            problem,
            trajectory,
            surface,
            interval,
            psi,
            sigma,
        })
    }

    /// The Hamiltonian of resting with this part of the control, if that is possible.
    fn rest(&self, part: f64) -> Option<f64> {
        let points = self.points(part);
        let psi = self.psi(&points);
        // Of a `Dir` it is a length, which is never below 0.
        let is_layer = psi[0] < -0.5 * self.sigma && psi[SAMPLES - 1] > 0.5 * self.sigma;
        if !is_layer {
            return None;
        }
        let flow = self.flow(&points);
        let rates = self.rates(&points, &psi, &flow);
        let place = (1..SAMPLES).find(|at| rates[at - 1] > 0.0 && rates[*at] <= 0.0)?;
        let values = self.hamiltonian(&flow);
        let weight = rates[place - 1] / (rates[place - 1] - rates[place]);
        let value = values[place - 1] + weight * (values[place] - values[place - 1]);
        // Terms that are larger than those of the whole solution are noise of its costates, not of
        // a pause.
        let is_sound = value.abs() <= self.trajectory.hamiltonian.size;
        (is_sound && self.is_allowed(&points, place)).then_some(value)
    }

    /// `[t | x | u]` on the line between the ends of the interval, from one side of the layer to
    /// the other.
    fn points(&self, part: f64) -> Columns {
        let (problem, k) = (self.problem, self.interval);
        let across = |at: usize| self.sigma * (2.0 * at as f64 / (SAMPLES - 1) as f64 - 1.0);
        let along = |at: usize| (across(at) - self.psi[0]) / (self.psi[1] - self.psi[0]);
        let mut points = Columns::new(1 + problem.layout.x + problem.layout.u, SAMPLES);
        for (i, state) in self.trajectory.states.iter().enumerate() {
            let column = points.column_mut(1 + i).iter_mut().enumerate();
            column.for_each(|(at, x)| *x = state[k] + along(at) * (state[k + 1] - state[k]));
        }
        for (i, (control, it)) in self.trajectory.controls.iter().zip(&problem.controls).enumerate()
        {
            let value = (part * control[k]).max(it.bounds.lower).min(it.bounds.upper);
            points.column_mut(1 + problem.layout.x + i).fill(value);
        }
        points
    }

    fn psi(&self, points: &Columns) -> Vec<f64> {
        sample(&*self.problem.switching, points, &self.trajectory.parameters)
            .swap_remove(self.surface)
    }

    fn flow(&self, points: &Columns) -> Vec<Vec<f64>> {
        sample(&*self.problem.dynamics, points, &self.trajectory.parameters)
    }

    /// Of the switching function, over the whole time.
    fn rates(&self, points: &Columns, psi: &[f64], flow: &[Vec<f64>]) -> Vec<f64> {
        let mut moved = points.clone();
        for (i, rates) in flow.iter().take(self.problem.layout.x).enumerate() {
            moved.column_mut(1 + i).iter_mut().zip(rates).for_each(|(x, rate)| *x += STEP * rate);
        }
        let both = self.psi(&moved).into_iter().zip(psi);
        both.map(|(moved, still)| (moved - still) / STEP).collect()
    }

    /// With the costate of the end that is farther from the surface.
    fn hamiltonian(&self, flow: &[Vec<f64>]) -> Vec<f64> {
        let (problem, trajectory) = (self.problem, self.trajectory);
        let far = self.interval + usize::from(self.psi[1].abs() > self.psi[0].abs());
        let duration = trajectory.time[trajectory.time.len() - 1] - trajectory.time[0];
        let costates = trajectory.costates.iter().map(|costate| problem.sense * costate[far]);
        let weights: Vec<f64> = costates.chain(problem.running_cost.then_some(1.0)).collect();
        let terms = |at: usize| {
            weights.iter().zip(flow).map(|(weight, output)| weight * output[at]).sum::<f64>()
        };
        (0..SAMPLES).map(|at| terms(at) / duration).collect()
    }

    fn is_allowed(&self, points: &Columns, place: usize) -> bool {
        let values = sample(&*self.problem.path, points, &self.trajectory.parameters);
        self.problem
            .path_bounds
            .iter()
            .zip(&values)
            .all(|(bounds, row)| bounds.violation(row[place]) == 0.0)
    }
}
