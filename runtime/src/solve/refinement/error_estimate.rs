//! The error of each step, by an accurate integration of the smoothed system from the beginning of
//! each interval.
//!
//! All intervals are integrated side by side by the classical Runge-Kutta scheme, with twice as
//! many steps until the ends stay where they are.

use crate::problem::{Columns, Problem};
use crate::solve::Outcome;
use crate::solve::tuning::error_estimate::{ACCURATE, FEWEST_STEPS, MOST_STEPS};
use crate::transcribe::TranscribedNlp;
use crate::transcribe::interval::add_up;

/// The largest relative error of a state, or of the running cost, over each interval.
pub(super) fn step_errors(problem: &Problem, outcome: &Outcome) -> Vec<f64> {
    let nlp = TranscribedNlp::new(problem);
    let flow =
        Flow { problem, nlp: &nlp, v: &outcome.solution.v, p: &outcome.trajectory.parameters };
    let (ends, scales) = (flow.ends_of_steps(), flow.scales(outcome.solution.objective));
    let mut errors = flow.errors(FEWEST_STEPS, &ends, &scales);
    let mut steps = FEWEST_STEPS;
    while steps < MOST_STEPS {
        steps *= 2;
        let better = flow.errors(steps, &ends, &scales);
        let change: f64 = errors.iter().zip(&better).map(|(a, b)| (a - b).abs()).sum();
        errors = better;
        if change <= ACCURATE * problem.method.tolerance {
            break;
        }
    }
    // Where even short steps have no value something is wrong with the interval: it is divided.
    errors.iter().map(|error| if error.is_finite() { *error } else { 1.0 }).collect()
}

/// The right side over normalised time, with the controls of a solution.
struct Flow<'a> {
    problem: &'a Problem,
    nlp: &'a TranscribedNlp<'a>,
    v: &'a [f64],
    p: &'a [f64],
}

impl Flow<'_> {
    fn intervals(&self) -> usize {
        self.nlp.chain().intervals
    }

    /// States and running cost at the end of each interval, as the scheme has them.
    fn ends_of_steps(&self) -> Columns {
        let (chain, problem) = (self.nlp.chain(), self.problem);
        let mut ends = Columns::new(problem.dynamics.outputs(), self.intervals());
        for (state, combination) in self.nlp.interval().end.states.iter().enumerate() {
            add_up(combination, chain, self.v, ends.column_mut(state));
        }
        for node in self.nlp.interval().nodes.iter().filter(|_| problem.running_cost) {
            let mut points =
                Columns::new(1 + problem.layout.x + problem.layout.u, self.intervals());
            node.point.set_times(self.nlp.mesh(), &mut points);
            node.point.load(chain, problem.dynamics.layout(), self.v, &mut points);
            let mut rates = Columns::new(problem.dynamics.outputs(), self.intervals());
            problem.dynamics.value(&points, self.p, &mut rates);
            let cost = rates.column(problem.layout.x);
            for (k, sum) in ends.column_mut(problem.layout.x).iter_mut().enumerate() {
                *sum += node.weight * self.length(k) * cost[k];
            }
        }
        ends
    }

    /// In normalised time.
    fn length(&self, k: usize) -> f64 {
        self.nlp.mesh().relative(k) / self.intervals() as f64
    }

    /// What an error is compared with: the size of the state, or of the objective, but at least 1.
    fn scales(&self, objective: f64) -> Vec<f64> {
        let states = self.nlp.interval().start.states.iter().map(|combination| {
            let mut column = vec![0.0; self.intervals()];
            add_up(combination, self.nlp.chain(), self.v, &mut column);
            column.iter().fold(1.0, |most: f64, x| most.max(x.abs()))
        });
        states.chain([objective.abs().max(1.0)]).collect()
    }

    fn errors(&self, steps: usize, ends: &Columns, scales: &[f64]) -> Vec<f64> {
        let accurate = self.integrated(steps);
        let error = |k: usize| {
            let one = |i: usize| (accurate.column(i)[k] - ends.column(i)[k]).abs() / scales[i];
            (0..ends.columns())
                .map(one)
                .fold(0.0, |most: f64, error| if error <= most { most } else { error })
        };
        (0..self.intervals()).map(error).collect()
    }

    /// States and running cost at the end of each interval after so many Runge-Kutta steps.
    fn integrated(&self, steps: usize) -> Columns {
        let outputs = self.problem.dynamics.outputs();
        let mut now = Columns::new(outputs, self.intervals());
        for (state, combination) in self.nlp.interval().start.states.iter().enumerate() {
            add_up(combination, self.nlp.chain(), self.v, now.column_mut(state));
        }
        for step in 0..steps {
            let at = |part: f64| (step as f64 + part) / steps as f64;
            let first = self.rates(at(0.0), &now);
            let second = self.rates(at(0.5), &self.moved(&now, &[(&first, 0.5)], steps));
            let third = self.rates(at(0.5), &self.moved(&now, &[(&second, 0.5)], steps));
            let last = self.rates(at(1.0), &self.moved(&now, &[(&third, 1.0)], steps));
            let (sixth, thirds) = (1.0 / 6.0, 1.0 / 3.0);
            let all = [(&first, sixth), (&second, thirds), (&third, thirds), (&last, sixth)];
            now = self.moved(&now, &all, steps);
        }
        now
    }

    fn moved(&self, from: &Columns, rates: &[(&Columns, f64)], steps: usize) -> Columns {
        let mut moved = from.clone();
        for i in 0..moved.columns() {
            for (rate, weight) in rates {
                let terms = rate.column(i).iter().enumerate();
                let terms = terms.map(|(k, rate)| weight * rate * self.length(k) / steps as f64);
                moved.column_mut(i).iter_mut().zip(terms).for_each(|(x, term)| *x += term);
            }
        }
        moved
    }

    /// The right side and the running cost at a time of each interval.
    fn rates(&self, part: f64, states: &Columns) -> Columns {
        let (problem, chain) = (self.problem, self.nlp.chain());
        let (dynamics, layout) = (&problem.dynamics, problem.dynamics.layout());
        let mut points = Columns::new(layout.point_inputs(), self.intervals());
        for (k, tau) in points.column_mut(0).iter_mut().enumerate() {
            *tau = self.nlp.mesh().at(k, part);
        }
        for state in 0..layout.x {
            points.column_mut(layout.t + state).copy_from_slice(states.column(state));
        }
        for (control, combination) in self.nlp.interval().controls_at(part).iter().enumerate() {
            add_up(combination, chain, self.v, points.column_mut(layout.t + layout.x + control));
        }
        let mut rates = Columns::new(dynamics.outputs(), self.intervals());
        dynamics.value(&points, self.p, &mut rates);
        rates
    }
}
