//! FDC0704: a plain number beside a formula, which is read in SI, though the formula is about names in other units.
//!
//! `end integral(dose) >= 80` with a dose in mg/d asks for 80 kg. Beside a name alone, the number would be in its unit.

use super::dimension::Dimension;
use super::inference::Inference;
use super::messages::unit_of;
use super::notation::{Notation, written};
use super::solve::Solution;
use super::table;
use super::value::Part;
use crate::resolve::conditions::measured;
use crate::resolve::expression::is_plain;
use crate::resolve::{scope, text, walk};
use fdcc_grammar::ast::{Expr, ExprKind, Item, Unit};
use fdcc_grammar::{Code, Diagnostic, Fix, Span};

/// A plain number, and the formula with which it is compared.
pub(crate) struct Bare<'a> {
    number: &'a Expr,
    part: Part,
    /// A name in it that is declared in another unit than that of SI.
    name: (Span, &'a str, &'a Unit),
}

impl<'a> Inference<'a> {
    /// Notes a plain number beside a formula with names in units of their own.
    pub fn note_bare(&mut self, sides: [(&'a Expr, Option<&Part>); 2]) {
        for [(number, _), (formula, part)] in [sides, [sides[1], sides[0]]] {
            let is_zero = matches!(number.kind, ExprKind::Number(0.0));
            if !is_plain(number) || is_zero || is_plain(formula) || measured(formula).is_some() {
                continue;
            }
            if let (Some(name), Some(part)) = (self.name_in_other_unit(formula), part) {
                self.bare.push(Bare { number, part: part.clone(), name });
            }
        }
    }

    fn name_in_other_unit(&self, formula: &'a Expr) -> Option<(Span, &'a str, &'a Unit)> {
        let mut found = None;
        walk::names(formula, &mut |name, span| {
            let item: Option<&'a Item> = self.scope.find(name).map(|at| self.scope.declarations[at].item);
            let unit = item.filter(|item| scope::unit(item).is_some()).and_then(unit_of);
            found = found.or(unit.filter(|unit| is_other(unit)).map(|unit| (span, name, unit)));
        });
        found
    }
}

/// Whether a unit measures something, and is not that of SI.
fn is_other(unit: &Unit) -> bool {
    let has_dimension = table::dimension(unit).is_some_and(|it| !it.is_none());
    has_dimension && table::scale(unit, &mut Vec::new()) != 1.0
}

/// The findings, once it is known what each formula measures.
pub(crate) fn found(inference: &Inference<'_>, solution: &Solution, notation: &Notation) -> Vec<Diagnostic> {
    let known = |part: &Part| solution.settled(part.dimension.as_ref()?).filter(Dimension::is_known);
    let all = inference.bare.iter().filter_map(|it| Some((it, known(&it.part)?)));
    all.filter(|it| !it.1.is_none())
        .map(|(it, dimension)| it.diagnostic(&notation.unit(&dimension)))
        .collect()
}

impl Bare<'_> {
    fn diagnostic(&self, unit: &str) -> Diagnostic {
        let (number, own) = (text::expr(self.number), written(self.name.2));
        let message = format!("`{number}` is read as {number} {unit}, though `{}` is in {own}", self.name.1);
        let found = Diagnostic::new(
            Code::BareNumber,
            message,
            self.number.span,
            format!("{unit}: beside a formula a plain number is in SI"),
        );
        let found = found.label(self.name.0, format!("in {own}"));
        let found = found.help(format!("say which unit is meant, for example `{number} [{unit}]`"));
        match self.number.kind {
            ExprKind::Number(_) => {
                let fix = Fix::likely("write the unit in which it is read");
                found.fix(fix.insert(self.number.span.end, format!(" [{unit}]")))
            }
            _ => found,
        }
    }
}
