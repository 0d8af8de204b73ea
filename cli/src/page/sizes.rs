//! By how little a signal may move and still be drawn as constant: what remains of rounding is
//! otherwise drawn as large as the motion of a signal that moves.
//!
//! | a signal | is constant where it moves by no more than |
//! |---|---|
//! | any | two steps of the seventh digit of its largest value: a page has no more |
//! | with bounds | 1e-9 of the largest of them: solutions hold to about 1e-8 of it |
//! | without | 1e-16 of its declared unit, by which solvers measure it: lost beside it |
//! | a costate | 1e-9 of the largest one, each times the size of its state |
//!
//! A costate times the size of its state is a change of the objective: these can be compared.

use super::figures::Limit;
use super::json::Json;
use super::units::of_value;

/// Of the largest value.
pub const OF_OWN: f64 = 2e-6;
const OF_OTHERS: f64 = 1e-9;
const OF_UNIT: f64 = 1e-16;

/// Of a signal that has limits, or none.
pub fn of_signal(limits: &[Limit], unit: f64) -> f64 {
    let largest = limits.iter().map(|it| it.value.abs()).fold(0.0, f64::max);
    if largest > 0.0 { OF_OTHERS * largest } else { OF_UNIT * unit }
}

/// Of a costate: `json` is a document or a phase of it.
pub fn of_costate(document: &Json, json: &Json, name: &str) -> f64 {
    let worth = |(name, values): &(String, Json)| largest(values) * size(document, json, name);
    let most = json.at("costates").pairs().iter().map(worth).fold(0.0, f64::max);
    let own = size(document, json, name);
    if own > 0.0 { OF_OTHERS * most / own } else { 0.0 }
}

/// The largest value or bound of a state; one of its unit where both are 0.
fn size(document: &Json, json: &Json, state: &str) -> f64 {
    let bounds = json.at("bounds").at(state);
    let size = largest(json.at("states").at(state)).max(largest(bounds));
    if size > 0.0 { size } else { of_value(document, state).si }
}

/// The largest finite number of a list.
fn largest(list: &Json) -> f64 {
    let numbers = list.list().iter().filter_map(Json::number).filter(|it| it.is_finite());
    numbers.map(f64::abs).fold(0.0, f64::max)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bounds_say_what_is_nothing_and_else_the_unit() {
        let limit = |value| Limit { label: "max", value, from: None, to: None };
        assert_eq!(of_signal(&[limit(-16.0), limit(2.0)], 1.0), 1.6e-8);
        assert_eq!(of_signal(&[limit(0.0)], 1e-3), 1e-19);
    }

    /// 1 m and 10 m/s: 100 J per m are as much as 10 J per m/s.
    #[test]
    fn a_costate_is_small_beside_what_the_others_are_worth() {
        let text = r#"{"states":{"x":[0,1],"v":[0,10]},"costates":{"x":[100,100],"v":[1e-9,0]}}"#;
        let json: Json = serde_json::from_str(text).expect("it is JSON");
        assert_eq!(of_costate(&json, &json, "v"), 1e-9 * 100.0 / 10.0);
        assert_eq!(of_costate(&json, &json, "x"), 1e-9 * 100.0);
    }
}
