//! Whether the multipliers of a solution are the only ones: where conditions depend on each other,
//! as the same one written twice, there are others, and what one of the conditions is worth is
//! anybody's guess.
//!
//! With springs `S` on all variables that no bound holds, and little `D` on the rows `A` that are
//! active,
//!
//! ```text
//!     [ S   A' ] [ v ]   [  0  ]
//!     [ A  -D  ] [ n ] = [ D r ]
//! ```
//!
//! leaves of `-r` the part `n` with `A' n = 0`, and of the rest what `D` is beside `A S^-1 A'`.

use super::covariance::{sizes_of_rows, slack, spring, springs_of_sizes};
use super::tuning::other_multipliers::{LARGEST, OFF, SHORT, SOFT, STEPS, WRONG};
use super::{Derivatives, Multipliers, Nlp, Solution};
use crate::linalg::Inertia;
use crate::linalg::solvers::{Structure, prepare};
use crate::problem::{Bounds, Linear};
use crate::random::Random;

/// Other multipliers with which the optimality conditions are met, without a change of signs;
/// nothing where there are none.
pub(crate) fn other_multipliers(nlp: &mut dyn Nlp, solution: &Solution) -> Option<Multipliers> {
    let active = Active::new(nlp, solution);
    let along = active.dependence(nlp)?;
    Some(active.moved(nlp, solution, &along))
}

/// What holds at a solution, and how large things are there.
struct Active {
    derivatives: Derivatives,
    bounds: Vec<Bounds>,
    /// Of each variable whether a bound holds it.
    held: Vec<bool>,
    springs: Vec<f64>,
    /// Of each row whether it is active.
    rows: Vec<bool>,
    equality: Vec<bool>,
    /// What the largest term of each row is for variables of their sizes.
    sizes: Vec<f64>,
}

impl Active {
    fn new(nlp: &mut dyn Nlp, solution: &Solution) -> Self {
        let (v, multipliers) = (&solution.v, &solution.multipliers);
        let mut derivatives = Derivatives::new(nlp);
        nlp.derivatives(v, 1.0, &multipliers.constraints, &mut derivatives);
        let mut values = vec![0.0; multipliers.constraints.len()];
        nlp.values(v, &mut values);
        let bounds = nlp.variable_bounds().to_vec();
        let springs = springs_of_sizes(nlp, v);
        let worth = solution.objective.abs().max(f64::MIN_POSITIVE);
        let is_held = |i: usize| {
            let size = (springs[i].powf(-0.5), worth);
            let lower = spring(v[i] - bounds[i].lower, multipliers.lower[i], size);
            let upper = spring(bounds[i].upper - v[i], multipliers.upper[i], size);
            bounds[i].is_equality() || lower.max(upper) > 0.0
        };
        let held = (0..v.len()).map(is_held).collect();
        let (structure, jacobian) = (nlp.jacobian_structure(), &derivatives.jacobian);
        let terms = sizes_of_rows(structure, jacobian, v, values.len());
        let rows = nlp.constraint_bounds().iter().zip(&multipliers.constraints);
        let rows = rows.zip(values.iter().zip(terms)).map(|((bounds, lambda), (value, terms))| {
            slack(bounds, (*value, terms), *lambda, worth) < OFF
        });
        let rows = rows.collect();
        let equality = nlp.constraint_bounds().iter().map(Bounds::is_equality).collect();
        let sizes: Vec<f64> = springs.iter().map(|it| it.powf(-0.5)).collect();
        let sizes = sizes_of_rows(structure, jacobian, &sizes, values.len());
        let sizes = sizes.into_iter().map(|it| if it > 0.0 { it } else { 1.0 }).collect();
        Active { derivatives, bounds, held, springs, rows, equality, sizes }
    }

    /// Multipliers of the rows that add up to nothing on all variables that are free.
    fn dependence(&self, nlp: &dyn Nlp) -> Option<Vec<f64>> {
        let structure = Structure {
            stages: nlp.stages(),
            phases: nlp.phases(),
            hessian: nlp.hessian_structure(),
            jacobian: nlp.jacobian_structure(),
            fixed: &self.held,
            equality: &self.equality,
        };
        let (_, mut factor) = prepare(Linear::SparseLdl, &structure);
        let softness = |(is_active, size): (&bool, &f64)| {
            if *is_active { SOFT * size * size } else { f64::MAX.sqrt() }
        };
        let d: Vec<f64> = self.rows.iter().zip(&self.sizes).map(softness).collect();
        let nothing = vec![0.0; self.derivatives.hessian.len()];
        let inertia = factor.factor(&nothing, &self.derivatives.jacobian, &self.springs, &d);
        if inertia != Inertia::Correct {
            return None;
        }
        let mut random = Random(1);
        let first = |(is_active, size): (&bool, &f64)| {
            if *is_active { random.next() / size } else { 0.0 }
        };
        let mut along: Vec<f64> = self.rows.iter().zip(&self.sizes).map(first).collect();
        for _ in 0..STEPS {
            let mut right = vec![0.0; self.springs.len()];
            right.extend(along.iter().zip(&d).map(|(value, d)| value * d));
            factor.solve(&mut right);
            along.copy_from_slice(&right[self.springs.len()..]);
        }
        self.is_exact(nlp, &along).then_some(along)
    }

    /// Whether what is left is more than what little softness leaves.
    fn is_exact(&self, nlp: &dyn Nlp, along: &[f64]) -> bool {
        let parts = along.iter().zip(&self.sizes).map(|(value, size)| (value * size).abs());
        let largest = parts.fold(0.0, f64::max);
        let free = self.forces(nlp, along).into_iter().zip(&self.springs).zip(&self.held);
        let forces =
            free.filter(|it| !it.1).map(|((force, spring), _)| force.abs() / spring.sqrt());
        largest.is_finite() && largest > LARGEST && forces.fold(0.0, f64::max) <= WRONG * largest
    }

    /// What multipliers of the rows add up to on each variable.
    fn forces(&self, nlp: &dyn Nlp, along: &[f64]) -> Vec<f64> {
        let mut forces = vec![0.0; self.springs.len()];
        let jacobian = &self.derivatives.jacobian;
        nlp.jacobian_structure().transposed_multiply_add(jacobian, along, &mut forces);
        forces
    }

    /// The multipliers that are as far away along `along` as those of the rows are large, or as
    /// their signs allow.
    fn moved(&self, nlp: &dyn Nlp, solution: &Solution, along: &[f64]) -> Multipliers {
        let mut moved = solution.multipliers.clone();
        let own = &solution.multipliers.constraints;
        let largest = |of: &[f64]| {
            of.iter().zip(&self.sizes).map(|it| (it.0 * it.1).abs()).fold(0.0, f64::max)
        };
        let inequalities = (0..own.len()).filter(|row| self.rows[*row] && !self.equality[*row]);
        let most = inequalities.map(|row| SHORT * (own[row] / along[row]).abs());
        let step = most.fold(largest(own).max(f64::MIN_POSITIVE) / largest(along), f64::min);
        moved.constraints.iter_mut().zip(along).for_each(|(it, by)| *it += step * by);
        let forces = self.forces(nlp, along);
        for i in (0..self.held.len()).filter(|i| self.held[*i]) {
            let (below, above) =
                (solution.v[i] - self.bounds[i].lower, self.bounds[i].upper - solution.v[i]);
            match below <= above {
                true => moved.lower[i] += step * forces[i],
                false => moved.upper[i] -= step * forces[i],
            }
        }
        moved
    }
}
