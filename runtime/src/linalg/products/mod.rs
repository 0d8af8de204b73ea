//! The matrix of the optimality conditions times a vector, without its diagonals, for a batch of
//! intervals at a time.
//!
//! ```text
//!     [ H  J' ] [ dv      ]
//!     [ J  0  ] [ dlambda ]
//! ```
//!
//! What an interval sees of the vector is `[x_k u_k y_k x_{k+1} | globals | rows]`. Each number of
//! the product is a sum of terms, whose list is the same for all intervals of a chain, so that
//! those of a batch share every operation and their sums stay in registers. Entries that belong to
//! no interval are added one by one.

mod sight;
mod sums;

use super::dense::lanes::is_fused;
use super::structure::phases::PhaseStages;
use super::structure::triplets::Triplets;
use sight::{NOTHING, Numbers, Sight};
use sums::{Entries, Sums};

/// The terms of all sums, and the memory for them.
pub(crate) struct Products {
    chains: Vec<Chain>,
    /// What belongs to no interval of a chain.
    hessian: Entries,
    jacobian: Entries,
    /// What an interval sees, and its part of the product.
    seen: Vec<Numbers>,
    found: Vec<Numbers>,
    fused: bool,
}

/// The sums of one chain.
struct Chain {
    sight: Sight,
    hessian: Sums,
    jacobian: Sums,
}

impl Products {
    /// For matrices of these structures, which are those of some chains of stages; without chains
    /// there is nothing to share.
    pub(crate) fn new(chains: Vec<PhaseStages>, hessian: &Triplets, jacobian: &Triplets) -> Self {
        let (mut hessian, mut jacobian) = (Entries::new(hessian), Entries::new(jacobian));
        let chain = |it| {
            let sight = Sight::new(it);
            let variable = |index, step| sight.variable(index, step);
            let of_hessian = hessian.sums(&sight, |it| {
                Some([variable(it.row, it.row_step)?, variable(it.column, it.column_step)?])
            });
            let of_jacobian = jacobian.sums(&sight, |it| {
                Some([sight.row(it.row, it.row_step)?, variable(it.column, it.column_step)?])
            });
            Chain { sight, hessian: of_hessian, jacobian: of_jacobian }
        };
        let chains: Vec<Chain> = chains.into_iter().map(chain).collect();
        let most = chains.iter().map(|it| it.sight.len()).max().unwrap_or(0);
        let nothing = || vec![NOTHING; most];
        let (seen, found) = (nothing(), nothing());
        Products { chains, hessian, jacobian, seen, found, fused: is_fused() }
    }

    /// `a += H v + J' w`, `b += J v`
    pub(crate) fn multiply_add(
        &mut self,
        (hessian, jacobian): (&[f64], &[f64]),
        (v, w): (&[f64], &[f64]),
        (a, b): (&mut [f64], &mut [f64]),
    ) {
        self.hessian.each(hessian, |value, row, column| {
            a[row] += value * v[column];
            if row != column {
                a[column] += value * v[row];
            }
        });
        self.jacobian.each(jacobian, |value, row, column| {
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
        self.jacobian.each(jacobian, |value, row, column| a[column] += value * w[row]);
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
        for chain in &self.chains {
            let sight = &chain.sight;
            let (seen, found) = (&mut self.seen[..sight.len()], &mut self.found[..sight.len()]);
            for batch in sight.batches() {
                sight.see_variables(&batch, v, seen);
                sight.see_rows(&batch, w, seen);
                found.fill(NOTHING);
                chain.hessian.add::<FUSED>(&batch, hessian, seen, found);
                chain.jacobian.add::<FUSED>(&batch, jacobian, seen, found);
                sight.tell_variables(&batch, found, a);
                sight.tell_rows(&batch, found, b);
            }
        }
    }

    #[inline(always)]
    fn transposed_intervals<const FUSED: bool>(
        &mut self,
        jacobian: &[f64],
        w: &[f64],
        a: &mut [f64],
    ) {
        for chain in &self.chains {
            let sight = &chain.sight;
            let (seen, found) = (&mut self.seen[..sight.len()], &mut self.found[..sight.len()]);
            for batch in sight.batches() {
                sight.see_rows(&batch, w, seen);
                found.fill(NOTHING);
                let sums = &mut found[..sight.first_row()];
                chain.jacobian.add::<FUSED>(&batch, jacobian, seen, sums);
                sight.tell_variables(&batch, found, a);
            }
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
