//! What stands around a place: the item, the equation, every expression down to the innermost.

use crate::syntax::walk;
use fdcc_grammar::Span;
use fdcc_grammar::ast::{self, Expr, Item, ItemKind};

/// The places of all that holds a byte, from the outside to the inside.
pub fn enclosing(tree: &ast::Model, offset: u32) -> Vec<Span> {
    let mut found = Vec::new();
    items(&tree.items, offset, &mut found);
    found
}

fn holds(span: Span, offset: u32) -> bool {
    span.start <= offset && offset <= span.end
}

fn items(all: &[Item], offset: u32, found: &mut Vec<Span>) {
    for item in all.iter().filter(|item| holds(item.span, offset)) {
        found.push(item.span);
        match &item.kind {
            ItemKind::Phase { items: inner, .. } => items(inner, offset, found),
            ItemKind::Dynamics { equations } => {
                found.extend(equations.iter().map(|it| it.span).filter(|span| holds(*span, offset)))
            }
            _ => {}
        }
        for value in walk::expressions(item).into_iter().filter(|value| holds(value.span, offset)) {
            expression(value, offset, found);
        }
    }
}

/// Downwards from one expression to the part of it that holds the byte.
fn expression(value: &Expr, offset: u32, found: &mut Vec<Span>) {
    let mut next = Some(value);
    while let Some(value) = next {
        found.push(value.span);
        let mut inside = Vec::new();
        walk::push_children(value, &mut inside);
        next = inside.into_iter().find(|it| holds(it.span, offset));
    }
}
