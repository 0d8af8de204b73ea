//! What inference knows about an expression: the dimension of each of its parts.

use super::declared::{Declared, Form};
use crate::units::dimension::{Atom, Dimension};
use std::rc::Rc;

/// The dimension of a number, or of one component of a vector.
#[derive(Clone, PartialEq, Eq, Hash, Debug)]
pub(crate) struct Part {
    /// `None` goes with everything: 0, and what has a mistake in it.
    pub dimension: Option<Dimension>,
    /// Made of nothing but numbers without units.
    pub plain: bool,
    /// The unit in which a plain number beside it is read.
    pub declared: Declared,
    /// What it is called as a part of its vector.
    pub called: Option<Rc<str>>,
}

impl Part {
    /// Goes with everything.
    pub const ANY: Part =
        Part { dimension: None, plain: false, declared: Declared::SI, called: None };

    pub fn of(dimension: Dimension) -> Self {
        Part { dimension: Some(dimension), ..Part::ANY }
    }

    /// The same, declared in a unit.
    pub fn in_unit(self, declared: Declared) -> Self {
        Part { declared, ..self }
    }

    /// The same, called as another part.
    pub fn called_as(self, other: &Part) -> Self {
        Part { called: other.called.clone(), ..self }
    }

    /// The same by itself.
    pub fn alone(self) -> Self {
        Part { called: None, ..self }
    }

    /// The same as a formula, beside which no plain number is read in the unit of a name.
    pub fn into_formula(self) -> Self {
        Part { declared: self.declared.into_formula(), ..self }
    }

    /// The same as a name that is given as a quantity.
    pub fn into_name(self) -> Self {
        Part { declared: self.declared.into_name(), ..self }
    }

    /// Whether it is a number without a unit, and not 0, which has every unit.
    pub fn is_bare(&self) -> bool {
        self.plain && self.dimension.is_some()
    }

    /// The unit of a sum with another part: plain numbers and what is unknown have none to give.
    pub fn sum_with(&self, other: &Part) -> Declared {
        let says = |it: &Part| !it.plain && it.dimension.is_some();
        match (says(self), says(other)) {
            (true, true) => self.declared.sum(&other.declared),
            (false, true) => other.declared.clone(),
            _ => self.declared.clone(),
        }
    }

    /// Whether a plain number beside it takes the unit of a name, other than that of SI.
    pub fn gives_unit(&self) -> bool {
        matches!(self.declared.form, Form::Name | Form::Quantity) && !self.declared.is_si()
    }

    /// A plain number; 0 goes with everything.
    pub fn number(value: f64) -> Self {
        Part { dimension: (value != 0.0).then(Dimension::none), plain: true, ..Part::ANY }
    }

    /// The number in the list of plain numbers that this is by itself.
    pub fn as_number(&self) -> Option<u32> {
        match self.dimension.as_ref()?.factors() {
            [(Atom::Number(at), power)] if *power == crate::units::dimension::ratio::Ratio::ONE => {
                Some(*at)
            }
            _ => None,
        }
    }

    pub fn times(&self, other: &Part) -> Part {
        self.with(other, Dimension::times, self.declared.times(&other.declared))
    }

    pub fn over(&self, other: &Part) -> Part {
        self.with(other, Dimension::over, self.declared.over(&other.declared))
    }

    fn with(
        &self,
        other: &Part,
        apply: impl Fn(&Dimension, &Dimension) -> Option<Dimension>,
        declared: Declared,
    ) -> Part {
        let both = self.dimension.as_ref().zip(other.dimension.as_ref());
        let dimension = both.and_then(|(a, b)| apply(a, b));
        let called = self.called.clone().or_else(|| other.called.clone());
        Part { dimension, plain: self.plain && other.plain, declared, called }
    }

    pub fn power(&self, exponent: crate::units::dimension::ratio::Ratio) -> Part {
        let dimension = self.dimension.as_ref().and_then(|it| it.power(exponent));
        Part { dimension, declared: self.declared.power(exponent), ..self.clone() }
    }
}

/// One part for a number, several for a vector, none if even the size is unknown.
pub(crate) type Value = Vec<Part>;

/// Applies something to parts that belong together; a number goes with every part of a vector.
pub(crate) fn pairwise(
    a: &[Part],
    b: &[Part],
    mut apply: impl FnMut(&Part, &Part) -> Part,
) -> Value {
    let size = a.len().max(b.len());
    if a.is_empty() || b.is_empty() || a.len() != b.len() && a.len() != 1 && b.len() != 1 {
        return Value::new();
    }
    (0..size).map(|at| apply(&a[at.min(a.len() - 1)], &b[at.min(b.len() - 1)])).collect()
}
