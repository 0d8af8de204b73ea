//! The backward and forward passes of a solve, through one interval; the names are those of [`super::interval`].
//!
//! ```text
//!     backward    pull = v_x + g_+        g = g_w + v_theta + T' pull - L' b
//!                 u_0 = -Q_uu^-1 g_u      v = g_z + gain' g_u
//!     forward     u = gain z + u_0        x+ = [T F] [w; b] - A pull      lambda = [L C] [w; b] - F' pull
//! ```
//!
//! Here `x+` is `(y, x+)`. From one pass to the other, `pull` waits in its place and `u_0` in that of `u`.

use super::Riccati;
use super::interval::Sizes;
use super::kernels::{View, add_row_product, dot, multiply_add};

/// The vectors that travel along the chain.
#[derive(Default)]
pub(super) struct Travel {
    /// `[v_x; v_theta]`, the gradient of the value function of the stage being left.
    pub(super) gradient: Vec<f64>,
    pub(super) theta: Vec<f64>,
    pub(super) x: Vec<f64>,
    /// Scratch over `(x, u, theta, y, x+)`, and `[pull; -b]`.
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
        (a, b): (&mut [f64], &[f64]),
    ) {
        let Sizes { n, m, inner, q } = sizes;
        let (w, all, next) = (sizes.reduced(), sizes.all(), sizes.next());
        let Travel { gradient, all: g, push, .. } = travel;
        let (gradient, g, push) = (&mut gradient[..n + q], &mut g[..all], &mut push[..2 * next]);
        let first = k * (n + m + inner);
        let a = &mut a[first..first + n + m + next];
        let defects = &b[self.stages.defects(k).start..][..next];
        for i in 0..n + m {
            g[i] = -a[i];
        }
        g[n + m..w].copy_from_slice(&gradient[n..]);
        for i in 0..inner {
            g[w + i] = -a[n + m + i];
        }
        g[w + inner..].copy_from_slice(&gradient[..n]);
        self.add_local_gradient(k, b, g);
        for i in 0..next {
            push[i] = g[w + i];
            push[next + i] = -defects[i];
        }
        a[n + m..].copy_from_slice(&g[w..]);
        let response = View::rows(self.factors.response(sizes, k), all);
        add_row_product::<FUSED>(1.0, (View::rows(push, 2 * next), 0), response, 2 * next, &mut g[..w]);
        self.eliminate_controls::<FUSED>(sizes, k, g, (gradient, &mut a[n..n + m]));
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
        for i in 0..kept {
            gradient[i] = g[sizes.position(i)];
        }
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
        known[w..].copy_from_slice(&b[start..start + next]);
        let response = self.factors.response(sizes, k);
        for i in 0..2 * next {
            push[i] = dot::<FUSED>(&response[i * all..][..all], known);
        }
        let pull = &mut a[n + m..];
        for i in 0..next {
            // -F' pull
            for l in 0..next {
                push[next + i] = multiply_add::<FUSED>(-response[l * all + w + i], pull[l], push[next + i]);
            }
        }
        if self.factors.penalised {
            let compliance = self.factors.compliance(next, k);
            for i in 0..next {
                push[i] -= dot::<FUSED>(&compliance[i * next..][..next], pull);
            }
        }
        known[w..].copy_from_slice(&push[..next]);
        pull[..inner].copy_from_slice(&push[..inner]);
        x.copy_from_slice(&push[inner..next]);
        b[start..start + next].copy_from_slice(&push[next..]);
        self.local_multipliers(k, known, &mut b[local_start..][..self.stages.local_rows]);
    }

    /// `lambda = (J v - b) / d`
    #[inline(always)]
    fn local_multipliers(&self, k: usize, known: &[f64], multipliers: &mut [f64]) {
        let entries = &self.assembly.local_entries;
        let (values, weights) = self.factors.local(k);
        multipliers.iter_mut().for_each(|value| *value = -*value);
        for (entry, value) in entries.iter().zip(values) {
            multipliers[entry.row] += value * known[entry.position];
        }
        multipliers.iter_mut().zip(weights).for_each(|(value, weight)| *value *= weight);
    }
}
