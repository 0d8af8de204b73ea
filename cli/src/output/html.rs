//! One HTML page per solution: a summary and a plot per signal, as inline SVG. No script, no network.

use super::document::{Document, switching};
use super::number::{short, significant};
use std::fmt::Write;

const WIDTH: f64 = 620.0;
const HEIGHT: f64 = 150.0;
const LEFT: f64 = 70.0;
const BOTTOM: f64 = 22.0;

const STYLE: &str = "body{font:15px/1.45 system-ui,sans-serif;max-width:1300px;margin:2em auto;padding:0 1em;color:#222}\
h1{font-size:1.5em}h2{font-size:1.15em;margin-top:1.6em}table{border-collapse:collapse}td{padding:.15em 1em .15em 0}\
td:first-child{color:#666}.plots{display:flex;flex-wrap:wrap;gap:.6em}figure{margin:0}figcaption{font-weight:600}\
svg text{font:11px system-ui,sans-serif;fill:#666}.held{fill:#f4b94233}";

/// The text of `MODEL.html`.
pub fn html(document: &Document) -> String {
    let mut page = format!(
        "<!doctype html>\n<html lang=\"en\"><meta charset=\"utf-8\"><title>{0}</title><style>{STYLE}</style>\n<h1>{0}</h1>\n",
        escape(&document.model)
    );
    page.push_str(&summary(document));
    let sections = [
        ("States", &document.states),
        ("Controls (constant on each interval)", &document.controls),
        ("Report", &document.report),
        ("Costates (dJ/dx)", &document.costates),
    ];
    for (title, signals) in sections.into_iter().filter(|(_, signals)| !signals.0.is_empty()) {
        write!(page, "<h2>{title}</h2>\n<div class=\"plots\">\n").expect("a string takes everything");
        for (name, values) in &signals.0 {
            page.push_str(&plot(document, name, values));
        }
        page.push_str("</div>\n");
    }
    page.push_str("</html>\n");
    page
}

fn summary(document: &Document) -> String {
    let method = &document.method;
    let mut rows = vec![
        ("status".to_string(), document.status.replace('_', " ")),
        ("objective".to_string(), significant(document.objective, 10)),
    ];
    rows.extend(document.free.0.iter().map(|(name, value)| (name.clone(), significant(*value, 10))));
    rows.push(("iterations".into(), document.iterations.to_string()));
    rows.push(("constraint violation".into(), short(document.constraint_violation)));
    rows.push(("optimality error".into(), short(document.kkt_error)));
    rows.push(("method".into(), format!("{}, N = {}, kernel {}", method.scheme, method.n, method.kernel)));
    rows.extend(method.sigmas.0.iter().map(|(name, sigma)| (format!("sigma of {name}"), short(*sigma))));
    rows.extend(
        document.surfaces.0.iter().map(|(name, spans)| (format!("surface {name}"), switching(spans))),
    );
    rows.push(("model".into(), format!("sha256 {}", document.source_sha256)));
    rows.push(("fdcc".into(), document.fdcc.clone()));
    let rows = rows
        .iter()
        .map(|(name, value)| format!("<tr><td>{}</td><td>{}</td></tr>\n", escape(name), escape(value)));
    format!("<table>\n{}</table>\n", rows.collect::<String>())
}

fn plot(document: &Document, name: &str, values: &[f64]) -> String {
    let range = |values: &[f64]| {
        let finite = values.iter().copied().filter(|value| value.is_finite());
        let (low, high) = finite.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), v| (l.min(v), h.max(v)));
        let pad = if high > low { 0.05 * (high - low) } else { 1.0 };
        (low - pad, high + pad)
    };
    let (first, last) = (document.time[0], document.time[document.time.len() - 1]);
    let (low, high) = range(values);
    let x = |t: f64| LEFT + (WIDTH - LEFT - 10.0) * (t - first) / (last - first).max(f64::MIN_POSITIVE);
    let y = |value: f64| 8.0 + (HEIGHT - BOTTOM - 8.0) * (high - value) / (high - low);
    let mut svg = format!(
        "<figure><figcaption>{}</figcaption><svg width=\"{WIDTH}\" height=\"{HEIGHT}\">",
        escape(name)
    );
    for (_, spans) in &document.surfaces.0 {
        for span in spans.iter().filter(|span| span.mode == "held") {
            let (from, width) = (x(span.from), x(span.to) - x(span.from));
            write!(
                svg,
                "<rect class=\"held\" x=\"{from:.1}\" y=\"8\" width=\"{width:.1}\" height=\"{:.1}\"/>",
                HEIGHT - BOTTOM - 8.0
            )
            .expect("a string takes everything");
        }
    }
    for value in [low, 0.5 * (low + high), high] {
        write!(svg, "<path d=\"M{LEFT} {0:.1}H{1}\" stroke=\"#ddd\"/><text x=\"{2}\" y=\"{3:.1}\" text-anchor=\"end\">{4}</text>",
            y(value), WIDTH - 10.0, LEFT - 6.0, y(value) + 4.0, significant(value, 3)).expect("a string takes everything");
    }
    for t in [first, 0.5 * (first + last), last] {
        write!(
            svg,
            "<text x=\"{:.1}\" y=\"{}\" text-anchor=\"middle\">{}</text>",
            x(t),
            HEIGHT - 6.0,
            significant(t, 4)
        )
        .expect("a string takes everything");
    }
    let path = path(&document.time, values, x, y);
    write!(
        svg,
        "<path d=\"{path}\" fill=\"none\" stroke=\"#1f5fa8\" stroke-width=\"1.6\"/></svg></figure>\n"
    )
    .expect("a string takes everything");
    svg
}

/// A polyline through grid values; steps for a signal that has one value per interval.
fn path(time: &[f64], values: &[f64], x: impl Fn(f64) -> f64, y: impl Fn(f64) -> f64) -> String {
    let steps = values.len() < time.len();
    let mut path = String::new();
    for (k, value) in values.iter().enumerate().filter(|(_, value)| value.is_finite()) {
        let command = if path.is_empty() { 'M' } else { 'L' };
        write!(path, "{command}{:.1} {:.1}", x(time[k]), y(*value)).expect("a string takes everything");
        if steps {
            write!(path, "L{:.1} {:.1}", x(time[k + 1]), y(*value)).expect("a string takes everything");
        }
    }
    path
}

fn escape(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;")
}
