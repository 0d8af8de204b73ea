//! Where a state is with respect to a switching surface.

/// Where the state is with respect to a surface.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Mode {
    /// The selector is -1.
    Below,
    /// The selector is 1.
    Above,
    /// The selector keeps the state on the surface.
    Sliding,
    /// A component of a ball that is not at 0, or leaves it.
    Moving,
    /// Kept on the surface by what a jump says follows it.
    Held,
}

impl Mode {
    /// -1, 1, or 0 on the surface.
    pub(crate) fn side(self) -> f64 {
        match self {
            Mode::Below => -1.0,
            Mode::Above => 1.0,
            Mode::Sliding | Mode::Moving | Mode::Held => 0.0,
        }
    }
}
