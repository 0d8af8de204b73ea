//! How large the blocks of an interval are, and where their entries stand.

/// Sizes of states, controls, inner variables and border.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sizes {
    pub(super) n: usize,
    pub(super) m: usize,
    pub(super) inner: usize,
    pub(super) q: usize,
}

impl Sizes {
    /// The same as constants, where there are any.
    #[inline(always)]
    pub(super) fn known<const N: usize, const M: usize, const Q: usize>(self) -> Sizes {
        if N == 0 { self } else { Sizes { n: N, m: M, inner: 0, q: Q } }
    }
    /// `w = (x, theta, u)`
    #[inline(always)]
    pub(super) fn reduced(&self) -> usize {
        self.n + self.m + self.q
    }
    /// `(y, x+)`
    #[inline(always)]
    pub(super) fn next(&self) -> usize {
        self.inner + self.n
    }
    /// `(x, theta, u, y, x+)`, and also `(x, theta, u, b)`
    #[inline(always)]
    pub(super) fn all(&self) -> usize {
        self.reduced() + self.next()
    }
    /// `z = (x, theta)`
    #[inline(always)]
    pub(super) fn kept(&self) -> usize {
        self.n + self.q
    }
    /// Lengths of `Q`, of the response `[T F; N M]` and of `E`, the parts of what is gathered.
    #[inline(always)]
    pub(super) fn parts(&self) -> [usize; 3] {
        let (next, w) = (self.next(), self.reduced());
        [w * w, 2 * next * self.all(), next * next]
    }
    /// Length of what is gathered for an interval.
    #[inline(always)]
    pub(super) fn gathered(&self) -> usize {
        self.parts().iter().sum()
    }
    /// Where the variable that is so many behind the first of its interval stands in `(x, theta, u,
    /// y, x+)`.
    #[inline(always)]
    pub(super) fn position(&self, index: usize) -> usize {
        if index < self.n { index } else { index + self.q }
    }
    /// Where the Hessian entry of two positions in `(x, theta, u, y, x+)` is gathered: lower
    /// triangles only, `H_ww` in `Q`.
    pub(super) fn hessian_place(&self, a: usize, b: usize) -> usize {
        let ([square, ..], w) = (self.parts(), self.reduced());
        let (row, column) = (a.max(b), a.min(b));
        match row.checked_sub(w) {
            None => row * w + column,
            Some(row) => square + (self.next() + row) * self.all() + column,
        }
    }
    /// Where an entry of a defect is gathered: `R` in `T`.
    pub(super) fn defect_place(&self, row: usize, position: usize) -> usize {
        let [square, response, _] = self.parts();
        match position.checked_sub(self.reduced()) {
            None => square + row * self.all() + position,
            Some(column) => square + response + row * self.next() + column,
        }
    }
}
