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
    located(&switches.map(switch).collect::<Vec<_>>(), document.at("jumps").list().len())
}

/// Whether nothing switches and nothing jumps.
pub(super) fn is_smooth(document: &Json) -> bool {
    let switches = |it: &Json| !it.at("surfaces").pairs().is_empty();
    let phases = document.at("phases").pairs();
    let is_any = switches(document) || phases.iter().any(|(_, it)| switches(it));
    !is_any && document.at("jumps").list().is_empty()
}
