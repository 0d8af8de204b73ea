//! FDC0411: constants and bounds that are no finite numbers: `1/0`, `0/0`.

use crate::check::facts::Facts;
use crate::expressions::graph::{Expr, ExprId};
use crate::model::{Range, Symbol};
use crate::resolve::elaborator::{Elaborator, Role, Usage};
use fdcc_grammar::ast::{self, ExprKind, Interval, Item, ItemKind};
use fdcc_grammar::{Code, Diagnostic, Span};

/// Reports what has no finite value, though all that it is made of has one.
pub(crate) fn check(facts: &mut Facts<'_, '_>, found: &mut Vec<Diagnostic>) {
    let (before, told) = (found.len(), facts.told());
    facts.items.iter().for_each(|item| {
        // What is unknown for another reason has been told.
        if !told.is_within(item.span) {
            of_item(facts.meaning, item, found);
        }
    });
    if found.len() == before {
        facts.meaning.usages.iter().for_each(|usage| of_usage(facts.meaning, usage, found));
    }
}

fn of_item(meaning: &Elaborator<'_>, item: &Item, found: &mut Vec<Diagnostic>) {
    let declared =
        crate::syntax::scope::declared(item).and_then(|name| meaning.scope.find(&name.name));
    let Some(at) = declared.filter(|&at| std::ptr::eq(meaning.scope.declarations[at].item, item))
    else {
        return;
    };
    let mut values = |parts: &[ExprId], what: &str, span: Span| {
        let bad = parts.iter().find_map(|&part| value(meaning, part).filter(|it| !it.is_finite()));
        found.extend(bad.map(|value| told(what, value, span)));
    };
    match &item.kind {
        ItemKind::Const { value, .. } => {
            values(meaning.values[at].parts.as_slice(), "a constant", value.span)
        }
        ItemKind::Time { interval, .. } => {
            values(&meaning.interval[..1], "the first time", interval.lower.span);
            values(&meaning.interval[1..], "the last time", interval.upper.span);
        }
        _ => {}
    }
    let Some(index) = meaning.index_of(at) else { return };
    let model = &meaning.model;
    match &item.kind {
        ItemKind::Param { value: given, bounds, .. } => {
            if let (Some(id), Some(given)) = (model.params[index].value, given) {
                values(&[id], "a parameter", given.span);
            }
            of_bounds(meaning, bounds.as_ref(), model.params[index].range, found);
        }
        ItemKind::Free { bounds, .. } => {
            of_bounds(meaning, bounds.as_ref(), model.frees[index].range, found);
        }
        ItemKind::Control { bounds, parts, .. } => {
            for control in model.controls[index..].iter().take(parts.len().max(1)) {
                of_bounds(meaning, bounds.as_ref(), control.range, found);
            }
        }
        ItemKind::State { bounds, parts, .. } => {
            for state in model.states[index..].iter().take(parts.len().max(1)) {
                of_bounds(meaning, bounds.as_ref(), state.range, found);
            }
        }
        _ => {}
    }
}

/// A lower bound may be `-inf` and an upper one `inf`.
fn of_bounds(
    meaning: &Elaborator<'_>,
    bounds: Option<&Interval>,
    range: Range,
    found: &mut Vec<Diagnostic>,
) {
    let Some(bounds) = bounds else { return };
    let ends = [
        (range.lower, &bounds.lower, f64::NEG_INFINITY),
        (range.upper, &bounds.upper, f64::INFINITY),
    ];
    for (id, text, open) in ends {
        let bad =
            value(meaning, id).filter(|it| !it.is_finite() && (*it != open || !is_infinity(text)));
        found.extend(bad.map(|value| told("a bound", value, text.span)));
    }
}

/// `inf` or `-inf` as it is written, not `1/0`.
fn is_infinity(expr: &ast::Expr) -> bool {
    match &expr.kind {
        ExprKind::Name(name) => name == "inf",
        ExprKind::Negate(inner) => is_infinity(inner),
        // A vector of bounds.
        ExprKind::Tuple(_) => true,
        _ => false,
    }
}

/// A number in a formula, such as that of `1/0`.
fn of_usage(meaning: &Elaborator<'_>, usage: &Usage<'_>, found: &mut Vec<Diagnostic>) {
    let span = match usage.role {
        Role::Equation(equation) => equation.right.span,
        Role::Path(_, condition) => condition.span,
        Role::Surface(name) | Role::Report(name) => name.span,
        _ => return,
    };
    let reachable = meaning.graph.reachable(usage.parts.as_slice());
    let number = |id: &ExprId| match meaning.graph.expr(*id) {
        Expr::Number(bits) => Some(bits.value()),
        _ => None,
    };
    let bad = reachable.iter().filter_map(number).find(|it| !it.is_finite());
    found.extend(bad.map(|value| told("a part of this", value, span)));
}

/// The value of an expression over parameters that all have one.
fn value(meaning: &Elaborator<'_>, id: ExprId) -> Option<f64> {
    let is_known = |input: u32| match meaning.symbols[input as usize] {
        Symbol::Param(at) => meaning.param_values[at].is_finite(),
        _ => false,
    };
    meaning.graph.inputs_of(&[id]).into_iter().all(is_known).then(|| meaning.numeric(id))
}

fn told(what: &str, value: f64, span: Span) -> Diagnostic {
    let (message, label) = match value.is_nan() {
        true => {
            (format!("{what} is not a number"), "0/0, or a root or logarithm of a negative number")
        }
        false => (format!("{what} is infinite"), "a division by 0, or beyond 1.8e308"),
    };
    let found = Diagnostic::new(Code::NotANumber, message, span, label);
    found.help("every number of a model is finite; a side without a bound is `inf`: `in [0, inf]`")
}
