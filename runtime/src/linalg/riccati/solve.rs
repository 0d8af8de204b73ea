//! The backward and forward passes of a solve, through one interval; the names are those of
//! [`super::interval`].
//!
//! ```text
//!     backward    c = F b      p = v_x + g_+ + M c      g = g_w + v_theta + T' p + N' c
//!                 u_0 = -Q_uu^-1 g_u      v = g_z + gain' g_u
//!     forward     u = gain z + u_0        x+ = T w + c      lambda = -F' (N w + M (x+ - c) + p)
//! ```
//!
//! Here `x+` is `(y, x+)`. From one pass to the other, `p` waits in the place of `x+`, `c` in that
//! of `b` and `u_0` in that of `u`. Local rows are not seen here: [`super::local`].

use super::compliance::{give_way, push_back_where_given_way};
use super::factors::Factors;
use super::kernels::{View, add_row_product, dot};
use super::recursion::Recursion;
use super::sizes::Sizes;

/// The vectors that travel along the chain.
#[derive(Default)]
pub(super) struct Travel {
    /// `[v_x; v_theta]`, the gradient of the value function of the stage being left.
    pub(super) gradient: Vec<f64>,
    /// `(x, theta)`
    pub(super) state: Vec<f64>,
    scratch: Vec<f64>,
}

impl Travel {
    pub(super) fn new(sizes: Sizes) -> Self {
        let zeros = |length: usize| vec![0.0; length];
        Travel {
            gradient: zeros(sizes.kept()),
            state: zeros(sizes.kept()),
            scratch: zeros(sizes.kept() + sizes.all() + 2 * sizes.next()),
        }
    }
}

/// Scratch for one pass: what travels, a vector over `(x, theta, u, y, x+)`, and two over `(y,
/// x+)`.
struct Scratch<'a> {
    travelling: &'a mut [f64],
    all: &'a mut [f64],
    pushes: &'a mut [f64],
}

/// Sizes up to this are kept in arrays of known length, which a compiler that knows the sizes keeps
/// in registers.
const FEW: usize = 16;

impl<'a> Scratch<'a> {
    #[inline(always)]
    fn new(sizes: Sizes, few: &'a mut [[f64; FEW]; 3], many: &'a mut [f64]) -> Self {
        let (kept, all, pushes) = (sizes.kept(), sizes.all(), 2 * sizes.next());
        if all.max(pushes) <= FEW {
            let [first, second, third] = few;
            return Scratch {
                travelling: &mut first[..kept],
                all: &mut second[..all],
                pushes: &mut third[..pushes],
            };
        }
        let (first, rest) = many.split_at_mut(kept);
        let (second, third) = rest.split_at_mut(all);
        Scratch { travelling: first, all: second, pushes: third }
    }
}

impl Recursion {
    #[inline(always)]
    pub(super) fn backward_intervals<const FUSED: bool>(
        &self,
        sizes: Sizes,
        travel: &mut Travel,
        (a, b): (&mut [f64], &mut [f64]),
    ) {
        let Travel { gradient, scratch, .. } = travel;
        let mut few = [[0.0; FEW]; 3];
        let mut backward = Scratch::new(sizes, &mut few, scratch);
        backward.travelling.copy_from_slice(gradient);
        for k in (0..self.stages.intervals).rev() {
            self.backward_interval::<FUSED>(sizes, k, &mut backward, (a, b));
        }
        gradient.copy_from_slice(backward.travelling);
    }

    #[inline(always)]
    pub(super) fn forward_intervals<const FUSED: bool>(
        &self,
        sizes: Sizes,
        travel: &mut Travel,
        (a, b): (&mut [f64], &mut [f64]),
    ) {
        let Travel { state, scratch, .. } = travel;
        let mut few = [[0.0; FEW]; 3];
        let mut forward = Scratch::new(sizes, &mut few, scratch);
        forward.travelling.copy_from_slice(state);
        for k in 0..self.stages.intervals {
            self.forward_interval::<FUSED>(sizes, k, &mut forward, (a, b));
        }
        state.copy_from_slice(forward.travelling);
    }

    /// Backward: what travels is the gradient of `V_{k+1}` and becomes that of `V_k`.
    #[inline(always)]
    fn backward_interval<const FUSED: bool>(
        &self,
        sizes: Sizes,
        k: usize,
        Scratch { travelling, all: g, pushes }: &mut Scratch,
        (a, b): (&mut [f64], &mut [f64]),
    ) {
        let Sizes { n, m, inner, .. } = sizes;
        let (w, kept, all, next) = (sizes.reduced(), sizes.kept(), sizes.all(), sizes.next());
        let a = &mut a[k * (n + m + inner)..][..n + m + next];
        let defects = &mut b[self.stages.defects(k).start..][..next];
        let (above, below) = self.factors.response(sizes, k).split_at(next * all);
        let (inverse, gain) = self.factors.controls(sizes, k);
        let (p, c) = pushes.split_at_mut(next);
        p[inner..].fill(0.0);
        for i in 0..inner {
            p[i] = -a[n + m + i];
        }
        self.push::<FUSED>(sizes, (above, below), (defects, p, c));
        let g = &mut g[..w];
        g[n..kept].fill(0.0);
        for i in 0..n + m {
            g[sizes.position(i)] = -a[i];
        }
        add_row_product::<FUSED>(1.0, (View::rows(c, 0), 0), View::rows(below, all), next, g);
        // Only now what travels has to be there.
        for i in 0..n {
            p[inner + i] += travelling[i];
        }
        add_row_product::<FUSED>(1.0, (View::rows(p, 0), 0), View::rows(above, all), next, g);
        a[n + m..].copy_from_slice(p);
        let fixed = &self.fixed[self.stages.control(k)];
        for i in 0..m {
            g[kept + i] = if fixed[i] { 0.0 } else { g[kept + i] };
        }
        let (by_z, by_u) = g.split_at_mut(kept);
        add_row_product::<FUSED>(1.0, (View::rows(by_u, 0), 0), View::rows(gain, kept), m, by_z);
        travelling[..n].copy_from_slice(&by_z[..n]);
        for i in n..kept {
            travelling[i] += by_z[i];
        }
        let feed_forward = &mut a[n..n + m];
        feed_forward.fill(0.0);
        add_row_product::<FUSED>(
            -1.0,
            (View::rows(by_u, 0), 0),
            View::rows(inverse, m),
            m,
            feed_forward,
        );
    }

    /// What pushes against the interval but for the one behind: `p` and `c`, which is kept in the
    /// place of `b`; `pull` and `-b` where rows give way.
    #[inline(always)]
    fn push<const FUSED: bool>(
        &self,
        sizes: Sizes,
        (steps, curvature): (&[f64], &[f64]),
        (defects, p, c): (&mut [f64], &mut [f64], &mut [f64]),
    ) {
        let (w, all, next) = (sizes.reduced(), sizes.all(), sizes.next());
        if self.factors.penalised {
            for i in 0..next {
                c[i] = -defects[i];
            }
            return;
        }
        for i in 0..next {
            c[i] = dot::<FUSED>(&steps[i * all + w..][..next], defects);
        }
        defects.copy_from_slice(c);
        // M is symmetric.
        add_row_product::<FUSED>(
            1.0,
            (View::rows(c, 0), 0),
            View::rows(&curvature[w..], all),
            next,
            p,
        );
    }

    /// Forward: what travels is `(x_k, theta)` and becomes `(x_{k+1}, theta)`.
    #[inline(always)]
    fn forward_interval<const FUSED: bool>(
        &self,
        sizes: Sizes,
        k: usize,
        Scratch { travelling, all: known, pushes }: &mut Scratch,
        (a, b): (&mut [f64], &mut [f64]),
    ) {
        let Sizes { n, m, inner, .. } = sizes;
        let (w, kept, next) = (sizes.reduced(), sizes.kept(), sizes.next());
        let a = &mut a[k * (n + m + inner)..][..n + m + next];
        let defects = &mut b[self.stages.defects(k).start..][..next];
        let (_, gain) = self.factors.controls(sizes, k);
        known[..kept].copy_from_slice(travelling);
        known[kept..w].copy_from_slice(&a[n..n + m]);
        a[..n].copy_from_slice(&known[..n]);
        let (controls, p) = a[n..].split_at_mut(m);
        let (step, back) = pushes.split_at_mut(next);
        for i in 0..m {
            known[kept + i] += dot::<FUSED>(&gain[i * kept..][..kept], &known[..kept]);
        }
        controls.copy_from_slice(&known[kept..w]);
        if self.factors.penalised {
            give_way(&self.factors, sizes, k, (known, step), (p, defects));
            push_back_where_given_way(&self.factors, sizes, k, known, (p, defects));
        } else {
            follow::<FUSED>(&self.factors, sizes, k, known, step);
            push_back::<FUSED>(&self.factors, sizes, k, (known, step, back), (p, defects));
        }
        p[..inner].copy_from_slice(&step[..inner]);
        travelling[..n].copy_from_slice(&step[inner..]);
    }
}

/// `T w`
#[inline(always)]
fn follow<const FUSED: bool>(
    factors: &Factors,
    sizes: Sizes,
    k: usize,
    known: &[f64],
    step: &mut [f64],
) {
    let (w, all) = (sizes.reduced(), sizes.all());
    let response = factors.response(sizes, k);
    for i in 0..sizes.next() {
        step[i] = dot::<FUSED>(&response[i * all..][..w], &known[..w]);
    }
}

/// Multipliers in the place of `c`, which is added to the step.
#[inline(always)]
fn push_back<const FUSED: bool>(
    factors: &Factors,
    sizes: Sizes,
    k: usize,
    (known, step, back): (&[f64], &mut [f64], &mut [f64]),
    (p, c): (&[f64], &mut [f64]),
) {
    let (w, all, next) = (sizes.reduced(), sizes.all(), sizes.next());
    let (steps, curvature) = factors.response(sizes, k).split_at(next * all);
    for i in 0..next {
        back[i] = p[i] + dot::<FUSED>(&curvature[i * all..][..w], &known[..w]);
    }
    // M is symmetric.
    add_row_product::<FUSED>(
        1.0,
        (View::rows(step, 0), 0),
        View::rows(&curvature[w..], all),
        next,
        back,
    );
    for i in 0..next {
        step[i] += c[i];
    }
    c.fill(0.0);
    add_row_product::<FUSED>(-1.0, (View::rows(back, 0), 0), View::rows(&steps[w..], all), next, c);
}
