//! The lines about jumps: which happen, and what the best answers with others are worth.

use crate::output::document::Document;
use crate::output::plural;
use crate::output::tried::{Happened, Tried};

/// The jumps, and what the best answer with others is worth.
pub fn lines(document: &Document) -> Vec<String> {
    if document.sequences.is_empty() {
        return Vec::new();
    }
    let when =
        |it: &Happened| format!("{} at t = {}", it.jump, document.units.value("time", it.time, 6));
    let happened = match document.jumps.len() {
        0 => "none is best".into(),
        _ => document.jumps.iter().map(when).collect::<Vec<_>>().join(", "),
    };
    let mut lines = vec![format!(" jumps {happened}")];
    lines.extend(with_others(document));
    if document.sequences_left_out {
        lines.push(
            "       longer sequences: not tried; `at most n` in the model says how often a jump \
             may happen"
                .into(),
        );
    }
    lines
}

/// So many of the other sequences are told.
const OTHERS: usize = 4;

/// What is the best with other jumps, the best of them first.
fn with_others(document: &Document) -> Vec<String> {
    let others = document.sequences.iter().filter(|it| !it.is_answer);
    let is_solved = |it: &&Tried| matches!(it.status.as_str(), "solved" | "acceptable");
    let (mut solved, failed): (Vec<&Tried>, Vec<&Tried>) = others.partition(is_solved);
    let distance = |it: &Tried| (it.objective - document.objective).abs();
    solved.sort_by(|a, b| distance(a).total_cmp(&distance(b)));
    let value = |it: &Tried| document.units.value("objective", it.objective, 9);
    let told = solved.iter().take(OTHERS);
    let mut lines: Vec<String> =
        told.map(|it| format!("       {}: objective {}", it.words, value(it))).collect();
    let more = solved.len().saturating_sub(OTHERS);
    lines.extend((more > 0).then(|| format!("       {}: worse", plural(more, "other sequence"))));
    match failed.as_slice() {
        [] => {}
        [one] => lines.push(format!("       {}: {}", one.words, one.status.replace('_', " "))),
        many => lines
            .push(format!("       {}: no trajectory found", plural(many.len(), "other sequence"))),
    }
    lines
}
