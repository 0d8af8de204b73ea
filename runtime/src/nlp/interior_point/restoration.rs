//! The restoration phase: back to (nearly) feasible points when the line search is stuck.
//!
//! From the point `v_R` where it starts, it solves, with the very same algorithm,
//!
//! ```text
//!     minimise    rho sum (p + n) + zeta/2 || D (v - v_R) ||^2
//!     subject to  c(v) - p + n = 0,  p, n >= 0
//! ```
//!
//! (Waechter & Biegler 2006, section 3.3), until a point is acceptable to the filter it was called
//! from. If it ends at an optimum of its own, the problem is locally infeasible: no small move
//! reduces the violation.

use super::algorithm::{Algorithm, Outcome};
use super::filter::Filter;
use super::formulation::Formulation;
use super::iterate::{Iterate, Values};
use super::residuals::Residuals;
use super::tuning::restoration::{FIRST_DECREASE, LARGEST_BOUND_MULTIPLIER, RHO};

use crate::linalg::{Family, PhaseStages, Stages, Triplets};
use crate::nlp::{Derivatives, Nlp, Options, Place, Progress, Quantities, Status, Watch};
use crate::problem::Bounds;
use std::sync::Arc;

/// How a restoration phase ended.
pub(super) enum Restored {
    /// The iterate is acceptable again.
    Acceptable,
    /// It found the smallest violation near by.
    Stationary,
    /// Its own line search found no step.
    Blocked,
    /// It ends the whole solve.
    Stopped(Status),
}

/// The rows of an NLP with a new objective: stay near `reference`.
pub(super) struct Proximity<'a> {
    inner: &'a mut dyn Nlp,
    reference: Vec<f64>,
    zeta: f64,
    /// The diagonal of `D^2`.
    weights: Vec<f64>,
    hessian: Triplets,
    /// The variable of each value that was appended to the Hessian.
    diagonal: Vec<usize>,
    derivatives: Derivatives,
}

impl<'a> Proximity<'a> {
    fn new(inner: &'a mut dyn Nlp, reference: &[f64], zeta: f64) -> Self {
        let weight = |value: &f64| (1.0 / value.abs()).min(1.0).powi(2);
        let appended = match &inner.phases()[..] {
            [] => diagonal_families(inner.stages(), reference.len()),
            phases => diagonal_families_of(phases, reference.len()),
        };
        let diagonal = Triplets { families: appended.clone() }.entries().map(|(i, _)| i).collect();
        let mut hessian = inner.hessian_structure().clone();
        hessian.families.extend(appended);
        let derivatives = Derivatives::new(inner);
        let weights = reference.iter().map(weight).collect();
        Proximity {
            inner,
            reference: reference.to_vec(),
            zeta,
            weights,
            hessian,
            diagonal,
            derivatives,
        }
    }
}

/// The diagonal, in families that respect the stages.
fn diagonal_families(stages: Option<Stages>, variables: usize) -> Vec<Family> {
    let repeat =
        |i, step, count| Family { row: i, column: i, row_step: step, column_step: step, count };
    match stages {
        None => vec![repeat(0, 1, variables)],
        Some(stages) => {
            let step = stages.variable_step();
            let chain = (0..step).map(|i| repeat(i, step, stages.intervals));
            let ends = stages.state(stages.intervals).chain(stages.globals());
            chain.chain(ends.map(|i| Family::single(i, i))).collect()
        }
    }
}

/// The same for several chains of stages.
fn diagonal_families_of(phases: &[PhaseStages], variables: usize) -> Vec<Family> {
    let of = |phase: &PhaseStages| -> Vec<Family> {
        let stages = Stages { globals: 0, ..phase.stages };
        let own = diagonal_families(Some(stages), phase.variables.len());
        let moved = |it: Family| {
            let place = phase.variables.start + it.row;
            Family { row: place, column: place, ..it }
        };
        own.into_iter().map(moved).collect()
    };
    let unknowns = phases.last().map_or(0, |last| last.variables.end)..variables;
    let unknowns = unknowns.map(|i| Family::single(i, i));
    phases.iter().flat_map(of).chain(unknowns).collect()
}

impl Nlp for Proximity<'_> {
    fn variable_bounds(&self) -> &[Bounds] {
        self.inner.variable_bounds()
    }
    fn constraint_bounds(&self) -> &[Bounds] {
        self.inner.constraint_bounds()
    }
    fn jacobian_structure(&self) -> &Triplets {
        self.inner.jacobian_structure()
    }
    fn hessian_structure(&self) -> &Triplets {
        &self.hessian
    }
    fn stages(&self) -> Option<Stages> {
        self.inner.stages()
    }
    fn phases(&self) -> Vec<PhaseStages> {
        self.inner.phases()
    }
    fn quantities(&self) -> Arc<Quantities> {
        self.inner.quantities()
    }
    fn objective_size(&mut self, terms: f64) -> f64 {
        terms
    }
    fn objective_unit(&mut self) -> f64 {
        1.0
    }
    fn values(&mut self, v: &[f64], rows: &mut [f64]) -> f64 {
        self.inner.values(v, rows);
        let distances = v.iter().zip(&self.reference).zip(&self.weights);
        0.5 * self.zeta * distances.map(|((v, r), w)| w * (v - r).powi(2)).sum::<f64>()
    }
    fn derivatives(&mut self, v: &[f64], weight: f64, multipliers: &[f64], out: &mut Derivatives) {
        self.inner.derivatives(v, 0.0, multipliers, &mut self.derivatives);
        for i in 0..v.len() {
            out.gradient[i] = self.zeta * self.weights[i] * (v[i] - self.reference[i]);
        }
        out.jacobian.copy_from_slice(&self.derivatives.jacobian);
        let (inner, appended) = out.hessian.split_at_mut(self.derivatives.hessian.len());
        inner.copy_from_slice(&self.derivatives.hessian);
        for (target, i) in appended.iter_mut().zip(&self.diagonal) {
            *target = weight * self.zeta * self.weights[*i];
        }
    }
    fn constraint_place(&self, row: usize) -> Place {
        self.inner.constraint_place(row)
    }
    fn not_finite(&mut self, v: &[f64]) -> Option<Place> {
        self.inner.not_finite(v)
    }
}

impl Algorithm {
    /// Looks for a feasible point near the start before the objective has a word, then iterates to
    /// the end.
    pub(super) fn run_with_phase_one(&mut self, nlp: &mut dyn Nlp, watch: &mut Watch) -> Status {
        let is_violated = self.values.is_finite() && self.values.largest() > self.options.tol;
        if is_violated && !self.formulation.has_crossed_bounds() {
            match self.restore(nlp, FIRST_DECREASE, watch) {
                Restored::Stopped(status) => return self.end_unseen(status, nlp),
                Restored::Stationary if self.values.largest() > self.options.tol => {
                    if self.relax(nlp) {
                        return self.end_unseen(Status::Infeasible, nlp);
                    }
                }
                Restored::Acceptable => {}
                Restored::Stationary | Restored::Blocked => self.begin_anew(nlp),
            }
        }
        self.run(nlp, watch)
    }

    /// Runs a restoration phase from the current iterate, until at most the fraction `decrease` of
    /// the violation is left.
    pub(super) fn restore(
        &mut self,
        nlp: &mut dyn Nlp,
        decrease: f64,
        watch: &mut Watch,
    ) -> Restored {
        self.watchdog.end();
        let violation = self.values.violation;
        self.filter.add(violation, self.barrier.value(&self.values));
        self.counts.restorations += 1;
        let mu = self.barrier.mu.max(self.values.largest().min(1.0));
        let variables = self.at.y[..self.formulation.variables].to_vec();
        let mut proximity = Proximity::new(nlp, &variables, mu.sqrt());
        let mut inner = self.elastic(&mut proximity, mu);
        let restored = loop {
            let outcome = inner.iterate(&mut proximity, &mut |progress| {
                watch(&Progress { restoration: true, ..*progress })
            });
            match outcome {
                Outcome::Continue => {}
                Outcome::Blocked => break Restored::Blocked,
                Outcome::Done(status) if status.is_solved() => break Restored::Stationary,
                // Its own objective has a least value: what runs away is the iteration.
                Outcome::Done(Status::Unbounded) => break Restored::Blocked,
                Outcome::Done(status) => break Restored::Stopped(status),
            }
            if self.accepts(proximity.inner, &inner.at, decrease * violation) {
                break Restored::Acceptable;
            }
            inner.loosen(&mut proximity);
        };
        self.take_over(proximity.inner, inner);
        if matches!(restored, Restored::Acceptable) {
            self.resume(proximity.inner);
        }
        restored
    }

    /// The restoration problem's own algorithm, at its start.
    fn elastic(&self, proximity: &mut Proximity, mu: f64) -> Algorithm {
        let formulation = self.formulation.elastic(RHO);
        let start = elastic_start(&formulation, &self.at, &self.values.residuals, mu);
        let options = Options { is_final: false, ..self.options };
        let mut inner = Algorithm::new(proximity, formulation, start, mu, options);
        inner.values.evaluate(proximity, &inner.formulation, &inner.at.y, &mut inner.counts);
        inner.filter = Filter::new(inner.values.violation);
        inner.counts = self.counts;
        inner
    }

    /// The wish to stay near weighs `zeta = sqrt(mu)` and vanishes with the barrier: it must not
    /// make a point look infeasible that is merely far from a feasible one.
    fn loosen(&mut self, proximity: &mut Proximity) {
        let zeta = self.barrier.mu.sqrt();
        if zeta < proximity.zeta {
            proximity.zeta = zeta;
            self.values.evaluate(proximity, &self.formulation, &self.at.y, &mut self.counts);
            self.filter.clear();
            self.watchdog.end();
            self.fresh = false;
        }
    }

    /// Whether the elastic iterate, without its elastic variables, satisfies the filter of this
    /// algorithm and violates rows by at most this.
    fn accepts(&mut self, nlp: &mut dyn Nlp, at: &Iterate, most: f64) -> bool {
        let y = &at.y[..self.formulation.len()];
        let mut values = Values::default();
        values.evaluate(nlp, &self.formulation, y, &mut self.counts)
            && values.violation <= most
            && self.filter.accepts(values.violation, self.barrier.value(&values))
    }

    fn take_over(&mut self, nlp: &mut dyn Nlp, inner: Algorithm) {
        self.counts = inner.counts;
        self.at.y.copy_from_slice(&inner.at.y[..self.formulation.len()]);
        // At the smallest violation these say which rows stand against each other.
        self.at.lambda = inner.at.lambda;
        self.values.evaluate(nlp, &self.formulation, &self.at.y, &mut self.counts);
        self.fresh = false;
    }

    /// Ends at a point that no iteration has looked at.
    pub(super) fn end_unseen(&mut self, status: Status, nlp: &mut dyn Nlp) -> Status {
        self.slopes.evaluate(nlp, &self.formulation, &self.at, &mut self.counts);
        self.residuals = Residuals::new(&self.formulation, &self.at, &self.values, &self.slopes);
        status
    }

    /// Multipliers after a restoration phase: bounds from the barrier, rows by least squares.
    pub(super) fn resume(&mut self, nlp: &mut dyn Nlp) {
        self.barrier.note(0.0, false);
        let mu = self.barrier.mu;
        self.at.set_bound_multipliers(&self.formulation, |distance| {
            (mu / distance).min(LARGEST_BOUND_MULTIPLIER)
        });
        self.estimate_multipliers(nlp);
    }
}

/// Elastic variables that minimise the barrier function at a fixed point (equation 33), and their
/// multipliers.
fn elastic_start(formulation: &Formulation, at: &Iterate, residuals: &[f64], mu: f64) -> Iterate {
    let mut start = at.clone();
    for (i, residual) in residuals.iter().enumerate() {
        let half = (mu - RHO * residual) / (2.0 * RHO);
        let n = half + (half * half + mu * residual / (2.0 * RHO)).sqrt();
        let p = residual + n;
        debug_assert_eq!(formulation.slacks[formulation.inequalities + 2 * i].row, i);
        start.y.extend([p, n]);
        start.lower.extend([mu / p, mu / n]);
        start.upper.extend([0.0, 0.0]);
    }
    start.lambda.fill(0.0);
    for z in start.lower[..at.y.len()].iter_mut().chain(&mut start.upper[..at.y.len()]) {
        *z = z.min(RHO);
    }
    start
}
