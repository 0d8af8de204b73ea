//! What can be done about an interval before anything is known of those behind it, for several at a
//! time.
//!
//! ```text
//!     T = -E^-1 R     F = E^-1     Q = H_ww + N' T + T' (N + M T)     H_ww, M += J' diag(1/d) J
//! ```
//!
//! Here `N` and `M` are `H_{+w}` and `H_{++}` alone, and `J` are local rows. Where rows are
//! penalised, `Q` is `H_ww` alone, and `[-R E]` stands in place of `[T F]`.

use super::assemble::Assembly;
use super::chain::Matrix;
use super::elimination::{add_row_product, divide};
use super::factors::Factors;
use super::kernels::{View, lower_end};
use super::sizes::Sizes;
use crate::linalg::dense::lanes::{Lanes, part};
use crate::linalg::structure::stages::Stages;
use std::ops::Range;

/// A few intervals, condensed, and the memory for it.
pub(super) struct Condensed {
    /// `Q`, `[T F; N M]` and `E`.
    gathered: Vec<Lanes>,
    /// `N + M T`
    costate: Vec<Lanes>,
    /// Values and weights of the local rows.
    local: Vec<Lanes>,
    weights: Vec<Lanes>,
    /// `Q` of each interval.
    quadratic: Vec<f64>,
}

impl Condensed {
    pub(super) fn new(sizes: Sizes, stages: Stages, assembly: &Assembly) -> Self {
        let zeros = |length: usize| vec![Lanes::ZERO; length];
        let w = sizes.reduced();
        Condensed {
            gathered: zeros(sizes.gathered()),
            costate: zeros(sizes.next() * w),
            local: zeros(assembly.local_entries.len()),
            weights: zeros(stages.local_constraints),
            quadratic: vec![0.0; Lanes::COUNT * w * w],
        }
    }

    /// Condenses these intervals, at most [`Lanes::COUNT`]; the response goes to the factors.
    /// `None` if some `E` is singular.
    #[inline(always)]
    pub(super) fn fill<const FUSED: bool>(
        &mut self,
        sizes: Sizes,
        (stages, assembly): (&Stages, &Assembly),
        matrix: Matrix,
        intervals: Range<usize>,
        factors: &mut Factors,
    ) -> Option<()> {
        self.gather::<FUSED>(sizes, (stages, assembly), matrix, intervals.clone(), factors);
        self.eliminate::<FUSED>(sizes, factors.penalised)?;
        let [square, response, _] = sizes.parts();
        let (q, rest) = self.gathered.split_at(square);
        part(&rest[..response], factors.responses_mut(sizes, intervals.clone()));
        part(q, &mut self.quadratic[..intervals.len() * square]);
        Some(())
    }

    /// `Q` of the interval that is so many behind the first.
    #[inline(always)]
    pub(super) fn quadratic_mut(&mut self, sizes: Sizes, index: usize) -> &mut [f64] {
        let [square, ..] = sizes.parts();
        &mut self.quadratic[index * square..][..square]
    }

    #[inline(always)]
    fn gather<const FUSED: bool>(
        &mut self,
        sizes: Sizes,
        (stages, assembly): (&Stages, &Assembly),
        matrix: Matrix,
        intervals: Range<usize>,
        factors: &mut Factors,
    ) {
        let Condensed { gathered, local, weights, .. } = self;
        let Matrix { hessian, jacobian, sigma, d } = matrix;
        let gathered = &mut gathered[..sizes.gathered()];
        let (first, count) = (intervals.start, intervals.len());
        assembly.gather((first, count), (hessian, jacobian), gathered, local);
        let of = |table: &[f64], place: usize, step: usize| {
            // Lanes without an interval repeat the last one.
            Lanes::from(|l| table[place + (first + l.min(count - 1)) * step])
        };
        for i in 0..sizes.n + sizes.m + sizes.inner {
            let place = sizes.hessian_place(sizes.position(i), sizes.position(i));
            gathered[place].add(of(sigma, i, stages.variable_step()));
        }
        for (i, weight) in weights.iter_mut().enumerate() {
            *weight = of(d, stages.defect_rows() + i, stages.row_step()).inverse();
        }
        assembly.condense::<FUSED>(local, weights, gathered);
        for l in count..Lanes::COUNT {
            // Something that can be divided by.
            for i in 0..sizes.next() {
                gathered[sizes.defect_place(i, sizes.reduced() + i)].0[l] = 1.0;
            }
        }
        part(local, factors.local_mut(intervals.clone()));
        part(weights, factors.weights_mut(intervals));
    }

    #[inline(always)]
    fn eliminate<const FUSED: bool>(&mut self, sizes: Sizes, penalised: bool) -> Option<()> {
        let (next, w, all) = (sizes.next(), sizes.reduced(), sizes.all());
        let [square, response, last] = sizes.parts();
        let (q, rest) = self.gathered.split_at_mut(square);
        let (response, e) = rest.split_at_mut(response);
        let (steps, curvature) = response.split_at_mut(next * all);
        for i in 0..next {
            for value in &mut steps[i * all..][..w] {
                *value = value.scaled(-1.0);
            }
            steps[i * all + w + i] = Lanes::ONE;
            for j in 0..i {
                curvature[j * all + w + i] = curvature[i * all + w + j];
            }
        }
        for j in sizes.kept()..w {
            for i in j + 1..w {
                q[j * w + i] = q[i * w + j];
            }
        }
        if penalised {
            for i in 0..next {
                steps[i * all + w..][..next].copy_from_slice(&e[i * next..][..next]);
            }
            return Some(());
        }
        if !divide::<FUSED>(next, &mut e[..last], (steps, all)) {
            return None;
        }
        let costate = &mut self.costate[..next * w];
        for i in 0..next {
            costate[i * w..][..w].copy_from_slice(&curvature[i * all..][..w]);
        }
        let (t, n) = (View::rows(&*steps, all), View::rows(&*curvature, all));
        let m = View { values: &curvature[w..], ..n };
        for i in 0..next {
            add_row_product::<FUSED>((m, i), t, next, &mut costate[i * w..][..w]);
        }
        for i in 0..w {
            // Of `Q` the lower triangle is needed, and all of `Q_uu`.
            let row = &mut q[i * w..][..if i < sizes.kept() { lower_end(i, w) } else { w }];
            add_row_product::<FUSED>((n.transposed(), i), t, next, row);
            add_row_product::<FUSED>((t.transposed(), i), View::rows(costate, w), next, row);
        }
        Some(())
    }
}
