//! Where the surfaces are used: the term of a right side that holds `Sgn(surface)`, `Dir(vector)`
//! or `match surface`.

use crate::check::facts::{Facts, left_side};
use crate::syntax::text::{self, Style};
use crate::syntax::walk;
use fdcc_grammar::ast::{Argument, BinaryOperator, Equation, Expr, ExprKind, ItemKind};
use fdcc_grammar::{Fix, Span};

/// The first use of a surface in an equation, or in a definition.
pub(super) struct Use<'a> {
    /// What it is called.
    pub surface: String,
    /// The equation.
    pub equation: Option<&'a Equation>,
    /// The term of the sum that holds it.
    pub term: &'a Expr,
    /// `Sgn(...)`, `Dir(...)` or `match ...`.
    pub set: &'a Expr,
    /// The surface inside.
    pub name: Span,
}

/// All of them, those in equations first.
pub(super) fn uses<'a>(facts: &Facts<'a, '_>) -> Vec<Use<'a>> {
    let mut all = Vec::new();
    for item in &facts.items {
        if let ItemKind::Dynamics { equations } = &item.kind {
            equations.iter().for_each(|it| in_sum(&it.right, Some(it), &mut all));
        }
    }
    for item in &facts.items {
        if let ItemKind::Let { value, .. } = &item.kind {
            in_sum(value, None, &mut all);
        }
    }
    all
}

fn in_sum<'a>(value: &'a Expr, equation: Option<&'a Equation>, all: &mut Vec<Use<'a>>) {
    let mut pending = vec![value];
    while let Some(term) = pending.pop() {
        match &term.kind {
            ExprKind::Binary(BinaryOperator::Add | BinaryOperator::Subtract, left, right) => {
                pending.extend([&**right, &**left])
            }
            ExprKind::Tuple(parts) => pending.extend(parts.iter().rev()),
            _ => walk::visit(term, &mut |inner| {
                if let Some((surface, name)) = surface_of(inner) {
                    all.push(Use { surface, equation, term, set: inner, name });
                }
            }),
        }
    }
}

/// The surface of a set, and where it stands.
fn surface_of(set: &Expr) -> Option<(String, Span)> {
    match &set.kind {
        ExprKind::Match { surface, .. } => Some((surface.name.clone(), surface.span)),
        ExprKind::Call(callee, arguments) => match (&callee.kind, arguments.as_slice()) {
            (ExprKind::Name(name), [Argument::Expr(psi)])
                if matches!(name.as_str(), "Sgn" | "Dir") =>
            {
                Some((text::expr(psi), psi.span))
            }
            _ => None,
        },
        _ => None,
    }
}

impl Use<'_> {
    /// The equation with the other sign before its term.
    pub fn flipped(&self) -> Option<String> {
        let (equation, right) = self.turned()?;
        let left = left_side(equation);
        Some(format!("{left} in {right}"))
    }

    /// The change that makes it so.
    pub fn flip(&self) -> Option<Fix> {
        let (equation, right) = self.turned()?;
        Some(Fix::likely("turn the sign around").replace(equation.right.span, right))
    }

    /// The equation, and its right side with the other sign.
    fn turned(&self) -> Option<(&Equation, String)> {
        let equation = self.equation?;
        let right = flip(&equation.right, self.term)?;
        Some((equation, text::styled(&right, Style::AsWritten)))
    }
}

fn flip(value: &Expr, term: &Expr) -> Option<Expr> {
    let kind = match &value.kind {
        _ if value.span == term.span => negated(value),
        ExprKind::Binary(
            operator @ (BinaryOperator::Add | BinaryOperator::Subtract),
            left,
            right,
        ) => {
            let other = if *operator == BinaryOperator::Add {
                BinaryOperator::Subtract
            } else {
                BinaryOperator::Add
            };
            match right.span == term.span {
                true => ExprKind::Binary(other, left.clone(), right.clone()),
                false => ExprKind::Binary(*operator, Box::new(flip(left, term)?), right.clone()),
            }
        }
        _ => return None,
    };
    Some(Expr { kind, span: value.span })
}

/// `-e`, and `e` for `-e`; the minus may stand before the first factor.
fn negated(value: &Expr) -> ExprKind {
    match &value.kind {
        ExprKind::Negate(inner) => inner.kind.clone(),
        ExprKind::Number(number) => ExprKind::Number(-number),
        ExprKind::Binary(
            operator @ (BinaryOperator::Multiply | BinaryOperator::Divide),
            left,
            right,
        ) => {
            let left = Expr { kind: negated(left), span: left.span };
            ExprKind::Binary(*operator, Box::new(left), right.clone())
        }
        _ => ExprKind::Negate(Box::new(value.clone())),
    }
}
