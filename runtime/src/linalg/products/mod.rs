//! The matrix of the optimality conditions times a vector, without its diagonals, for a batch of
//! intervals at a time.
//!
//! ```text
//!     [ H  J' ] [ dv      ]
//!     [ J  0  ] [ dlambda ]
//! ```
//!
//! What an interval sees of the vector is `[x_k u_k y_k x_{k+1} | globals | rows]`. Each number of
//! the product is a sum of terms, whose list is the same for all intervals, so that those of a
//! batch share every operation and their sums stay in registers. Entries that belong to no interval
//! are added one by one.

mod sight;
mod sums;

use super::dense::lanes::is_fused;
use super::structure::stages::Stages;
use super::structure::triplets::Triplets;
use sight::{NOTHING, Numbers, Sight};
use sums::Sums;

/// The terms of all sums, and the memory for them.
pub(crate) struct Products {
    sight: Sight,
    hessian: Sums,
    jacobian: Sums,
    /// What an interval sees, and its part of the product.
    seen: Vec<Numbers>,
    found: Vec<Numbers>,
    fused: bool,
}

impl Products {
    /// For matrices of these structures; without stages there is nothing to share.
    pub(crate) fn new(stages: Option<Stages>, hessian: &Triplets, jacobian: &Triplets) -> Self {
        let sight = Sight::new(stages);
        let hessian = Sums::new(sight, hessian, |family| {
            Some([
                sight.variable(family.row, family.row_step)?,
                sight.variable(family.column, family.column_step)?,
            ])
        });
        let jacobian = Sums::new(sight, jacobian, |family| {
            Some([
                sight.row(family.row, family.row_step)?,
                sight.variable(family.column, family.column_step)?,
            ])
        });
        let nothing = || vec![NOTHING; sight.len()];
        Products { sight, hessian, jacobian, seen: nothing(), found: nothing(), fused: is_fused() }
    }

    /// `a += H v + J' w`, `b += J v`
    pub(crate) fn multiply_add(
        &mut self,
        (hessian, jacobian): (&[f64], &[f64]),
        (v, w): (&[f64], &[f64]),
        (a, b): (&mut [f64], &mut [f64]),
    ) {
        self.hessian.each_other(hessian, |value, row, column| {
            a[row] += value * v[column];
            if row != column {
                a[column] += value * v[row];
            }
        });
        self.jacobian.each_other(jacobian, |value, row, column| {
            b[row] += value * v[column];
            a[column] += value * w[row];
        });
        #[cfg(target_arch = "x86_64")]
        if self.fused {
            // SAFETY: `fused` is set only if this machine has both features.
            #[allow(unsafe_code)]
            return unsafe { self.multiply_fused((hessian, jacobian), (v, w), (a, b)) };
        }
        self.multiply_intervals::<false>((hessian, jacobian), (v, w), (a, b));
    }

    /// `a += J' w`
    pub(crate) fn transposed_multiply_add(&mut self, jacobian: &[f64], w: &[f64], a: &mut [f64]) {
        self.jacobian.each_other(jacobian, |value, row, column| a[column] += value * w[row]);
        #[cfg(target_arch = "x86_64")]
        if self.fused {
            // SAFETY: `fused` is set only if this machine has both features.
            #[allow(unsafe_code)]
            return unsafe { self.transposed_fused(jacobian, w, a) };
        }
        self.transposed_intervals::<false>(jacobian, w, a);
    }

    #[cfg(target_arch = "x86_64")]
    #[target_feature(enable = "avx2,fma")]
    fn multiply_fused(
        &mut self,
        matrices: (&[f64], &[f64]),
        x: (&[f64], &[f64]),
        y: (&mut [f64], &mut [f64]),
    ) {
        self.multiply_intervals::<true>(matrices, x, y);
    }

    #[cfg(target_arch = "x86_64")]
    #[target_feature(enable = "avx2,fma")]
    fn transposed_fused(&mut self, jacobian: &[f64], w: &[f64], a: &mut [f64]) {
        self.transposed_intervals::<true>(jacobian, w, a);
    }

    #[inline(always)]
    fn multiply_intervals<const FUSED: bool>(
        &mut self,
        (hessian, jacobian): (&[f64], &[f64]),
        (v, w): (&[f64], &[f64]),
        (a, b): (&mut [f64], &mut [f64]),
    ) {
        let Products { sight, seen, found, .. } = self;
        for batch in sight.batches() {
            sight.see_variables(&batch, v, seen);
            sight.see_rows(&batch, w, seen);
            found.fill(NOTHING);
            self.hessian.add::<FUSED>(&batch, hessian, seen, found);
            self.jacobian.add::<FUSED>(&batch, jacobian, seen, found);
            sight.tell_variables(&batch, found, a);
            sight.tell_rows(&batch, found, b);
        }
    }

    #[inline(always)]
    fn transposed_intervals<const FUSED: bool>(
        &mut self,
        jacobian: &[f64],
        w: &[f64],
        a: &mut [f64],
    ) {
        let Products { sight, seen, found, .. } = self;
        for batch in sight.batches() {
            sight.see_rows(&batch, w, seen);
            found.fill(NOTHING);
            self.jacobian.add::<FUSED>(&batch, jacobian, seen, &mut found[..sight.first_row()]);
            sight.tell_variables(&batch, found, a);
        }
    }
}

#[cfg(test)]
impl Products {
    /// As on a machine that cannot multiply and add in one instruction.
    pub(crate) fn without_fused(self) -> Self {
        Products { fused: false, ..self }
    }
}
