//! One HTML page per solution: a summary and a plot per signal, as inline SVG. No script, no
//! network.

use super::document::{Document, switching};
use super::number::scientific;
use super::optimality::on_the_true_system;
use super::phases::on_one_axis;
use super::plot::{escape, plot};
use super::units::Units;

const STYLE: &str = "body{font:15px/1.45 system-ui,sans-serif;max-width:1300px;margin:2em \
                     auto;padding:0 1em;color:#222}\
h1{font-size:1.5em}h2{font-size:1.15em;margin-top:1.6em}table{border-collapse:collapse}\
td{padding:.15em 1em .15em 0;vertical-align:top}td:first-child{color:#666;white-space:nowrap}\
.plots{display:flex;flex-wrap:wrap;gap:.6em}figure{margin:0}figcaption{font-weight:600}\
svg text{font:11px system-ui,sans-serif;fill:#666}.held{fill:#f4b942;fill-opacity:.25}.axis{stroke:#ddd}\
.signal{fill:none;stroke:#1f5fa8;stroke-width:1.6}";

/// The text of `MODEL.html`.
pub fn html(document: &Document) -> String {
    let title = escape(&document.model);
    format!(
        "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta \
         charset=\"utf-8\"/>\n<title>{title}</title>\n\
         <style>{STYLE}</style>\n</head>\n<body>\n{}</body>\n</html>\n",
        body(document)
    )
}

/// The same as a part of a page of others, to which its style does not apply.
pub fn fragment(document: &Document) -> String {
    format!("<div class=\"fdcc\">\n<style>.fdcc{{{STYLE}}}</style>\n{}</div>\n", body(document))
}

fn body(document: &Document) -> String {
    let document = &on_one_axis(document);
    let sections = [
        ("States", &document.states, &document.units),
        ("Controls (constant on each interval)", &document.controls, &document.units),
        ("Report", &document.report, &document.units),
        ("Costates (dJ/dx)", &document.costates, &Units::default()),
    ];
    let sections = sections.into_iter().filter(|(_, signals, _)| !signals.0.is_empty());
    let sections: String = sections
        .map(|(title, signals, units)| {
            let is_state = std::ptr::eq(signals, &document.states);
            let plots = signals.0.iter().map(|(name, values)| {
                let befores = if is_state { befores(document, name, units) } else { Vec::new() };
                let values: Vec<f64> =
                    values.iter().map(|value| units.scaled(name, *value)).collect();
                plot(document, &units.title(name), &values, &befores)
            });
            format!(
                "<h2>{title}</h2>\n<div class=\"plots\">\n{}</div>\n",
                plots.collect::<String>()
            )
        })
        .collect();
    let title = escape(&document.model);
    format!("<h1>{title}</h1>\n{}{}{sections}", summary(document), legend(document))
}

/// The values of a state just before jumps, in its unit, with the grid points of those after them.
fn befores(document: &Document, name: &str, units: &Units) -> Vec<(usize, f64)> {
    let at = |k: usize| {
        document.befores(k).filter_map(move |before| Some((k, before.get(name).copied()?)))
    };
    let all = (0..document.time.len()).flat_map(at);
    all.map(|(k, value)| (k, units.scaled(name, value))).collect()
}

fn legend(document: &Document) -> &'static str {
    if document.surfaces.0.is_empty() { "" } else { "<p>Shaded: a surface is held.</p>\n" }
}

fn summary(document: &Document) -> String {
    let row = |(name, value): (String, String)| {
        format!("<tr><td>{}</td><td>{}</td></tr>\n", escape(&name), escape(&value))
    };
    format!("<table>\n{}</table>\n", rows(document).into_iter().map(row).collect::<String>())
}

fn rows(document: &Document) -> Vec<(String, String)> {
    let Document { units, method, .. } = document;
    let value = |name: &str, value: f64, digits| units.value(name, value, digits);
    let status = document.status.replace('_', " ");
    let verified = on_the_true_system(document);
    let mut rows = vec![row("status", format!("{status}, {verified}"))];
    rows.push(row("objective", value("objective", document.objective, 10)));
    rows.extend(document.free.0.iter().map(|(name, it)| row(name, value(name, *it, 10))));
    let jumps = document.jumps.iter();
    rows.extend(jumps.map(|it| {
        row(&format!("jump {}", it.jump), format!("at t = {}", value("time", it.time, 10)))
    }));
    rows.push(row("iterations", document.iterations.to_string()));
    rows.push(row("constraint violation", scientific(document.constraint_violation, 1)));
    rows.push(row("optimality error", scientific(document.kkt_error, 1)));
    rows.push(row(
        "method",
        format!("{}, N = {}, kernel {}", method.scheme, method.n, method.kernel),
    ));
    let surfaces = document.surfaces.0.iter().zip(&method.sigmas.0);
    rows.extend(surfaces.map(|((name, spans), (_, sigma))| {
        row(
            &format!("surface {name}"),
            format!("{} (sigma {})", switching(spans, units), units.width(name, *sigma)),
        )
    }));
    let params = document.params.0.iter();
    rows.extend(params.map(|(name, it)| row(&format!("param {name}"), value(name, *it, 6))));
    rows.push(row("seed", method.seed.to_string()));
    rows.push(row("model", format!("sha256 {}", document.source_sha256)));
    rows.push(row("fdcc", document.fdcc.clone()));
    rows
}

fn row(name: &str, value: String) -> (String, String) {
    (name.into(), value)
}
