//! A JSON document as the page sees it: in the order in which it was written, read leniently.
//! What an earlier version did not write is absent, and a number that was not finite is NaN.

use super::whole;
use crate::failure::Failure;
use crate::input;
use crate::output::named::Named;
use serde::de::{MapAccess, SeqAccess, Visitor};
use serde::{Deserialize, Deserializer, Serialize, Serializer};
use std::fmt;
use std::path::Path;

/// Digits of a number in a page: a picture shows fewer, and all of them would double its size.
const DIGITS: usize = 7;

/// Any value.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum Json {
    #[default]
    Null,
    Bool(bool),
    Number(f64),
    Text(String),
    List(Vec<Json>),
    Object(Named<Json>),
}

/// Nothing.
pub static NULL: Json = Json::Null;

impl Json {
    /// Reads a `.sol.json`; one whose signals do not fit its times is refused.
    pub fn read(path: &Path) -> Result<Json, Failure> {
        let failure = |what: String| Failure::File(format!("{}{what}", path.display()));
        let text = input::text(path).map_err(|it| failure(format!(" cannot be read: {it}")))?;
        let json: Json = serde_json::from_str(&text)
            .map_err(|error| failure(format!(" is not a solution: {error}")))?;
        // Phases have times of their own; a simulation of them has no other.
        let phases = json.at("phases").pairs();
        let has_time = |it: &Json| !it.at("time").is_absent();
        let is_timed = !phases.is_empty() && phases.iter().all(|(_, it)| has_time(it));
        match has_time(&json) || is_timed {
            false => Err(failure(" is not a solution: it has no `time`".into())),
            true => whole::check(&json).map(|()| json).map_err(|what| failure(format!(": {what}"))),
        }
    }

    /// What stands under a key, or nothing.
    pub fn at(&self, key: &str) -> &Json {
        self.pairs().iter().find(|(own, _)| own == key).map_or(&NULL, |(_, value)| value)
    }

    /// The keys and values of an object.
    pub fn pairs(&self) -> &[(String, Json)] {
        if let Json::Object(pairs) = self { &pairs.0 } else { &[] }
    }

    /// The entries of a list.
    pub fn list(&self) -> &[Json] {
        if let Json::List(list) = self { list } else { &[] }
    }

    /// A text, or nothing.
    pub fn text(&self) -> &str {
        if let Json::Text(text) = self { text } else { "" }
    }

    /// A number that is finite.
    pub fn number(&self) -> Option<f64> {
        if let Json::Number(number) = self { Some(*number) } else { None }
    }

    /// A list of numbers, NaN where there is none.
    pub fn column(&self) -> Vec<f64> {
        self.list().iter().map(|it| it.number().unwrap_or(f64::NAN)).collect()
    }

    /// Whether it is `true`.
    pub fn is_true(&self) -> bool {
        *self == Json::Bool(true)
    }

    /// Whether there is nothing.
    pub fn is_absent(&self) -> bool {
        match self {
            Json::Null => true,
            Json::List(list) => list.is_empty(),
            Json::Object(pairs) => pairs.is_empty(),
            _ => false,
        }
    }
}

/// With as many digits as a picture needs.
impl Serialize for Json {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match self {
            Json::Null => serializer.serialize_unit(),
            Json::Bool(it) => serializer.serialize_bool(*it),
            Json::Number(it) if it.fract() == 0.0 && it.abs() < 1e15 => {
                serializer.serialize_i64(*it as i64)
            }
            Json::Number(it) => serializer.serialize_f64(rounded(*it)),
            Json::Text(it) => serializer.serialize_str(it),
            Json::List(it) => it.serialize(serializer),
            Json::Object(it) => it.serialize(serializer),
        }
    }
}

fn rounded(number: f64) -> f64 {
    let text = format!("{number:.*e}", DIGITS - 1);
    text.parse().expect("it was a number before")
}

impl<'de> Deserialize<'de> for Json {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(Any)
    }
}

struct Any;

impl<'de> Visitor<'de> for Any {
    type Value = Json;

    fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str("JSON")
    }
    fn visit_unit<E>(self) -> Result<Json, E> {
        Ok(Json::Null)
    }
    fn visit_bool<E>(self, it: bool) -> Result<Json, E> {
        Ok(Json::Bool(it))
    }
    fn visit_i64<E>(self, it: i64) -> Result<Json, E> {
        Ok(Json::Number(it as f64))
    }
    fn visit_u64<E>(self, it: u64) -> Result<Json, E> {
        Ok(Json::Number(it as f64))
    }
    fn visit_f64<E>(self, it: f64) -> Result<Json, E> {
        Ok(Json::Number(it))
    }
    fn visit_str<E>(self, it: &str) -> Result<Json, E> {
        Ok(Json::Text(it.to_owned()))
    }
    fn visit_seq<A: SeqAccess<'de>>(self, mut list: A) -> Result<Json, A::Error> {
        let mut all = Vec::new();
        while let Some(it) = list.next_element()? {
            all.push(it);
        }
        Ok(Json::List(all))
    }
    fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<Json, A::Error> {
        let mut all = Vec::new();
        while let Some(pair) = map.next_entry()? {
            all.push(pair);
        }
        Ok(Json::Object(Named(all)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn order_and_what_is_missing_survive() {
        let text = r#"{"z":[1,null,0.1234567891],"a":{"b":true},"c":"<x>"}"#;
        let json: Json = serde_json::from_str(text).expect("it is JSON");
        assert_eq!(json.at("z").column()[0], 1.0);
        assert!(json.at("z").column()[1].is_nan() && json.at("none").at("more").is_absent());
        assert!(json.at("a").at("b").is_true());
        let short = serde_json::to_string(&json).expect("text keys");
        assert_eq!(short, r#"{"z":[1,null,0.1234568],"a":{"b":true},"c":"<x>"}"#);
    }

    #[test]
    fn tiny_and_huge_numbers_keep_their_size() {
        let json: Json = serde_json::from_str("[1e-296,-1.5e300,2e16]").expect("it is JSON");
        assert_eq!(serde_json::to_string(&json).expect("text"), "[1e-296,-1.5e+300,2e+16]");
    }
}
