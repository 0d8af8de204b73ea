//! FDC0701, FDC0702, FDC0703: what a mistake with units is, where each unit comes from, and what to
//! do.

use super::Mistake;
use super::repairs::{Blame, Repairs};
use crate::syntax::scope;
use crate::units::dimension::notation::{Notation, written};
use crate::units::inference::requirement::{Reason, Requirement, Side};
use fdcc_grammar::ast::{self, BinaryOperator, ExprKind, ItemKind, Unit};
use fdcc_grammar::{Code, Diagnostic};

/// What a message may look at.
pub(crate) struct Speaker<'a> {
    /// The whole text.
    pub tree: &'a ast::Model,
    /// How units are written in it.
    pub notation: Notation,
}

impl<'a> Speaker<'a> {
    /// The whole finding. `wanted`: whether the surroundings need of the wrong text what its
    /// argument is.
    pub fn diagnostic(&self, mistake: &Mistake<'a>, wanted: bool) -> Diagnostic {
        let it = &mistake.requirement;
        let repairs = Repairs { speaker: self, mistake, wanted };
        let blame = repairs.blame();
        let found = match it.reason {
            Reason::NoUnit(_) | Reason::Plain(_) | Reason::Exponent | Reason::FixedPower => {
                self.alone(it, blame.as_ref())
            }
            _ if it.left.span == it.right.span => self.within_one(it),
            _ => self.two_sided(it, blame.as_ref()),
        };
        let found = self.called(found, it);
        let fix = repairs.fix(blame.as_ref());
        let found = match repairs.help(blame) {
            Some(help) => found.help(help),
            None => found,
        };
        match fix {
            Some(fix) => found.fix(fix),
            None => found,
        }
    }

    fn code(&self, reason: Reason<'_>) -> Code {
        match reason {
            Reason::NoUnit(_) | Reason::Plain(_) | Reason::Exponent => Code::UnitHere,
            Reason::FixedPower => Code::UnitOfPower,
            _ => Code::UnitMismatch,
        }
    }

    fn two_sided(&self, it: &Requirement<'a>, blame: Option<&Blame<'a>>) -> Diagnostic {
        let is_use = matches!(it.reason, Reason::Uses(_));
        let of =
            |side: usize| blame.filter(|blame| blame.side == side && !(is_use && it.right.plain));
        let [mut left, right] = [self.label(&it.left, of(0)), self.label(&it.right, of(1))];
        left += match it.reason {
            Reason::Uses(_) => ", where it is used",
            Reason::Blend => ", where it changes sides",
            _ => "",
        };
        Diagnostic::new(self.code(it.reason), self.message(it), it.left.span, left)
            .label(it.right.span, right)
    }

    fn within_one(&self, it: &Requirement<'a>) -> Diagnostic {
        let [a, b] = [&it.left, &it.right].map(|side| self.notation.explained(&side.dimension));
        let label = format!("one part: {a}, another: {b}");
        Diagnostic::new(self.code(it.reason), self.message(it), it.left.span, label)
    }

    /// A text that should have no unit.
    fn alone(&self, it: &Requirement<'a>, blame: Option<&Blame<'a>>) -> Diagnostic {
        let unit = self.label(&it.left, blame);
        let (span, label) = match (it.reason, it.calls.last()) {
            (Reason::NoUnit(_), Some(call)) => {
                let line = self.tree.line_of(call.span.start);
                (it.site, format!("the argument is in {unit} when called from line {line}"))
            }
            _ => (it.left.span, format!("in {unit}")),
        };
        Diagnostic::new(self.code(it.reason), self.message(it), span, label)
    }

    /// Where the function was called in which it went wrong.
    fn called(&self, found: Diagnostic, it: &Requirement<'a>) -> Diagnostic {
        let Some(call) = it.calls.last() else { return found };
        let label = match it.reason {
            Reason::NoUnit(_) => {
                format!("called with {} here", self.notation.noun(&it.left.dimension))
            }
            _ => "called here".into(),
        };
        found.label(call.span, label)
    }

    fn message(&self, it: &Requirement<'a>) -> String {
        let [a, b] = [&it.left, &it.right].map(|side| self.noun(side));
        match it.reason {
            Reason::Sum(BinaryOperator::Subtract) => format!("subtracting {b} from {a}"),
            Reason::Sum(_) => format!("adding {a} and {b}"),
            Reason::Comparison => format!("comparing {a} with {b}"),
            Reason::Equation(_) => format!("equating {a} and {b}"),
            Reason::Alternatives => format!("one alternative is {a}, another is {b}"),
            Reason::Together("metric") => format!("the metric adds {a} and {b}"),
            Reason::Together(name) => format!("`{name}` of {a} and {b}"),
            Reason::Given("the width", name) => {
                format!("`{}` is a width of {a}, not {b}", name.name)
            }
            Reason::Given(what, name) => format!("`{}` is {a}, but {what} is {b}", name.name),
            Reason::Blend => format!("`blend` rounds over {a}, but its width is {b}"),
            Reason::Uses(name) => format!("`{}` is used as {a}, but its value is {b}", name.name),
            Reason::NoUnit(name) => format!("`{name}` of {a}"),
            Reason::Plain(name) => format!("`{name}` has no unit, but is given {a}"),
            Reason::Exponent => format!("an exponent that is {a}"),
            Reason::FixedPower => format!("a power of {a} whose exponent is not a fixed number"),
        }
    }

    fn noun(&self, side: &Side<'a>) -> String {
        self.notation.noun(&side.dimension)
    }

    /// The unit of a side, as its author writes it, and which name has none.
    fn label(&self, side: &Side<'a>, blame: Option<&Blame<'a>>) -> String {
        if side.plain && side.dimension.is_none() && blame.is_none() {
            return "a number without a unit".into();
        }
        let unit =
            self.own_unit(side).map_or_else(|| self.notation.explained(&side.dimension), written);
        match blame {
            Some(blame) => format!("{unit}, because `{}` has no unit", blame.culprit.name.name),
            None => unit,
        }
    }

    /// The unit that is written at the declaration, for a name by itself.
    fn own_unit(&self, side: &Side<'a>) -> Option<&'a Unit> {
        let ExprKind::Name(name) = &side.expr?.kind else { return None };
        let is_it = |item: &&ast::Item| scope::declared(item).is_some_and(|it| it.name == *name);
        let mut declared = self.tree.items.iter().filter(is_it);
        declared.next().and_then(unit_of).filter(|unit| {
            crate::units::dimension::table::dimension(unit)
                .is_some_and(|it| it == side.dimension && !it.is_none())
        })
    }
}

/// The unit that a declaration writes, after the name or after its value.
pub(crate) fn unit_of(item: &ast::Item) -> Option<&Unit> {
    let in_value = match &item.kind {
        ItemKind::Param { value: Some(value), .. }
        | ItemKind::Const { value, .. }
        | ItemKind::Let { value, .. }
        | ItemKind::Signal { value, .. } => match &value.kind {
            ExprKind::Quantity(_, unit) => Some(unit),
            ExprKind::Negate(inner) => match &inner.kind {
                ExprKind::Quantity(_, unit) => Some(unit),
                _ => None,
            },
            _ => None,
        },
        _ => None,
    };
    scope::unit(item).or(in_value)
}
