//! Every tuned number of gradients, by the file that uses it.

pub(super) mod approximations {
    /// Where the method names no width: this part of the largest value of a switching function.
    pub(crate) const RELATIVE_WIDTH: f64 = 0.01;
}

pub(super) mod exact {
    /// Forward sensitivities and adjoint that differ by more are not trusted.
    pub(crate) const AGREEMENT: f64 = 1e-10;
    /// Derivatives along steps of two lengths that differ by more are not trusted.
    pub(crate) const RESOLVED: f64 = 1e-6;
    /// Derivatives from two sides that differ by more, relative to what they are the sums of, are
    /// two.
    pub(crate) const SIDES: f64 = 1e-5;
    /// For more quantities nobody waits for the derivatives from both sides.
    pub(crate) const MOST_SIDES: usize = 64;
}

pub(super) mod second {
    /// So often steps of the explicit method are halved before the stiff one takes them,
    pub(crate) const MOST_EXPLICIT: usize = 1;
    /// and so often all are halved for second derivatives,
    pub(crate) const MOST_HALVINGS: usize = 6;
    /// unless they change by less than this part.
    pub(crate) const SETTLED: f64 = 1e-6;
}
