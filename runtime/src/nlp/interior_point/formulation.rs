//! The NLP as the interior point method sees it: every constraint is an equality, with slacks.
//!
//! `y = [v | slacks | p | n]`. Every row becomes an equality
//!
//! ```text
//!     c_i(v) - target_i + sum over slacks j of sign_j y_j = 0
//! ```
//!
//! An inequality has a slack (`sign -1`, the bounds of the row, target 0). In a restoration phase
//! every row has two elastic variables more, `-p + n` with `p, n >= 0` and a cost: slacks, too. A
//! slack appears in its row only, so it is eliminated by a division, and the linear algebra never
//! sees it.

use crate::nlp::Nlp;
use crate::problem::Bounds;

/// A variable that appears, with coefficient `sign`, in one row only.
#[derive(Clone, Copy, Debug)]
pub(super) struct Slack {
    pub(super) row: usize,
    pub(super) sign: f64,
    /// Its coefficient in the objective.
    pub(super) cost: f64,
}

/// Sizes, bounds and attachments.
#[derive(Clone, Debug)]
pub(super) struct Formulation {
    /// Variables of the NLP.
    pub(super) variables: usize,
    pub(super) slacks: Vec<Slack>,
    /// How many of the slacks are those of inequalities; the others are elastic.
    pub(super) inequalities: usize,
    /// Bounds of `y`; infinite for fixed variables.
    pub(super) lower: Vec<f64>,
    pub(super) upper: Vec<f64>,
    /// Which of them are finite.
    bounded_below: Vec<u32>,
    bounded_above: Vec<u32>,
    /// Variables with one bound only, and its direction: +1 for a lower bound, -1 for an upper.
    pub(super) one_sided: Vec<(usize, f64)>,
    /// Right-hand sides of the rows.
    pub(super) target: Vec<f64>,
    pub(super) fixed: Vec<bool>,
    pub(super) equality: Vec<bool>,
    /// How far bounds were moved outwards, relative to their size where that is more than 1.
    pub(super) widened: f64,
}

impl Formulation {
    pub(super) fn new(nlp: &dyn Nlp) -> Self {
        let rows = nlp.constraint_bounds();
        let variables = nlp.variable_bounds();
        let equality: Vec<bool> = rows.iter().map(Bounds::is_equality).collect();
        let fixed: Vec<bool> = variables.iter().map(Bounds::is_equality).collect();
        let most = variables.len() + rows.len();
        let mut formulation = Formulation {
            variables: variables.len(),
            slacks: Vec::new(),
            inequalities: 0,
            lower: Vec::with_capacity(most),
            upper: Vec::with_capacity(most),
            bounded_below: Vec::with_capacity(most),
            bounded_above: Vec::with_capacity(most),
            one_sided: Vec::new(),
            target: rows.iter().map(|b| if b.is_equality() { b.lower } else { 0.0 }).collect(),
            fixed,
            equality,
            widened: 0.0,
        };
        for bounds in variables {
            formulation.push_bounds(if bounds.is_equality() { Bounds::FREE } else { *bounds });
        }
        for (row, bounds) in rows.iter().enumerate().filter(|(_, bounds)| !bounds.is_equality()) {
            formulation.slacks.push(Slack { row, sign: -1.0, cost: 0.0 });
            formulation.push_bounds(*bounds);
        }
        formulation.inequalities = formulation.slacks.len();
        formulation
    }

    /// The same with two elastic variables per row, each with cost `rho`.
    pub(super) fn elastic(&self, rho: f64) -> Self {
        // How far bounds were moved is no matter of a restoration: the smallest violation has no
        // price.
        let mut formulation = Formulation { widened: 0.0, ..self.clone() };
        for row in 0..self.target.len() {
            for sign in [-1.0, 1.0] {
                formulation.slacks.push(Slack { row, sign, cost: rho });
                formulation.push_bounds(Bounds { lower: 0.0, upper: f64::INFINITY });
            }
        }
        formulation
    }

    fn push_bounds(&mut self, bounds: Bounds) {
        let index = self.len() as u32;
        let (below, above) = (bounds.lower > f64::NEG_INFINITY, bounds.upper < f64::INFINITY);
        if below {
            self.bounded_below.push(index);
        }
        if above {
            self.bounded_above.push(index);
        }
        if below != above {
            self.one_sided.push((self.len(), if below { 1.0 } else { -1.0 }));
        }
        self.lower.push(bounds.lower);
        self.upper.push(bounds.upper);
    }

    /// Length of `y`.
    pub(super) fn len(&self) -> usize {
        self.lower.len()
    }

    /// How many bounds are finite.
    pub(super) fn bounds(&self) -> usize {
        self.bounded_below.len() + self.bounded_above.len()
    }

    /// Whether some lower bound is above its upper bound.
    pub(super) fn has_crossed_bounds(&self) -> bool {
        self.lower.iter().zip(&self.upper).any(|(lower, upper)| lower > upper)
    }

    /// Moves all bounds outwards.
    pub(super) fn widen(&mut self, by: f64) {
        self.widened = by;
        for i in 0..self.len() {
            self.lower[i] -= self.moved(self.lower[i]);
            self.upper[i] += self.moved(self.upper[i]);
        }
    }

    /// How far a bound is moved, or was.
    pub(super) fn moved(&self, bound: f64) -> f64 {
        self.widened * bound.abs().max(1.0)
    }

    /// Moves the right-hand sides so that these residuals become none.
    pub(super) fn relax(&mut self, residuals: &mut [f64]) {
        self.target.iter_mut().zip(&*residuals).for_each(|(target, residual)| *target += residual);
        residuals.fill(0.0);
    }

    /// Turns row values into residuals, in place.
    pub(super) fn residuals(&self, y: &[f64], rows: &mut [f64]) {
        rows.iter_mut().zip(&self.target).for_each(|(row, target)| *row -= target);
        for (slack, value) in self.slacks.iter().zip(&y[self.variables..]) {
            rows[slack.row] += slack.sign * value;
        }
    }

    /// The part of the objective that elastic variables cost.
    pub(super) fn elastic_cost(&self, y: &[f64]) -> f64 {
        let costs = self.slacks.iter().zip(&y[self.variables..]);
        costs.skip(self.inequalities).map(|(slack, value)| slack.cost * value).sum()
    }

    /// Moves `y` into the interior (Waechter & Biegler 2006, section 3.6).
    pub(super) fn push_inside(&self, y: &mut [f64], push: f64) {
        for i in 0..y.len() {
            let (lower, upper) = (self.lower[i], self.upper[i]);
            let room =
                if upper - lower < f64::INFINITY { push * (upper - lower) } else { f64::INFINITY };
            let from = |bound: f64| (push * bound.abs().max(1.0)).min(room);
            if lower > f64::NEG_INFINITY {
                y[i] = y[i].max(lower + from(lower));
            }
            if upper < f64::INFINITY {
                y[i] = y[i].min(upper - from(upper));
            }
        }
    }

    /// Calls `action(i, distance, direction)` for every finite bound: `direction` is +1 for a lower
    /// bound, -1 for an upper.
    #[inline]
    pub(super) fn for_each_bound(&self, y: &[f64], mut action: impl FnMut(usize, f64, f64)) {
        for i in self.bounded_below.iter().map(|i| *i as usize) {
            action(i, y[i] - self.lower[i], 1.0);
        }
        for i in self.bounded_above.iter().map(|i| *i as usize) {
            action(i, self.upper[i] - y[i], -1.0);
        }
    }
}
