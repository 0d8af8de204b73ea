//! The units of declared names: those that are written, those of their definitions, and those that
//! are to be found.

use super::declared::Form;
use super::expression::written;
use super::requirement::Reason;
use super::value::{Part, Value};
use super::{Inference, Operand, named};
use crate::syntax::order::order;
use crate::syntax::scope::{self, Declaration, Scope};
use crate::syntax::walk;
use fdcc_grammar::ast::{Expr, ExprKind, Ident, Interval, Item, ItemKind, Start, Unit};

impl<'a> Inference<'a> {
    /// Makes the names of a scope known; those that are known already stay what they are.
    pub fn enter(&mut self, scope: Scope<'a>) {
        let order = order(&scope, &mut Vec::new());
        let is_new = |it: &Declaration<'a>| !self.values.contains_key(&it.name.span);
        let new: Vec<bool> = scope.declarations.iter().map(is_new).collect();
        self.scope = scope;
        self.circular = order.circular;
        let fresh = |at: &usize| new[*at];
        (0..new.len()).filter(fresh).for_each(|at| self.declare(self.scope.declarations[at]));
        order
            .sequence
            .into_iter()
            .filter(fresh)
            .for_each(|at| self.define(self.scope.declarations[at]));
        (0..new.len()).filter(fresh).for_each(|at| self.bound(self.scope.declarations[at]));
    }

    fn declare(&mut self, it: Declaration<'a>) {
        let unit = scope::unit(it.item);
        let value = match &it.item.kind {
            ItemKind::State { parts, .. } | ItemKind::Control { parts, .. } => {
                self.variable(parts, unit)
            }
            ItemKind::Time { .. } => self.variable(&[], unit),
            ItemKind::Free { bounds, guess, .. } => {
                let given = bounds.iter().flat_map(|it| [&it.lower, &it.upper]).chain(guess);
                match unit {
                    None if is_number(given) => vec![self.number(it.name, it.item)],
                    _ => self.variable(&[], unit),
                }
            }
            ItemKind::Param { value: None, .. } => self.variable(&[], unit),
            ItemKind::Data { columns, .. } => return self.declare_columns(columns),
            _ => return,
        };
        self.values.insert(it.name.span, value);
    }

    /// One part for each component, with the written unit or each with its own that is to be found.
    pub fn variable(&mut self, parts: &[Ident], unit: Option<&Unit>) -> Value {
        let mut part = |called| {
            let part = unit.map_or_else(|| self.unknown(), written);
            Part { called, ..part }
        };
        match parts {
            [] => vec![part(None)],
            _ => parts.iter().map(|it| part(Some(it.name.as_str().into()))).collect(),
        }
    }

    fn define(&mut self, it: Declaration<'a>) {
        let value = match &it.item.kind {
            ItemKind::Param { value: Some(value), unit, .. }
            | ItemKind::Const { value, unit, .. }
            | ItemKind::Let { value, unit, .. }
            | ItemKind::Signal { value, unit, .. } => self.defined(it, value, unit.as_ref()),
            ItemKind::Surface { value, .. } => {
                let value = self.evaluate(value);
                self.switches.extend(value.first().cloned());
                value
            }
            _ => return,
        };
        self.values.insert(it.name.span, value);
    }

    /// A definition has the unit that is written after its name, or that of its value. A plain
    /// number is a name for it.
    fn defined(&mut self, it: Declaration<'a>, value: &'a Expr, unit: Option<&Unit>) -> Value {
        let given = self.operand(value);
        let own: Value = if let Some(unit) = unit {
            let declared = (vec![written(unit)], named(it.name.span));
            self.compare(Reason::Given("its value", it.name), &declared, &given);
            given.0.iter().map(|part| written(unit).called_as(part)).collect()
        } else {
            let own = |part: &Part| match part.plain {
                true => self.number(it.name, it.item).called_as(part),
                false if part.declared.form == Form::Quantity => part.clone().into_name(),
                false => part.clone().into_formula(),
            };
            given.0.iter().map(own).collect()
        };
        if !self.suspects.contains(&it.name.span) {
            return own;
        }
        let used: Value = own.iter().map(|part| self.unknown().called_as(part)).collect();
        self.equal(Reason::Uses(it.name), &(used.clone(), named(it.name.span)), &(own, given.1));
        used
    }

    /// Bounds, starts and guesses have the unit of the name.
    fn bound(&mut self, it: Declaration<'a>) {
        let subject = self.subject(it);
        match &it.item.kind {
            ItemKind::Param { bounds, .. } => {
                self.interval("a bound", it.name, &subject, bounds.as_ref())
            }
            ItemKind::Time { interval, .. } => {
                self.interval("an end", it.name, &subject, Some(interval));
            }
            ItemKind::Free { bounds, guess, .. } | ItemKind::Control { bounds, guess, .. } => {
                self.interval("a bound", it.name, &subject, bounds.as_ref());
                guess
                    .iter()
                    .for_each(|guess| self.value_for("the guess", it.name, &subject, guess));
            }
            ItemKind::State { bounds, start, .. } => {
                self.interval("a bound", it.name, &subject, bounds.as_ref());
                match start {
                    Some(Start::Value(value)) => {
                        self.value_for("the start", it.name, &subject, value)
                    }
                    Some(Start::Free { bounds, .. }) => {
                        self.interval("a bound of the start", it.name, &subject, bounds.as_ref());
                    }
                    None => {}
                }
            }
            _ => {}
        }
    }

    /// A declared name as an operand.
    pub fn subject(&self, it: Declaration<'a>) -> Operand<'a> {
        (self.values.get(&it.name.span).cloned().unwrap_or_default(), named(it.name.span))
    }

    fn interval(
        &mut self,
        what: &'static str,
        name: &'a Ident,
        subject: &Operand<'a>,
        interval: Option<&'a Interval>,
    ) {
        for end in interval.iter().flat_map(|it| [&it.lower, &it.upper]) {
            self.value_for(what, name, subject, end);
        }
    }

    /// A value that is given to a name.
    pub fn value_for(
        &mut self,
        what: &'static str,
        name: &'a Ident,
        subject: &Operand<'a>,
        value: &'a Expr,
    ) {
        let given = self.operand(value);
        self.compare(Reason::Given(what, name), subject, &given);
    }
}

/// Whether a name is given as a plain number: by at least one, and by nothing else.
fn is_number<'e>(given: impl Iterator<Item = &'e Expr>) -> bool {
    let mut count = 0;
    let mut plain = true;
    for expr in given {
        count += 1;
        walk::visit(expr, &mut |inner| {
            plain &= match &inner.kind {
                ExprKind::Number(_) | ExprKind::Negate(_) | ExprKind::Binary(..) => true,
                ExprKind::Name(name) => name == "pi" || name == "inf",
                _ => false,
            };
        });
    }
    plain && count > 0
}

/// Every unit that an item writes.
pub(crate) fn units_in<'a>(item: &'a Item, into: &mut Vec<&'a Unit>) {
    match &item.kind {
        ItemKind::Data { columns, .. } => {
            into.extend(columns.iter().filter_map(|it| it.1.as_ref()))
        }
        ItemKind::Phase { items, .. } => items.iter().for_each(|item| units_in(item, into)),
        ItemKind::Method { settings } => {
            into.extend(settings.iter().filter_map(|it| it.unit.as_ref()))
        }
        _ => into.extend(scope::unit(item)),
    }
    for expr in walk::expressions(item) {
        walk::visit(expr, &mut |inner| {
            if let ExprKind::Quantity(_, unit) = &inner.kind {
                into.push(unit);
            }
        });
    }
}
