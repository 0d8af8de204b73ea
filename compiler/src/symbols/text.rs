//! Names with their bounds and values, in the units in which they are declared: `v [km/h] in [0,
//! 100]`.

use crate::model::numbers::Numbers;
use crate::model::{Model, Place, Range, Symbol};
use crate::syntax::text::number;
use crate::units::NamedUnit;
use fdcc_runtime::problem::Bounds;

impl Model {
    /// The unit of a name, if the text uses units and it could be found.
    pub fn unit_of(&self, name: &str) -> Option<&NamedUnit> {
        self.units.iter().find(|it| it.name == name)
    }

    /// One of the declared unit of time in SI; 1 where the text declares none.
    pub fn time_size(&self) -> f64 {
        self.units.iter().find(|it| it.is_time).map_or(1.0, |it| it.scale)
    }

    /// One of the declared unit of a name in SI; 1 where the text declares none.
    pub fn unit_size(&self, name: &str) -> f64 {
        let scale = self.unit_of(name).map_or(1.0, |it| it.scale);
        if scale.is_finite() && scale > 0.0 { scale } else { 1.0 }
    }
}

/// A state or a control: `v [km/h] in [0, 100]`.
pub(crate) fn ranged(model: &Model, numbers: &Numbers, place: &Place, range: Range) -> String {
    in_units(model, &place.name, numbers.bounds(model, range))
}

/// An unknown: `T [s] in [1, 60] guess 15`.
pub(crate) fn free(model: &Model, numbers: &Numbers, at: usize) -> String {
    let it = &model.frees[at];
    let guess = numbers.of(Symbol::Free(at)) / scale(model, &it.place.name);
    format!("{} guess {}", ranged(model, numbers, &it.place, it.range), short(guess))
}

/// A parameter: `m = 2 kg`.
pub(crate) fn param(model: &Model, numbers: &Numbers, at: usize) -> String {
    valued(model, &model.params[at].place.name, numbers.of(Symbol::Param(at)))
}

/// A name with its value in SI: `m = 2 kg`.
pub(crate) fn valued(model: &Model, name: &str, value: f64) -> String {
    let unit = model.unit_of(name).map_or("", |it| &it.unit);
    let value = short(value / scale(model, name));
    format!("{name} = {value} {unit}").trim_end().to_string()
}

/// `v [km/h] in [0, 100]`
fn in_units(model: &Model, name: &str, bounds: Bounds) -> String {
    let scale = scale(model, name);
    let [lower, upper] = [bounds.lower / scale, bounds.upper / scale].map(rounded);
    match model.unit_of(name).filter(|it| !it.unit.is_empty()) {
        Some(it) => bounded(&format!("{name} [{}]", it.unit), Bounds { lower, upper }),
        None => bounded(name, Bounds { lower, upper }),
    }
}

/// How many SI units one of the units is in which a name is declared.
fn scale(model: &Model, name: &str) -> f64 {
    model.unit_of(name).map_or(1.0, |it| it.scale)
}

/// Without the digits that going to SI and back leaves behind.
fn rounded(value: f64) -> f64 {
    format!("{value:.13e}").parse().unwrap_or(value)
}

fn short(value: f64) -> String {
    number(rounded(value))
}

/// `v in [0, 100]`, `v <= 100`
pub(crate) fn bounded(name: &str, bounds: Bounds) -> String {
    let (lower, upper) = (number(bounds.lower), number(bounds.upper));
    match (bounds.lower.is_finite(), bounds.upper.is_finite()) {
        (false, false) => name.into(),
        (true, true) if bounds.is_equality() => format!("{name} == {lower}"),
        (false, true) => format!("{name} <= {upper}"),
        (true, false) => format!("{name} >= {lower}"),
        (true, true) => format!("{name} in [{lower}, {upper}]"),
    }
}
