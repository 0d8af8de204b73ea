//! What inference knows about an expression: the dimension of each of its parts.

use super::dimension::{Atom, Dimension};

/// The dimension of a number, or of one component of a vector.
#[derive(Clone, PartialEq, Eq, Hash, Debug)]
pub(crate) struct Part {
    /// `None` goes with everything: 0, and what has a mistake in it.
    pub dimension: Option<Dimension>,
    /// Made of nothing but numbers without units.
    pub plain: bool,
}

impl Part {
    /// Goes with everything.
    pub const ANY: Part = Part { dimension: None, plain: false };

    pub fn of(dimension: Dimension) -> Self {
        Part { dimension: Some(dimension), plain: false }
    }

    /// A plain number; 0 goes with everything.
    pub fn number(value: f64) -> Self {
        Part { dimension: (value != 0.0).then(Dimension::none), plain: true }
    }

    /// The number in the list of plain numbers that this is by itself.
    pub fn as_number(&self) -> Option<u32> {
        match self.dimension.as_ref()?.factors() {
            [(Atom::Number(at), power)] if *power == super::ratio::Ratio::ONE => Some(*at),
            _ => None,
        }
    }

    pub fn times(&self, other: &Part) -> Part {
        self.with(other, Dimension::times)
    }

    pub fn over(&self, other: &Part) -> Part {
        self.with(other, Dimension::over)
    }

    fn with(&self, other: &Part, apply: impl Fn(&Dimension, &Dimension) -> Option<Dimension>) -> Part {
        let both = self.dimension.as_ref().zip(other.dimension.as_ref());
        Part { dimension: both.and_then(|(a, b)| apply(a, b)), plain: self.plain && other.plain }
    }

    pub fn power(&self, exponent: super::ratio::Ratio) -> Part {
        let dimension = self.dimension.as_ref().and_then(|it| it.power(exponent));
        Part { dimension, plain: self.plain }
    }
}

/// One part for a number, several for a vector, none if even the size is unknown.
pub(crate) type Value = Vec<Part>;

/// Applies something to parts that belong together; a number goes with every part of a vector.
pub(crate) fn pairwise(a: &[Part], b: &[Part], mut apply: impl FnMut(&Part, &Part) -> Part) -> Value {
    let size = a.len().max(b.len());
    if a.is_empty() || b.is_empty() || a.len() != b.len() && a.len() != 1 && b.len() != 1 {
        return Value::new();
    }
    (0..size).map(|at| apply(&a[at.min(a.len() - 1)], &b[at.min(b.len() - 1)])).collect()
}
