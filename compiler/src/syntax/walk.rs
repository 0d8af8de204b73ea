//! Ways through the syntax tree that several passes need.
//!
//! Sums of ten thousand terms are trees of that depth; [`spine`] and [`visit`] go along them in a
//! loop.

use fdcc_grammar::ast::{
    Argument, BinaryOperator, Expr, ExprKind, Interval, Item, ItemKind, Start,
};
use fdcc_grammar::{Span, ast};

/// One step of a chain: the whole left operand, the operator, the right operand.
pub(crate) type Link<'a> = (&'a Expr, BinaryOperator, &'a Expr);

/// Takes `a + b - c` apart into `a` and its successive right operands.
pub(crate) fn spine(value: &Expr) -> (&Expr, Vec<Link<'_>>) {
    let mut rest = Vec::new();
    let mut left = value;
    while let ExprKind::Binary(operator, next, right) = &left.kind {
        rest.push((&**next, *operator, &**right));
        left = next;
    }
    rest.reverse();
    (left, rest)
}

/// Calls `see` for an expression and everything in it, in the order of the text.
pub(crate) fn visit<'a>(value: &'a Expr, see: &mut dyn FnMut(&'a Expr)) {
    let mut stack = vec![value];
    while let Some(next) = stack.pop() {
        see(next);
        let from = stack.len();
        push_children(next, &mut stack);
        stack[from..].reverse();
    }
}

/// The expressions just inside one, in the order of the text.
pub(crate) fn push_children<'a>(value: &'a Expr, into: &mut Vec<&'a Expr>) {
    match &value.kind {
        ExprKind::Number(_) | ExprKind::Quantity(..) | ExprKind::Name(_) => {}
        ExprKind::Negate(inner)
        | ExprKind::Part(inner, _)
        | ExprKind::Index(inner, _)
        | ExprKind::Prime(inner) => into.push(inner),
        ExprKind::Binary(_, left, right) => into.extend([&**left, &**right]),
        ExprKind::Call(callee, arguments) => {
            into.push(callee);
            into.extend(arguments.iter().filter_map(|argument| match argument {
                Argument::Expr(value) => Some(value),
                _ => None,
            }));
        }
        ExprKind::Tuple(parts) => into.extend(parts),
        ExprKind::Piecewise { arms, otherwise } => {
            arms.iter().for_each(|arm| into.extend([&arm.left, &arm.right, &arm.value]));
            into.push(otherwise);
        }
        ExprKind::Match { below, above, .. } => into.extend([&**below, &**above]),
    }
}

/// Calls `see` with every name that an expression mentions, data sets and surfaces of `match` among
/// them.
pub(crate) fn names<'a>(value: &'a Expr, see: &mut dyn FnMut(&'a str, Span)) {
    visit(value, &mut |inner| match &inner.kind {
        ExprKind::Name(name) => see(name, inner.span),
        ExprKind::Match { surface, .. } => see(&surface.name, surface.span),
        ExprKind::Call(_, arguments) => arguments.iter().for_each(|argument| {
            if let Argument::Iteration(_, data) = argument {
                see(&data.name, data.span);
            }
        }),
        _ => {}
    });
}

/// Where a name is mentioned first.
pub(crate) fn mention(value: &Expr, wanted: &str) -> Option<Span> {
    let mut found = None;
    names(value, &mut |name, span| {
        if name == wanted && found.is_none() {
            found = Some(span);
        }
    });
    found
}

fn ends(bounds: &Option<Interval>) -> impl Iterator<Item = &Expr> {
    bounds.iter().flat_map(|it| [&it.lower, &it.upper])
}

/// All expressions of an item, those of nested items not.
pub(crate) fn expressions(item: &Item) -> Vec<&Expr> {
    let mut all: Vec<&Expr> = Vec::new();
    match &item.kind {
        ItemKind::Param { value, bounds, .. } => {
            all.extend(value);
            all.extend(ends(bounds));
        }
        ItemKind::Const { value, .. }
        | ItemKind::Let { value, .. }
        | ItemKind::Signal { value, .. }
        | ItemKind::Surface { value, .. } => all.push(value),
        ItemKind::Fn { body, .. } => all.push(body),
        ItemKind::Free { bounds, guess, .. } | ItemKind::Control { bounds, guess, .. } => {
            all.extend(ends(bounds));
            all.extend(guess);
        }
        ItemKind::Time { interval, .. } => all.extend([&interval.lower, &interval.upper]),
        ItemKind::State { bounds, start, .. } => {
            all.extend(ends(bounds));
            match start {
                Some(Start::Value(value)) => all.push(value),
                Some(Start::Free { bounds, .. }) => all.extend(ends(bounds)),
                None => {}
            }
        }
        ItemKind::Dynamics { equations } => equations
            .iter()
            .for_each(|equation| all.extend(equation.factor.iter().chain([&equation.right]))),
        ItemKind::Metric { weights } => all.extend(weights.iter().map(|weight| &weight.1)),
        ItemKind::Jump { at_most, assignments, .. } => {
            all.extend(at_most);
            all.extend(assignments.iter().map(|it| &it.value));
        }
        ItemKind::Link { assignments, .. } => all.extend(assignments.iter().map(|it| &it.value)),
        ItemKind::Start { condition }
        | ItemKind::End { condition }
        | ItemKind::Path { condition, .. } => {
            all.push(&condition.first);
            all.extend(condition.rest.iter().map(|it| &it.1));
        }
        ItemKind::At { time, condition } => {
            all.extend([time, &condition.first]);
            all.extend(condition.rest.iter().map(|it| &it.1));
        }
        ItemKind::Objective { value, .. } => all.push(value),
        ItemKind::Fit { signals, .. } => {
            all.extend(signals.iter().flat_map(|it| [&it.signal, &it.deviation]))
        }
        ItemKind::Guess { bindings } | ItemKind::Report { bindings } => {
            all.extend(bindings.iter().map(|it| &it.value))
        }
        ItemKind::Method { settings } => settings.iter().for_each(|it| match &it.value {
            ast::SettingValue::Expr(value) => all.push(value),
            ast::SettingValue::List(values) => all.extend(values),
            ast::SettingValue::Scheme { .. } => {}
        }),
        ItemKind::Sweep { lists } => all.extend(lists.iter().flat_map(|list| &list.values)),
        ItemKind::Plot { curves, over, .. } => all.extend(curves.iter().chain([over])),
        ItemKind::Expect { checks } => checks.iter().for_each(|it| {
            all.extend([&it.left, &it.right]);
            all.extend(&it.within);
        }),
        ItemKind::Data { .. } | ItemKind::Phase { .. } => {}
    }
    all
}
