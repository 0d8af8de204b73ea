//! The numbers of a document that no plot shows, as tables.

use super::impulses::impulses;
use super::json::Json;
use super::located::all_jumps;
use super::moves::moves;
use super::runs;
use super::tags::{Cell, escape, section, table};
use super::units::{of_condition, of_time, of_value, per};
use crate::command::line;
use crate::output::number::{scientific, significant};

/// The objective, the unknowns and some parameters, large.
pub fn tiles(document: &Json, params: &[&str]) -> String {
    let own = |name: &&str| Some(((*name).to_owned(), document.at("params").at(name).number()?));
    let params = params.iter().filter_map(own);
    let objective = document.at("objective").number().map(|it| ("objective".to_owned(), it));
    let free = document.at("free").pairs().iter();
    let free = free.filter_map(|(name, it)| Some((name.clone(), it.number()?)));
    let of = document.at("value").number();
    let value = of.map(|it| (document.at("of").text().to_owned(), it));
    let tile = |(name, value): (String, f64)| {
        let is_value = document.at("of").text() == name;
        let unit = of_value(document, if is_value { "objective" } else { &name });
        let value = unit.value(value, 7);
        format!("<div><dt>{}</dt><dd>{}</dd></div>\n", escape(&name), escape(&value))
    };
    let tiles: String = params.chain(objective).chain(value).chain(free).map(tile).collect();
    format!("<dl class=\"tiles\">\n{tiles}</dl>\n")
}

/// The parameters in which documents differ.
pub fn differing(documents: &[Json]) -> Vec<&str> {
    let Some((first, others)) = documents.split_first() else { return Vec::new() };
    let params = first.at("params").pairs().iter();
    let is_other =
        |name: &str, value: &Json| others.iter().any(|other| other.at("params").at(name) != value);
    params.filter(|(name, it)| is_other(name, it)).map(|(name, _)| name.as_str()).collect()
}

/// All tables of a document, and its text.
pub fn tables(document: &Json) -> String {
    if runs::of(document).is_some() {
        return runs::tables(document) + &text(document);
    }
    [
        sensitivities(document),
        moves(document),
        switches(document),
        impulses(document),
        jumps(document),
        tried(document, "sequences", "Sequences of jumps"),
        tried(document, "starts", "Starts"),
        end_multipliers(document),
        certificate(document),
        checks(document),
        method(document),
        text(document),
    ]
    .concat()
}

/// By the change that 1 % more of a parameter makes, the largest first.
fn sensitivities(document: &Json) -> String {
    let params = document.at("params");
    let objective = of_value(document, "objective");
    let mut all: Vec<(&String, f64, f64)> = Vec::new();
    for (name, slope) in document.at("sensitivities").pairs() {
        if let (Some(slope), Some(value)) = (slope.number(), params.at(name).number()) {
            all.push((name, value, slope));
        }
    }
    let effect = |it: &(&String, f64, f64)| 0.01 * it.1 * it.2;
    all.sort_by(|a, b| effect(b).abs().total_cmp(&effect(a).abs()));
    let most = all.iter().map(|it| effect(it).abs()).fold(0.0, f64::max);
    let row = |it: &(&String, f64, f64)| {
        let (name, value, slope) = it;
        let unit = of_value(document, name);
        vec![
            Cell::text(*name),
            Cell::Number(unit.value(*value, 6)),
            Cell::Number(per(&objective, &unit).value(*slope, 5)),
            Cell::Number(objective.value(effect(it), 3)),
            Cell::Bar(if most > 0.0 { effect(it) / most } else { 0.0 }),
        ]
    };
    let head = ["parameter", "value", "objective per unit", "1 % more changes it by", ""];
    table("What the optimum is worth", &head, &all.iter().map(row).collect::<Vec<_>>())
}

fn jumps(document: &Json) -> String {
    let row = |(name, it): &(String, &Json)| {
        let time = it.at("time").number().unwrap_or(f64::NAN);
        let state = |side: &str| {
            let pairs = it.at(side).pairs().iter().map(|(name, value)| {
                let value = value.number().unwrap_or(f64::NAN);
                format!("{name} = {}", of_value(document, name).value(value, 5))
            });
            Cell::text(pairs.collect::<Vec<_>>().join(", "))
        };
        let time = Cell::Number(of_time(document).value(time, 7));
        vec![Cell::text(name), time, state("before"), state("after")]
    };
    let rows: Vec<_> = all_jumps(document).iter().map(row).collect();
    table("Jumps", &["jump", "time", "before", "after"], &rows)
}

fn tried(document: &Json, key: &str, title: &str) -> String {
    let row = |(at, it): (usize, &Json)| {
        let jumps: Vec<&str> = it.at("jumps").list().iter().map(Json::text).collect();
        let name = match (key, jumps.as_slice()) {
            ("starts", _) => format!("start {}", at + 1),
            (_, []) => "no jump".into(),
            (_, jumps) => jumps.join(", "),
        };
        let objective = it.at("objective").number();
        let objective = objective.map(|value| of_value(document, "objective").value(value, 9));
        let iterations = it.at("iterations").number().map(|it| it.to_string());
        vec![
            Cell::text(name),
            Cell::text(it.at("status").text().replace('_', " ")),
            Cell::Number(objective.unwrap_or_default()),
            Cell::Number(iterations.unwrap_or_default()),
        ]
    };
    let rows: Vec<_> = document.at(key).list().iter().enumerate().map(row).collect();
    table(title, &["", "status", "objective", "iterations"], &rows)
}

fn end_multipliers(document: &Json) -> String {
    let objective = of_value(document, "objective");
    let row = |(name, it): &(String, Json)| {
        let unit = per(&objective, &of_condition(document, name));
        vec![Cell::text(name), Cell::Number(unit.value(it.number().unwrap_or(f64::NAN), 6))]
    };
    let rows: Vec<_> = document.at("end_multipliers").pairs().iter().map(row).collect();
    table("Multipliers of the conditions at the ends", &["condition", "objective per unit"], &rows)
}

fn switches(document: &Json) -> String {
    let row = |it: &Json| {
        let time = it.at("time").number().unwrap_or(f64::NAN);
        vec![
            Cell::text(it.at("surface").text()),
            Cell::Number(of_time(document).value(time, 10)),
            Cell::text(it.at("from").text()),
            Cell::text(it.at("to").text()),
        ]
    };
    let switches = document.at("certificate").at("switches");
    let rows: Vec<_> = switches.list().iter().map(row).collect();
    table("Located switches", &["surface", "time", "from", "to"], &rows)
}

fn certificate(document: &Json) -> String {
    let row = |it: &Json| {
        let figure = |key: &str| match it.at(key).number() {
            Some(0.0) => "0".into(),
            figure => figure.map_or("-".into(), |figure| scientific(figure, 1)),
        };
        let passes = if it.at("passes").is_true() { "passes" } else { "FAILS" };
        vec![
            Cell::text(it.at("check").text()),
            Cell::Number(figure("figure")),
            Cell::Number(figure("limit")),
            Cell::text(passes),
        ]
    };
    let rows: Vec<_> = document.at("certificate").at("checks").list().iter().map(row).collect();
    let title = "Certificate: the checks of an optimum of the true system";
    table(title, &["check", "figure", "limit", ""], &rows)
}

fn checks(document: &Json) -> String {
    let row = |it: &Json| {
        let control = it.at("control").text();
        let name = format!("{} {control}", it.at("check").text().replace('_', " "));
        let part = it.at("figure").number().zip(it.at("size").number());
        let part = part.map_or("-".into(), |(figure, size)| percent(figure / size));
        let limit = it.at("limit").number().map_or("-".into(), percent);
        let says = if it.at("contradicts").is_true() { "CONTRADICTS" } else { "does not" };
        vec![Cell::text(name), Cell::Number(part), Cell::Number(limit), Cell::text(says)]
    };
    let rows: Vec<_> = document.at("optimality").at("checks").list().iter().map(row).collect();
    let head = ["condition", "missed by", "allowed", "contradicts an optimum"];
    table("Necessary conditions of an optimum", &head, &rows)
}

fn method(document: &Json) -> String {
    let method = document.at("method");
    let intervals = number(method.at("N"));
    let grid = format!("{}, N = {intervals}", method.at("scheme").text());
    let mut rows = vec![("grid", grid), ("controls", method.at("controls").text().into())];
    if let Some(error) = document.at("step_errors").number() {
        rows.push(("errors of all steps", scientific(error, 1)));
    }
    for (surface, sigma) in method.at("sigmas").pairs() {
        let sigma = sigma.number().filter(|sigma| *sigma > 0.0);
        let Some(sigma) = sigma else { continue };
        let width = of_value(document, surface).value(sigma, 4);
        let kernel = method.at("kernel").text();
        rows.push(("width of smoothing", format!("{width} around {surface}, kernel {kernel}")));
    }
    let seconds = document.at("seconds").at("total").number().map(|it| significant(it, 2));
    let work = format!("{} iterations", number(document.at("iterations")));
    let seconds = seconds.map(|it| format!(", {it} s")).unwrap_or_default();
    rows.push(("solver", format!("{}, {work}{seconds}", method.at("solver").text())));
    rows.push(("seed", number(method.at("seed"))));
    for (name, value) in document.at("params").pairs() {
        let value = of_value(document, name).value(value.number().unwrap_or(f64::NAN), 6);
        rows.push(("parameter", format!("{name} = {value}")));
    }
    rows.push(("fdcc", document.at("fdcc").text().into()));
    rows.push(("model", format!("sha256 {}", document.at("source_sha256").text())));
    let row = |(name, value): (&str, String)| vec![Cell::text(name), Cell::text(value)];
    table("How it was solved", &[], &rows.into_iter().map(row).collect::<Vec<_>>())
}

/// The text of the model, and how to solve it again.
fn text(document: &Json) -> String {
    let text = document.at("source").text();
    if text.is_empty() {
        return String::new();
    }
    let model = document.at("model").text();
    let again = again(document);
    section(
        "The model",
        &format!(
            "<p>To run it again:</p>\n<pre>{}</pre>\n<details open=\"\"><summary>{}.fdc</summary>\n\
             <pre>{}</pre></details>\n",
            escape(&again),
            escape(model),
            escape(text)
        ),
    )
}

/// What runs it again: the command that was given, or what leads to such a document where nothing
/// is known of it.
fn again(document: &Json) -> String {
    let model = document.at("model").text();
    let usual = format!("{model}.fdc");
    let given: Vec<&str> = document.at("command").list().iter().map(Json::text).collect();
    let file = given.iter().find(|it| it.ends_with(".fdc")).unwrap_or(&usual.as_str()).to_string();
    let given = (!given.is_empty()).then(|| line(given.into_iter().chain(["--out", "results"])));
    match runs::of(document) {
        Some(run) => given.unwrap_or_else(|| run.again(document)),
        // A sweep writes many solutions.
        None if given.as_ref().is_some_and(|it| it.starts_with("fdcc sweep")) => {
            given.unwrap_or_default()
        }
        None => {
            let verify = line(["verify", &format!("results/{model}.sol.json"), &file]);
            let given = given.unwrap_or_else(|| line(["solve", &usual, "--out", "results"]));
            format!("{given}\n{verify}")
        }
    }
}

fn number(it: &Json) -> String {
    it.number().map_or("-".into(), |value| significant(value, 6))
}

fn percent(part: f64) -> String {
    format!("{} %", significant(100.0 * part, 2))
}
