//! The order in which definitions are evaluated, so that use before declaration is fine.
//!
//! A depth-first walk over "is mentioned in"; a mention of something that is still open closes a
//! circle.

use super::scope::{Declaration, Scope};
use super::walk;
use fdcc_grammar::ast::ItemKind;
use fdcc_grammar::{Code, Diagnostic, Span};

#[derive(Clone, Copy, PartialEq)]
enum Mark {
    New,
    Open,
    Done,
}

/// The declarations that have a definition, each after those it mentions; and those that lie on a
/// circle.
pub(crate) struct Order {
    /// Indices of declarations.
    pub sequence: Vec<usize>,
    /// Whether a declaration needs itself.
    pub circular: Vec<bool>,
}

/// Sorts the definitions of a scope and reports circles.
pub(crate) fn order(scope: &Scope<'_>, diagnostics: &mut Vec<Diagnostic>) -> Order {
    let needs: Vec<Vec<(usize, Span)>> =
        (0..scope.declarations.len()).map(|at| mentioned(scope, at)).collect();
    let mut marks = vec![Mark::New; needs.len()];
    let mut order = Order { sequence: Vec::new(), circular: vec![false; needs.len()] };
    for root in 0..needs.len() {
        descend(root, &needs, &mut marks, &mut order, &mut |circle, span| {
            diagnostics.push(circular(scope, circle, span))
        });
    }
    order
}

/// One walk from `root`, with its own stack: definitions may hang on each other thousands deep.
fn descend(
    root: usize,
    needs: &[Vec<(usize, Span)>],
    marks: &mut [Mark],
    order: &mut Order,
    report: &mut dyn FnMut(&[usize], Span),
) {
    let mut stack: Vec<(usize, usize)> = Vec::new();
    if marks[root] == Mark::New {
        marks[root] = Mark::Open;
        stack.push((root, 0));
    }
    while let Some((at, next)) = stack.last_mut() {
        let Some(&(need, span)) = needs[*at].get(*next) else {
            marks[*at] = Mark::Done;
            order.sequence.push(*at);
            stack.pop();
            continue;
        };
        *next += 1;
        match marks[need] {
            Mark::New => {
                marks[need] = Mark::Open;
                stack.push((need, 0));
            }
            Mark::Open => {
                let from = stack
                    .iter()
                    .position(|open| open.0 == need)
                    .expect("an open definition is on the stack");
                let circle: Vec<usize> = stack[from..].iter().map(|open| open.0).collect();
                circle.iter().for_each(|&at| order.circular[at] = true);
                report(&circle, span);
            }
            Mark::Done => {}
        }
    }
}

/// The definitions that a definition mentions.
fn mentioned(scope: &Scope<'_>, at: usize) -> Vec<(usize, Span)> {
    let item = scope.declarations[at].item;
    let mut needs = Vec::new();
    let mut add = |value| {
        walk::names(value, &mut |name, span| needs.extend(scope.find(name).map(|at| (at, span))))
    };
    match &item.kind {
        ItemKind::Let { value, .. }
        | ItemKind::Const { value, .. }
        | ItemKind::Signal { value, .. } => add(value),
        ItemKind::Fn { body, .. } => add(body),
        ItemKind::Surface { value, .. } => add(value),
        ItemKind::Param { value: Some(value), .. } | ItemKind::Free { guess: Some(value), .. } => {
            add(value)
        }
        ItemKind::Time { interval, .. } => {
            add(&interval.lower);
            add(&interval.upper);
        }
        _ => {}
    }
    if let ItemKind::Signal { name, .. } = &item.kind {
        // Its points are spread over the whole time.
        let is_time = |it: &Declaration<'_>| matches!(it.item.kind, ItemKind::Time { .. });
        let time = scope.declarations.iter().position(is_time);
        needs.extend(time.map(|at| (at, name.span)));
    }
    if let ItemKind::Fn { arguments, .. } = &item.kind {
        needs.retain(|need| {
            arguments.iter().all(|it| it.name != scope.declarations[need.0].name.name)
        });
    }
    needs
}

fn circular(scope: &Scope<'_>, circle: &[usize], span: Span) -> Diagnostic {
    let first = scope.declarations[circle[0]].name;
    let names: Vec<&str> = circle
        .iter()
        .chain(&circle[..1])
        .map(|&at| scope.declarations[at].name.name.as_str())
        .collect();
    let message = format!("the definition of `{}` needs itself", first.name);
    Diagnostic::new(
        Code::CircularDefinition,
        message,
        first.span,
        format!(
            "needs \
        {}",
            names[1..].join(", which needs ")
        ),
    )
    .label(span, "this closes the circle")
    .help(
        "break the circle: give one of them a value of its own; something that changes with \
               its own value is a `state`",
    )
}
