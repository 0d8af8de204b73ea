//! In which unit each plain number of the text is read; FDC0704 where it would have to be guessed.
//!
//! One rule for all places: a number without a unit takes the declared unit of the name beside it.
//! Beside a formula it is in SI, which is refused where the names of the formula are declared in
//! other units: `end integral(dose) >= 80` with a dose in mg/d would ask for 80 kg. What resolution
//! multiplies a text with is found here and nowhere else.

use super::declared::Form;
use super::requirement::{Call, Side};
use super::solve::Solution;
use super::value::Part;
use super::{Inference, Operand, side};
use crate::syntax::text;
use crate::units::dimension::Dimension;
use crate::units::dimension::notation::Notation;
use fdcc_grammar::ast::{Argument, BinaryOperator, Expr, ExprKind};
use fdcc_grammar::{Code, Diagnostic, Fix, Span};
use std::collections::HashMap;

/// By what the values of texts are multiplied, by their places; 1 where nothing is noted.
pub(crate) type Readings = HashMap<Span, f64>;

/// A number without a unit that is refused where it stands.
pub(crate) struct Bare<'a> {
    number: Span,
    expr: Option<&'a Expr>,
    why: Why,
    /// What it stands beside.
    beside: Span,
    part: Part,
    /// The call of the function in which it stands.
    call: Option<Call<'a>>,
}

/// Why it cannot take the unit of what it stands beside.
enum Why {
    /// That is a formula, or the function is called with different things.
    Formula,
    /// It is a term, whose sum has that unit; told here only if there is no other mistake: 1 is not
    /// 1 deg.
    Term,
    /// It is a curve without a unit: this one.
    Curve(Part),
}

impl<'a> Inference<'a> {
    /// A number without a unit is read in the declared unit of what it stands beside.
    pub fn read(&mut self, number: &Operand<'a>, beside: &Operand<'a>) {
        let Some(expr) = number.1.expr else { return };
        if let (ExprKind::Tuple(parts), true) = (&expr.kind, number.0.len() > 1) {
            for (at, (text, part)) in parts.iter().zip(&number.0).enumerate() {
                let Some(other) = beside.0.get(at).or(beside.0.last()) else { return };
                self.read(
                    &(vec![part.clone()], side(text)),
                    &(vec![other.clone()], beside.1.clone()),
                );
            }
            return;
        }
        let (Some(other), true) = (beside.0.first(), number.0.iter().any(Part::is_bare)) else {
            return;
        };
        let is_same = |it: &Part| it.declared == other.declared && !it.plain;
        if !beside.0.iter().all(is_same)
            || !number.0.iter().all(|it| it.plain)
            || !other.gives_unit()
        {
            let odd = beside.0.iter().find(|it| !it.plain && !it.declared.is_si());
            odd.cloned()
                .into_iter()
                .for_each(|odd| self.refuse(&number.1, &beside.1, odd, Why::Formula));
        } else if !self.take(expr.span, other.declared.scale().0) {
            self.refuse(&number.1, &beside.1, other.clone(), Why::Formula);
        }
    }

    /// Notes by what a text is multiplied; not where it has another reading already, or one for
    /// each call.
    pub fn take(&mut self, place: Span, scale: f64) -> bool {
        self.calls.is_empty() && *self.readings.entry(place).or_insert(scale) == scale
    }

    /// A term without a unit in a sum that has one, though it measures nothing: `phi + 30` with an
    /// angle in degrees.
    pub fn read_term(&mut self, left: (&Part, &Side<'a>), right: (&Part, &Side<'a>)) {
        for ((number, text), (part, beside)) in [(left, right), (right, left)] {
            if number.is_bare() && !part.plain {
                self.terms.insert(text.span);
                if !part.declared.is_si() {
                    self.refuse(text, beside, part.clone(), Why::Term);
                }
            }
        }
    }

    /// `n + 30` beside an angle in degrees: 30 stands in a sum that counts in radians, and is given
    /// to what counts in degrees.
    pub fn read_sum(&mut self, sum: &Operand<'a>, beside: &Operand<'a>) {
        let (Some(expr), Some(part)) = (sum.1.expr, beside.0.first()) else { return };
        let is_in_si = |it: &Part| !it.plain && it.declared.is_si();
        if part.gives_unit() && part.declared.is_share() && sum.0.iter().all(is_in_si) {
            for term in terms(expr) {
                if self.terms.contains(&term.span) {
                    self.refuse(&side(term), &beside.1, part.clone(), Why::Term);
                }
            }
        }
    }

    /// A guessed curve such as `t/T` counts in nothing.
    pub fn read_curve(&mut self, curve: &Operand<'a>, subject: &Operand<'a>) {
        for (at, part) in curve.0.iter().enumerate().filter(|it| !it.1.plain) {
            let Some(subject_part) = subject.0.get(at).or(subject.0.last()) else { return };
            if subject_part.gives_unit() && part.dimension.is_some() {
                let why = Why::Curve(part.clone());
                self.refuse(&curve.1, &subject.1, subject_part.clone(), why);
            }
        }
    }

    fn refuse(&mut self, number: &Side<'a>, beside: &Side<'a>, part: Part, why: Why) {
        let call = self.calls.last().copied();
        let (expr, number, beside) = (number.expr, number.span, beside.span);
        self.bare.push(Bare { number, expr, why, beside, part, call });
    }
}

/// The terms of a sum, and of the sums in it; one of several is each of these.
fn terms(expr: &Expr) -> Vec<&Expr> {
    let (mut found, mut pending) = (Vec::new(), vec![expr]);
    while let Some(next) = pending.pop() {
        match &next.kind {
            ExprKind::Binary(BinaryOperator::Add | BinaryOperator::Subtract, left, right) => {
                pending.extend([&**left, &**right])
            }
            ExprKind::Negate(inner) => pending.push(inner),
            ExprKind::Call(callee, arguments) if is_one_of_them(callee) => {
                let values = arguments.iter().filter_map(|it| match it {
                    Argument::Expr(value) => Some(value),
                    _ => None,
                });
                pending.extend(values);
            }
            _ => found.push(next),
        }
    }
    found
}

/// `min` and `max` are as large as one of their arguments, `abs` is as large as its own.
fn is_one_of_them(callee: &Expr) -> bool {
    matches!(&callee.kind, ExprKind::Name(name) if matches!(name.as_str(), "min" | "max" | "abs"))
}

/// The findings, once it is known what each formula measures.
pub(crate) fn found(
    inference: &Inference<'_>,
    solution: &Solution,
    notation: &Notation,
) -> Vec<Diagnostic> {
    let settled = |part: &Part| part.dimension.as_ref().and_then(|it| solution.settled(it));
    let mut all = Vec::new();
    for it in &inference.bare {
        let dimension = settled(&it.part);
        let measures = dimension.as_ref().is_none_or(|it| !it.is_none());
        let is_share = it.part.declared.is_share();
        let is_wrong = match &it.why {
            Why::Formula => {
                measures || is_share || matches!(it.part.declared.form, Form::Name | Form::Quantity)
            }
            Why::Term => !measures && is_share,
            Why::Curve(curve) => {
                settled(curve).is_some_and(|it| it.is_none())
                    && (measures || !curve.declared.has_share())
            }
        };
        if is_wrong {
            all.push(it.diagnostic(&dimension.unwrap_or_default(), notation));
        }
    }
    all
}

impl Bare<'_> {
    fn diagnostic(&self, dimension: &Dimension, notation: &Notation) -> Diagnostic {
        let number = self.expr.map(text::expr).unwrap_or_default();
        let own = self.part.declared.text(dimension);
        let si = Some(notation.unit(dimension)).filter(|it| !it.is_empty() && dimension.is_known());
        let label = match (&own, self.part.declared.form) {
            (Some(own), Form::Name | Form::Quantity) => format!("in {own}"),
            (Some(own), _) => format!("made of names in {own}"),
            (None, Form::Mixed) => "made of names in different units".into(),
            (None, _) => "made of names in other units than those of SI".into(),
        };
        let message = match self.why {
            Why::Curve(_) => format!("`{number}` is a curve without a unit"),
            _ => format!("`{number}` has no unit, and what it stands beside is not in that of SI"),
        };
        let found = Diagnostic::new(Code::BareNumber, message, self.number, "in which unit?");
        let found = found.label(self.beside, label);
        let found = match self.call {
            Some(call) => found.label(call.span, "called here"),
            None => found,
        };
        let units: Vec<String> = own.into_iter().chain(si).collect();
        self.helped(found, &number, units)
    }

    /// What to write, the declared unit first.
    fn helped(&self, found: Diagnostic, number: &str, mut units: Vec<String>) -> Diagnostic {
        units.dedup();
        let is_literal = self.expr.is_some_and(|it| matches!(it.kind, ExprKind::Number(_)));
        let with = |unit: &String| match is_literal {
            true => format!("`{number} [{unit}]`"),
            false => format!("`1 [{unit}] * ({number})`"),
        };
        let Some(first) = units.first() else {
            return found.help(
                "give the number a unit, for example `3 [mm]`, or declare the names in SI units",
            );
        };
        let choices = units.iter().map(with).collect::<Vec<_>>().join(" or ");
        let found = found.help(format!("say which unit is meant: {choices}"));
        match is_literal {
            true => {
                let fix = Fix::likely(format!("write {}", with(first)));
                found.fix(fix.insert(self.number.end, format!(" [{first}]")))
            }
            false => found,
        }
    }
}
