//! The optimality conditions as one sparse matrix, for problems without stage structure.
//!
//! Nothing is added to its diagonal: [`Multifrontal`] finds pivots for any matrix that is regular.

mod balance;
mod factors;
mod front;
mod multifrontal;
mod pairs;
#[cfg(test)]
mod tests;
mod tree;

use super::structure::triplets::Triplets;
use crate::linalg::structure::columns::Columns;
use crate::linalg::structure::factor::{Factor, Inertia};
use multifrontal::Multifrontal;

/// Sparse LDL of the whole matrix.
pub struct SparseLdl {
    variables: usize,
    fixed: Vec<bool>,
    ldl: Multifrontal,
    values: Vec<f64>,
    /// Where each Hessian and Jacobian value goes; `None` if it belongs to a fixed variable.
    hessian: Vec<Option<u32>>,
    jacobian: Vec<Option<u32>>,
    diagonal: Vec<u32>,
}

impl SparseLdl {
    /// Prepares the matrix of `fixed.len()` variables and `rows` rows.
    pub fn new(hessian: &Triplets, jacobian: &Triplets, fixed: &[bool], rows: usize) -> Self {
        let variables = fixed.len();
        let size = variables + rows;
        let hessian_places = hessian
            .entries()
            .map(|(i, j)| (!fixed[i] && !fixed[j]).then_some((i.min(j), i.max(j))));
        let jacobian_places =
            jacobian.entries().map(|(i, j)| (!fixed[j]).then_some((j, variables + i)));
        let places: Vec<_> =
            hessian_places.chain(jacobian_places).chain((0..size).map(|i| Some((i, i)))).collect();
        let (pattern, mut targets) = Columns::of_places(&places, size, size);
        let diagonal = targets.split_off(targets.len() - size).into_iter().flatten().collect();
        let jacobian = targets.split_off(hessian.len());
        let values = pattern.values.clone();
        SparseLdl {
            variables,
            fixed: fixed.to_vec(),
            ldl: Multifrontal::new(pattern),
            values,
            hessian: targets,
            jacobian,
            diagonal,
        }
    }

    /// How many multiplications a factorisation takes, about.
    pub(crate) fn multiplications(&self) -> f64 {
        self.ldl.multiplications()
    }

    fn add_diagonal(&mut self, sigma: &[f64], d: &[f64]) {
        for (i, place) in self.diagonal.iter().enumerate() {
            self.values[*place as usize] += match i.checked_sub(self.variables) {
                Some(row) => -d[row],
                None if self.fixed[i] => 1.0,
                None => sigma[i],
            };
        }
    }
}

impl Factor for SparseLdl {
    fn factor(&mut self, hessian: &[f64], jacobian: &[f64], sigma: &[f64], d: &[f64]) -> Inertia {
        self.values.fill(0.0);
        let targets = self.hessian.iter().chain(&self.jacobian);
        for (target, value) in targets.zip(hessian.iter().chain(jacobian)) {
            if let Some(place) = target {
                self.values[*place as usize] += value;
            }
        }
        self.add_diagonal(sigma, d);
        match self.ldl.factor(&self.values) {
            None => Inertia::Singular,
            Some(negative) if negative + self.variables == self.diagonal.len() => Inertia::Correct,
            Some(_) => Inertia::Wrong,
        }
    }

    fn solve(&mut self, right_side: &mut [f64]) {
        for (value, fixed) in right_side.iter_mut().zip(&self.fixed) {
            if *fixed {
                *value = 0.0;
            }
        }
        self.ldl.solve(right_side);
    }
}
