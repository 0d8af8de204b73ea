//! What was located of a solution: switches, touches and jumps.

use super::json::Json;
use crate::output::certificate::located;

/// How many switches and jumps were located.
pub(super) fn all_located(document: &Json) -> String {
    let switches = document.at("certificate").at("switches").list().iter();
    let switch = |it| {
        let time = Json::at(it, "time").number().unwrap_or(f64::NAN);
        (it.at("surface").text(), time, it.at("to").text())
    };
    located(&switches.map(switch).collect::<Vec<_>>(), all_jumps(document).len())
}

/// The jumps, each with its name; those of phases with the name of the phase before it.
pub(super) fn all_jumps(document: &Json) -> Vec<(String, &Json)> {
    let own = document.at("jumps").list().iter().map(|it| (it.at("jump").text().to_owned(), it));
    let of_phases = document.at("phases").pairs().iter().flat_map(|(phase, json)| {
        let named = move |it| (format!("{phase}.{}", Json::at(it, "jump").text()), it);
        json.at("jumps").list().iter().map(named)
    });
    own.chain(of_phases).collect()
}

/// Whether nothing switches and nothing jumps.
pub(super) fn is_smooth(document: &Json) -> bool {
    let switches = |it: &Json| !it.at("surfaces").pairs().is_empty();
    let phases = document.at("phases").pairs();
    let is_any = switches(document) || phases.iter().any(|(_, it)| switches(it));
    !is_any && all_jumps(document).is_empty()
}
