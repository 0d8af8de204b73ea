//! Every tuned number of sensitivities, by the file that uses it.

pub(super) mod resolved {
    /// By this part of its value, or of one of its unit where it is 0, each quantity is moved for
    /// the trajectory beside; far above rounding, and far below what makes another motion.
    pub(crate) const BESIDE: f64 = 1e-3;
    /// Derivatives along steps of two lengths that differ by less than so many tolerances of a step
    /// are those of the system: a method of order 5 is 32 times as exact along the shorter.
    pub(crate) const TOLERANCES: f64 = 1e3;
    /// So often steps of the explicit method are halved before the stiff one takes them.
    pub(crate) const MOST_EXPLICIT: usize = 2;
    /// So often steps are halved, and so often for the digits of what has decayed to nothing.
    pub(crate) const MOST_HALVINGS: usize = 8;
    pub(crate) const FEW_HALVINGS: usize = 4;
    /// Behind these, derivatives that differ by more than this part of what they did before do not
    /// settle: a method of any order is twice as exact along half the step.
    pub(crate) const SETTLES: f64 = 0.5;
}
