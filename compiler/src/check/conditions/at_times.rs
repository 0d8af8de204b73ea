//! FDC0416, FDC0417: conditions at times beside what divides time otherwise; conditions that would
//! be the same at any time; and two at one time that exclude each other.

use crate::check::facts::Facts;
use crate::expressions::graph::ExprId;
use crate::model::{AtTime, Constraint, Symbol};
use crate::resolve::elaborator::Elaborator;
use fdcc_grammar::ast::ItemKind;
use fdcc_grammar::{Code, Diagnostic, Span};
use std::collections::HashMap;

/// Reports conditions at times that cannot be treated, or say nothing of their time.
pub(crate) fn check(facts: &mut Facts<'_, '_>, found: &mut Vec<Diagnostic>) {
    let beside = beside(facts);
    for item in &facts.items {
        if let (ItemKind::At { .. }, Some((what, place))) = (&item.kind, &beside) {
            found.push(told(item.span, what, *place));
        }
    }
    if beside.is_none() {
        found.extend(facts.meaning.model.at_times.iter().filter_map(|it| still(facts.meaning, it)));
        contradictions(facts.meaning, found);
    }
}

/// What divides time otherwise, or needs it whole, and where it stands.
fn beside(facts: &Facts<'_, '_>) -> Option<(&'static str, Option<Span>)> {
    let meaning = &*facts.meaning;
    if let Some(phase) = facts.phase {
        return Some(("a phase", Some(phase.span)));
    }
    if let Some(phase) = meaning.phases.first() {
        return Some(("phases", Some(phase.name.span)));
    }
    if let Some(jump) = meaning.model.jumps.first() {
        return Some(("a jump", Some(jump.place.span)));
    }
    if let Some(surface) = meaning.surfaces.first() {
        return Some(("a surface", Some(surface.place.span)));
    }
    let sum = meaning.model.sums.first();
    sum.map(|it| ("a sum over data", Some(it.place.span)))
}

fn told(span: Span, what: &str, place: Option<Span>) -> Diagnostic {
    let message = format!("a condition at a time beside {what}");
    let found = Diagnostic::new(Code::TimeBeside, message, span, "not understood together yet");
    let found = match place {
        Some(place) => found.label(place, "with this"),
        None => found,
    };
    found.help(match what {
        "a phase" | "phases" => {
            "let a phase end at that time, with the condition as its `end`, and link it to the next"
        }
        _ => {
            "write two `phase`s, the first of which ends at that time with the condition as its \
             `end`, and link them"
        }
    })
}

/// A condition that reads no state would be the same at any time.
fn still(meaning: &Elaborator<'_>, it: &AtTime) -> Option<Diagnostic> {
    let moves = |row: &Constraint| {
        let inputs = meaning.graph.inputs_of(&[row.value, row.range.lower, row.range.upper]);
        inputs.iter().any(|at| matches!(meaning.symbols[*at as usize], Symbol::State(_)))
    };
    let row = it.rows.iter().find(|row| !moves(row))?;
    let message = format!("`{}` reads no state", row.place.name);
    let label = "would be the same at any time";
    Some(
        Diagnostic::new(Code::NothingMoves, message, row.place.span, label)
            .help("a condition on unknowns alone is a bound of theirs, or an `end` condition"),
    )
}

/// One value that must lie in two places at one time, the second of which may be a path condition.
fn contradictions(meaning: &Elaborator<'_>, found: &mut Vec<Diagnostic>) {
    let model = &meaning.model;
    let always = model.path.iter().map(|row| (None, row));
    let at_times =
        (model.at_times.iter()).flat_map(|it| it.rows.iter().map(move |row| (Some(it.time), row)));
    let all: Vec<(Option<ExprId>, &Constraint)> = always.chain(at_times).collect();
    let mut before: HashMap<(ExprId, Option<ExprId>), Furthest> = HashMap::new();
    for (at, (time, row)) in all.iter().enumerate() {
        let ends = [row.range.lower, row.range.upper].map(|it| meaning.numeric(it));
        if time.is_some() {
            let then = [*time, None].map(|time| before.get(&(row.value, time)));
            let other = then.into_iter().flatten().filter_map(|it| it.excludes(ends)).min();
            found.extend(other.map(|other| excluded(row, all[other].1)));
        }
        before.entry((row.value, *time)).or_default().add(at, ends);
    }
}

fn excluded(row: &Constraint, by: &Constraint) -> Diagnostic {
    let message = format!("`{}` cannot hold at that time", row.place.name);
    Diagnostic::new(Code::Contradiction, message, row.place.span, "excluded")
        .label(by.place.span, "by this")
        .help("leave one of them out")
}

/// Bounds of one value, each with its row: those that reach further than all before them.
#[derive(Default)]
struct Furthest {
    lower: Vec<(f64, usize)>,
    upper: Vec<(f64, usize)>,
}

impl Furthest {
    fn add(&mut self, row: usize, [lower, upper]: [f64; 2]) {
        if !lower.is_nan() && self.lower.last().is_none_or(|it| lower > it.0) {
            self.lower.push((lower, row));
        }
        if !upper.is_nan() && self.upper.last().is_none_or(|it| upper < it.0) {
            self.upper.push((upper, row));
        }
    }

    /// The first row that leaves nothing between these bounds.
    fn excludes(&self, [lower, upper]: [f64; 2]) -> Option<usize> {
        let above = self.lower.partition_point(|it| upper.is_nan() || it.0 <= upper);
        let below = self.upper.partition_point(|it| lower.is_nan() || it.0 >= lower);
        let both = [self.lower.get(above), self.upper.get(below)];
        both.into_iter().flatten().map(|it| it.1).min()
    }
}
