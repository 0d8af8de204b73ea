//! One trajectory of phases that were solved at once.
//!
//! A problem with jumps is solved as one without: each phase between two jumps has its own states
//! and controls over the same `tau` in [0, 1], and the durations of all phases but the last are its
//! last unknowns. Here they are put one after the other again: phase `j` begins at `T_j` and
//!
//! ```text
//! t = T_j + tau D_j,     x(t) = x_j(tau),     u(t) = u_j(tau),     T_j+1 = T_j + D_j
//! ```

use super::lagrangian::Hamiltonian;
use super::modes::modes;
use super::outcome::{Limiting, Outcome};
use super::trajectory::{Trajectory, sample, times};
use crate::nlp::{Place, Status};
use crate::problem::{Columns, Problem};

/// The state on both sides of a jump.
#[derive(Clone, Debug, PartialEq)]
pub struct Jump {
    /// When it happens.
    pub time: f64,
    /// The states before it.
    pub before: Vec<f64>,
    /// The states after it.
    pub after: Vec<f64>,
}

/// Puts the phases of a solution one after the other, with a jump between each two. `between` is
/// the problem of one phase by itself over the whole time. At the time of a jump the trajectory has
/// the state after it.
pub fn joined(between: &Problem, solved: &Problem, outcome: &Outcome) -> (Outcome, Vec<Jump>) {
    let phases = Phases::new(between, solved, &outcome.trajectory);
    let trajectory = phases.trajectory();
    let sigma: Vec<f64> = outcome.sigma[..between.surfaces.len()].to_vec();
    let switching = trajectory.switching.iter().zip(&sigma);
    let modes = switching.map(|(psi, sigma)| modes(&trajectory.time, psi, *sigma)).collect();
    let limiting = outcome.limiting.clone().map(|it| Limiting { time: None, ..it });
    let mut solution = outcome.solution.clone();
    if let Status::NotFinite(place) = &solution.status {
        solution.status = Status::NotFinite(Place { grid_point: None, ..place.clone() });
    }
    let jumps = phases.jumps();
    let attempts = outcome.attempts.clone();
    let (convex, is_impossible) = (outcome.convex, outcome.is_impossible);
    (
        Outcome { solution, trajectory, sigma, modes, convex, limiting, is_impossible, attempts },
        jumps,
    )
}

struct Phases<'a> {
    between: &'a Problem,
    solved: &'a Problem,
    /// Over `tau`.
    own: &'a Trajectory,
    /// When each phase begins, and when the last one ends.
    begins: Vec<f64>,
    /// `p` of the problem of one phase.
    parameters: Vec<f64>,
}

impl<'a> Phases<'a> {
    fn new(between: &'a Problem, solved: &'a Problem, own: &'a Trajectory) -> Self {
        let known = between.unknowns.len();
        let mut parameters: Vec<f64> = between.parameters.iter().map(|it| it.value).collect();
        // Both have the same parameters, then the same unknowns; then one has durations, and both
        // have widths.
        let shared = solved.unknowns.get(known).map_or(parameters.len(), |first| first.parameter);
        parameters[..shared].copy_from_slice(&own.parameters[..shared]);
        let widths = parameters.len() - shared;
        let first_width = shared + solved.unknowns.len() - known;
        parameters[shared..].copy_from_slice(&own.parameters[first_width..][..widths]);
        let whole = times(between, &parameters);
        let mut begins = vec![whole[0]];
        for duration in &solved.unknowns[known..] {
            begins.push(begins[begins.len() - 1] + own.parameters[duration.parameter]);
        }
        begins.push(whole[whole.len() - 1]);
        Phases { between, solved, own, begins, parameters }
    }

    fn count(&self) -> usize {
        self.begins.len() - 1
    }

    fn trajectory(&self) -> Trajectory {
        let states = self.shown_states();
        let time = self.time();
        let controls = self.controls();
        let points = self.points(&time, &states, &controls);
        Trajectory {
            report: sample(&*self.between.report, &points, &self.parameters),
            switching: sample(&*self.between.switching, &points, &self.parameters),
            costates: self.signals(&self.own.costates),
            path_multipliers: self.path_multipliers(),
            end_multipliers: self.end_multipliers(),
            // That of all phases at once is not that of any of them.
            hamiltonian: Hamiltonian::default(),
            nodes: None,
            time,
            states,
            controls,
            parameters: self.parameters.clone(),
        }
    }

    /// The start of each interval, and the last time.
    fn time(&self) -> Vec<f64> {
        let intervals = self.own.time.len() - 1;
        let of = |j: usize| {
            let (begin, duration) = (self.begins[j], self.begins[j + 1] - self.begins[j]);
            self.own.time[..intervals].iter().map(move |tau| begin + tau * duration)
        };
        (0..self.count()).flat_map(of).chain(self.begins.last().copied()).collect()
    }

    /// States, and zeros for integrals that are states to the solver only: they belong to no phase.
    fn shown_states(&self) -> Vec<Vec<f64>> {
        let mut states = self.signals(&self.own.states);
        let points = states.first().map_or(0, Vec::len);
        states.resize(self.between.states.len(), vec![0.0; points]);
        states
    }

    /// What all states have, one phase after the other.
    fn signals(&self, own: &[Vec<f64>]) -> Vec<Vec<f64>> {
        let states = self.shown();
        let phase = |i: usize, j: usize| {
            let column = &own[i + j * states];
            let is_last = j + 1 == self.count();
            column[..column.len() - usize::from(!is_last)].iter().copied()
        };
        (0..states).map(|i| (0..self.count()).flat_map(|j| phase(i, j)).collect()).collect()
    }

    fn shown(&self) -> usize {
        self.between.states.iter().filter(|state| !state.hidden).count()
    }

    fn controls(&self) -> Vec<Vec<f64>> {
        let controls = self.between.controls.len();
        let phases = |i: usize| (0..self.count()).map(move |j| i + j * controls);
        (0..controls)
            .map(|i| phases(i).flat_map(|at| self.own.controls[at].iter().copied()).collect())
            .collect()
    }

    /// `[t | x | u]` over the normalised time of the whole, with the last control at the end.
    fn points(&self, time: &[f64], states: &[Vec<f64>], controls: &[Vec<f64>]) -> Columns {
        let mut points = Columns::new(1 + states.len() + controls.len(), time.len());
        let (first, duration) = (time[0], time[time.len() - 1] - time[0]);
        let taus = time.iter().map(|t| (t - first) / duration);
        points.column_mut(0).iter_mut().zip(taus).for_each(|(place, tau)| *place = tau);
        for (at, column) in states.iter().chain(controls).enumerate() {
            let last = column.last().copied().unwrap_or(0.0);
            let values = column.iter().copied().chain([last]);
            points
                .column_mut(1 + at)
                .iter_mut()
                .zip(values)
                .for_each(|(place, value)| *place = value);
        }
        points
    }

    /// Of the constraints that are written; those that keep a phase on its side of a surface come
    /// after them.
    fn path_multipliers(&self) -> Vec<Vec<f64>> {
        let rows = self.between.path_bounds.len();
        let phase = |row: usize, j: usize| {
            let duration = self.begins[j + 1] - self.begins[j];
            self.own.path_multipliers[row + j * rows].iter().map(move |it| it / duration)
        };
        (0..rows).map(|row| (0..self.count()).flat_map(|j| phase(row, j)).collect()).collect()
    }

    /// Of the conditions that are written; those that tie the phases together come before them.
    fn end_multipliers(&self) -> Vec<f64> {
        let ties = self.solved.boundary_bounds.len() - self.between.boundary_bounds.len();
        self.own.end_multipliers[ties..].to_vec()
    }

    fn jumps(&self) -> Vec<Jump> {
        let states = self.shown();
        let state = |j: usize, of: fn(&[f64]) -> f64| -> Vec<f64> {
            (0..states).map(|i| of(&self.own.states[i + j * states])).collect()
        };
        let jump = |j: usize| Jump {
            time: self.begins[j],
            before: state(j - 1, |column| column[column.len() - 1]),
            after: state(j, |column| column[0]),
        };
        (1..self.count()).map(jump).collect()
    }
}
