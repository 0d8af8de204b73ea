//! What a unit measures: a product of powers of the seven SI base units, and of units that are not
//! known yet.
//!
//! As exponents it is a linear form, `e = sum_i r_i a_i` with rational `r_i`: a product adds forms,
//! a power scales them, and two quantities can be added if their forms are equal. Inference solves
//! linear equations between such forms.

pub(super) mod notation;
pub(super) mod quantity;
pub(super) mod ratio;
pub(super) mod table;

use super::dimension::ratio::Ratio;

/// The base units, in the order in which they are written.
pub(crate) const BASE: [&str; 7] = ["kg", "m", "s", "A", "K", "mol", "cd"];

/// What a dimension is made of.
#[derive(Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Debug)]
pub(crate) enum Atom {
    /// A base unit.
    Base(u8),
    /// The unit of a name that was given as a plain number: none, unless its place says otherwise.
    Number(u32),
    /// The unit of a name that was declared without one.
    Unknown(u32),
}

/// A product of powers; no atom twice, none with the power 0, in a fixed order.
#[derive(Clone, PartialEq, Eq, Hash, Default, Debug)]
pub struct Dimension(Vec<(Atom, Ratio)>);

impl Dimension {
    /// No unit.
    pub(crate) fn none() -> Self {
        Dimension::default()
    }

    pub(crate) fn atom(atom: Atom) -> Self {
        Dimension(vec![(atom, Ratio::ONE)])
    }

    /// Whole powers of the base units.
    pub(crate) fn of_base(powers: [i8; 7]) -> Self {
        let factor =
            |(at, power): (usize, &i8)| (Atom::Base(at as u8), Ratio::whole(i32::from(*power)));
        Dimension(powers.iter().enumerate().filter(|it| *it.1 != 0).map(factor).collect())
    }

    pub(crate) fn factors(&self) -> &[(Atom, Ratio)] {
        &self.0
    }

    /// Whether it is known to be no unit at all.
    pub(crate) fn is_none(&self) -> bool {
        self.0.is_empty()
    }

    /// Whether it is made of base units alone.
    pub(crate) fn is_known(&self) -> bool {
        self.0.iter().all(|(atom, _)| matches!(atom, Atom::Base(_)))
    }

    /// Whether it is that of one name by itself, and not known yet.
    pub(crate) fn is_unknown(&self) -> bool {
        matches!(self.0[..], [(Atom::Unknown(_), Ratio::ONE)])
    }

    pub(crate) fn has_number(&self) -> bool {
        self.0.iter().any(|(atom, _)| matches!(atom, Atom::Number(_)))
    }

    /// The power of an atom.
    pub(crate) fn power_of(&self, atom: Atom) -> Ratio {
        self.0.iter().find(|it| it.0 == atom).map_or(Ratio::ZERO, |it| it.1)
    }

    pub(crate) fn times(&self, other: &Dimension) -> Option<Self> {
        self.combined(other, Ratio::ONE)
    }

    pub(crate) fn over(&self, other: &Dimension) -> Option<Self> {
        self.combined(other, Ratio::whole(-1))
    }

    pub(crate) fn power(&self, exponent: Ratio) -> Option<Self> {
        Dimension::none().combined(self, exponent)
    }

    /// `self * other^scale`.
    pub(crate) fn combined(&self, other: &Dimension, scale: Ratio) -> Option<Self> {
        let mut sum = Vec::with_capacity(self.0.len() + other.0.len());
        let (mut left, mut right) = (self.0.iter().peekable(), other.0.iter().peekable());
        while let Some(atom) = smaller(left.peek(), right.peek()) {
            let own = left.next_if(|it| it.0 == atom).map_or(Ratio::ZERO, |it| it.1);
            let added = right.next_if(|it| it.0 == atom).map_or(Ratio::ZERO, |it| it.1);
            let power = own.plus(added.times(scale)?)?;
            if !power.is_zero() {
                sum.push((atom, power));
            }
        }
        Some(Dimension(sum))
    }

    /// The same with an atom replaced by what it is.
    pub(crate) fn substituted(&self, atom: Atom, value: &Dimension) -> Option<Self> {
        let power = self.power_of(atom);
        self.combined(&Dimension::atom(atom), power.negative()?)?.combined(value, power)
    }
}

fn smaller(left: Option<&&(Atom, Ratio)>, right: Option<&&(Atom, Ratio)>) -> Option<Atom> {
    left.map(|it| it.0).into_iter().chain(right.map(|it| it.0)).min()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn products_add_exponents_and_leave_out_what_cancels() {
        let (metre, second) = (Dimension::atom(Atom::Base(1)), Dimension::atom(Atom::Base(2)));
        let speed = metre.over(&second).expect("small");
        assert_eq!(speed, Dimension::of_base([0, 1, -1, 0, 0, 0, 0]));
        assert_eq!(speed.times(&second), Some(metre.clone()));
        assert!(metre.over(&metre).expect("small").is_none());
        assert_eq!(metre.power(Ratio::whole(2)).and_then(|area| area.over(&metre)), Some(metre));
    }

    #[test]
    fn an_atom_is_replaced_with_its_power() {
        let unknown = Atom::Unknown(3);
        let square = Dimension::atom(unknown).power(Ratio::whole(2)).expect("small");
        let newton = Dimension::of_base([1, 1, -2, 0, 0, 0, 0]);
        assert_eq!(square.substituted(unknown, &newton), newton.power(Ratio::whole(2)));
    }
}
