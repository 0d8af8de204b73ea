//! A dimension in words and as a unit: `a force`, `N`, `kg m/s^2`.

use super::ratio::Ratio;
use super::table;
use super::{Atom, BASE, Dimension};
use fdcc_grammar::ast::Unit;
use std::collections::HashMap;

/// Powers of kg, m, s, A, K, mol, cd and what they measure.
const NOUNS: &[([i8; 7], &str)] = &[
    ([0; 7], "a plain number"),
    ([0, 1, 0, 0, 0, 0, 0], "a length"),
    ([1, 0, 0, 0, 0, 0, 0], "a mass"),
    ([0, 0, 1, 0, 0, 0, 0], "a time"),
    ([0, 0, 0, 1, 0, 0, 0], "a current"),
    ([0, 0, 0, 0, 1, 0, 0], "a temperature"),
    ([0, 0, 0, 0, 0, 1, 0], "an amount of substance"),
    ([0, 2, 0, 0, 0, 0, 0], "an area"),
    ([0, 3, 0, 0, 0, 0, 0], "a volume"),
    ([0, 1, -1, 0, 0, 0, 0], "a speed"),
    ([0, 1, -2, 0, 0, 0, 0], "an acceleration"),
    ([0, 1, -3, 0, 0, 0, 0], "a jerk"),
    ([0, 0, -1, 0, 0, 0, 0], "a rate"),
    ([0, 0, -2, 0, 0, 0, 0], "an angular acceleration"),
    ([1, 1, -2, 0, 0, 0, 0], "a force"),
    ([1, 2, -2, 0, 0, 0, 0], "an energy"),
    ([1, 2, -3, 0, 0, 0, 0], "a power"),
    ([1, -1, -2, 0, 0, 0, 0], "a pressure"),
    ([1, 1, -1, 0, 0, 0, 0], "a momentum"),
    ([1, 2, 0, 0, 0, 0, 0], "a moment of inertia"),
    ([1, 0, -2, 0, 0, 0, 0], "a spring constant"),
    ([1, 0, -1, 0, 0, 0, 0], "a damping constant"),
    ([1, -3, 0, 0, 0, 0, 0], "a density"),
    ([0, 0, 1, 1, 0, 0, 0], "a charge"),
    ([1, 2, -3, -1, 0, 0, 0], "a voltage"),
    ([1, 2, -3, -2, 0, 0, 0], "a resistance"),
    ([-1, -2, 4, 2, 0, 0, 0], "a capacitance"),
    ([1, 2, -2, -2, 0, 0, 0], "an inductance"),
    ([1, 2, -2, -1, 0, 0, 0], "a magnetic flux"),
];

/// What a dimension is called, if it has a name.
pub(crate) fn noun(dimension: &Dimension) -> Option<&'static str> {
    NOUNS.iter().find(|row| Dimension::of_base(row.0) == *dimension).map(|row| row.1)
}

/// Names with powers.
type Factors = Vec<(String, Ratio)>;

/// How dimensions are written in one model: as its author writes them, where that can be seen.
#[derive(Default)]
pub(crate) struct Notation {
    /// Units in SI that stand in the text.
    seen: HashMap<Dimension, Factors>,
}

impl Notation {
    pub fn new(units: &[&Unit]) -> Self {
        let mut seen = HashMap::new();
        for unit in units {
            let is_si = table::scale(unit, &mut Vec::new()) == 1.0;
            let is_angle =
                unit.factors.iter().any(|factor| matches!(factor.0.name.as_str(), "rad" | "sr"));
            if let (Some(dimension), true, false) = (table::dimension(unit), is_si, is_angle) {
                seen.entry(dimension).or_insert_with(|| factors(unit));
            }
        }
        Notation { seen }
    }

    /// As a unit, without brackets; empty for none.
    pub fn unit(&self, dimension: &Dimension) -> String {
        joined(self.factors(dimension))
    }

    fn factors(&self, dimension: &Dimension) -> Factors {
        match table::derived(dimension) {
            Some(name) => vec![(name.to_string(), Ratio::ONE)],
            None => self.seen.get(dimension).cloned().unwrap_or_else(|| short(dimension)),
        }
    }

    /// The unit of a factor that is missing between two others: `N/m` between a length and a force.
    pub fn quotient(&self, above: &Dimension, below: &Dimension) -> String {
        let Some(quotient) = above.over(below) else { return String::new() };
        let both_named = [above, below].into_iter().all(|it| table::derived(it).is_some());
        if both_named
            || quotient.factors().len() < 2
            || self.seen.contains_key(&quotient)
            || table::derived(&quotient).is_some()
        {
            return self.unit(&quotient);
        }
        let mut factors = self.factors(above);
        for (name, power) in self.factors(below) {
            match factors.iter_mut().find(|it| it.0 == name) {
                Some(same) => {
                    same.1 = power.negative().and_then(|it| same.1.plus(it)).unwrap_or(Ratio::ZERO)
                }
                None => factors.push((name, power.negative().unwrap_or(power))),
            }
        }
        joined(factors.into_iter().filter(|it| !it.1.is_zero()).collect())
    }

    /// `a force`, `a quantity in m^2/s^3`.
    pub fn noun(&self, dimension: &Dimension) -> String {
        noun(dimension)
            .map_or_else(|| format!("a quantity in {}", self.unit(dimension)), str::to_string)
    }

    /// `N  (kg m/s^2)`, `m/s`, `no unit`.
    pub fn explained(&self, dimension: &Dimension) -> String {
        let (unit, in_base) = (self.unit(dimension), joined(base(dimension)));
        match table::derived(dimension) {
            Some(_) if unit != in_base => format!("{unit}  ({in_base})"),
            _ if unit.is_empty() => "no unit".into(),
            _ => unit,
        }
    }
}

/// In base units, or shorter with a power of a derived one: `N^2 s`. Nobody writes `kg/s^2` for
/// `N/m`.
fn short(dimension: &Dimension) -> Factors {
    let plain = base(dimension);
    if noun(dimension) == Some("a spring constant") {
        return vec![("N".into(), Ratio::ONE), ("m".into(), Ratio::whole(-1))];
    }
    let powers = [1, -1, 2, -2].map(Ratio::whole);
    let all =
        ["N", "J", "W", "Pa", "V"].into_iter().flat_map(|name| powers.map(|power| (name, power)));
    let with = |(name, power): (&str, Ratio)| {
        let rest = dimension.combined(&table::named(name)?.1, power.negative()?)?;
        let mut factors = vec![(name.to_string(), power)];
        factors.extend(base(&rest));
        (factors.len() <= 2).then_some(factors)
    };
    if plain.len() < 3 { plain } else { all.into_iter().find_map(with).unwrap_or(plain) }
}

/// In base units.
fn base(dimension: &Dimension) -> Factors {
    let named = |&(atom, power): &(Atom, Ratio)| match atom {
        Atom::Base(at) => Some((BASE[at as usize].to_string(), power)),
        _ => None,
    };
    dimension.factors().iter().filter_map(named).collect()
}

fn factors(unit: &Unit) -> Factors {
    unit.factors.iter().map(|(name, power)| (name.name.clone(), Ratio::whole(*power))).collect()
}

/// A unit as it stands in the text, without brackets.
pub(crate) fn written(unit: &Unit) -> String {
    joined(factors(unit))
}

/// Factors with positive powers, then each of the others behind a `/`, which turns over the next
/// factor only.
pub(crate) fn joined(factors: Factors) -> String {
    let (below, above): (Factors, Factors) =
        factors.into_iter().partition(|factor| factor.1.is_negative());
    let power = |name: &str, power: Ratio| match power == Ratio::ONE {
        true => name.to_string(),
        false => format!("{name}^{power}"),
    };
    let mut text = above.iter().map(|it| power(&it.0, it.1)).collect::<Vec<_>>().join(" ");
    if text.is_empty() && !below.is_empty() {
        text.push('1');
    }
    for (name, exponent) in below {
        text.push('/');
        text.push_str(&power(&name, exponent.negative().unwrap_or(exponent)));
    }
    text
}
