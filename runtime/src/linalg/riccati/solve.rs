//! The backward and forward passes of a solve, through one interval; the names are those of [`super::interval`].
//!
//! ```text
//!     backward    c = F b      p = v_x + g_+ + M c      g = g_w + v_theta + T' p + N' c
//!                 u_0 = -Q_uu^-1 g_u      v = g_z + gain' g_u
//!     forward     u = gain z + u_0        x+ = T w + c      lambda = -F' (N w + M (x+ - c) + p)
//! ```
//!
//! Here `x+` is `(y, x+)`. From one pass to the other, `p` waits in the place of `x+`, `c` in that of `b` and `u_0` in that of `u`.

use super::Riccati;
use super::kernels::{View, add_row_product, dot};
use super::sizes::Sizes;

/// The vectors that travel along the chain.
#[derive(Default)]
pub(super) struct Travel {
    /// `[v_x; v_theta]`, the gradient of the value function of the stage being left.
    pub(super) gradient: Vec<f64>,
    pub(super) theta: Vec<f64>,
    pub(super) x: Vec<f64>,
    /// Scratch over `(x, u, theta, y, x+)`, and `[p; c]`.
    all: Vec<f64>,
    push: Vec<f64>,
}

impl Travel {
    pub(super) fn new(sizes: Sizes) -> Self {
        let zeros = |length: usize| vec![0.0; length];
        Travel {
            gradient: zeros(sizes.kept()),
            theta: zeros(sizes.q),
            x: zeros(sizes.n),
            all: zeros(sizes.all()),
            push: zeros(2 * sizes.next()),
        }
    }
}

impl Riccati {
    /// Backward: the gradient is that of `V_{k+1}` and becomes that of `V_k`.
    #[inline(always)]
    pub(super) fn backward<const FUSED: bool>(
        &self,
        sizes: Sizes,
        k: usize,
        travel: &mut Travel,
        (a, b): (&mut [f64], &mut [f64]),
    ) {
        let Sizes { n, m, inner, q } = sizes;
        let (w, all, next) = (sizes.reduced(), sizes.all(), sizes.next());
        let Travel { gradient, all: g, push, .. } = travel;
        let (gradient, g, push) = (&mut gradient[..n + q], &mut g[..all], &mut push[..2 * next]);
        let first = k * (n + m + inner);
        let a = &mut a[first..first + n + m + next];
        for i in 0..n + m {
            g[i] = -a[i];
        }
        g[n + m..w].copy_from_slice(&gradient[n..]);
        for i in 0..inner {
            g[w + i] = -a[n + m + i];
        }
        g[w + inner..].copy_from_slice(&gradient[..n]);
        self.add_local_gradient(k, b, g);
        let defects = &mut b[self.stages.defects(k).start..][..next];
        let response = self.factors.response(sizes, k);
        self.push::<FUSED>(sizes, response, &g[w..], (defects, push));
        a[n + m..].copy_from_slice(&push[..next]);
        // What does not wait for the interval behind comes first.
        let ((p, c), (above, below)) = (push.split_at(next), response.split_at(next * all));
        add_row_product::<FUSED>(1.0, (View::rows(c, next), 0), View::rows(below, all), next, &mut g[..w]);
        add_row_product::<FUSED>(1.0, (View::rows(p, next), 0), View::rows(above, all), next, &mut g[..w]);
        self.eliminate_controls::<FUSED>(sizes, k, g, (gradient, &mut a[n..n + m]));
    }

    /// What pushes against the interval: `[p; c]`, of which `c` is kept in the place of `b`; `[pull; -b]` where rows give way.
    #[inline(always)]
    fn push<const FUSED: bool>(
        &self,
        sizes: Sizes,
        response: &[f64],
        pull: &[f64],
        (defects, push): (&mut [f64], &mut [f64]),
    ) {
        let (w, all, next) = (sizes.reduced(), sizes.all(), sizes.next());
        let (p, c) = push.split_at_mut(next);
        p.copy_from_slice(pull);
        if self.factors.penalised {
            c.iter_mut().zip(defects).for_each(|(c, b)| *c = -*b);
            return;
        }
        let (steps, curvature) = response.split_at(next * all);
        for i in 0..next {
            c[i] = dot::<FUSED>(&steps[i * all + w..][..next], defects);
        }
        defects.copy_from_slice(c);
        // M is symmetric.
        let m = View { values: &curvature[w..], row: all, column: 1 };
        add_row_product::<FUSED>(1.0, (View::rows(c, next), 0), m, next, p);
    }

    /// Local rows: `g -= J' diag(1/d) b`
    #[inline(always)]
    fn add_local_gradient(&self, k: usize, b: &[f64], g: &mut [f64]) {
        let entries = &self.assembly.local_entries;
        let (values, weights) = self.factors.local(k);
        let b = &b[self.stages.local(k)];
        for (entry, value) in entries.iter().zip(values) {
            g[entry.position] -= weights[entry.row] * b[entry.row] * value;
        }
    }

    #[inline(always)]
    fn eliminate_controls<const FUSED: bool>(
        &self,
        sizes: Sizes,
        k: usize,
        g: &mut [f64],
        (gradient, feed_forward): (&mut [f64], &mut [f64]),
    ) {
        let Sizes { n, m, .. } = sizes;
        let kept = sizes.kept();
        gradient[..n].copy_from_slice(&g[..n]);
        gradient[n..].copy_from_slice(&g[n + m..sizes.reduced()]);
        let fixed = &self.fixed[self.stages.control(k).start..][..m];
        let g = &mut g[n..n + m];
        for i in (0..m).filter(|i| fixed[*i]) {
            g[i] = 0.0;
        }
        let (inverse, gain) = self.factors.controls(sizes, k);
        let g = View::rows(g, m);
        feed_forward.fill(0.0);
        add_row_product::<FUSED>(-1.0, (g, 0), View::rows(inverse, m), m, feed_forward);
        add_row_product::<FUSED>(1.0, (g, 0), View::rows(gain, kept), m, gradient);
    }

    /// Forward: `x` is `x_k` and becomes `x_{k+1}`.
    #[inline(always)]
    pub(super) fn forward<const FUSED: bool>(
        &self,
        sizes: Sizes,
        k: usize,
        travel: &mut Travel,
        (a, b): (&mut [f64], &mut [f64]),
    ) {
        let Sizes { n, m, inner, q } = sizes;
        let (w, kept, all, next) = (sizes.reduced(), sizes.kept(), sizes.all(), sizes.next());
        let Travel { theta, x, all: known, push, .. } = travel;
        let (x, theta, known, push) = (&mut x[..n], &theta[..q], &mut known[..all], &mut push[..2 * next]);
        let first = k * (n + m + inner);
        let a = &mut a[first..first + n + m + next];
        let (start, local_start) = (self.stages.defects(k).start, self.stages.local(k).start);
        let (_, gain) = self.factors.controls(sizes, k);
        known[..n].copy_from_slice(x);
        known[n + m..w].copy_from_slice(theta);
        for i in 0..m {
            let gain = &gain[i * kept..][..kept];
            known[n + i] = a[n + i] + dot::<FUSED>(&gain[..n], x) + dot::<FUSED>(&gain[n..], theta);
        }
        a[..n + m].copy_from_slice(&known[..n + m]);
        let (defects, p) = (&mut b[start..start + next], &mut a[n + m..]);
        if self.factors.penalised {
            self.follow_penalised(sizes, k, (known, push), (p, defects));
        } else {
            self.follow::<FUSED>(sizes, k, (known, push), (p, defects));
        }
        p[..inner].copy_from_slice(&known[w..w + inner]);
        x.copy_from_slice(&known[w + inner..]);
        self.local_multipliers(k, known, &mut b[local_start..][..self.stages.local_rows]);
    }

    /// Completes `(w, x+)` and puts the multipliers in the place of `c`.
    #[inline(always)]
    fn follow<const FUSED: bool>(
        &self,
        sizes: Sizes,
        k: usize,
        (known, push): (&mut [f64], &mut [f64]),
        (p, c): (&[f64], &mut [f64]),
    ) {
        let (w, all, next) = (sizes.reduced(), sizes.all(), sizes.next());
        let (steps, curvature) = self.factors.response(sizes, k).split_at(next * all);
        for i in 0..next {
            push[i] = dot::<FUSED>(&steps[i * all..][..w], &known[..w]);
        }
        known[w..].copy_from_slice(&push[..next]);
        for i in 0..next {
            push[next + i] = p[i] + dot::<FUSED>(&curvature[i * all..][..all], known);
        }
        for i in 0..next {
            known[w + i] += c[i];
        }
        c.fill(0.0);
        let f = View { values: &steps[w..], row: all, column: 1 };
        add_row_product::<FUSED>(-1.0, (View::rows(&push[next..], next), 0), f, next, c);
    }

    /// The same where rows give way, with `pull` and `b`.
    fn follow_penalised(
        &self,
        sizes: Sizes,
        k: usize,
        (known, push): (&mut [f64], &mut [f64]),
        (pull, b): (&[f64], &mut [f64]),
    ) {
        let (w, all, next) = (sizes.reduced(), sizes.all(), sizes.next());
        known[w..].copy_from_slice(b);
        let (response, compliance) = (self.factors.response(sizes, k), self.factors.compliance(next, k));
        for i in 0..2 * next {
            push[i] = dot::<false>(&response[i * all..][..all], known);
        }
        for i in 0..next {
            push[i] -= dot::<false>(&compliance[i * next..][..next], pull);
        }
        known[w..].copy_from_slice(&push[..next]);
        b.copy_from_slice(&push[next..]);
        let f = View { values: &response[w..], row: all, column: 1 };
        add_row_product::<false>(-1.0, (View::rows(pull, next), 0), f, next, b);
    }

    /// `lambda = (J v - b) / d`
    #[inline(always)]
    fn local_multipliers(&self, k: usize, known: &[f64], multipliers: &mut [f64]) {
        let entries = &self.assembly.local_entries;
        let (values, weights) = self.factors.local(k);
        for value in multipliers.iter_mut() {
            *value = -*value;
        }
        for (entry, value) in entries.iter().zip(values) {
            multipliers[entry.row] += value * known[entry.position];
        }
        for (value, weight) in multipliers.iter_mut().zip(weights) {
            *value *= weight;
        }
    }
}
