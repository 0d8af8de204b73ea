//! Every tuned number of the comparison with the true system, by the file that uses it.

pub(super) mod alignment {
    /// So much of the whole time after a jump the state is that after it.
    pub(crate) const AFTER: f64 = 1e-9;
}

pub(super) mod conditions {
    /// `abs`, `min` and `max` in a condition are those of the true system: as narrow as this part
    /// of the width with which it was solved.
    pub(crate) const NO_WIDTH: f64 = 1e-12;
}

pub(super) mod motion {
    /// A difference of less than this part of the largest value is rounding.
    pub(crate) const ROUNDING: f64 = 1e-10;
    /// So is one of less than this part of the declared unit, around 0.
    pub(crate) const ROUNDING_OF_UNIT: f64 = 1e-14;
}

pub(super) mod times {
    /// A solution whose first or last time differs by more, relative to 1 and the whole time, is
    /// not one of the system.
    pub(crate) const OTHER_TIME: f64 = 1e-6;
}
