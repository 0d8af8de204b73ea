//! Linear equations between dimensions, solved one after another: each holds already, or tells one
//! unknown, or is wrong.
//!
//! What is as good as a declaration comes first, and equations with names that were given as plain
//! numbers come last: so a mistake never spoils what the declared units say.

use crate::units::dimension::ratio::Ratio;
use crate::units::dimension::{Atom, Dimension};

/// Formulas have few plain numbers that also have a place with a unit.
const MOST_CHOICES: usize = 64;

/// Which equations are solved first.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Debug)]
pub(crate) enum Rank {
    /// The bound, start or guess of a name without a unit: as good as a declaration.
    Direct,
    /// Any other without plain numbers.
    Formula,
    /// With names that were given as plain numbers.
    Doubtful,
    /// The value of a definition that its uses seem to contradict.
    Suspect,
}

/// What is known about the atoms.
#[derive(Default)]
pub(crate) struct Solution {
    /// The unit of each name without one, once it is found.
    unknowns: Vec<Option<Dimension>>,
    /// The unit that its place gives to each name that was given as a plain number.
    numbers: Vec<Option<Dimension>>,
}

impl Solution {
    /// Nothing found yet.
    pub fn new(unknowns: usize, numbers: Vec<Option<Dimension>>) -> Self {
        Solution { unknowns: vec![None; unknowns], numbers }
    }

    /// Makes all differences vanish as far as that can be done; those that cannot.
    pub fn contradictions(&mut self, differences: &[(Rank, Dimension)]) -> Vec<usize> {
        let mut order: Vec<usize> = (0..differences.len()).collect();
        order.sort_by_key(|&at| differences[at].0);
        order.into_iter().filter(|&at| !self.make_none(&differences[at].1)).collect()
    }

    fn make_none(&mut self, difference: &Dimension) -> bool {
        let Some(rest) = self.reduced(difference) else { return true };
        let unknown = rest.factors().iter().rev().find_map(|&(atom, power)| match atom {
            Atom::Unknown(at) => Some((at, atom, power)),
            _ => None,
        });
        match unknown {
            Some((at, atom, power)) => {
                let others = rest.substituted(atom, &Dimension::none());
                let exponent = Ratio::ONE.over(power).and_then(Ratio::negative);
                self.unknowns[at as usize] = others.zip(exponent).and_then(|(it, by)| it.power(by));
                true
            }
            None => self.holds(&rest),
        }
    }

    /// Whether a form without unknowns vanishes, whichever of the plain numbers take the units of
    /// their places.
    fn holds(&self, rest: &Dimension) -> bool {
        let numbers = rest.factors().iter().filter_map(|it| match it.0 {
            Atom::Number(at) => Some((it.0, self.numbers[at as usize].clone())),
            _ => None,
        });
        let mut possible = vec![rest.clone()];
        for (atom, place) in numbers {
            let choices =
                [Some(Dimension::none()), place.filter(|_| possible.len() < MOST_CHOICES)];
            let both = |form: &Dimension| {
                choices.iter().flatten().map(|it| form.substituted(atom, it)).collect::<Vec<_>>()
            };
            let Some(next) = possible.iter().flat_map(both).collect::<Option<Vec<_>>>() else {
                return true;
            };
            possible = next;
        }
        possible
            .iter()
            .any(|form| self.settled(form).is_none_or(|it| it.is_none() || !it.is_known()))
    }

    /// The form with everything that was found put in; `None` if its exponents grow beyond all
    /// sense.
    pub fn reduced(&self, form: &Dimension) -> Option<Dimension> {
        self.replaced(form, |atom| match atom {
            Atom::Unknown(at) => self.unknowns[at as usize].clone(),
            _ => None,
        })
    }

    /// The same, and plain numbers with the unit of their place, or none.
    pub fn settled(&self, form: &Dimension) -> Option<Dimension> {
        self.replaced(form, |atom| match atom {
            Atom::Unknown(at) => self.unknowns[at as usize].clone(),
            Atom::Number(at) => Some(self.numbers[at as usize].clone().unwrap_or_default()),
            Atom::Base(_) => None,
        })
    }

    /// Replaces atoms until none is left to be replaced. What is found never leads back to itself;
    /// what places say may, so there is an end to it.
    fn replaced(
        &self,
        form: &Dimension,
        value: impl Fn(Atom) -> Option<Dimension>,
    ) -> Option<Dimension> {
        let mut form = form.clone();
        let most = 2 * (self.unknowns.len() + self.numbers.len()) + 1;
        for _ in 0..most {
            let next = form.factors().iter().find_map(|it| Some((it.0, value(it.0)?)));
            let Some((atom, value)) = next else { return Some(form) };
            form = form.substituted(atom, &value)?;
        }
        None
    }

    /// Whether the unit of a name that was given as a plain number stays open.
    pub fn is_plain(&self, number: u32) -> bool {
        self.numbers[number as usize].is_none()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn base(at: u8) -> Dimension {
        Dimension::atom(Atom::Base(at))
    }

    fn unknown(at: u32) -> Dimension {
        Dimension::atom(Atom::Unknown(at))
    }

    #[test]
    fn unknowns_are_found_whatever_the_order() {
        // a b = m, b^2 = s, so a = m / s^(1/2)
        let product =
            unknown(0).times(&unknown(1)).and_then(|it| it.over(&base(1))).expect("small");
        let square =
            unknown(1).power(Ratio::whole(2)).and_then(|it| it.over(&base(2))).expect("small");
        for equations in [[product.clone(), square.clone()], [square, product]] {
            let equations = equations.map(|it| (Rank::Formula, it));
            let mut solution = Solution::new(2, Vec::new());
            assert!(solution.contradictions(&equations).is_empty());
            let half = Ratio::from_decimal(0.5).expect("a fraction");
            let expected = base(2).power(half).and_then(|it| base(1).over(&it));
            assert_eq!(solution.reduced(&unknown(0)), expected);
        }
    }

    #[test]
    fn a_plain_number_is_none_or_has_the_unit_of_its_place() {
        let number = Dimension::atom(Atom::Number(0));
        let metre = |form: &Dimension| form.over(&base(1)).expect("small");
        let contradiction = |place, form| {
            !Solution::new(0, vec![place]).contradictions(&[(Rank::Doubtful, form)]).is_empty()
        };
        assert!(contradiction(None, metre(&number)));
        assert!(!contradiction(Some(base(1)), metre(&number)));
        assert!(!contradiction(Some(base(1)), number));
        assert!(contradiction(Some(base(2)), metre(&Dimension::atom(Atom::Number(0)))));
    }
}
