//! Inertia correction: the smallest regularisation with which the step is a descent direction
//! (Waechter & Biegler 2006, algorithm IC).

use super::formulation::Formulation;
use super::iterate::Slopes;
use super::kkt::Kkt;
use super::tuning::inertia::{
    BISECTIONS, CAUTION_GROWTH, CUT_SHORT, DECAY, DEPENDENT_ROWS, FIRST_GROWTH,
    FIRST_REGULARIZATION, GROWTH, LARGEST_REGULARIZATION, MOST_CAUTION, MU_POWER, NOT_CUT,
    ROW_REGULARIZATION, SMALLEST_REGULARIZATION,
};
use crate::linalg::Inertia;
use crate::nlp::Counts;

impl Kkt {
    /// Factors with the smallest regularisation that gives the right inertia; `false` if none does.
    /// Rows that depend on each other are regularised from the beginning.
    pub(super) fn factor_with_inertia(
        &mut self,
        formulation: &Formulation,
        slopes: &Slopes,
        mu: f64,
        are_dependent: bool,
        counts: &mut Counts,
    ) -> bool {
        // IC-1, IC-3: the unmodified matrix first. Curvature that was wrong a moment ago is likely
        // to be wrong again: zero is tried only every other time.
        let start = if self.was_needed { self.smaller_regularization() } else { 0.0 };
        self.regularization = start.max(self.caution);
        let (first, mut rows) =
            (self.regularization, if are_dependent { DEPENDENT_ROWS } else { 0.0 });
        loop {
            match self.factor_once(formulation, slopes, rows, counts) {
                Inertia::Correct => break,
                // IC-2: a regularisation of the constraints where the matrix is singular.
                Inertia::Singular if rows == 0.0 => rows = ROW_REGULARIZATION * mu.powf(MU_POWER),
                // IC-5: a larger one of the Hessian.
                Inertia::Wrong | Inertia::Singular => {
                    self.regularization = self.next_regularization()
                }
            }
            // IC-6
            if self.regularization > LARGEST_REGULARIZATION {
                return false;
            }
        }
        self.was_needed = self.regularization > first;
        if self.regularization > 0.0 {
            self.last_regularization = self.regularization;
        }
        true
    }

    /// Factors with a regularisation of at least `least` that gives the right inertia, and hardly
    /// more than one that does not; `true` if that is `least` itself, or none does.
    pub(super) fn factor_barely(
        &mut self,
        formulation: &Formulation,
        slopes: &Slopes,
        mu: f64,
        least: f64,
        counts: &mut Counts,
    ) -> bool {
        // Far away from the start it may be 0, which does not grow.
        self.regularization = least.max(1.0 / LARGEST_REGULARIZATION);
        let (mut rows, mut wrong) = (0.0, None);
        loop {
            match self.factor_once(formulation, slopes, rows, counts) {
                Inertia::Correct => break,
                Inertia::Singular if rows == 0.0 => rows = ROW_REGULARIZATION * mu.powf(MU_POWER),
                Inertia::Wrong | Inertia::Singular => {
                    wrong = Some(self.regularization);
                    self.regularization *= GROWTH;
                }
            }
            if self.regularization.is_nan() || self.regularization > LARGEST_REGULARIZATION {
                return true;
            }
        }
        let Some(mut wrong) = wrong else { return true };
        // Inverse iteration tells directions apart by their distances from the regularisation.
        let mut right = self.regularization;
        for _ in 0..BISECTIONS {
            self.regularization = (wrong * right).sqrt();
            match self.factor_once(formulation, slopes, rows, counts) {
                Inertia::Correct => right = self.regularization,
                Inertia::Wrong | Inertia::Singular => wrong = self.regularization,
            }
        }
        if self.regularization != right {
            self.regularization = right;
            self.factor_once(formulation, slopes, rows, counts);
        }
        false
    }

    /// Whether the matrix that was assembled has the right inertia with so much less on the
    /// diagonal of each variable.
    pub(super) fn curves_by(
        &mut self,
        least: &[f64],
        formulation: &Formulation,
        slopes: &Slopes,
        counts: &mut Counts,
    ) -> bool {
        self.sigma.iter_mut().zip(least).for_each(|(sigma, least)| *sigma -= least);
        self.regularization = 0.0;
        self.factor_once(formulation, slopes, 0.0, counts) == Inertia::Correct
    }

    /// Whether some regularisation gave the right inertia.
    pub(super) fn is_factored(&self) -> bool {
        self.regularization <= LARGEST_REGULARIZATION
    }

    /// Whether the last factorisation was that of Newton's own matrix.
    pub(super) fn is_newton(&self) -> bool {
        self.regularization == 0.0
    }

    /// Learns from a line search: steps that are cut again and again often come from a nearly
    /// singular Hessian, and are made shorter by regularising it although its inertia is right.
    /// Where that does not help it is given up.
    pub(super) fn judge(&mut self, fraction: f64) {
        if fraction < CUT_SHORT {
            let raised = (CAUTION_GROWTH * self.caution).max(FIRST_REGULARIZATION);
            self.caution = if raised > MOST_CAUTION { 0.0 } else { raised };
        } else if fraction > NOT_CUT {
            self.caution = if self.caution < FIRST_REGULARIZATION {
                0.0
            } else {
                self.caution / CAUTION_GROWTH
            };
        }
    }

    fn smaller_regularization(&self) -> f64 {
        (DECAY * self.last_regularization).max(SMALLEST_REGULARIZATION)
    }

    fn next_regularization(&self) -> f64 {
        match (self.regularization, self.last_regularization) {
            (0.0, 0.0) => FIRST_REGULARIZATION,
            (0.0, _) => self.smaller_regularization(),
            (now, 0.0) => FIRST_GROWTH * now,
            (now, _) => GROWTH * now,
        }
    }

    fn factor_once(
        &mut self,
        formulation: &Formulation,
        slopes: &Slopes,
        rows: f64,
        counts: &mut Counts,
    ) -> Inertia {
        counts.factorizations += 1;
        counts.regularizations += usize::from(self.regularization > 0.0);
        for (target, sigma) in self.diagonal.iter_mut().zip(&self.sigma) {
            *target = sigma + self.regularization;
        }
        self.d.fill(rows);
        for (slack, sigma) in formulation.slacks.iter().zip(&self.sigma[formulation.variables..]) {
            self.d[slack.row] += 1.0 / (sigma + self.regularization);
        }
        let derivatives = &slopes.derivatives;
        self.factor.factor(&derivatives.hessian, &derivatives.jacobian, &self.diagonal, &self.d)
    }
}
