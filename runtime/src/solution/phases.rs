//! One trajectory of phases between jumps.
//!
//! At the time of a jump it has the state after it. What each phase says of its times is put one
//! after the other; each has a grid of its own.

use super::hamiltonian::Hamiltonian;
use super::modes::{Span, modes};
use super::outcome::{ChainOutcome, Limiting, Outcome};
use super::trajectory::{ControlNodes, Trajectory};
use crate::lagrange;
use crate::nlp::{Place, Status};
use crate::problem::{Chain, Columns, Problem};

/// A shorter phase, for the whole time, lasts for no time.
const MOMENT: f64 = 1e-9;

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
/// the problem of one phase by itself over the whole time.
pub fn joined(between: &Problem, chain: &Chain, outcome: &ChainOutcome) -> (Outcome, Vec<Jump>) {
    let phases: Vec<&Trajectory> = outcome.phases.iter().map(|it| &it.trajectory).collect();
    let phases = Phases { between, phases };
    let trajectory = Trajectory {
        parameters: phases.parameters(chain),
        end_multipliers: end_multipliers(between, chain, outcome),
        ..phases.trajectory()
    };
    let sigma: Vec<f64> = outcome.sigma[..between.surfaces.len()].to_vec();
    let switching = trajectory.switching.iter().zip(&sigma);
    let modes = switching.map(|(psi, sigma)| modes(&trajectory.time, psi, *sigma)).collect();
    let limiting = outcome.limiting.clone().map(|it| Limiting { phase: 0, ..it });
    let mut solution = outcome.solution.clone();
    if let Status::NotFinite(place) = &solution.status {
        solution.status = Status::NotFinite(Place { grid_point: None, phase: 0, ..place.clone() });
    }
    let attempts = outcome.attempts.clone();
    let (convex, is_impossible) = (outcome.convex, outcome.is_impossible);
    (
        Outcome { solution, trajectory, sigma, modes, convex, limiting, is_impossible, attempts },
        phases.jumps(),
    )
}

/// Puts the phases of given modes of the true system one after the other; and the state on both
/// sides of each end of a phase. `between` is the smoothed problem over the whole time, `modes`
/// what each of its surfaces does.
pub fn located(
    between: &Problem,
    chain: &Chain,
    outcome: &ChainOutcome,
    modes: Vec<Vec<Span>>,
) -> (Outcome, Vec<Jump>) {
    let bare = Problem { surfaces: Vec::new(), ..between.clone() };
    let (mut whole, ends) = joined(&bare, chain, outcome);
    let trajectory = &mut whole.trajectory;
    trajectory.parameters.resize(between.parameters.len(), 0.0);
    trajectory.switching = switching(between, trajectory);
    whole.sigma = vec![0.0; between.surfaces.len()];
    (Outcome { modes, ..whole }, ends)
}

/// The functions of all surfaces at the grid points.
fn switching(between: &Problem, trajectory: &Trajectory) -> Vec<Vec<f64>> {
    let count = trajectory.time.len();
    let mut points = Columns::new(between.switching.layout().point_inputs(), count);
    let [first, last] = [trajectory.time[0], trajectory.time[count - 1]];
    for (tau, time) in points.column_mut(0).iter_mut().zip(&trajectory.time) {
        *tau = (time - first) / (last - first);
    }
    let states = between.layout.x.min(trajectory.states.len());
    for (at, column) in trajectory.states[..states].iter().enumerate() {
        points.column_mut(1 + at).copy_from_slice(column);
    }
    let mut values = Columns::new(between.switching.outputs(), count);
    between.switching.value(&points, &trajectory.parameters, &mut values);
    (0..between.switching.outputs()).map(|at| values.column(at).to_vec()).collect()
}

/// Of the conditions that are written, which are the last ones of the links; then of starts, which
/// belong to the first phase.
fn end_multipliers(between: &Problem, chain: &Chain, outcome: &ChainOutcome) -> Vec<f64> {
    let of_starts = &outcome.phases[0].trajectory.end_multipliers;
    if chain.links.is_empty() {
        return of_starts.clone();
    }
    let rows = &outcome.solution.multipliers.constraints;
    let written = between.boundary_bounds.len() - of_starts.len();
    let linked = rows[rows.len() - written..].iter().map(|lambda| -between.sense * lambda);
    linked.chain(of_starts.iter().copied()).collect()
}

struct Phases<'a> {
    between: &'a Problem,
    /// In the order of time.
    phases: Vec<&'a Trajectory>,
}

impl Phases<'_> {
    fn trajectory(&self) -> Trajectory {
        Trajectory {
            time: self.at_points(&|it| std::slice::from_ref(&it.time)).swap_remove(0),
            states: self.shown_states(),
            controls: self.on_intervals(&|it| &it.controls[..self.between.controls.len()]),
            nodes: self.nodes(),
            costates: self.shown(self.at_points(&|it| &it.costates)),
            path_multipliers: self
                .on_intervals(&|it| &it.path_multipliers[..self.between.path_bounds.len()]),
            end_multipliers: Vec::new(),
            // What it has to be in one phase says nothing of another: its values alone.
            hamiltonian: Hamiltonian { values: self.hamiltonian(), ..Hamiltonian::default() },
            report: self.at_points(&|it| &it.report),
            switching: self.at_points(&|it| &it.switching),
            parameters: Vec::new(),
        }
    }

    /// Without the times of the jumps, which stand between the unknowns of the model and the
    /// widths.
    fn parameters(&self, chain: &Chain) -> Vec<f64> {
        let (own, known) = (&self.phases[0].parameters, self.between.unknowns.len());
        let Some(first) = chain.unknowns.get(known) else { return own.clone() };
        let behind = first.parameter + chain.unknowns.len() - known;
        [&own[..first.parameter], &own[behind..]].concat()
    }

    /// Columns with a number for each grid point: the last one of a phase is the first of the next.
    fn at_points(&self, columns: &dyn Fn(&Trajectory) -> &[Vec<f64>]) -> Vec<Vec<f64>> {
        let last = self.phases.len() - 1;
        let of = |i: usize| {
            let phases = self.phases.iter().enumerate();
            let own = phases.flat_map(|(j, it)| {
                let column = &columns(it)[i];
                &column[..column.len() - usize::from(j < last)]
            });
            own.copied().collect()
        };
        (0..columns(self.phases[0]).len()).map(of).collect()
    }

    /// That of each phase on its intervals. A phase that lasts for no time, such as the touch of a
    /// surface, is kept from becoming shorter, which its own says: it has that of the one before.
    fn hamiltonian(&self) -> Vec<f64> {
        let ends = |it: &Trajectory| [it.time[0], it.time[it.time.len() - 1]];
        let duration = |[first, last]: [f64; 2]| last - first;
        let [first, last] = [0, self.phases.len() - 1].map(|at| ends(self.phases[at]));
        let least = MOMENT * (last[1] - first[0]);
        let mut all: Vec<f64> = Vec::new();
        for phase in &self.phases {
            let (own, before) = (&phase.hamiltonian.values, all.last().copied());
            match before.filter(|_| duration(ends(phase)) <= least) {
                Some(before) => all.extend(own.iter().map(|_| before)),
                None => all.extend(own),
            }
        }
        all
    }

    /// Columns with a number for each interval.
    fn on_intervals(&self, columns: &dyn Fn(&Trajectory) -> &[Vec<f64>]) -> Vec<Vec<f64>> {
        let of = |i: usize| self.phases.iter().flat_map(|it| &columns(it)[i]).copied().collect();
        (0..columns(self.phases[0]).len()).map(of).collect()
    }

    /// Without integrals that are states to the solver only: they belong to no phase.
    fn shown(&self, mut columns: Vec<Vec<f64>>) -> Vec<Vec<f64>> {
        columns.truncate(self.between.states.iter().filter(|state| !state.hidden).count());
        columns
    }

    /// States, and zeros for those that are not shown.
    fn shown_states(&self) -> Vec<Vec<f64>> {
        let mut states = self.shown(self.at_points(&|it| &it.states));
        let points = self.phases.iter().map(|it| it.time.len() - 1).sum::<usize>() + 1;
        states.resize(self.between.states.len(), vec![0.0; points]);
        states
    }

    /// As many nodes in each interval, so that each has its own values at its ends.
    fn nodes(&self) -> Option<ControlNodes> {
        if let [only] = &self.phases[..] {
            return only.nodes.clone();
        }
        self.phases.iter().find(|it| it.nodes.is_some())?;
        let own: Vec<Piece> = self.phases.iter().flat_map(|it| pieces(it)).collect();
        let most = own.iter().map(|piece| piece.time.len()).max()?;
        let own: Vec<Piece> = own.into_iter().map(|piece| piece.with_nodes(most)).collect();
        let values = |i: usize| own.iter().flat_map(|piece| &piece.values[i]).copied().collect();
        Some(ControlNodes {
            time: own.iter().flat_map(|piece| &piece.time).copied().collect(),
            values: (0..self.between.controls.len()).map(values).collect(),
        })
    }

    fn jumps(&self) -> Vec<Jump> {
        let states = |it: &Trajectory, of: fn(&[f64]) -> f64| -> Vec<f64> {
            self.shown(it.states.clone()).iter().map(|column| of(column)).collect()
        };
        let jump = |pair: &[&Trajectory]| Jump {
            time: pair[1].time[0],
            before: states(pair[0], |column| column[column.len() - 1]),
            after: states(pair[1], |column| column[0]),
        };
        self.phases.windows(2).map(jump).collect()
    }
}

/// The controls of an interval.
#[derive(Clone)]
struct Piece {
    /// First and last time.
    ends: [f64; 2],
    /// Of its nodes.
    time: Vec<f64>,
    /// One column per control.
    values: Vec<Vec<f64>>,
}

/// The intervals of a phase; a control that is constant has its value in the middle.
fn pieces(phase: &Trajectory) -> Vec<Piece> {
    let intervals = phase.time.len() - 1;
    let middle = |k: usize| 0.5 * (phase.time[k] + phase.time[k + 1]);
    let constant = || ControlNodes {
        time: (0..intervals).map(middle).collect(),
        values: phase.controls.clone(),
    };
    let nodes = phase.nodes.clone().unwrap_or_else(constant);
    let is_linear = nodes.time.len() == intervals + 1;
    let own = if is_linear { 1 } else { nodes.time.len() / intervals };
    let piece = |k: usize| {
        let range = k * own..(k + 1) * own + usize::from(is_linear);
        let of = |column: &Vec<f64>| column[range.clone()].to_vec();
        Piece {
            ends: [phase.time[k], phase.time[k + 1]],
            time: of(&nodes.time),
            values: nodes.values.iter().map(of).collect(),
        }
    };
    (0..intervals).map(piece).collect()
}

impl Piece {
    /// The same polynomials by so many nodes.
    fn with_nodes(self, count: usize) -> Piece {
        if self.time.len() == count {
            return self;
        }
        let [first, last] = self.ends;
        let at = |node: usize| first + (last - first) * (node as f64 + 0.5) / count as f64;
        let time: Vec<f64> = (0..count).map(at).collect();
        let value = |column: &[f64], time: f64| -> f64 {
            lagrange::combined(&lagrange::values(&self.time, time), column.iter().copied())
        };
        let of = |column: &Vec<f64>| time.iter().map(|time| value(column, *time)).collect();
        let values = self.values.iter().map(of).collect();
        Piece { values, time, ..self }
    }
}
