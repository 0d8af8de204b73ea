//! The unit in which a plain number beside an expression is read: that of the declarations of its
//! names.
//!
//! Values are held in SI. A name declared in mm counts in mm, so `x <= 3` is 3 mm; the formula
//! `2*x` counts in nothing of its own, and a plain number beside it is refused.

use crate::units::dimension::Dimension;
use crate::units::dimension::notation;
use crate::units::dimension::ratio::Ratio;
use crate::units::dimension::table;
use fdcc_grammar::ast::Unit;

/// Scales that differ by rounding alone are the same.
const ROUNDING: f64 = 1e-12;

/// What an expression is, as far as it has a unit of its own.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub(crate) enum Form {
    /// A name, a part of it, its value at an end, its absolute value, a sum of such in one unit.
    Name,
    /// A number with its unit. In a formula that is no unit of a name; beside it alone a plain
    /// number has it.
    Quantity,
    /// Any other formula.
    Formula,
    /// A sum of terms in different units.
    Mixed,
}

/// A product of powers of the units that are written where the names of an expression are declared.
#[derive(Clone, PartialEq, Eq, Hash, Debug)]
pub(crate) struct Declared {
    /// Names of units; those of names without a written unit are missing, which is SI.
    factors: Vec<(String, Ratio)>,
    /// What the expression is.
    pub form: Form,
}

impl Declared {
    /// Nothing is written: SI.
    pub const SI: Declared = Declared { factors: Vec::new(), form: Form::Name };

    /// The unit of a declared name or of a quantity.
    pub fn of(unit: &Unit) -> Self {
        let factors =
            unit.factors.iter().map(|(name, power)| (name.name.clone(), Ratio::whole(*power)));
        Declared::SI.combined(&factors.collect::<Vec<_>>(), Ratio::ONE, Form::Name)
    }

    /// The same where it is written at a number: `3 [mm]`.
    pub fn of_quantity(unit: &Unit) -> Self {
        Declared { form: Form::Quantity, ..Declared::of(unit) }
    }

    /// The same as a name that is given as a quantity.
    pub fn into_name(self) -> Self {
        Declared { form: Form::Name, ..self }
    }

    /// That of an angle that a function gives.
    pub fn radians() -> Self {
        Declared { factors: vec![("rad".into(), Ratio::ONE)], form: Form::Formula }
    }

    pub fn times(&self, other: &Declared) -> Self {
        self.product(other, Ratio::ONE)
    }

    pub fn over(&self, other: &Declared) -> Self {
        self.product(other, Ratio::whole(-1))
    }

    fn product(&self, other: &Declared, by: Ratio) -> Self {
        let form = other.form.with(Form::Formula);
        self.in_a_formula().combined(&other.in_a_formula().factors, by, form)
    }

    pub fn power(&self, exponent: Ratio) -> Self {
        let form = self.form.with(Form::Formula);
        Declared::SI.combined(&self.in_a_formula().factors, exponent, form)
    }

    /// The same as a formula: beside `max(x, y)` nothing is read in the unit of `x`.
    pub fn into_formula(mut self) -> Self {
        self.form = self.form.with(Form::Formula);
        self
    }

    /// A sum, whose unit is that of its terms if they have one in common.
    pub fn sum(&self, other: &Declared) -> Self {
        match (self.form, other.form) {
            (_, Form::Quantity) => return self.clone(),
            (Form::Quantity, _) => return other.clone(),
            _ => {}
        }
        if self.scale() == other.scale() {
            let form = self.form.with(other.form);
            return Declared { factors: self.factors.clone(), form };
        }
        let mut factors = self.factors.clone();
        factors.extend(other.factors.iter().cloned());
        Declared { factors, form: Form::Mixed }
    }

    /// Angles and shares are what a quantity makes them: `90 [deg]` is no plain 90.
    fn in_a_formula(&self) -> Declared {
        match self.form {
            Form::Quantity if !self.has_share() => Declared::SI,
            _ => self.clone(),
        }
    }

    fn combined(&self, other: &[(String, Ratio)], by: Ratio, form: Form) -> Self {
        let mut factors = self.factors.clone();
        for (name, power) in other {
            let Some(power) = power.times(by) else { continue };
            match factors.iter_mut().find(|it| it.0 == *name) {
                Some(same) => same.1 = same.1.plus(power).unwrap_or(Ratio::ZERO),
                None => factors.push((name.clone(), power)),
            }
        }
        factors.retain(|it| !it.1.is_zero());
        Declared { factors, form: if self.form == Form::Mixed { Form::Mixed } else { form } }
    }

    /// How many SI units one of it is; 1 up to rounding is 1.
    pub fn scale(&self) -> Scale {
        let factor = |(name, power): &(String, Ratio)| {
            table::named(name).map_or(1.0, |(value, _)| match power.as_whole() {
                Some(power) => value.powi(power),
                None => value.powf(power.value()),
            })
        };
        Scale(self.factors.iter().map(factor).product())
    }

    /// Whether a plain number has the same value in it and in SI.
    pub fn is_si(&self) -> bool {
        self.form != Form::Mixed && self.scale() == Scale(1.0)
    }

    /// Whether it is made of units that measure nothing, such as degrees and percent, and is not
    /// empty.
    pub fn is_share(&self) -> bool {
        !self.factors.is_empty() && self.factors.iter().all(|it| measures_nothing(&it.0))
    }

    /// Whether there is such a unit in it.
    pub fn has_share(&self) -> bool {
        self.factors.iter().any(|it| measures_nothing(&it.0))
    }

    /// As it would be written, if it measures that.
    pub fn text(&self, dimension: &Dimension) -> Option<String> {
        let measured =
            self.factors.iter().try_fold(Dimension::none(), |product, (name, power)| {
                product.combined(&table::named(name)?.1, *power)
            })?;
        let is_one = self.form != Form::Mixed && !self.factors.is_empty() && measured == *dimension;
        is_one.then(|| notation::joined(self.factors.clone()))
    }
}

fn measures_nothing(unit: &str) -> bool {
    table::named(unit).is_some_and(|it| it.1.is_none())
}

impl Form {
    /// What both are together.
    fn with(self, other: Form) -> Form {
        match (self, other) {
            (Form::Mixed, _) | (_, Form::Mixed) => Form::Mixed,
            _ if self == other => self,
            _ => Form::Formula,
        }
    }
}

/// How many SI units one unit is; equal up to rounding.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Scale(pub f64);

impl PartialEq for Scale {
    fn eq(&self, other: &Scale) -> bool {
        (self.0 - other.0).abs() <= ROUNDING * self.0.abs().max(other.0.abs())
    }
}
