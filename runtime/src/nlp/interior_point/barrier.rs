//! The barrier function, its parameter, and how far a step may go (Waechter & Biegler 2006, section
//! 2.1, 3.7).
//!
//! The parameter never rises, and falls where its problem is solved: `E_mu <= accuracy * mu`. Near
//! a solution of it Newton's method takes whole steps, and would do so from a rough solution, too;
//! far from one a parameter that falls too early costs more than it saves. So there are two rules:
//! the monotone one of Fiacco and McCormick, and a superlinear one.

use super::formulation::Formulation;
use super::iterate::{Iterate, SearchDirection, Slopes, Values};
use super::residuals::Residuals;
use super::tuning::barrier::{
    BELOW_TOLERANCE, CLOSE, DAMPING, MONOTONE, MULTIPLIER_CORRIDOR, PRODUCTS, SMALLEST_FRACTION,
    SUPERLINEAR, SUPERLINEAR_AFTER, WHOLE,
};
use super::vectors::dot;

/// How exactly a barrier problem is solved before `mu` falls, which it does to the smaller of
/// `factor * mu` and `mu^power`.
pub(super) struct UpdateRule {
    pub(super) accuracy: f64,
    pub(super) factor: f64,
    pub(super) power: f64,
}

/// The barrier parameter `mu` and the fraction `tau` of the way to the boundary that a step may go.
#[derive(Clone, Copy, Debug)]
pub(super) struct Barrier {
    pub(super) mu: f64,
    smallest: f64,
    /// Whole steps in a row.
    whole_steps: usize,
}

impl Barrier {
    pub(super) fn new(mu: f64, tol: f64) -> Self {
        Barrier { mu, smallest: tol / BELOW_TOLERANCE, whole_steps: 0 }
    }

    /// Lets the parameter fall as far as this error asks for.
    pub(super) fn aim_at(&mut self, error: f64) {
        self.smallest = error / BELOW_TOLERANCE;
    }

    /// Makes room around a point that was left.
    pub(super) fn raise(&mut self, mu: f64) {
        self.mu = self.mu.max(mu);
    }

    pub(super) fn tau(&self) -> f64 {
        SMALLEST_FRACTION.max(1.0 - self.mu)
    }

    /// Notes which fraction of a step was taken; one that is not Newton's own counts as none.
    pub(super) fn note(&mut self, fraction: f64, is_newton: bool) {
        self.whole_steps = if is_newton && fraction >= WHOLE { self.whole_steps + 1 } else { 0 };
    }

    /// Lowers `mu` while its problem is solved; `true` if it changed.
    pub(super) fn update(&mut self, residuals: &Residuals) -> bool {
        let before = self.mu;
        let rule = if self.whole_steps >= SUPERLINEAR_AFTER { SUPERLINEAR } else { MONOTONE };
        while residuals.error(self.mu) <= rule.accuracy * self.mu && self.lower_by(&rule) {}
        self.mu < before
    }

    /// Lowers `mu` by one step of the monotone rule; `false` if it is as low as it gets.
    pub(super) fn lower(&mut self) -> bool {
        self.lower_by(&MONOTONE)
    }

    fn lower_by(&mut self, rule: &UpdateRule) -> bool {
        let next = (rule.factor * self.mu).min(self.mu.powf(rule.power));
        // The tolerance would be met between the last two: the objective would be as far off as
        // chance has it.
        let next = if next < CLOSE * self.smallest { self.smallest } else { next };
        let lowered = next < self.mu;
        self.mu = next.min(self.mu);
        lowered
    }

    /// `phi = f - mu sum ln(distance) + damping`
    pub(super) fn value(&self, values: &Values) -> f64 {
        let Terms { logarithms, damping } = values.terms;
        values.objective - self.mu * logarithms + DAMPING * self.mu * damping
    }

    /// Adds the gradient of the damping to `gradient`.
    pub(super) fn add_damping(&self, formulation: &Formulation, gradient: &mut [f64]) {
        for &(i, direction) in &formulation.one_sided {
            gradient[i] += direction * DAMPING * self.mu;
        }
    }

    /// Slope of `phi` along a step; `slopes` must be those of the iterate, and `barrier_gradient`
    /// that of `phi - f`.
    pub(super) fn slope(
        formulation: &Formulation,
        slopes: &Slopes,
        barrier_gradient: &[f64],
        step: &SearchDirection,
    ) -> f64 {
        let gradient = dot(&slopes.derivatives.gradient, &step.y[..formulation.variables]);
        let costs = formulation
            .slacks
            .iter()
            .zip(&step.y[formulation.variables..])
            .skip(formulation.inequalities);
        let cost: f64 = costs.map(|(slack, d)| slack.cost * d).sum();
        gradient + cost + dot(barrier_gradient, &step.y)
    }

    /// Largest step lengths of primal and dual variables that stay inside.
    pub(super) fn longest_steps(
        &self,
        formulation: &Formulation,
        at: &Iterate,
        step: &SearchDirection,
    ) -> (f64, f64) {
        let tau = self.tau();
        let (mut primal, mut dual) = (1.0f64, 1.0f64);
        formulation.for_each_bound(&at.y, |i, distance, direction| {
            let towards = -direction * step.y[i];
            if towards * primal > tau * distance {
                primal = tau * distance / towards;
            }
            let (z, dz) = if direction > 0.0 {
                (at.lower[i], step.lower[i])
            } else {
                (at.upper[i], step.upper[i])
            };
            if -dz * dual > tau * z {
                dual = tau * z / -dz;
            }
        });
        (primal, dual)
    }

    /// Keeps bound multipliers near `mu / distance`.
    pub(super) fn correct_multipliers(&self, formulation: &Formulation, at: &mut Iterate) {
        let Iterate { y, lower, upper, .. } = at;
        formulation.for_each_bound(y, |i, distance, direction| {
            let z = if direction > 0.0 { &mut lower[i] } else { &mut upper[i] };
            let centre = self.mu / distance;
            // Unlike `clamp` these take what is not a number.
            *z = z.max(centre * (1.0 / MULTIPLIER_CORRIDOR)).min(centre * MULTIPLIER_CORRIDOR);
        });
    }
}

/// The sums in the barrier function of which the parameter is a factor.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Terms {
    logarithms: f64,
    damping: f64,
}

impl Terms {
    pub(super) fn new(formulation: &Formulation, y: &[f64]) -> Self {
        let (mut logarithms, mut damping) = (LogarithmSum::default(), 0.0);
        formulation.for_each_bound(y, |_, distance, _| logarithms.add(distance));
        for &(i, direction) in &formulation.one_sided {
            damping += if direction > 0.0 {
                y[i] - formulation.lower[i]
            } else {
                formulation.upper[i] - y[i]
            };
        }
        Terms { logarithms: logarithms.sum(), damping }
    }
}

/// Sum of logarithms, with one logarithm for many factors. Products take turns, so that none has to
/// wait for the one before.
struct LogarithmSum {
    sum: f64,
    products: [f64; 4],
}

impl Default for LogarithmSum {
    fn default() -> Self {
        LogarithmSum { sum: 0.0, products: [1.0; 4] }
    }
}

impl LogarithmSum {
    fn add(&mut self, factor: f64) {
        let [first, second, third, fourth] = self.products;
        let mut product = first * factor;
        if !PRODUCTS.contains(&product) {
            self.sum += product.ln();
            product = 1.0;
        }
        self.products = [second, third, fourth, product];
    }
    fn sum(&self) -> f64 {
        self.sum + self.products.iter().product::<f64>().ln()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What 0.1 becomes after two steps, given by what was taken of them and whether they were
    /// Newton's own, at a point with this error.
    fn after(steps: [(f64, bool); 2], error: f64) -> f64 {
        let mut barrier = Barrier::new(0.1, 1e-8);
        steps.iter().for_each(|(fraction, is_newton)| barrier.note(*fraction, *is_newton));
        barrier.update(&Residuals::of_gradient(error));
        barrier.mu
    }

    #[test]
    fn the_parameter_falls_sooner_and_further_where_newtons_method_converges() {
        let (whole, cut, regularised) = ((1.0, true), (0.5, true), (1.0, false));
        assert!((after([whole, whole], 1.0) - 0.005).abs() < 1e-12);
        for steps in [[whole, cut], [cut, whole], [whole, regularised], [regularised, whole]] {
            assert_eq!(after(steps, 1.0), 0.1);
        }
        // However it falls, it ends at the same place.
        assert_eq!([after([whole, whole], 0.0), after([whole, cut], 0.0)], [1e-9; 2]);
    }
}
