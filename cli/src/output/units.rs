//! Values for people: in the unit in which the model declares the name, with the unit beside it. JSON stays in SI and says so.

use super::named::Named;
use super::number::significant;
use fdcc_compiler::{Model, NamedUnit};
use serde::{Serialize, Serializer};

/// The units of the names of a model.
#[derive(Clone, Debug, Default)]
pub struct Units(Vec<NamedUnit>);

impl From<&Model> for Units {
    fn from(model: &Model) -> Self {
        Units(model.units.clone())
    }
}

impl Units {
    /// Whether the model uses no units.
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    fn of(&self, name: &str) -> Option<&NamedUnit> {
        self.0.iter().find(|it| it.name == name || name == "time" && it.is_time)
    }

    /// `92.3 km/h`
    pub fn value(&self, name: &str, value: f64, digits: usize) -> String {
        let number = significant(self.scaled(name, value), digits);
        match self.of(name) {
            Some(NamedUnit { unit, .. }) if !unit.is_empty() => format!("{number} {unit}"),
            _ => number,
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
        let pair = |(name, value): &(String, f64)| format!("{name} = {}", self.value(name, *value, digits));
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
        Units(vec![
            named("v", "km/h", "m/s", 1.0 / 3.6),
            named("phi", "deg", "", 0.5),
            named("n", "", "", 1.0),
        ])
    }

    #[test]
    fn people_see_the_unit_of_the_declaration() {
        assert_eq!(units().value("v", 25.0, 6), "90 km/h");
        assert_eq!(units().value("n", 25.0, 6), "25");
        assert_eq!(units().value("other", 25.0, 6), "25");
        assert_eq!(units().per("v", "phi", 25.0, 6), "45 km/h per deg");
        assert_eq!(units().per("n", "v", 3.6, 6), "1 per km/h");
        assert_eq!(units().per("n", "n", 3.0, 6), "3 per unit");
        assert_eq!(units().title("phi"), "phi [deg]");
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
