//! The table of a fit: what each unknown is estimated as, and how the estimates go together.

use super::json::Json;
use super::tags::{Cell, escape, section, table};
use super::units::of_value;
use crate::output::number::significant;
use crate::output::plural;

/// A correlation with more unknowns than this is not written out.
const MOST: usize = 12;

/// The section of a document; nothing where nothing was fitted.
pub fn estimates(document: &Json) -> String {
    let estimates = document.at("estimates");
    let names: Vec<&str> =
        estimates.at("unknowns").pairs().iter().map(|(name, _)| name.as_str()).collect();
    let shown = if (2..=MOST).contains(&names.len()) { &names[..] } else { &[] };
    let titles: Vec<String> = shown.iter().map(|it| format!("correlation with {it}")).collect();
    let mut head = vec!["unknown", "estimate", "± standard error", "part of it"];
    head.extend(titles.iter().map(String::as_str));
    let rows: Vec<_> = names.iter().map(|name| row(document, name, shown)).collect();
    match rows.is_empty() {
        true if estimates.is_absent() => String::new(),
        true => section("Estimates", &fit(estimates)),
        // The words stand below the heading of the table.
        false => table("Estimates", &head, &rows).replacen(
            "</h2>\n",
            &format!("</h2>\n{}", fit(estimates)),
            1,
        ),
    }
}

fn row(document: &Json, name: &str, others: &[&str]) -> Vec<Cell> {
    let estimates = document.at("estimates");
    let it = estimates.at("unknowns").at(name);
    let (unit, value) = (of_value(document, name), it.at("value").number().unwrap_or(f64::NAN));
    let error = it.at("standard_error").number();
    let shown = match error {
        Some(error) => format!("± {}", unit.value(error, 3)),
        None if it.at("is_at_bound").is_true() => "at its bound".into(),
        None => "not known".into(),
    };
    let part = error.filter(|_| value != 0.0).map(|error| 100.0 * error / value.abs());
    let part = part.map_or("-".into(), |part| format!("{} %", significant(part, 2)));
    let mut cells = vec![
        Cell::text(name),
        Cell::Number(unit.value(value, 7)),
        Cell::Number(shown),
        Cell::Number(part),
    ];
    let correlations = estimates.at("correlations").at(name);
    cells.extend(others.iter().map(|other| {
        let of = correlations.at(other).number().filter(|_| error.is_some());
        Cell::Number(of.map_or("-".into(), |of| significant(of, 4)))
    }));
    cells
}

/// How well the model fits, and what the data leave open.
fn fit(estimates: &Json) -> String {
    let count = |key: &str| estimates.at(key).number().map(|it| it as usize);
    let mut told = vec![plural(count("rows").unwrap_or(0), "measurement")];
    told.extend(
        count("degrees_of_freedom").map(|it| format!("{} of freedom", plural(it, "degree"))),
    );
    if let Some(deviation) = estimates.at("deviation").number() {
        let deviation = significant(deviation, 4);
        told.push(match estimates.at("noise").text() {
            "given" => format!(
                "residuals of {deviation} standard deviations in the mean of squares; about 1 if \
                 the model and the standard deviations are right"
            ),
            _ => format!(
                "residuals of {deviation} in the mean of squares, from which the standard errors \
                 are taken"
            ),
        });
    }
    let mut text = format!("<p>{}.</p>\n", escape(&told.join(", ")));
    for group in estimates.at("undetermined").list() {
        let names: Vec<&str> = group.list().iter().map(Json::text).collect();
        text += &format!(
            "<p><b class=\"open\">The data do not determine</b> {}: other values fit as \
             well.</p>\n",
            escape(&names.join(", "))
        );
    }
    if estimates.at("is_minimum") == &Json::Bool(false) {
        text += "<p><b class=\"open\">A strict minimum could not be shown</b>, so nothing has a \
                 standard error.</p>\n";
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn estimates_have_their_units_errors_and_correlations() {
        let text = r#"{"display_units":{"m":{"unit":"g","si":0.001}},"estimates":{"unknowns":{
            "m":{"value":2,"standard_error":0.01,"is_at_bound":false},
            "mu":{"value":0,"standard_error":null,"is_at_bound":true}},
            "correlations":{"m":{"m":1,"mu":0},"mu":{"m":0,"mu":1}},"undetermined":[["a","b"]],
            "rows":5,"degrees_of_freedom":3,"deviation":1.5,"noise":"given","is_minimum":true}}"#;
        let html = estimates(&serde_json::from_str(text).expect("it is JSON"));
        for told in ["2000 g", "± 10 g", "0.5 %", "at its bound", "5 measurements", "a, b: other"]
        {
            assert!(html.contains(told), "{told}: {html}");
        }
        assert!(estimates(&Json::Null).is_empty());
    }
}
