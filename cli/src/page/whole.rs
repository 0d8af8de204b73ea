//! Whether a document has what a page draws.

use super::json::Json;
use crate::output::whole::{Signals, Twice, has_length};

/// Says what of a solution is half: signals that do not fit their times would be drawn wrong.
pub fn check(document: &Json) -> Result<(), String> {
    part(document, String::new())?;
    let phases = document.at("phases").pairs();
    phases.iter().try_for_each(|(name, phase)| part(phase, format!("phases.{name}.")))
}

/// A document or a phase of it.
fn part(json: &Json, prefix: String) -> Result<(), String> {
    let (time, states, controls) =
        (json.at("time").column(), columns(json.at("states")), columns(json.at("controls")));
    let (states, controls) = (lent(&states), lent(&controls));
    let signals = Signals { prefix, time: &time, twice: Twice::Any, states, controls };
    signals.check()?;
    // What is no number in these is a gap in a curve: a report may have no value somewhere.
    let prefix = signals.prefix;
    let group = |group: &'static str| json.at(group).pairs().iter().map(move |it| (group, it));
    for (group, (name, it)) in group("costates").chain(group("report")).chain(group("path")) {
        let values = if group == "path" { it.at("values") } else { it };
        has_length(&format!("{prefix}{group}.{name}"), values.list().len(), time.len())?;
    }
    Ok(())
}

fn columns(group: &Json) -> Vec<(&str, Vec<f64>)> {
    group.pairs().iter().map(|(name, values)| (name.as_str(), values.column())).collect()
}

fn lent<'c>(columns: &'c [(&'c str, Vec<f64>)]) -> Vec<(&'c str, &'c [f64])> {
    columns.iter().map(|(name, values)| (*name, values.as_slice())).collect()
}
