//! Expressions back to text, for labels and for the repairs that messages propose.
//!
//! Operators keep the blanks they were written with, which the gap between two operands tells; whatever was not
//! in the text is written as the house style has it: `*`, `/` and `^` tight, `+` and `-` with blanks.

use super::walk;
use fdcc_grammar::ast::{Argument, BinaryOperator, Condition, Expr, ExprKind, Relation, Unit};

/// How blanks around operators are chosen.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum Style {
    /// As in the text.
    AsWritten,
    /// As the house style has it.
    Compact,
}

/// An expression as it was written.
pub(crate) fn expr(value: &Expr) -> String {
    styled(value, Style::AsWritten)
}

/// An expression in one of the styles.
pub(crate) fn styled(value: &Expr, style: Style) -> String {
    let mut out = String::new();
    write(value, style, 0, &mut out);
    out
}

/// A condition as it was written.
pub(crate) fn condition(condition: &Condition) -> String {
    let mut out = expr(&condition.first);
    for (relation, right) in &condition.rest {
        out.push_str(&format!(" {} {}", self::relation(*relation), expr(right)));
    }
    out
}

/// The sign of a comparison.
pub(crate) fn relation(relation: Relation) -> &'static str {
    match relation {
        Relation::LessEqual => "<=",
        Relation::GreaterEqual => ">=",
        Relation::Equal => "==",
    }
}

/// A number, short: `2`, `0.5`, `1e-9`.
pub(crate) fn number(value: f64) -> String {
    let value = if value == 0.0 { 0.0 } else { value };
    let size = value.abs();
    if size != 0.0 && size.is_finite() && !(1e-4..1e7).contains(&size) { format!("{value:e}") } else { format!("{value}") }
}

const SUM: u8 = 1;
const PRODUCT: u8 = 2;
const SIGN: u8 = 3;
const POWER: u8 = 4;
const ATOM: u8 = 5;

fn strength(operator: BinaryOperator) -> u8 {
    match operator {
        BinaryOperator::Add | BinaryOperator::Subtract => SUM,
        BinaryOperator::Multiply | BinaryOperator::Divide => PRODUCT,
        BinaryOperator::Power => POWER,
    }
}

fn sign(operator: BinaryOperator) -> char {
    match operator {
        BinaryOperator::Add => '+',
        BinaryOperator::Subtract => '-',
        BinaryOperator::Multiply => '*',
        BinaryOperator::Divide => '/',
        BinaryOperator::Power => '^',
    }
}

/// Writes `value`, in parentheses if it binds weaker than `least`.
fn write(value: &Expr, style: Style, least: u8, out: &mut String) {
    let own = match &value.kind {
        ExprKind::Binary(operator, ..) => strength(*operator),
        ExprKind::Negate(_) => SIGN,
        ExprKind::Number(number) if *number < 0.0 => SIGN,
        _ => ATOM,
    };
    let (open, close) = if own < least { ("(", ")") } else { ("", "") };
    out.push_str(open);
    match &value.kind {
        ExprKind::Binary(..) => chain(value, style, out),
        ExprKind::Negate(inner) => {
            out.push('-');
            write(inner, style, PRODUCT, out);
        }
        _ => atom(value, style, out),
    }
    out.push_str(close);
}

/// A chain such as `a - b + c`, without recursion along its left side.
fn chain(value: &Expr, style: Style, out: &mut String) {
    let (first, rest) = walk::spine(value);
    let lowest = rest.first().map_or(ATOM, |(_, operator, _)| strength(*operator));
    // Parentheses that a left operand needs open at the very beginning.
    let opened = rest.windows(2).filter(|pair| strength(pair[0].1) < strength(pair[1].1)).count();
    out.push_str(&"(".repeat(opened));
    write(first, style, if lowest == POWER { ATOM } else { lowest }, out);
    for (index, (left, operator, right)) in rest.iter().enumerate() {
        let gap = right.span.start.saturating_sub(left.span.end);
        let tight = match style {
            Style::AsWritten if gap > 0 => gap == 1,
            _ => strength(*operator) > SUM,
        };
        let blank = if tight { "" } else { " " };
        out.push_str(&format!("{blank}{}{blank}", sign(*operator)));
        let exact = matches!(operator, BinaryOperator::Subtract | BinaryOperator::Divide) as u8;
        let least = if *operator == BinaryOperator::Power { POWER } else { strength(*operator) + exact };
        write(right, style, least, out);
        let closes = rest.get(index + 1).is_some_and(|next| strength(*operator) < strength(next.1));
        if closes {
            out.push(')');
        }
    }
}

fn atom(value: &Expr, style: Style, out: &mut String) {
    match &value.kind {
        ExprKind::Number(value) => out.push_str(&number(*value)),
        ExprKind::Quantity(value, unit) => out.push_str(&format!("{} {}", number(*value), self::unit(unit))),
        ExprKind::Name(name) => out.push_str(name),
        ExprKind::Part(base, part) => {
            write(base, style, ATOM, out);
            out.push_str(&format!(".{}", part.name));
        }
        ExprKind::Index(base, index) => {
            write(base, style, ATOM, out);
            out.push_str(&format!("[{index}]"));
        }
        ExprKind::Prime(base) => {
            write(base, style, ATOM, out);
            out.push('\'');
        }
        ExprKind::Call(callee, arguments) => {
            write(callee, style, ATOM, out);
            let arguments = arguments.iter().map(|argument| self::argument(argument, style));
            out.push_str(&format!("({})", arguments.collect::<Vec<_>>().join(", ")));
        }
        ExprKind::Tuple(parts) => {
            let parts: Vec<String> = parts.iter().map(|part| styled(part, style)).collect();
            out.push_str(&format!("({})", parts.join(", ")));
        }
        ExprKind::Piecewise { .. } => out.push_str("piecewise { ... }"),
        ExprKind::Match { surface, below, above } => {
            let (below, above) = (styled(below, style), styled(above, style));
            out.push_str(&format!("match {} {{ below => {below}, above => {above} }}", surface.name));
        }
        ExprKind::Negate(_) | ExprKind::Binary(..) => write(value, style, 0, out),
    }
}

fn argument(argument: &Argument, style: Style) -> String {
    match argument {
        Argument::Expr(value) => styled(value, style),
        Argument::End(_) => "end".into(),
        Argument::Start(_) => "start".into(),
        Argument::Iteration(name, data) => format!("{} in {}", name.name, data.name),
    }
}

/// A unit with its brackets.
pub(crate) fn unit(unit: &Unit) -> String {
    let factor = |(name, power): &(fdcc_grammar::ast::Ident, i32)| match power {
        1 => name.name.clone(),
        _ => format!("{}^{power}", name.name),
    };
    format!("[{}]", unit.factors.iter().map(factor).collect::<Vec<_>>().join(" "))
}
