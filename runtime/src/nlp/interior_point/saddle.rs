//! Leaving a stationary point that is no minimum, along a direction of negative curvature.
//!
//! At a minimum the Hessian of the barrier Lagrangian is positive semidefinite on the null space of
//! the rows (Nocedal & Wright, Numerical Optimization, 2nd ed., section 12.5), which
//! the inertia of the factored matrix tells. Where it is not, inverse iteration with a
//! regularisation that just gives the right inertia finds the eigenvector of the lowest
//! eigenvalue, and the Lagrangian falls along it to either side. Curvature that can gain nothing
//! that counts is none.
//!
//! Where the lowest curvature is 0, as of `u^3` and `-u^4` at 0, derivatives of higher order
//! decide: short steps to both sides along its direction show what they say.

use super::algorithm::Algorithm;
use super::iterate::{SearchDirection, Values};
use super::tuning::saddle::{
    AWAY, CREEPING, FEW_ITERATIONS, GOLDEN, ITERATIONS, LARGEST_VIOLATION, LEAST_GAIN, LONGER,
    MOST_DEPARTURES, MOST_HALVINGS, MOST_ITERATIONS, NOTHING, ROOM, ROUNDING, SHORT_STEPS,
    SIGN_PATTERNS, SPREAD,
};
use super::vectors::dot;
use crate::nlp::Nlp;
use crate::nlp::assessment::Assessment;

/// What became of a stationary point.
pub(super) enum Departure {
    /// It is a minimum, as far as curvature says.
    NotNeeded,
    /// The iterate is another one.
    Taken,
    /// It is none, but the Lagrangian does not fall along the direction that was found.
    Impossible,
}

impl Algorithm {
    /// Leaves a stationary point that is no minimum.
    pub(super) fn departure(&mut self, nlp: &mut dyn Nlp, found: &Assessment) -> Departure {
        // The step before ended here, with Newton's own matrix and the right inertia.
        if self.counts.iterations > 0 && self.kkt.is_newton() {
            return Departure::NotNeeded;
        }
        let least = self.least_curvature(nlp, found);
        let Some((mut step, curvature)) = self.lowest_curvature(nlp, least) else {
            // Without a matrix nothing is known of its curvature: another factorisation may say it.
            self.is_saddle = !self.kkt.is_factored();
            return if self.is_saddle { Departure::Impossible } else { Departure::NotNeeded };
        };
        let length = self.stretch(&self.reach(nlp), &mut step);
        let gain = -0.5 * curvature * length * length;
        if gain <= found.least_gain(self.options.tol) {
            return Departure::NotNeeded;
        }
        self.is_saddle = self.departures >= MOST_DEPARTURES || !self.depart(nlp, &mut step, gain);
        self.departures += 1;
        if self.is_saddle { Departure::Impossible } else { Departure::Taken }
    }

    /// Leaves a point near a saddle to which regularised steps creep: they go down where the
    /// Lagrangian is convex by little, and along a direction of negative curvature that its
    /// gradient does not know not at all. `false` where they do as well.
    pub(super) fn leaves_creeping(&mut self, nlp: &mut dyn Nlp) -> bool {
        if self.creeping < self.creeping_limit || self.departures >= MOST_DEPARTURES {
            return false;
        }
        self.creeping_limit *= LONGER;
        let decrease = self.kkt.slope(&self.step).abs();
        let found = self.assessment(nlp);
        let least = self.least_curvature(nlp, &found);
        let Some((mut step, curvature)) = self.lowest_curvature(nlp, least) else { return false };
        let length = self.stretch(&self.reach(nlp), &mut step);
        let gain = -0.5 * curvature * length * length;
        let is_left = gain > CREEPING * decrease && self.depart(nlp, &mut step, gain);
        self.departures += usize::from(is_left);
        is_left
    }

    /// Whether the barrier is all that keeps variables between their bounds from gaining what
    /// counts: without it the inertia is wrong. With a smaller barrier parameter it tells.
    pub(super) fn hides_curvature(&mut self, nlp: &dyn Nlp, found: &Assessment) -> bool {
        let worth = self.barrier.mu * self.formulation.bounds() as f64;
        if worth <= found.least_gain(self.options.tol) {
            return false;
        }
        let least = self.least_curvature(nlp, found);
        self.assemble_without_barrier(nlp);
        let Algorithm { formulation, slopes, kkt, barrier, counts, .. } = self;
        !kkt.factor_barely(formulation, slopes, barrier.mu, least, counts)
    }

    /// The matrix at the iterate without what the barrier adds to it, but for variables that are
    /// near a bound.
    fn assemble_without_barrier(&mut self, nlp: &dyn Nlp) {
        let reach = self.reach(nlp);
        let Algorithm { formulation, at, slopes, kkt, barrier, .. } = self;
        kkt.assemble(formulation, at, slopes, barrier);
        let mut is_near = vec![false; reach.len()];
        formulation.for_each_bound(&at.y, |i, distance, _| {
            let is_far = |reach: &f64| distance > AWAY * reach;
            is_near.get_mut(i).into_iter().for_each(|it| *it |= !reach.get(i).is_some_and(is_far));
        });
        kkt.forget_barrier(&is_near);
    }

    /// A point (one value per variable) beside the iterate, which stays, if that is no minimum.
    pub(super) fn descent_by_curvature(
        &mut self,
        nlp: &mut dyn Nlp,
        found: &Assessment,
    ) -> Option<Vec<f64>> {
        let before = (self.at.clone(), self.values.clone(), self.barrier.mu);
        let is_left = matches!(self.departure(nlp, found), Departure::Taken);
        let beside = self.at.y[..self.formulation.variables].to_vec();
        (self.at, self.values, self.barrier.mu) = before;
        self.is_saddle = false;
        is_left.then_some(beside)
    }

    /// A point (one value per variable) near the iterate, to which the Lagrangian falls although
    /// neither slope nor curvature says so; the shortest step that changes it by what counts
    /// decides.
    pub(super) fn descent_of_higher_order(
        &mut self,
        nlp: &mut dyn Nlp,
        found: &Assessment,
    ) -> Option<Vec<f64>> {
        let counts = found.least_gain(self.options.tol);
        if self.rises_all_around(nlp, counts) {
            return None;
        }
        let least = self.least_curvature(nlp, found);
        self.factor_at_iterate(least);
        let sizes = self.own_sizes(nlp);
        (0..SIGN_PATTERNS).find_map(|pattern| {
            let start = signs(nlp, pattern);
            let (mut step, _) = self.softest_direction(&start, FEW_ITERATIONS)?;
            self.stretch(&sizes, &mut step);
            self.descent_along(nlp, &mut step, &SHORT_STEPS, counts)
        })
    }

    /// Whether the longest of the short steps costs what counts in every direction, as curvature
    /// says without the barrier: with so much less of it the inertia is right still, and no
    /// derivative of higher order has to decide.
    fn rises_all_around(&mut self, nlp: &dyn Nlp, worth: f64) -> bool {
        let [.., longest] = SHORT_STEPS;
        let least = |size: &f64| 2.0 * worth / (longest * size).powi(2);
        let least: Vec<f64> = self.own_sizes(nlp).iter().map(least).collect();
        self.assemble_without_barrier(nlp);
        let Algorithm { formulation, slopes, kkt, counts, .. } = self;
        kkt.curves_by(&least, formulation, slopes, counts)
    }

    /// The same along a step or back.
    pub(super) fn descent_along(
        &mut self,
        nlp: &mut dyn Nlp,
        step: &mut SearchDirection,
        parts: &[f64],
        counts: f64,
    ) -> Option<Vec<f64>> {
        let lagrangian = self.barrier_lagrangian(&self.values);
        for _ in 0..2 {
            for part in parts {
                let alpha =
                    part.min(self.barrier.longest_steps(&self.formulation, &self.at, step).0);
                let (y, values) = self.moved(nlp, step, alpha)?;
                let change = self.barrier_lagrangian(&values) - lagrangian;
                if change < -counts && values.violation <= LARGEST_VIOLATION {
                    return Some(y[..self.formulation.variables].to_vec());
                }
                if change > counts {
                    break;
                }
            }
            turn(step);
        }
        None
    }

    /// The point after a part of a step; `None` where it has no value.
    pub(super) fn moved(
        &mut self,
        nlp: &mut dyn Nlp,
        step: &SearchDirection,
        alpha: f64,
    ) -> Option<(Vec<f64>, Values)> {
        let y: Vec<f64> = self.at.y.iter().zip(&step.y).map(|(y, d)| y + alpha * d).collect();
        let mut values = Values::default();
        values.evaluate(nlp, &self.formulation, &y, &mut self.counts).then_some((y, values))
    }

    /// A unit vector over `y` in the null space of the rows and the curvature along it, if that is
    /// below `-least`.
    fn lowest_curvature(&mut self, nlp: &dyn Nlp, least: f64) -> Option<(SearchDirection, f64)> {
        if self.factor_at_iterate(least) {
            return None;
        }
        let (mut step, mut curvature) = self.softest_direction(&signs(nlp, 0), ITERATIONS)?;
        for _ in ITERATIONS..MOST_ITERATIONS {
            if curvature < -ROUNDING * self.terms_of_curvature(nlp, &step) {
                return Some((step, curvature));
            }
            let Algorithm { formulation, slopes, kkt, .. } = self;
            curvature = kkt.inverse_iteration(formulation, slopes, &mut step)?;
        }
        None
    }

    /// The sum of the sizes of all terms of the curvature along a step.
    fn terms_of_curvature(&self, nlp: &dyn Nlp, step: &SearchDirection) -> f64 {
        let terms = nlp.hessian_structure().entries().zip(&self.slopes.derivatives.hessian);
        terms.map(|((i, j), h)| (h * step.y[i] * step.y[j]).abs()).sum()
    }

    /// See [`Kkt::factor_barely`](super::kkt::Kkt::factor_barely), at the iterate.
    pub(super) fn factor_at_iterate(&mut self, least: f64) -> bool {
        let Algorithm { formulation, at, slopes, kkt, barrier, counts, .. } = self;
        kkt.assemble(formulation, at, slopes, barrier);
        kkt.factor_barely(formulation, slopes, barrier.mu, least, counts)
    }

    /// A unit vector over `y` in the null space of the rows along which the matrix that was
    /// factored last has the lowest curvature, and the curvature without its regularisation; by
    /// inverse iterations from these signs of the variables.
    fn softest_direction(
        &mut self,
        signs: &[f64],
        iterations: usize,
    ) -> Option<(SearchDirection, f64)> {
        let Algorithm { formulation, slopes, kkt, .. } = self;
        let mut step = SearchDirection::new(formulation);
        // Nearly the same at all times: of several directions that are as good, one that goes to
        // one side.
        let size = |i: usize| 1.0 + SPREAD * (i as f64 * GOLDEN).fract();
        signs.iter().enumerate().for_each(|(i, sign)| step.y[i] = sign * size(i));
        let mut curvature = f64::NAN;
        for _ in 0..iterations {
            curvature = kkt.inverse_iteration(formulation, slopes, &mut step)?;
        }
        Some((step, curvature))
    }

    /// Less curvature cannot gain what counts, however far the variables go.
    pub(super) fn least_curvature(&self, nlp: &dyn Nlp, found: &Assessment) -> f64 {
        let reach = self.reach(nlp);
        2.0 * found.least_gain(self.options.tol) / dot(&reach, &reach)
    }

    /// How far each variable may go: by its size, its unit, its nominal magnitude, which is 1 in a
    /// scaled program, or between its bounds: one newton moves no truck.
    fn reach(&self, nlp: &dyn Nlp) -> Vec<f64> {
        let quantities = nlp.quantities();
        let mut sizes: Vec<f64> = quantities.units.iter().map(|unit| unit.max(1.0)).collect();
        let bounds = nlp.variable_bounds().iter().map(|it| it.upper - it.lower);
        for ((i, value), range) in quantities.variables.iter().zip(&self.at.y).zip(bounds) {
            let range = if range.is_finite() { range } else { 0.0 };
            sizes[*i] = sizes[*i].max(value.abs()).max(range);
        }
        quantities.variables.iter().map(|i| sizes[*i]).collect()
    }

    /// The largest value over time of the quantity that each variable belongs to; its nominal
    /// magnitude, which is 1, where it is 0.
    pub(super) fn own_sizes(&self, nlp: &dyn Nlp) -> Vec<f64> {
        let quantities = nlp.quantities();
        let mut sizes = vec![0.0; quantities.units.len()];
        for (i, value) in quantities.variables.iter().zip(&self.at.y) {
            sizes[*i] = value.abs().max(sizes[*i]);
        }
        let size = |i: &usize| if sizes[*i] > NOTHING { sizes[*i] } else { 1.0 };
        quantities.variables.iter().map(size).collect()
    }

    /// Makes the step as long as bounds and the reach of the variable that moves most allow; its
    /// length.
    pub(super) fn stretch(&self, reach: &[f64], step: &mut SearchDirection) -> f64 {
        let moves = reach.iter().zip(&step.y).map(|(reach, d)| d.abs() / reach);
        let factor = 1.0 / moves.fold(f64::MIN_POSITIVE, f64::max);
        step.y.iter_mut().for_each(|d| *d *= factor);
        let longest = self.longest_of_both(step);
        step.y.iter_mut().for_each(|d| *d *= longest);
        factor * longest
    }

    /// How far the step may go to the side that has more room.
    fn longest_of_both(&self, step: &mut SearchDirection) -> f64 {
        let ahead = self.barrier.longest_steps(&self.formulation, &self.at, step).0;
        turn(step);
        let back = self.barrier.longest_steps(&self.formulation, &self.at, step).0;
        if back < ahead {
            turn(step);
        }
        ahead.max(back)
    }

    /// Goes along the step, or back, as far as the Lagrangian falls; `false` if it does not.
    fn depart(&mut self, nlp: &mut dyn Nlp, step: &mut SearchDirection, gain: f64) -> bool {
        let lagrangian = self.barrier_lagrangian(&self.values);
        for halvings in 0..MOST_HALVINGS {
            let part = 0.5f64.powi(halvings as i32);
            for _ in 0..2 {
                let alpha =
                    part.min(self.barrier.longest_steps(&self.formulation, &self.at, step).0);
                let Some((y, values)) = self.moved(nlp, step, alpha) else { continue };
                let is_good = values.violation <= LARGEST_VIOLATION
                    && self.barrier_lagrangian(&values)
                        < lagrangian - LEAST_GAIN * gain * alpha * alpha;
                if is_good {
                    (self.at.y, self.values, self.fresh) = (y, values, false);
                    self.counts.iterations += 1;
                    // A barrier that is worth more than the gain would push it back.
                    self.barrier.raise(ROOM.min(gain));
                    self.begin_anew(nlp);
                    return true;
                }
                turn(step);
            }
        }
        false
    }

    pub(super) fn barrier_lagrangian(&self, values: &Values) -> f64 {
        self.barrier.value(values) + dot(&self.at.lambda, &values.residuals)
    }
}

/// A sign for each variable, the same for all of a quantity; pattern 0 has no minus. Of three
/// quantities that follow each other the first four patterns have all signs, but for turning.
fn signs(nlp: &dyn Nlp, pattern: usize) -> Vec<f64> {
    let is_even = |quantity: &usize| (quantity & pattern).count_ones().is_multiple_of(2);
    let quantities = nlp.quantities();
    quantities.variables.iter().map(|it| if is_even(it) { 1.0 } else { -1.0 }).collect()
}

fn turn(step: &mut SearchDirection) {
    step.y.iter_mut().for_each(|d| *d = -*d);
}
