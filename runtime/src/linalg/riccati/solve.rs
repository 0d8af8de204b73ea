//! The backward and forward passes of a solve, through one interval.
//!
//! ```text
//!     backward    x+_0 = E^-1 b        y = M x+_0 + pull       g = g_w + T'y + N' x+_0 + v_theta
//!     forward     u = gain z + u_0     x+ = T w + x+_0         lambda = -E^-T (M x+ + N w + pull)
//! ```

use super::interval::{Interval, Sizes};
use super::kernels::{add_scaled, dot};
use crate::linalg::Stages;

impl Interval {
    /// Backward: `gradient` is that of `V_{k+1}` and becomes that of `V_k`. `g` is scratch of size `all`.
    pub(super) fn backward(
        &mut self,
        stages: &Stages,
        k: usize,
        (a, b): (&[f64], &[f64]),
        gradient: &mut [f64],
        g: &mut [f64],
    ) {
        let Sizes { n, m, q } = self.sizes;
        let w = self.sizes.reduced();
        g.fill(0.0);
        self.local_gradient(&b[stages.local(k)], g);
        for (g, a) in g.iter_mut().zip(&a[stages.state(k).start..stages.control(k).end]) {
            *g -= a;
        }
        for i in 0..n {
            self.pull[i] = gradient[i] + g[w + i];
        }
        for i in 0..q {
            g[n + m + i] += gradient[n + i];
        }
        self.eliminate_next(&b[stages.defects(k)], &mut g[..w]);
        self.eliminate_controls(g, gradient);
    }

    /// Local rows: `g -= J' diag(1/d) b`
    fn local_gradient(&self, b: &[f64], g: &mut [f64]) {
        let all = self.sizes.all();
        for (i, value) in b.iter().enumerate() {
            let factor = -self.weights[i] * value;
            for j in 0..all {
                g[j] += factor * self.local[i * all + j];
            }
        }
    }

    fn eliminate_next(&mut self, b: &[f64], g: &mut [f64]) {
        let (n, w) = (self.sizes.n, self.sizes.reduced());
        if self.penalised {
            for i in 0..n {
                self.offset[i] = -self.pull[i];
                self.offset[n + i] = b[i];
            }
            self.s.solve(&mut self.offset, 1);
            for i in 0..2 * n {
                add_scaled(g, &self.coupling[i * w..][..w], self.offset[i]);
            }
            return;
        }
        self.offset[..n].copy_from_slice(b);
        self.e.solve(n, &mut self.offset[..n], 1);
        for i in 0..n {
            let m_row = &self.m[i * n..][..n];
            let y = self.pull[i] + dot(m_row, &self.offset[..n]);
            add_scaled(g, &self.response[i * w..][..w], y);
            add_scaled(g, &self.coupling[i * w..][..w], self.offset[i]);
        }
    }

    fn eliminate_controls(&mut self, g: &mut [f64], gradient: &mut [f64]) {
        let (n, m, kept) = (self.sizes.n, self.sizes.m, self.sizes.kept());
        for i in 0..m {
            if self.fixed[i] {
                g[n + i] = 0.0;
            }
            self.feed_forward[i] = -g[n + i];
        }
        for i in 0..kept {
            gradient[i] = g[if i < n { i } else { i + m }];
        }
        for i in 0..m {
            add_scaled(gradient, &self.gain[i * kept..][..kept], g[n + i]);
        }
        self.uu.solve(&mut self.feed_forward, 1);
    }

    /// Forward: `x` is `x_k` and becomes `x_{k+1}`. `all` is scratch of size `all`.
    pub(super) fn forward(
        &mut self,
        stages: &Stages,
        k: usize,
        (a, b): (&mut [f64], &mut [f64]),
        (x, theta): (&mut [f64], &[f64]),
        all: &mut [f64],
    ) {
        let Sizes { n, m, q } = self.sizes;
        let (w, kept, width) = (self.sizes.reduced(), self.sizes.kept(), self.sizes.all());
        all[..n].copy_from_slice(x);
        all[n + m..n + m + q].copy_from_slice(theta);
        for i in 0..m {
            let gain = &self.gain[i * kept..][..kept];
            all[n + i] = self.feed_forward[i] + dot(&gain[..n], x) + dot(&gain[n..], theta);
        }
        for i in 0..n {
            all[w + i] = self.offset[i] + dot(&self.response[i * w..][..w], &all[..w]);
        }
        a[stages.state(k).start..stages.control(k).end].copy_from_slice(&all[..n + m]);
        self.defect_multipliers(all, &mut b[stages.defects(k)]);
        for (i, row) in stages.local(k).enumerate() {
            b[row] = self.weights[i] * (dot(&self.local[i * width..][..width], all) - b[row]);
        }
        x.copy_from_slice(&all[w..]);
    }

    fn defect_multipliers(&self, all: &[f64], multipliers: &mut [f64]) {
        let (n, w) = (self.sizes.n, self.sizes.reduced());
        for i in 0..n {
            multipliers[i] = if self.penalised {
                self.offset[n + i] + dot(&self.response[(n + i) * w..][..w], &all[..w])
            } else {
                let from_next = dot(&self.m[i * n..][..n], &all[w..]);
                -(self.pull[i] + from_next + dot(&self.coupling[i * w..][..w], &all[..w]))
            };
        }
        if !self.penalised {
            self.e.solve_transposed(multipliers);
        }
    }
}
