//! What is in force when: the mode of each surface, and which controls are at their bounds.

use super::figures::{Part, parts};
use super::json::Json;
use serde::Serialize;

/// One row: a name, and the times at which it is in each of its modes.
#[derive(Debug, Serialize)]
pub struct Strip {
    pub name: String,
    /// `surface`, `control`, `state` or `path`.
    pub of: &'static str,
    pub spans: Vec<Span>,
}

#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Span {
    pub mode: String,
    pub from: f64,
    pub to: f64,
}

/// A value within this part of the distance of its bounds, or of the range of values where there is
/// one bound, is at the bound: an interior point method keeps off it by less.
const NEAR: f64 = 1e-4;

/// The strips of one of the documents; a name of several phases has one.
pub fn strips(documents: &[Json], of: usize) -> Vec<Strip> {
    let parts = parts(documents);
    let own = || parts.iter().filter(move |part| part.of == of);
    let mut strips = Vec::new();
    for part in own() {
        for (name, spans) in part.json.at("surfaces").pairs() {
            extend(&mut strips, name, "surface", spans.list().iter().map(span).collect());
        }
    }
    let arcs = documents[of].at("certificate");
    let arcs = if arcs.at("certified").is_true() { arcs.at("arcs").pairs() } else { &[] };
    let phases = documents[of].at("phases").pairs();
    for (name, spans) in arcs {
        let own = phases.iter().find_map(|(phase, _)| name.strip_prefix(phase)?.strip_prefix('.'));
        let spans = spans.list().iter().map(span).collect();
        let name = own.unwrap_or(name);
        let has = |key: &str| {
            self::parts(documents).iter().any(|it| !it.json.at(key).at(name).is_absent())
        };
        let of = if has("path") {
            "path"
        } else if has("states") {
            "state"
        } else {
            "control"
        };
        extend(&mut strips, name, of, spans);
    }
    // What is at a bound by its values says the same of an arc less exactly.
    let located: Vec<String> =
        strips.iter().filter(|it| it.of != "surface").map(|it| it.name.clone()).collect();
    let is_open = |name: &str| !located.iter().any(|it| it == name);
    for part in own().filter(|_| arcs.is_empty()) {
        for (name, values) in part.json.at("controls").pairs() {
            let bounds = part.json.at("bounds").at(name);
            extend(&mut strips, name, "control", at_bounds(part, bounds, &values.column()));
        }
    }
    for part in own() {
        for (name, values) in part.json.at("states").pairs().iter().filter(|it| is_open(&it.0)) {
            let bounds = part.json.at("bounds").at(name);
            extend(&mut strips, name, "state", at_bounds(part, bounds, &values.column()));
        }
        for (name, it) in part.json.at("path").pairs().iter().filter(|it| is_open(&it.0)) {
            let values = it.at("values").column();
            let spans = at_bounds(part, it.at("bounds"), values.get(1..).unwrap_or_default());
            extend(&mut strips, name, "path", spans);
        }
    }
    strips.retain(|it| it.of == "surface" || it.spans.iter().any(|span| span.mode != FREE));
    strips
}

const FREE: &str = "free";

fn extend(strips: &mut Vec<Strip>, name: &str, of: &'static str, spans: Vec<Span>) {
    match strips.iter_mut().find(|it| it.name == name && it.of == of) {
        Some(strip) => strip.spans.extend(spans),
        None => strips.push(Strip { name: name.to_owned(), of, spans }),
    }
}

fn span(it: &Json) -> Span {
    let [from, to] = ["from", "to"].map(|key| it.at(key).number().unwrap_or(f64::NAN));
    Span { mode: it.at("mode").text().to_owned(), from, to }
}

/// When a signal is at its bounds; a signal with as many values as there are times holds from each
/// to the next.
fn at_bounds(part: &Part, bounds: &Json, values: &[f64]) -> Vec<Span> {
    let [lower, upper] = bounds.column()[..] else { return Vec::new() };
    let time = part.json.at("time").column();
    let [least, most] = [f64::min, f64::max].map(|of| values.iter().copied().fold(f64::NAN, of));
    let distance = upper - lower;
    let near = |bound: f64| {
        NEAR * if distance.is_finite() { distance } else { bound.abs().max(most - least) }
    };
    let mode = |value: f64| match value {
        _ if upper - value <= near(upper) => "max",
        _ if value - lower <= near(lower) => "min",
        _ => FREE,
    };
    let mut spans: Vec<Span> = Vec::new();
    for (ends, value) in time.windows(2).zip(values) {
        match spans.last_mut().filter(|it| it.mode == mode(*value)) {
            Some(span) => span.to = ends[1],
            None => spans.push(Span { mode: mode(*value).into(), from: ends[0], to: ends[1] }),
        }
    }
    spans
}

#[cfg(test)]
mod tests {
    use super::*;

    fn document(text: &str) -> [Json; 1] {
        [serde_json::from_str(text).expect("it is JSON")]
    }

    #[test]
    fn a_control_is_at_its_bounds_where_it_is_near_them() {
        let documents = document(
            r#"{"time":[0,1,2,3,4],"controls":{"u":[2,1.99999,0.5,-1],"free":[0,0,0,0]},
                "bounds":{"u":[-1,2]},"surfaces":{"s":[{"mode":"held","from":0,"to":4}]}}"#,
        );
        let strips = strips(&documents, 0);
        let names: Vec<&str> = strips.iter().map(|it| it.name.as_str()).collect();
        assert_eq!(names, ["s", "u"]);
        let modes: Vec<(&str, f64)> =
            strips[1].spans.iter().map(|it| (it.mode.as_str(), it.to)).collect();
        assert_eq!(modes, [("max", 2.0), ("free", 3.0), ("min", 4.0)]);
    }

    /// Arcs that were located are told instead of what values look like.
    #[test]
    fn the_arcs_of_a_certificate_are_those_of_the_strips() {
        let documents = document(
            r#"{"time":[0,1,2],"controls":{"u":[2,0.5]},"bounds":{"u":[-1,2]},
                "certificate":{"certified":true,"arcs":{"u":[{"mode":"max","from":0,"to":0.9},
                {"mode":"free","from":0.9,"to":2}]}}}"#,
        );
        let strips = strips(&documents, 0);
        assert_eq!(strips[0].spans[0].to, 0.9);
    }

    #[test]
    fn a_path_condition_and_its_arc_are_one_row() {
        let documents = document(
            r#"{"time":[0,1,2],"path":{"c":{"bounds":[0,null],"values":[null,0,5]}},
                "certificate":{"certified":true,"arcs":{"c":[{"mode":"min","from":0,"to":0.9},
                {"mode":"free","from":0.9,"to":2}]}}}"#,
        );
        let all = strips(&documents, 0);
        assert_eq!((all.len(), all[0].of, all[0].spans[0].to), (1, "path", 0.9));
    }

    #[test]
    fn a_bound_on_one_side_and_phases_one_after_the_other() {
        let documents = document(
            r#"{"phases":{"a":{"time":[0,1],"states":{"x":[0]},"bounds":{"x":[0,null]}},
                          "b":{"time":[1,2],"states":{"x":[5]},"bounds":{"x":[0,null]}}}}"#,
        );
        let strips = strips(&documents, 0);
        let modes: Vec<(&str, f64)> =
            strips[0].spans.iter().map(|it| (it.mode.as_str(), it.to)).collect();
        assert_eq!(modes, [("min", 1.0), ("free", 2.0)]);
    }
}
