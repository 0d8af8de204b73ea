//! What a page says of the gradient of the true system.

use super::headline::{Claim, Mark};
use super::json::Json;
use super::tags::{Cell, table};
use super::units::{Unit, of_time, of_value, per};
use crate::output::gradient_words::own;
use crate::output::number::{scientific, significant};

/// Of more numbers, such as all rows of a control, only the largest are listed.
const MOST: usize = 40;

/// The whole in one sentence.
pub fn title(document: &Json) -> String {
    let of = document.at("of").text();
    let is = |key: &str| document.at(key).is_true();
    match () {
        _ if document.at("value").is_absent() => {
            format!("No gradient of {of}: the simulation does not reach the end")
        }
        _ if is("trusted") => format!("Exact gradient of {of}: it can be trusted"),
        _ if is("differentiable") => format!("Gradient of {of}: it cannot be trusted"),
        _ => format!("{of} is not differentiable here{}", cause(document)),
    }
}

/// Where it is not differentiable.
fn cause(document: &Json) -> String {
    let cause = document.at("cause");
    let Some(time) = cause.at("time").number() else { return String::new() };
    let (surface, time) = (cause.at("surface").text(), of_time(document).value(time, 6));
    match cause.at("kind").text() {
        "grazing" => format!(": {surface} is grazed at t = {time}"),
        "corner" => format!(": {surface} meets another surface at t = {time}"),
        "coincident" => {
            format!(": {surface} is met at t = {time}, when the controls change or at the start")
        }
        "limit" => format!(": {surface} is held as hard as it can be from t = {time} on"),
        _ => format!(": {surface} is met at the end, t = {time}"),
    }
}

/// Whether it can be used.
pub fn mark(document: &Json) -> Mark {
    if document.at("trusted").is_true() { Mark::Certain } else { Mark::Wrong }
}

/// What is certain and what is not.
pub fn claims(document: &Json) -> Vec<Claim> {
    let claim = |mark: Mark, text: String| Claim { mark, text };
    let status = document.at("status").text();
    if document.at("value").is_absent() {
        let text = format!("The simulation ends early: {}.", status.replace('_', " "));
        return vec![claim(Mark::Wrong, text)];
    }
    let is_trusted = document.at("trusted").is_true();
    let figure = |key: &str| {
        document.at(key).number().map_or("an unknown amount".into(), |it| scientific(it, 1))
    };
    let mut claims = vec![claim(
        if is_trusted { Mark::Certain } else { Mark::Open },
        format!(
            "The derivatives of the system as it was written, through all of its events: forward \
             and adjoint differ by {}, along steps of twice the length by {}.",
            figure("agreement"),
            figure("resolution")
        ),
    )];
    if !document.at("differentiable").is_true() {
        let text = format!("There is no derivative{}.", cause(document));
        claims.push(claim(Mark::Wrong, text));
    }
    let doubt = if is_trusted { Mark::Open } else { Mark::Wrong };
    let warnings = document.at("warnings").list().iter();
    claims.extend(warnings.map(|it| claim(doubt, sentence(it.text()))));
    claims
}

/// A warning with a capital letter and a full stop.
fn sentence(text: &str) -> String {
    let mut letters = text.chars();
    let first = letters.next().map(|it| it.to_uppercase().to_string()).unwrap_or_default();
    format!("{first}{}.", letters.as_str())
}

/// A number by which is differentiated.
struct By {
    label: String,
    name: String,
    /// Its row, where it is of a control.
    row: Option<usize>,
    /// Its derivative.
    exact: f64,
    unit: Unit,
}

/// All of them, or the largest where there are many.
fn all_by(document: &Json) -> Vec<By> {
    let mut all = Vec::new();
    for (name, derivative) in document.at("gradient").pairs() {
        let unit = per(&of_value(document, "objective"), &of_value(document, own(name)));
        let mut add = |label: String, row: Option<usize>, exact: f64| {
            all.push(By { label, name: name.clone(), row, exact, unit: unit.clone() });
        };
        derivative.number().into_iter().for_each(|exact| add(name.clone(), None, exact));
        for (row, exact) in derivative.column().into_iter().enumerate() {
            add(format!("{name}, row {}", row + 1), Some(row), exact);
        }
    }
    if all.len() > MOST {
        all.sort_by(|a, b| b.exact.abs().total_cmp(&a.exact.abs()));
        all.truncate(MOST);
    }
    all
}

/// The derivatives beside those that others compute, then the second ones; nothing of a document
/// that is of no gradient.
pub fn tables(document: &Json) -> String {
    derivatives(document) + &second(document)
}

fn derivatives(document: &Json) -> String {
    let (columns, all) = (columns(document), all_by(document));
    let has_units = all.iter().any(|it| !it.unit.name.is_empty());
    let row = |it: &By| {
        let mut cells = vec![Cell::text(&it.label)];
        cells.extend(columns.iter().map(|(_, column)| Cell::Number(shown(column, it))));
        if has_units {
            cells.push(Cell::text(&it.unit.name));
        }
        // Lengths of bars can be compared where derivatives have the same unit.
        let alike = all.iter().filter(|other| other.unit == it.unit);
        let most = alike.map(|other| other.exact.abs()).fold(0.0, f64::max);
        cells.push(Cell::Bar(if most > 0.0 { it.exact / most } else { 0.0 }));
        cells
    };
    let mut head = vec!["by"];
    head.extend(columns.iter().map(|(title, _)| title.as_str()));
    head.extend(has_units.then_some("unit"));
    head.push("");
    let rows: Vec<_> = all.iter().map(row).collect();
    table(&format!("Derivatives of {}", document.at("of").text()), &head, &rows)
}

/// The titles of columns, with the objects that have their derivatives by name.
fn columns(document: &Json) -> Vec<(String, Column<'_>)> {
    let sides = document.at("one_sided");
    let mut columns = match sides.is_absent() {
        true => ["gradient", "adjoint"]
            .map(|key| (key.replace("gradient", "exact"), Column::All(document.at(key))))
            .into(),
        false => {
            ["below", "above"].map(|side| (side.to_owned(), Column::Side(sides, side))).to_vec()
        }
    };
    for (name, other) in document.at("compare").pairs() {
        let n = significant(other.at("N").number().unwrap_or(f64::NAN), 6);
        let title = format!("{name} ({}, N {n})", other.at("scheme").text());
        columns.push((title, Column::All(other)));
    }
    columns
}

/// Where the derivatives of a column stand.
#[derive(Clone)]
enum Column<'j> {
    All(&'j Json),
    /// One side of each, where there is no derivative.
    Side(&'j Json, &'static str),
}

fn shown(column: &Column, by: &By) -> String {
    let value = match column {
        Column::All(all) => match by.row {
            Some(row) => all.at(&by.name).list().get(row).and_then(Json::number),
            None => all.at(&by.name).number(),
        },
        Column::Side(sides, side) => sides.at(&by.name).at(side).number(),
    };
    value.map_or("-".into(), |value| significant(value / by.unit.si, 7))
}

fn second(document: &Json) -> String {
    let all = document.at("second").pairs();
    let unit = |a: &str, b: &str| {
        let first = per(&of_value(document, "objective"), &of_value(document, own(a)));
        per(&first, &of_value(document, own(b)))
    };
    let row = |(name, values): &(String, Json)| {
        let cell = |(by, value): &(String, Json)| {
            Cell::Number(unit(name, by).value(value.number().unwrap_or(f64::NAN), 6))
        };
        [Cell::text(name)].into_iter().chain(values.pairs().iter().map(cell)).collect()
    };
    let mut head = vec!["by both"];
    head.extend(all.iter().map(|(name, _)| name.as_str()));
    table("Second derivatives", &head, &all.iter().map(row).collect::<Vec<_>>())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn document(more: &str) -> Json {
        let text = format!(
            r#"{{"of":"x(end)","value":2,"agreement":1e-15,"resolution":2e-11,"gradient":{{"m":4,
                "u":[1,-8]}},"adjoint":{{"m":4,"u":[1,-8]}},"compare":{{"discretised":{{
                "scheme":"euler","N":20,"m":6,"u":[1,2]}}}},"warnings":["it is off"],
                "display_units":{{"m":{{"unit":"g","si":0.001}},
                "objective":{{"unit":"m","si":1}}}},{more}}}"#
        );
        serde_json::from_str(&text).expect("it is JSON")
    }

    #[test]
    fn a_trusted_gradient_has_its_table_in_units_and_its_warnings() {
        let document = document(r#""trusted":true,"differentiable":true"#);
        assert_eq!(title(&document), "Exact gradient of x(end): it can be trusted");
        assert_eq!(mark(&document), Mark::Certain);
        let claims = claims(&document);
        assert_eq!((claims[1].mark, &claims[1].text[..]), (Mark::Open, "It is off."));
        let html = tables(&document);
        for told in ["0.004", "0.006", "m per g", "u, row 2", "discretised (euler, N 20)"] {
            assert!(html.contains(told), "{told}: {html}");
        }
    }

    #[test]
    fn what_is_not_differentiable_says_where_and_has_both_sides() {
        let document = document(
            r#""trusted":false,"differentiable":false,"one_sided":{"m":{"below":3,"above":null}},
               "cause":{"kind":"grazing","surface":"s","time":1.5}"#,
        );
        let title = title(&document);
        assert_eq!(title, "x(end) is not differentiable here: s is grazed at t = 1.5");
        assert_eq!(mark(&document), Mark::Wrong);
        assert!(tables(&document).contains(">below<") && tables(&document).contains("0.003"));
    }
}
