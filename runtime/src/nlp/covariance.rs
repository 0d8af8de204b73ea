//! The inverse of the reduced Hessian of a Lagrangian over a few variables: how far these can
//! change, all others following by the constraints, before the objective has grown by 1/2.
//!
//! With the columns `E` of the identity that belong to these variables, the matrix `K` of the
//! optimality conditions, in which active bounds and inequalities are springs, and springs `R` on
//! the variables themselves,
//!
//! ```text
//!     S = E' (K + E R E')^-1 E = (H + R)^-1,   H^-1 = R^-1/2 [ sum of L/(1 - L) w w' ] R^-1/2
//! ```
//!
//! over the eigenvalues `L` and eigenvectors `w` of `R^1/2 S R^1/2`. An eigenvalue of 0 is a
//! direction that constraints forbid, one of 1 a direction in which nothing changes. `R` is first
//! soft: what holds a variable worse than that does not hold it. Then it is as stiff as what was
//! found, so that no digits are lost.
//!
//! A bound holds a variable where its spring, multiplier over distance, is stiffer than all else
//! that holds it. So it is, too, where the Lagrangian falls along the variable: the curvature is
//! then that in the other directions.

use super::implied::Equations;
use super::tuning::covariance::{
    CLOSE, GOLDEN, HARD, LEAST, NEAR, SETTLED, SMALL, SOFT, SOFTNESS, TINY,
};
use super::{Derivatives, Multipliers, Nlp, Solution};
use crate::linalg::dense::eigen::eigen;
use crate::linalg::solvers::{Structure, prepare};
use crate::linalg::{Factor, Inertia, Triplets};
use crate::problem::{Bounds, Linear};
use std::collections::HashSet;
use std::ops::Range;

/// What it is at a solution, by the places of the variables among those that were asked for.
#[derive(Clone, Debug)]
pub struct Covariance {
    /// The inverse, without the directions that change nothing.
    pub inverse: Vec<Vec<f64>>,
    /// Which variables a bound holds: the rest is that for their values.
    pub is_at_bound: Vec<bool>,
    /// The directions that change nothing, each by the variables that it changes.
    pub undetermined: Vec<Vec<usize>>,
    /// In how many directions all variables of the program could change that change something.
    pub directions: usize,
}

/// How large a variable may be taken to be: its value, or a part of what its bounds leave it.
pub(crate) fn size_of(value: f64, bounds: &Bounds) -> f64 {
    let width = bounds.upper - bounds.lower;
    value.abs().max(if width.is_finite() { LEAST * width } else { 0.0 })
}

/// That over a range of variables of which these are the sizes, where the objective is about
/// `unit` times a number of order 1; none where the Lagrangian falls along some direction that no
/// bound forbids.
pub(crate) fn covariance(
    nlp: &mut dyn Nlp,
    solution: &Solution,
    of: Range<usize>,
    (sizes, unit): (&[f64], f64),
) -> Option<Covariance> {
    let mut system = System::new(nlp, solution, of, (sizes, unit));
    let soft = |size: &f64| unit.max(TINY) / (SOFT * size).powi(2);
    let mut springs: Vec<f64> = sizes.iter().map(soft).collect();
    let is_at_bound = system.hold(&solution.v, sizes, &mut springs)?;
    let first = system.inverse(&springs)?;
    let soft = Springs::new(&first, &springs, &is_at_bound);
    for i in (0..sizes.len()).filter(|i| !is_at_bound[*i]) {
        springs[i] = springs[i].max(1.0 / first[i][i].max(least(sizes[i])));
    }
    let stiff = Springs::new(&system.inverse(&springs)?, &springs, &is_at_bound);
    let directions = system.directions(&is_at_bound);
    Some(stiff.taken_off(soft.count_open(), is_at_bound, directions))
}

/// The least entry of an inverse.
fn least(size: f64) -> f64 {
    TINY * size * size
}

/// The inverse with springs, taken apart.
struct Springs {
    /// The variables that no bound holds, with the roots of their springs.
    kept: Vec<(usize, f64)>,
    /// With the smallest eigenvalue first.
    directions: Vec<(f64, Vec<f64>)>,
}

impl Springs {
    fn new(with: &[Vec<f64>], springs: &[f64], is_at_bound: &[bool]) -> Self {
        let kept = springs.iter().map(|it| it.sqrt()).enumerate();
        let kept: Vec<(usize, f64)> = kept.filter(|(i, _)| !is_at_bound[*i]).collect();
        let row = |(i, root): &(usize, f64)| -> Vec<f64> {
            kept.iter().map(|(j, other)| root * with[*i][*j] * other).collect()
        };
        let (values, vectors) = eigen(kept.iter().map(row).collect());
        let vector = |k: usize| vectors.iter().map(|row| row[k]).collect();
        let mut directions: Vec<(f64, Vec<f64>)> =
            values.iter().enumerate().map(|(k, value)| (*value, vector(k))).collect();
        directions.sort_by(|a, b| a.0.total_cmp(&b.0));
        Springs { kept, directions }
    }

    /// In how many directions springs hold more than everything else.
    fn count_open(&self) -> usize {
        self.directions.iter().filter(|it| it.0 > 0.5).count()
    }

    /// The inverse without springs, and without the directions that hold least.
    fn taken_off(self, open: usize, is_at_bound: Vec<bool>, directions: usize) -> Covariance {
        let (n, known) = (is_at_bound.len(), self.directions.len() - open);
        let mut inverse = vec![vec![0.0; n]; n];
        for (value, vector) in &self.directions[..known] {
            let weight = value / (1.0 - value);
            for ((i, root), a) in self.kept.iter().zip(vector) {
                for ((j, other), b) in self.kept.iter().zip(vector) {
                    inverse[*i][*j] += weight * a * b / (root * other);
                }
            }
        }
        let changed = |(_, vector): &(f64, Vec<f64>)| -> Vec<usize> {
            let parts = self.kept.iter().zip(vector);
            parts.filter(|(_, part)| part.abs() > SMALL).map(|((i, _), _)| *i).collect()
        };
        let undetermined = self.directions[known..].iter().map(changed).collect();
        let directions = directions.saturating_sub(open);
        Covariance { inverse, is_at_bound, undetermined, directions }
    }
}

/// The optimality conditions at a solution.
pub(super) struct System {
    factor: Box<dyn Factor>,
    derivatives: Derivatives,
    bounds: Vec<Bounds>,
    /// What bounds add to the diagonal; `inverse()` leaves that of the range out.
    sigma: Vec<f64>,
    /// What inequalities add to the diagonal of their rows.
    d: Vec<f64>,
    /// How many conditions are inequalities that are active somewhere.
    active: usize,
    fixed: Vec<bool>,
    equality: Vec<bool>,
    of: Range<usize>,
}

impl System {
    pub(super) fn new(
        nlp: &mut dyn Nlp,
        solution: &Solution,
        of: Range<usize>,
        (sizes, unit): (&[f64], f64),
    ) -> Self {
        let worth = solution.objective.abs().max(unit).max(TINY);
        let (v, multipliers) = (&solution.v, &solution.multipliers);
        let mut derivatives = Derivatives::new(nlp);
        nlp.derivatives(v, 1.0, &multipliers.constraints, &mut derivatives);
        let mut values = vec![0.0; multipliers.constraints.len()];
        nlp.values(v, &mut values);
        let bounds = nlp.variable_bounds().to_vec();
        let fixed: Vec<bool> = bounds.iter().map(Bounds::is_equality).collect();
        let equality: Vec<bool> = nlp.constraint_bounds().iter().map(Bounds::is_equality).collect();
        let structure = Structure {
            stages: nlp.stages(),
            phases: nlp.phases(),
            hessian: nlp.hessian_structure(),
            jacobian: nlp.jacobian_structure(),
            fixed: &fixed,
            equality: &equality,
        };
        let (_, mut factor) = prepare(Linear::SparseLdl, &structure);
        let size = |i: usize| i.checked_sub(of.start).and_then(|at| sizes.get(at));
        let side = |i: usize, distance: f64, multiplier: f64| match size(i) {
            Some(size) => multiplier.max(0.0) / distance.max(CLOSE * size),
            None => spring(distance, multiplier, (size_of(v[i], &bounds[i]), worth)),
        };
        let lower = |i: usize| side(i, v[i] - bounds[i].lower, multipliers.lower[i]);
        let upper = |i: usize| side(i, bounds[i].upper - v[i], multipliers.upper[i]);
        let sigma = (0..v.len()).map(|i| lower(i) + upper(i)).collect();
        let terms = sizes_of_rows(nlp.jacobian_structure(), &derivatives.jacobian, v, values.len());
        let rows = nlp.constraint_bounds().iter().zip(&values).zip(&multipliers.constraints);
        let d = rows.zip(terms).map(|(((bounds, value), lambda), terms)| {
            slack(bounds, (*value, terms), *lambda, worth)
        });
        let d: Vec<f64> = d.collect();
        let is_active = |row: &usize| !equality[*row] && d[*row] < 1.0 / TINY;
        // One along the time is the same in all phases, one at the ends is not.
        let named = |row: usize| {
            let place = nlp.constraint_place(row);
            let phase = if place.grid_point.is_some() { 0 } else { place.phase };
            (phase, place.origin.label.to_string())
        };
        let springs = springs_of_sizes(nlp, v);
        let (jacobian, hessian) = (&derivatives.jacobian[..], derivatives.hessian.len());
        let rows = (nlp.jacobian_structure(), jacobian);
        let mut equations = Equations::new(&mut *factor, rows, (&springs, &equality), hessian);
        let mut active = HashSet::new();
        for row in (0..d.len()).filter(is_active) {
            let name = named(row);
            if !active.contains(&name) && !equations.imply(row) {
                active.insert(name);
            }
        }
        System { factor, derivatives, bounds, sigma, d, active: active.len(), fixed, equality, of }
    }

    /// With the springs of all bounds and inequalities, active or not: the matrix of the last step.
    pub(super) fn with_all_bounds(mut self, nlp: &mut dyn Nlp, solution: &Solution) -> Self {
        let Multipliers { constraints, lower, upper } = &solution.multipliers;
        let side = |multiplier: f64, distance: f64| multiplier.max(0.0) / distance.max(TINY);
        for (i, (bounds, value)) in self.bounds.iter().zip(&solution.v).enumerate() {
            let below = side(lower[i], value - bounds.lower);
            self.sigma[i] = below + side(upper[i], bounds.upper - value);
        }
        let mut values = vec![0.0; constraints.len()];
        nlp.values(&solution.v, &mut values);
        let rows = nlp.constraint_bounds().iter().zip(values.iter().zip(constraints));
        for ((d, is_equality), (bounds, (value, lambda))) in
            self.d.iter_mut().zip(&self.equality).zip(rows)
        {
            let below = side(-lambda, value - bounds.lower);
            let spring = below + side(*lambda, bounds.upper - value);
            *d = if *is_equality { 0.0 } else { 1.0 / spring.max(TINY) };
        }
        self
    }

    /// What bounds add to the diagonal, one number per variable.
    pub(super) fn springs(&self) -> &[f64] {
        &self.sigma
    }

    /// The solution for a right side over variables and rows, with as soft springs of all variables
    /// as give the right inertia; none if none of these does. What depends on how stiff they are
    /// beside each other, by more than `least`, is no number.
    pub(super) fn solved(
        &mut self,
        right: &[f64],
        (soft, least): (&[f64], &[f64]),
    ) -> Option<Vec<f64>> {
        let (part, found) = SOFTNESS.into_iter().find_map(|part| {
            let springs: Vec<f64> = soft.iter().map(|soft| part * soft).collect();
            Some((part, self.solved_with(right, &springs)?))
        })?;
        let part = part.max(SOFTNESS[1]);
        let uneven = |(i, soft): (usize, &f64)| part * soft * (1.0 + (GOLDEN * i as f64).fract());
        let other: Vec<f64> = soft.iter().enumerate().map(uneven).collect();
        let other = self.solved_with(right, &other)?;
        let told = |((own, other), least): ((&f64, &f64), &f64)| {
            let is_same = (own - other).abs() <= SETTLED * own.abs().max(other.abs()) + least;
            if is_same { *own } else { f64::NAN }
        };
        Some(found.iter().zip(&other).zip(least).map(told).collect())
    }

    fn solved_with(&mut self, right: &[f64], springs: &[f64]) -> Option<Vec<f64>> {
        let Derivatives { hessian, jacobian, .. } = &self.derivatives;
        let sigma: Vec<f64> = self.sigma.iter().zip(springs).map(|(own, it)| own + it).collect();
        if self.factor.factor(hessian, jacobian, &sigma, &self.d) != Inertia::Correct {
            return None;
        }
        let mut found = right.to_vec();
        self.factor.solve(&mut found);
        found.iter().all(|it| it.is_finite()).then_some(found)
    }

    /// Which variables a bound holds, whose springs become hard; none if the inertia is wrong with
    /// the springs of all bounds. With `with = 1/(own + bound)` that of a variable itself is `own`.
    fn hold(&mut self, v: &[f64], sizes: &[f64], springs: &mut [f64]) -> Option<Vec<bool>> {
        let bounds = self.sigma[self.of.clone()].to_vec();
        let all: Vec<f64> = springs.iter().zip(&bounds).map(|(own, bound)| own + bound).collect();
        let with = self.inverse(&all)?;
        let held = (0..sizes.len()).map(|i| {
            let (at, with, bound) = (self.of.start + i, with[i][i].max(least(sizes[i])), bounds[i]);
            let room = (v[at] - self.bounds[at].lower).min(self.bounds[at].upper - v[at]);
            let is_held = self.fixed[at] || room <= NEAR * sizes[i] && bound * with > 0.5;
            if is_held {
                let own = (1.0 / with - bound).abs().max(f64::EPSILON * bound);
                springs[i] = HARD * own.max(springs[i]);
            }
            is_held
        });
        Some(held.collect())
    }

    /// With these springs; none if the inertia is wrong.
    fn inverse(&mut self, springs: &[f64]) -> Option<Vec<Vec<f64>>> {
        let mut sigma = self.sigma.clone();
        sigma[self.of.clone()].copy_from_slice(springs);
        let Derivatives { hessian, jacobian, .. } = &self.derivatives;
        if self.factor.factor(hessian, jacobian, &sigma, &self.d) != Inertia::Correct {
            return None;
        }
        let mut column = |at: usize| {
            let mut right = vec![0.0; sigma.len() + self.d.len()];
            right[at] = 1.0;
            self.factor.solve(&mut right);
            right[self.of.clone()].to_vec()
        };
        let columns: Vec<Vec<f64>> = self.of.clone().map(&mut column).collect();
        let n = columns.len();
        let mean = |i: usize, j: usize| 0.5 * (columns[i][j] + columns[j][i]);
        Some((0..n).map(|i| (0..n).map(|j| mean(i, j)).collect()).collect())
    }

    /// How many variables may change at will: those that are neither fixed nor held, less the
    /// equations and the inequalities that are active. One that is so at several times forbids one
    /// direction at least.
    fn directions(&self, is_at_bound: &[bool]) -> usize {
        let held = self.of.clone().zip(is_at_bound).filter(|(i, held)| **held && !self.fixed[*i]);
        let variables = self.fixed.iter().filter(|it| !**it).count();
        let equations = self.equality.iter().filter(|it| **it).count();
        variables.saturating_sub(equations + self.active + held.count())
    }
}

/// One over the square of the size of each variable, or of its unit.
pub(super) fn springs_of_sizes(nlp: &dyn Nlp, v: &[f64]) -> Vec<f64> {
    let quantities = nlp.quantities();
    let units = quantities.variables.iter().map(|it| quantities.units[*it]);
    let spring = |(value, unit): (&f64, f64)| value.abs().max(unit).max(TINY).powi(-2);
    v.iter().zip(units).map(spring).collect()
}

/// `z / distance` of a bound, 0 of none and of one that is not active: what its multiplier is
/// worth, as a part of the objective, is less than the distance, as a part of the size.
pub(super) fn spring(distance: f64, multiplier: f64, (size, worth): (f64, f64)) -> f64 {
    let (distance, size) = (distance.max(TINY), size.max(distance).max(TINY));
    let is_active = multiplier * size / worth > distance / size;
    if distance.is_finite() && is_active { multiplier / distance } else { 0.0 }
}

/// For each row the largest of its terms, as far as it is linear.
pub(super) fn sizes_of_rows(
    structure: &Triplets,
    jacobian: &[f64],
    v: &[f64],
    rows: usize,
) -> Vec<f64> {
    let mut sizes = vec![0.0_f64; rows];
    for ((row, column), slope) in structure.entries().zip(jacobian) {
        sizes[row] = sizes[row].max((slope * v[column]).abs());
    }
    sizes
}

/// `distance / z` of a row from the bound that its multiplier belongs to; with its value stands the
/// size of its terms.
pub(super) fn slack(
    bounds: &Bounds,
    (value, terms): (f64, f64),
    multiplier: f64,
    worth: f64,
) -> f64 {
    if bounds.is_equality() {
        return 0.0;
    }
    let distance = if multiplier > 0.0 { bounds.upper - value } else { value - bounds.lower };
    let size = value.abs().max(terms).max(TINY);
    let spring = spring(distance, multiplier.abs(), (size, worth));
    // Rows may say the same: an arc of a state that rests. As hard as that they can be told apart.
    let hardest = HARD * worth / (size * size);
    1.0 / spring.min(hardest).max(TINY)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Hessian 2 on the sum of two, 8 on a third, nothing on a fourth, with springs of 1.
    #[test]
    fn what_changes_nothing_is_told_and_the_rest_is_known() {
        // (H + 1)^-1 of the block [[2, 2], [2, 2]] + 1.
        let with = vec![
            vec![0.6, -0.4, 0.0, 0.0],
            vec![-0.4, 0.6, 0.0, 0.0],
            vec![0.0, 0.0, 1.0 / 9.0, 0.0],
            vec![0.0, 0.0, 0.0, 1.0],
        ];
        let held = [false; 4];
        let found = Springs::new(&with, &[1.0; 4], &held);
        assert_eq!(found.count_open(), 2);
        let found = found.taken_off(2, held.to_vec(), 4);
        let mut undetermined = found.undetermined.clone();
        undetermined.sort();
        assert_eq!(undetermined, [vec![0, 1], vec![3]]);
        assert!((found.inverse[2][2] - 1.0 / 8.0).abs() < 1e-14);
        assert_eq!(found.directions, 2);
    }
}
