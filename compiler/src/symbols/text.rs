//! Names with their bounds and values, in the units in which they are declared: `v [km/h] in [0,
//! 100]`.

use crate::model::numbers::Numbers;
use crate::model::{Constraint, Model, Place, Range, Symbol};
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

    /// One of the declared unit of a name in SI, 1 where the text declares none; less where it is
    /// known to be far smaller.
    pub fn unit_size(&self, name: &str) -> f64 {
        if let Some((_, magnitude)) = self.magnitudes.iter().find(|it| it.0 == name) {
            return *magnitude;
        }
        let scale = self.unit_of(name).map_or(1.0, |it| it.scale);
        if scale.is_finite() && scale > 0.0 { scale } else { 1.0 }
    }

    /// A name with its value, which is given in SI: `m = 2 kg`.
    pub(crate) fn valued(&self, name: &str, value: f64) -> String {
        let unit = self.unit_of(name).map_or("", |it| &it.unit);
        let value = short(value / scale(self, name));
        format!("{name} = {value} {unit}").trim_end().to_string()
    }

    /// Whether every number of the text is one of SI.
    pub(crate) fn is_in_si(&self) -> bool {
        self.units.iter().all(|it| it.scale == 1.0)
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
    model.valued(&model.params[at].place.name, numbers.of(Symbol::Param(at)))
}

/// An end of the time, in SI: `tf = 10 ms`.
pub(crate) fn time(model: &Model, name: &str, value: f64) -> String {
    let unit = model.units.iter().find(|it| it.is_time).map_or("", |it| &it.unit);
    let value = short(value / model.time_size());
    format!("{name} = {value} {unit}").trim_end().to_string()
}

/// A condition: `limit [mm] <= 5`; one without a name is what stands in the text, and between which
/// numbers: `x <= 2*w (<= 5 mm)`.
pub(crate) fn condition(model: &Model, numbers: &Numbers, it: &Constraint) -> String {
    let name = it.place.name.as_str();
    let is_it = |unit: &&NamedUnit| {
        let rest = name.strip_prefix(unit.name.as_str());
        rest.is_some_and(|rest| rest.is_empty() || rest.starts_with('.'))
    };
    let unit = model.condition_units.iter().find(is_it);
    let (scale, unit) = unit.map_or((1.0, ""), |it| (it.scale, it.unit.as_str()));
    let bounds = scaled(numbers.bounds(model, it.range), scale);
    if name.contains(' ') {
        let bounds = bounded("", bounds);
        return format!("{name} ({})", format!("{} {unit}", bounds.trim_start()).trim_end());
    }
    match unit {
        "" => bounded(name, bounds),
        unit => bounded(&format!("{name} [{unit}]"), bounds),
    }
}

/// Where a name has a value, `x == 0.004` in SI, with that in its unit: `x == 4 [mm]`. A place that
/// is a formula stays as it is.
pub(crate) fn place(model: &Model, equation: &str) -> String {
    let sides = equation.split_once(" == ");
    let found = sides.and_then(|(name, value)| {
        let unit = model.unit_of(name).filter(|it| !it.unit.is_empty())?;
        let value = short(value.parse::<f64>().ok()? / unit.scale);
        Some(format!("{name} == {value} [{}]", unit.unit))
    });
    found.unwrap_or_else(|| equation.into())
}

/// `v [km/h] in [0, 100]`
fn in_units(model: &Model, name: &str, bounds: Bounds) -> String {
    let bounds = scaled(bounds, scale(model, name));
    match model.unit_of(name).filter(|it| !it.unit.is_empty()) {
        Some(it) => bounded(&format!("{name} [{}]", it.unit), bounds),
        None => bounded(name, bounds),
    }
}

fn scaled(bounds: Bounds, scale: f64) -> Bounds {
    let [lower, upper] = [bounds.lower / scale, bounds.upper / scale].map(rounded);
    Bounds { lower, upper }
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
