//! FDC0411: constants and bounds that are no finite numbers: `1/0`, `0/0`.

use crate::check::facts::{Facts, Told};
use crate::expressions::graph::builtins::Builtin;
use crate::expressions::graph::{Expr, ExprId, evaluate};
use crate::model::{Range, Symbol};
use crate::resolve::elaborator::constants::ConstantPart;
use crate::resolve::elaborator::{Elaborator, Role, Usage};
use crate::syntax::{text, walk};
use fdcc_grammar::ast::{self, ExprKind, Interval, Item, ItemKind};
use fdcc_grammar::{Code, Diagnostic, Span};
use std::collections::HashSet;

/// Reports what has no finite value, though all that it is made of has one.
pub(crate) fn check(facts: &mut Facts<'_, '_>, found: &mut Vec<Diagnostic>) {
    let (before, told) = (found.len(), facts.told());
    of_constants(facts.meaning, &told, found);
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

/// The constant parts of all formulas, each place and each value once.
fn of_constants(meaning: &Elaborator<'_>, told: &Told, found: &mut Vec<Diagnostic>) {
    let values = values_of(meaning, &meaning.constants);
    let is_bad = |(part, value): &(&ConstantPart<'_>, f64)| match part.is_divisor {
        true => *value == 0.0,
        false => !value.is_finite(),
    };
    let defined = definitions(meaning);
    let (mut places, mut without_value) = (HashSet::new(), HashSet::new());
    for (part, value) in meaning.constants.iter().zip(values).filter(is_bad) {
        let is_first = places.insert(part.expr.span) && !told.is_within(part.expr.span);
        let needed = meaning.graph.reachable(&[part.value]);
        let follows = !has_values(meaning, part.value)
            || needed.iter().any(|it| *it != part.value && without_value.contains(it));
        without_value.extend(Some(part.value).filter(|it| defined.contains(it)));
        found.extend((is_first && !follows).then(|| of_constant(part, value)));
    }
    for part in cancelled(meaning) {
        let is_first = places.insert(part.expr.span) && !told.is_within(part.expr.span);
        found.extend(is_first.then(|| of_constant(part, 0.0)));
    }
}

fn values_of(meaning: &Elaborator<'_>, parts: &[ConstantPart<'_>]) -> Vec<f64> {
    let roots: Vec<ExprId> = parts.iter().map(|it| it.value).collect();
    evaluate(&meaning.graph, &roots, &param_values(meaning), &[])
}

/// The divisors that are 0 and left no trace in the constant that they are in: `2*p/p` is 2.
fn cancelled<'m, 'a>(meaning: &'m Elaborator<'a>) -> impl Iterator<Item = &'m ConstantPart<'a>> {
    let values = values_of(meaning, &meaning.constant_divisors);
    let all = meaning.constant_divisors.iter().zip(values);
    let zeros = all.filter(|(_, value)| *value == 0.0).map(|(part, _)| part);
    zeros.filter(move |part| {
        let mut around = meaning.constants.iter().filter(|it| encloses(it, part));
        !around.any(|it| divides_by(meaning, it.value, part.value))
    })
}

fn encloses(whole: &ConstantPart<'_>, part: &ConstantPart<'_>) -> bool {
    let [whole, part] = [whole, part].map(|it| it.expr.span);
    whole.start <= part.start && part.end <= whole.end
}

/// Whether anything in a value is divided by a divisor, or by a factor of it.
fn divides_by(meaning: &Elaborator<'_>, value: ExprId, divisor: ExprId) -> bool {
    let parts = meaning.graph.reachable(&[divisor]);
    let by = |id: &ExprId| meaning.graph.as_call(*id, Builtin::Div).map(|operands| operands[1]);
    meaning.graph.reachable(&[value]).iter().filter_map(by).any(|it| parts.contains(&it))
}

/// The values that have names: where such a one is infinite, nothing is said of what is made of it.
fn definitions(meaning: &Elaborator<'_>) -> HashSet<ExprId> {
    let is_definition = |at: &usize| {
        let item = meaning.scope.declarations[*at].item;
        matches!(item.kind, ItemKind::Const { .. } | ItemKind::Let { .. } | ItemKind::Signal { .. })
    };
    let all = (0..meaning.values.len()).filter(is_definition);
    all.flat_map(|at| meaning.values[at].parts.as_slice()).copied().collect()
}

fn of_constant(part: &ConstantPart<'_>, value: f64) -> Diagnostic {
    let text = text::expr(part.expr);
    match part.is_divisor {
        true => {
            let message = format!("a division by `{text}`, which is 0");
            let found = Diagnostic::new(Code::NotANumber, message, part.expr.span, "0");
            found.help(FINITE)
        }
        false => told_as(&format!("`{text}`"), value, part.expr.span),
    }
}

fn of_item(meaning: &Elaborator<'_>, item: &Item, found: &mut Vec<Diagnostic>) {
    let declared =
        crate::syntax::scope::declared(item).and_then(|name| meaning.scope.find(&name.name));
    let Some(at) = declared.filter(|&at| std::ptr::eq(meaning.scope.declarations[at].item, item))
    else {
        return;
    };
    let Some(index) = meaning.index_of(at) else { return };
    let model = &meaning.model;
    match &item.kind {
        ItemKind::Param { bounds, .. } => {
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
        ItemKind::State { bounds, start, parts, .. } => {
            for state in model.states[index..].iter().take(parts.len().max(1)) {
                of_bounds(meaning, bounds.as_ref(), state.range, found);
                if let (Some(ast::Start::Free { bounds, .. }), Some(range)) =
                    (start, state.start_range)
                {
                    of_bounds(meaning, bounds.as_ref(), range, found);
                }
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
        let bad = bad.or_else(|| hides_infinity(meaning, text).then_some(f64::NAN));
        found.extend(bad.map(|value| told_as("a bound", value, text.span)));
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

/// `inf` inside of a formula: `0*inf` is no number, though simplified it is 0.
fn hides_infinity(meaning: &Elaborator<'_>, expr: &ast::Expr) -> bool {
    let is_inf = |it: &ast::Expr| matches!(&it.kind, ExprKind::Name(name) if name == "inf");
    match &expr.kind {
        ExprKind::Tuple(parts) => parts.iter().any(|it| hides_infinity(meaning, it)),
        _ if is_infinity(expr) || meaning.scope.find("inf").is_some() => false,
        _ => {
            let mut is_inside = false;
            walk::visit(expr, &mut |inner| is_inside |= is_inf(inner));
            is_inside
        }
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
    found.extend(bad.map(|value| told_as("a part of this", value, span)));
}

/// The value of an expression over parameters that all have one.
fn value(meaning: &Elaborator<'_>, id: ExprId) -> Option<f64> {
    has_values(meaning, id).then(|| meaning.numeric(id))
}

/// Whether an expression reads nothing but parameters with finite values.
fn has_values(meaning: &Elaborator<'_>, id: ExprId) -> bool {
    let is_known = |input: u32| match meaning.symbols[input as usize] {
        Symbol::Param(at) => meaning.param_values[at].is_finite(),
        _ => false,
    };
    meaning.graph.inputs_of(&[id]).into_iter().all(is_known)
}

/// The values of all inputs that are parameters.
fn param_values(meaning: &Elaborator<'_>) -> Vec<f64> {
    let value = |symbol: &Symbol| match symbol {
        Symbol::Param(at) => meaning.param_values[*at],
        _ => f64::NAN,
    };
    meaning.symbols.iter().map(value).collect()
}

const FINITE: &str =
    "every number of a model is finite; a side without a bound is `inf`: `in [0, inf]`";

fn told_as(what: &str, value: f64, span: Span) -> Diagnostic {
    let (message, label) = match value.is_nan() {
        true => {
            (format!("{what} is not a number"), "0/0, or a root or logarithm of a negative number")
        }
        false => (format!("{what} is infinite"), "a division by 0, or beyond 1.8e308"),
    };
    Diagnostic::new(Code::NotANumber, message, span, label).help(FINITE)
}
