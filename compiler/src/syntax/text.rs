//! Expressions back to text, for labels and for the repairs that messages propose.
//!
//! Operators keep the blanks they were written with, which the gap between two operands tells;
//! whatever was not in the text is written as the house style has it: `*`, `/` and `^` tight, `+`
//! and `-` with blanks.

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
    let mut printer = Printer { style, depth: 0, out: String::new() };
    printer.write(value, 0);
    printer.out
}

/// A condition as it was written.
pub(crate) fn condition(condition: &Condition) -> String {
    let mut out = expr(&condition.first);
    for (relation, right) in &condition.rest {
        out.push_str(&format!(" {} {}", self::relation(*relation), expr(right)));
    }
    out
}

/// A condition at a time as it was written.
pub(crate) fn at_time(time: &Expr, condition: &Condition) -> String {
    format!("at {}: {}", expr(time), self::condition(condition))
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
    if size != 0.0 && size.is_finite() && !(1e-4..1e7).contains(&size) {
        format!("{value:e}")
    } else {
        format!("{value}")
    }
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

/// Deeper expressions are cut off: nobody reads them, and they must not exhaust the stack.
const DEEPEST: usize = 100;

struct Printer {
    style: Style,
    depth: usize,
    out: String,
}

impl Printer {
    /// Writes `value`, in parentheses if it binds weaker than `least`.
    fn write(&mut self, value: &Expr, least: u8) {
        let own = match &value.kind {
            ExprKind::Binary(operator, ..) => strength(*operator),
            ExprKind::Negate(_) => SIGN,
            ExprKind::Number(number) if *number < 0.0 => SIGN,
            _ => ATOM,
        };
        if self.depth == DEEPEST {
            return self.out.push_str("...");
        }
        self.depth += 1;
        let (open, close) = if own < least { ("(", ")") } else { ("", "") };
        self.out.push_str(open);
        match &value.kind {
            ExprKind::Binary(..) => self.chain(value),
            ExprKind::Negate(inner) => {
                self.out.push('-');
                self.write(inner, PRODUCT);
            }
            _ => self.atom(value),
        }
        self.out.push_str(close);
        self.depth -= 1;
    }

    /// A chain such as `a - b + c`, without recursion along its left side.
    fn chain(&mut self, value: &Expr) {
        let (first, rest) = walk::spine(value);
        let lowest = rest.first().map_or(ATOM, |(_, operator, _)| strength(*operator));
        // Parentheses that a left operand needs open at the very beginning.
        let opened =
            rest.windows(2).filter(|pair| strength(pair[0].1) < strength(pair[1].1)).count();
        self.out.push_str(&"(".repeat(opened));
        self.write(first, if lowest == POWER { ATOM } else { lowest });
        for (index, link) in rest.iter().enumerate() {
            self.link(link);
            if rest.get(index + 1).is_some_and(|next| strength(link.1) < strength(next.1)) {
                self.out.push(')');
            }
        }
    }

    /// An operator and its right operand.
    fn link(&mut self, &(left, operator, right): &walk::Link<'_>) {
        let gap = right.span.start.saturating_sub(left.span.end);
        let tight = match self.style {
            Style::AsWritten if gap > 0 => gap == 1,
            _ => strength(operator) > SUM,
        };
        let blank = if tight { "" } else { " " };
        self.out.push_str(&format!("{blank}{}{blank}", sign(operator)));
        let exact = matches!(operator, BinaryOperator::Subtract | BinaryOperator::Divide) as u8;
        self.write(
            right,
            if operator == BinaryOperator::Power { POWER } else { strength(operator) + exact },
        );
    }

    fn atom(&mut self, value: &Expr) {
        match &value.kind {
            ExprKind::Number(value) => self.out.push_str(&number(*value)),
            ExprKind::Quantity(value, unit) => {
                self.out.push_str(&format!("{} {}", number(*value), self::unit(unit)))
            }
            ExprKind::Name(name) => self.out.push_str(name),
            ExprKind::Part(base, part) => self.postfix(base, &format!(".{}", part.name)),
            ExprKind::Index(base, index) => self.postfix(base, &format!("[{index}]")),
            ExprKind::Prime(base) => self.postfix(base, "'"),
            ExprKind::Call(callee, arguments) => {
                self.postfix(callee, "(");
                self.list(arguments.iter(), Self::argument);
                self.out.push(')');
            }
            ExprKind::Tuple(parts) => {
                self.out.push('(');
                self.list(parts.iter(), |this, part| this.write(part, 0));
                self.out.push(')');
            }
            ExprKind::Piecewise { .. } => self.out.push_str("piecewise { ... }"),
            ExprKind::Match { surface, below, above, .. } => {
                self.out.push_str(&format!("match {} {{ below => ", surface.name));
                self.write(below, 0);
                self.out.push_str(", above => ");
                self.write(above, 0);
                self.out.push_str(" }");
            }
            ExprKind::Negate(_) | ExprKind::Binary(..) => self.write(value, 0),
        }
    }

    fn postfix(&mut self, base: &Expr, after: &str) {
        self.write(base, ATOM);
        self.out.push_str(after);
    }

    fn list<'t, T: 't>(
        &mut self,
        items: impl Iterator<Item = &'t T>,
        mut write: impl FnMut(&mut Self, &'t T),
    ) {
        for (at, item) in items.enumerate() {
            if at > 0 {
                self.out.push_str(", ");
            }
            write(self, item);
        }
    }

    fn argument(&mut self, argument: &Argument) {
        match argument {
            Argument::Expr(value) => self.write(value, 0),
            Argument::End(_) => self.out.push_str("end"),
            Argument::Start(_) => self.out.push_str("start"),
            Argument::Iteration(name, data) => {
                self.out.push_str(&format!("{} in {}", name.name, data.name))
            }
        }
    }
}

/// A unit with its brackets: `[kg m/s^2]`, `[1/s]`.
pub(crate) fn unit(unit: &Unit) -> String {
    let factor =
        |name: &str, power: u32| if power == 1 { name.into() } else { format!("{name}^{power}") };
    let above = unit.factors.iter().filter(|(_, power)| *power >= 0);
    let above: Vec<String> =
        above.map(|(name, power)| factor(&name.name, power.unsigned_abs())).collect();
    let below = unit.factors.iter().filter(|(_, power)| *power < 0);
    let below: String = below
        .map(|(name, power)| format!("/{}", factor(&name.name, power.unsigned_abs())))
        .collect();
    let above = if above.is_empty() { "1".into() } else { above.join(" ") };
    format!("[{above}{below}]")
}
