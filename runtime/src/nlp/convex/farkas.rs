//! Whether multipliers of affine rows prove that no point within the bounds meets them (Farkas'
//! lemma; Boyd & Vandenberghe, Convex Optimization, section 5.8): at all these points the sum of
//! the rows, each times its multiplier, is larger than their bounds allow.
//!
//! A variable without a bound must not be in that sum at all: a slope of 1e-9, which is what a
//! solver leaves, is an excess of nothing at values of 1e9. Multipliers are moved as little as
//! takes these slopes away before they are believed.

use crate::linalg::sparse_ldl::SparseLdl;
use crate::linalg::{Factor, Inertia, Triplets};
use crate::nlp::tuning::farkas::{MARGIN, NOT_USED, REPAIRS, ROUNDING};
use crate::nlp::{Derivatives, Nlp};
use crate::problem::Bounds;

/// The affine rows at the origin, with their slopes.
struct Rows {
    at_origin: Vec<f64>,
    jacobian: Vec<f64>,
}

/// `lambda` has one multiplier per row.
pub(super) fn proves_infeasible(nlp: &mut dyn Nlp, lambda: &[f64]) -> bool {
    let rows = Rows::new(nlp);
    let mut lambda = lambda.to_vec();
    drop_noise(nlp, &mut lambda);
    for _ in 0..REPAIRS {
        let open = rows.open(nlp, &lambda);
        if open.iter().all(|it| !it) {
            return rows.exceed(nlp, &lambda);
        }
        if rows.close(nlp, &open, &mut lambda).is_none() {
            return false;
        }
    }
    rows.open(nlp, &lambda).iter().all(|it| !it) && rows.exceed(nlp, &lambda)
}

/// A multiplier of a bound that is not there proves nothing, and nor does one that rounding made.
fn drop_noise(nlp: &dyn Nlp, lambda: &mut [f64]) {
    let largest = lambda.iter().fold(0.0, |most: f64, it| most.max(it.abs()));
    for (own, bounds) in lambda.iter_mut().zip(nlp.constraint_bounds()) {
        if !side(bounds, *own).is_finite() || own.abs() <= ROUNDING * largest {
            *own = 0.0;
        }
    }
}

/// The bound of a row that its multiplier speaks of.
fn side(bounds: &Bounds, multiplier: f64) -> f64 {
    if multiplier > 0.0 { bounds.upper } else { bounds.lower }
}

impl Rows {
    fn new(nlp: &mut dyn Nlp) -> Self {
        let origin = vec![0.0; nlp.variable_bounds().len()];
        let mut at_origin = vec![0.0; nlp.constraint_bounds().len()];
        let mut at = Derivatives::new(nlp);
        nlp.values(&origin, &mut at_origin);
        nlp.derivatives(&origin, 0.0, &vec![0.0; at_origin.len()], &mut at);
        Rows { at_origin, jacobian: at.jacobian }
    }

    /// The slopes of the sum of the rows by each variable, and the sums of the sizes of their
    /// terms.
    fn slopes(&self, nlp: &dyn Nlp, lambda: &[f64]) -> [Vec<f64>; 2] {
        let zeros = vec![0.0; nlp.variable_bounds().len()];
        let [mut slopes, mut sizes] = [zeros.clone(), zeros];
        let entries = nlp.jacobian_structure().entries().zip(&self.jacobian);
        for ((row, column), value) in entries {
            slopes[column] += value * lambda[row];
            sizes[column] += (value * lambda[row]).abs();
        }
        [slopes, sizes]
    }

    /// Variables that can make the sum as small as one likes.
    fn open(&self, nlp: &dyn Nlp, lambda: &[f64]) -> Vec<bool> {
        let [slopes, sizes] = self.slopes(nlp, lambda);
        let all = slopes.iter().zip(&sizes).zip(nlp.variable_bounds());
        all.map(|((slope, size), bounds)| {
            slope.abs() > ROUNDING * size && !side(bounds, -slope).is_finite()
        })
        .collect()
    }

    /// Moves multipliers so that the slopes by open variables are 0, and those by other variables
    /// without bounds stay so: with `W` the squares of the multipliers,
    ///
    /// ```text
    /// min  d' W^-1 d      A_F' (lambda + d) = 0
    /// ```
    fn close(&self, nlp: &dyn Nlp, open: &[bool], lambda: &mut [f64]) -> Option<()> {
        let [slopes, _] = self.slopes(nlp, lambda);
        let bounds = nlp.variable_bounds().iter();
        let is_free = |it: &Bounds| it.lower == f64::NEG_INFINITY && it.upper == f64::INFINITY;
        let fixed: Vec<bool> = bounds.zip(open).map(|(it, open)| !open && !is_free(it)).collect();
        let structure = nlp.jacobian_structure();
        let mut ldl = SparseLdl::new(&Triplets::default(), structure, &fixed, lambda.len());
        let largest = lambda.iter().fold(f64::MIN_POSITIVE, |most, it| most.max(it.abs()));
        let weight = |(own, bounds): (&f64, &Bounds)| match bounds.is_equality() {
            true => 1.0,
            false => (own / largest).powi(2).max(NOT_USED),
        };
        let weights: Vec<f64> = lambda.iter().zip(nlp.constraint_bounds()).map(weight).collect();
        let inverse: Vec<f64> = weights.iter().map(|it| 1.0 / it).collect();
        let is_unused = self.unused(nlp);
        let sigma: Vec<f64> = is_unused.iter().map(|it| f64::from(u8::from(*it))).collect();
        if ldl.factor(&[], &self.jacobian, &sigma, &inverse) == Inertia::Singular {
            return None;
        }
        let mut solution: Vec<f64> = slopes.iter().map(|it| -it).collect();
        solution.resize(slopes.len() + lambda.len(), 0.0);
        ldl.solve(&mut solution);
        let moves = &solution[slopes.len()..];
        for ((own, more), weight) in lambda.iter_mut().zip(moves).zip(&weights) {
            *own += if *weight > NOT_USED { *more } else { 0.0 };
        }
        drop_noise(nlp, lambda);
        Some(())
    }

    /// Variables in no row.
    fn unused(&self, nlp: &dyn Nlp) -> Vec<bool> {
        let mut unused = vec![true; nlp.variable_bounds().len()];
        for ((_, column), value) in nlp.jacobian_structure().entries().zip(&self.jacobian) {
            unused[column] &= *value == 0.0;
        }
        unused
    }

    /// Whether the least value of the sum is above what the bounds of the rows allow, by more than
    /// rounding. No variable is open.
    fn exceed(&self, nlp: &dyn Nlp, lambda: &[f64]) -> bool {
        let [slopes, _] = self.slopes(nlp, lambda);
        let (mut sum, mut size) = (0.0, 0.0);
        let mut add = |term: f64| {
            sum += term;
            size += term.abs();
        };
        for (slope, bounds) in slopes.iter().zip(nlp.variable_bounds()) {
            let bound = side(bounds, -slope);
            if *slope != 0.0 && bound.is_finite() {
                add(slope * bound);
            }
        }
        let rows = lambda.iter().zip(&self.at_origin).zip(nlp.constraint_bounds());
        for ((own, row), bounds) in rows.filter(|it| *it.0.0 != 0.0) {
            add(own * row);
            add(-own * side(bounds, *own));
        }
        sum > MARGIN * size
    }
}
