//! The lines about jumps: which happen, and what the best answers with others are worth.

use crate::output::document::Document;
use crate::output::plural;
use crate::report::verdict::without_value::WithoutValue;
use fdcc::{Sequence, Solution};

/// The jumps, and what the best answer with others is worth.
pub fn lines(solution: &Solution, document: &Document) -> Vec<String> {
    if solution.sequences.is_empty() {
        return Vec::new();
    }
    let all = document.all_jumps();
    let when = |(name, time): &(String, f64)| {
        format!("{name} at t = {}", document.units.value("time", *time, 6))
    };
    let is_better = |it: &Sequence| {
        it.ended.is_solved && !it.jumps.is_empty() && is_clearly_better(it, solution, document)
    };
    let told = match all.len() {
        0 if solution.sequences.iter().any(is_better) => "none".into(),
        0 if solution.sequences.iter().any(is_unfinished) => "none".into(),
        0 if !solution.sequences.iter().any(|it| it.ended.is_solved) => "none".into(),
        0 => "none is best".into(),
        _ => all.iter().map(when).collect::<Vec<_>>().join(", "),
    };
    let mut lines = vec![format!(" jumps {told}")];
    lines.extend(with_others(solution, document));
    if document.sequences_left_out {
        lines.push(
            "       longer sequences: not tried; `at most n` in the model says how often a jump \
             may happen"
                .into(),
        );
    }
    lines
}

/// Whether nobody knows what a sequence is worth, because its solve was stopped.
fn is_unfinished(sequence: &Sequence) -> bool {
    ["time_limit", "interrupted", "iteration_limit"].contains(&sequence.ended.status)
}

/// Whether the answer has exactly the jumps of a sequence, wherever it was found: what is located
/// may have others than what it was found near.
fn is_found(sequence: &Sequence, document: &Document) -> bool {
    let all = document.all_jumps();
    let is_known = sequence.is_answer || sequence.crosses.is_empty() && !all.is_empty();
    is_known && all.iter().map(|it| &it.0).eq(&sequence.jumps)
}

/// By more than a grid changes it.
fn is_clearly_better(sequence: &Sequence, solution: &Solution, document: &Document) -> bool {
    let [own, its] = [document.objective, sequence.ended.objective];
    let gain = solution.problem.sense * (own - its);
    gain > COARSE * own.abs().max(its.abs())
}

/// Grids change an objective by less than this part of it.
const COARSE: f64 = 0.02;
/// So many of the other sequences are told.
const OTHERS: usize = 4;

/// What is the best with other jumps, the best of them first.
fn with_others(solution: &Solution, document: &Document) -> Vec<String> {
    let others = solution.sequences.iter().filter(|it| !is_found(it, document));
    let is_solved = |it: &&Sequence| it.ended.is_solved;
    let (mut solved, failed): (Vec<&Sequence>, Vec<&Sequence>) = others.partition(is_solved);
    let distance = |it: &Sequence| (it.ended.objective - document.objective).abs();
    solved.sort_by(|a, b| distance(a).total_cmp(&distance(b)));
    let value = |it: &Sequence| document.units.value("objective", it.ended.objective, 9);
    let is_certified = solution.is_certified();
    let better = |it: &Sequence| match is_certified {
        true if is_clearly_better(it, solution, document) => {
            ", better on its grid, and not certified"
        }
        true => " on its grid",
        false => "",
    };
    let told = solved.iter().take(OTHERS);
    let mut lines: Vec<String> = told
        .map(|it| format!("       {}: objective {}{}", it.words, value(it), better(it)))
        .collect();
    let more = solved.len().saturating_sub(OTHERS);
    lines.extend((more > 0).then(|| format!("       {}: worse", plural(more, "other sequence"))));
    let (unfinished, failed): (Vec<&Sequence>, Vec<&Sequence>) =
        failed.into_iter().partition(|it| is_unfinished(it));
    let many = plural(unfinished.len(), "other sequence");
    lines.extend((!unfinished.is_empty()).then(|| {
        format!("       {many}: not finished ({})", unfinished[0].ended.status.replace('_', " "))
    }));
    lines.extend(those_that_failed(solution, &failed));
    lines
}

/// What is said of the sequences for which nothing was found.
fn those_that_failed(solution: &Solution, failed: &[&Sequence]) -> Vec<String> {
    let why = failed.iter().find_map(|it| Some((it, WithoutValue::of(solution, it)?)));
    let why = why.map(|(it, why)| format!("       {}: {}", it.words, why.words()));
    let all = match failed {
        [] => None,
        [_] if why.is_some() => None,
        [one] => Some(format!("       {}: {}", one.words, one.ended.status.replace('_', " "))),
        many => {
            let found_none = many.iter().filter(|it| it.ended.status == "none_found").count();
            let count = plural(many.len(), "other sequence");
            Some(match many.len() - found_none {
                0 => format!("       {count}: no trajectory found"),
                lost => format!("       {count}: not solved, {lost} of them for numerical reasons"),
            })
        }
    };
    all.into_iter().chain(why).collect()
}
