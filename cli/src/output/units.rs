//! Values for people: in the unit in which the model declares the name, with the unit beside it.
//! JSON stays in SI and says so.

use super::named::Named;
use super::number::{short, significant};
use fdcc::Model;
use fdcc::language::NamedUnit;
use serde::{Serialize, Serializer};
use std::collections::HashMap;

/// The units of the names of a model, of its conditions, and of a width of smoothing; where each
/// name stands.
#[derive(Clone, Debug, Default)]
pub struct Units(Vec<NamedUnit>, Vec<NamedUnit>, Option<NamedUnit>, HashMap<String, usize>);

impl From<&Model> for Units {
    fn from(model: &Model) -> Self {
        let width = model.meaning().width_unit.as_ref().map(|it| it.unit.clone());
        Units::new(model.units().to_vec(), model.condition_units().to_vec(), width)
    }
}

/// A unit in which people see a value.
#[derive(Clone, Debug, Serialize)]
pub struct Shown {
    /// Such as `km/h`; empty for a plain number.
    pub unit: String,
    /// How many SI units one of it is.
    pub si: f64,
}

impl Units {
    fn new(names: Vec<NamedUnit>, conditions: Vec<NamedUnit>, width: Option<NamedUnit>) -> Self {
        let mut places: HashMap<String, usize> = HashMap::new();
        for (place, it) in names.iter().enumerate().rev() {
            let time = it.is_time.then(|| "time".to_owned());
            places.extend([it.name.clone()].into_iter().chain(time).map(|name| (name, place)));
        }
        Units(names, conditions, width, places)
    }

    /// The unit in which people see each name; that of time is also under `time`.
    pub fn shown(&self) -> Named<Shown> {
        let shown = |it: &NamedUnit| Shown { unit: it.unit.clone(), si: it.scale };
        let time = self.of("time").map(|it| ("time".to_owned(), shown(it)));
        let names = self.0.iter().chain(&self.1).map(|it| (it.name.clone(), shown(it)));
        time.into_iter().chain(names).collect()
    }

    /// Whether the model uses no units.
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    fn of(&self, name: &str) -> Option<&NamedUnit> {
        self.3.get(name).map(|place| &self.0[*place])
    }

    /// `92.3 km/h`
    pub fn value(&self, name: &str, value: f64, digits: usize) -> String {
        let number = significant(self.scaled(name, value), digits);
        match self.of(name) {
            Some(NamedUnit { unit, .. }) if !unit.is_empty() => format!("{number} {unit}"),
            _ => number,
        }
    }

    /// `3.2 mm`: by how much a condition is violated, or a part of one, or a bound.
    pub fn violation(&self, condition: &str, value: f64, digits: usize) -> String {
        let is_it = |it: &&NamedUnit| {
            condition
                .strip_prefix(it.name.as_str())
                .is_some_and(|rest| rest.is_empty() || rest.starts_with('.'))
        };
        // A condition of a phase is told with its name in front.
        let of_phase = condition.split_once('.').map(|it| it.1);
        let is_of_phase = |it: &&NamedUnit| of_phase == Some(it.name.as_str());
        match self.1.iter().find(is_it).or_else(|| self.1.iter().find(is_of_phase)) {
            Some(it) => {
                Units::new(vec![it.clone()], Vec::new(), None).value(&it.name, value, digits)
            }
            None => self.value(condition, value, digits),
        }
    }

    /// `0.5 J per kg`: a derivative of what one name measures by another.
    pub fn per(&self, of: &str, by: &str, derivative: f64, digits: usize) -> String {
        let value = self.value(of, derivative / self.scaled(by, 1.0), digits);
        match self.of(by) {
            Some(NamedUnit { unit, .. }) if !unit.is_empty() => format!("{value} per {unit}"),
            _ => format!("{value} per unit"),
        }
    }

    /// How many of its unit one in SI of such a derivative is, and that unit: `J per kg`, `J` by a
    /// number, `1 per kg`.
    pub fn of_derivative(&self, of: &str, by: &str) -> (f64, String) {
        let unit =
            |name: &str| self.of(name).map(|it| it.unit.as_str()).filter(|unit| !unit.is_empty());
        let text = match (unit(of), unit(by)) {
            (None, None) => String::new(),
            (Some(of), None) => of.into(),
            (of, Some(by)) => format!("{} per {by}", of.unwrap_or("1")),
        };
        (self.scaled(of, 1.0) / self.scaled(by, 1.0), text)
    }

    /// `100 mm/s`: the width of the smoothing of a surface.
    pub fn width(&self, surface: &str, value: f64) -> String {
        match self.of(surface).or(self.2.as_ref()) {
            Some(it) if !it.unit.is_empty() => format!("{} {}", short(value / it.scale), it.unit),
            _ => short(value),
        }
    }

    /// How many SI units one of the unit of all widths is; 1 where surfaces differ.
    pub fn width_scale(&self) -> f64 {
        self.2.as_ref().map_or(1.0, |it| it.scale)
    }

    /// ` min`, with the blank before it; nothing for a plain number.
    pub fn unit(&self, name: &str) -> String {
        let unit = self.of(name).map_or("", |it| it.unit.as_str());
        if unit.is_empty() { String::new() } else { format!(" {unit}") }
    }

    /// The number alone, in the unit of the name.
    pub fn scaled(&self, name: &str, value: f64) -> f64 {
        self.of(name).map_or(value, |it| value / it.scale)
    }

    /// `v [km/h]`
    pub fn title(&self, name: &str) -> String {
        match self.of(name) {
            Some(NamedUnit { unit, .. }) if !unit.is_empty() => format!("{name} [{unit}]"),
            _ => name.to_string(),
        }
    }

    /// `x = 1 m  v = 0.5 m/s`
    pub fn pairs(&self, values: &Named<f64>, digits: usize) -> String {
        let pair = |(name, value): &(String, f64)| {
            format!("{name} = {}", self.value(name, *value, digits))
        };
        values.0.iter().map(pair).collect::<Vec<_>>().join("  ")
    }
}

/// The SI unit of each name: that of its values in the same document.
impl Serialize for Units {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let si = |it: &NamedUnit| (it.name.clone(), it.si.clone());
        self.0.iter().map(si).collect::<Named<String>>().serialize(serializer)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn units() -> Units {
        let named = |name: &str, unit: &str, si: &str, scale| NamedUnit {
            name: name.into(),
            unit: unit.into(),
            si: si.into(),
            scale,
            ..NamedUnit::default()
        };
        let names = vec![
            named("v", "km/h", "m/s", 1.0 / 3.6),
            named("phi", "deg", "", 0.5),
            named("n", "", "", 1.0),
        ];
        let conditions = vec![named("end pos == goal", "mm", "m", 1e-3)];
        Units::new(names, conditions, None)
    }

    #[test]
    fn people_see_the_unit_of_the_declaration() {
        assert_eq!(units().value("v", 25.0, 6), "90 km/h");
        assert_eq!(units().value("n", 25.0, 6), "25");
        assert_eq!(units().value("other", 25.0, 6), "25");
        assert_eq!(units().per("v", "phi", 25.0, 6), "45 km/h per deg");
        assert_eq!(units().per("n", "v", 3.6, 6), "1 per km/h");
        assert_eq!(units().of_derivative("n", "phi"), (0.5, "1 per deg".into()));
        assert_eq!(units().of_derivative("phi", "n"), (2.0, "deg".into()));
        assert_eq!(units().per("n", "n", 3.0, 6), "3 per unit");
        assert_eq!(units().violation("end pos == goal.y", 0.0032, 3), "3.2 mm");
        assert_eq!(units().violation("v", 25.0, 3), "90 km/h");
        assert_eq!(units().violation("unknown", 25.0, 3), "25");
        assert_eq!(units().title("phi"), "phi [deg]");
        assert_eq!(units().width("v", 25.0), "90 km/h");
        assert_eq!(units().width("other", 25.0), "25");
        assert_eq!(units().unit("v"), " km/h");
        assert_eq!(units().unit("n"), "");
        assert_eq!(
            units().pairs(&Named(vec![("phi".into(), 1.0), ("n".into(), 2.0)]), 6),
            "phi = 2 deg  n = 2"
        );
    }

    #[test]
    fn programs_see_si() {
        let text = serde_json::to_string(&units()).expect("text keys");
        assert_eq!(text, r#"{"v":"m/s","phi":"","n":""}"#);
    }
}
