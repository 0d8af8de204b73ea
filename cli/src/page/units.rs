//! The units in which a page shows the values of a document.

use super::json::Json;
use crate::output::number::significant;
use serde::Serialize;

/// A unit, and how many SI units one of it is.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Unit {
    /// Empty for a plain number.
    pub name: String,
    pub si: f64,
}

impl Unit {
    /// `92.3 km/h`
    pub fn value(&self, value: f64, digits: usize) -> String {
        let number = significant(value / self.si, digits);
        if self.name.is_empty() { number } else { format!("{number} {}", self.name) }
    }
}

/// That of a name; a plain number where nothing is known.
pub fn of_value(document: &Json, name: &str) -> Unit {
    let shown = document.at("display_units").at(name);
    let si = shown.at("si").number().filter(|it| *it > 0.0);
    match si {
        Some(si) => Unit { name: shown.at("unit").text().to_owned(), si },
        None => Unit { name: String::new(), si: 1.0 },
    }
}

/// That of the time.
pub fn of_time(document: &Json) -> Unit {
    of_value(document, "time")
}

/// That of a condition, or of a bound of a name.
pub fn of_condition(document: &Json, condition: &str) -> Unit {
    let is_it = |name: &str| {
        let rest = condition.strip_prefix(name);
        rest.is_some_and(|rest| rest.is_empty() || rest.starts_with('.'))
    };
    let all = document.at("display_units").pairs();
    // A condition of a phase is told with its name in front.
    let of_phase = condition.split_once('.').map(|it| it.1);
    let known = all.iter().find(|(name, _)| is_it(name));
    let known = known.or_else(|| all.iter().find(|(name, _)| of_phase == Some(name.as_str())));
    // `start v` is the start that the model gives to a state.
    let own = condition.strip_prefix("start ").unwrap_or(condition);
    of_value(document, known.map_or(own, |(name, _)| name))
}

/// `J per kg`: that of a derivative.
pub fn per(of: &Unit, by: &Unit) -> Unit {
    let name = match (of.name.as_str(), by.name.as_str()) {
        (of, "") => of.to_owned(),
        ("", by) => format!("1 per {by}"),
        (of, by) => format!("{of} per {by}"),
    };
    Unit { name, si: of.si / by.si }
}
