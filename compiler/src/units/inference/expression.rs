//! What an expression measures: one arm per kind; calls are in the file beside this one.

use super::declared::Declared;
use super::requirement::Reason;
use super::value::{Part, Value, pairwise};
use super::{Inference, Operand, side};
use crate::syntax::DEEPEST;
use crate::syntax::each::phase_named;
use crate::syntax::{scope, walk};
use crate::units::dimension::Dimension;
use crate::units::dimension::ratio::Ratio;
use crate::units::dimension::table;
use fdcc_grammar::Span;
use fdcc_grammar::ast::{Arm, BinaryOperator, Expr, ExprKind, Ident, ItemKind, Unit};

impl<'a> Inference<'a> {
    /// The dimensions of an expression; what it demands is noted.
    pub fn evaluate(&mut self, expr: &'a Expr) -> Value {
        if self.depth > DEEPEST {
            return Value::new();
        }
        self.depth += 1;
        let value = self.evaluate_kind(expr);
        self.depth -= 1;
        value
    }

    fn evaluate_kind(&mut self, expr: &'a Expr) -> Value {
        match &expr.kind {
            ExprKind::Number(value) => vec![Part::number(*value)],
            ExprKind::Quantity(_, unit) => {
                vec![written(unit).in_unit(Declared::of_quantity(unit))]
            }
            ExprKind::Name(name) => self.name(name),
            ExprKind::Negate(inner) => self.evaluate(inner),
            ExprKind::Binary(..) => self.chain(expr),
            ExprKind::Call(callee, arguments) => self.call(expr, callee, arguments),
            ExprKind::Part(base, part) => self.part(base, part),
            ExprKind::Index(base, index) => {
                let part = self.evaluate(base).into_iter().nth(index.wrapping_sub(1));
                part.map(Part::alone).into_iter().collect()
            }
            ExprKind::Prime(base) => {
                let (base, time) = (self.evaluate(base), self.time());
                pairwise(&base, &time, Part::over)
            }
            ExprKind::Tuple(parts) => {
                let part = |part| self.evaluate(part).pop().unwrap_or(Part::ANY).alone();
                parts.iter().map(part).collect()
            }
            ExprKind::Piecewise { arms, otherwise } => self.piecewise(arms, otherwise),
            ExprKind::Match { below, above, .. } => {
                let (below, above) = (self.operand(below), self.operand(above));
                let both = self.equal(Reason::Alternatives, &below, &above);
                both.into_iter().map(Part::into_formula).collect()
            }
        }
    }

    fn name(&mut self, name: &str) -> Value {
        if let Some(value) = self.local(name) {
            return value.clone();
        }
        match self.scope.find(name) {
            Some(at) => {
                self.values.get(&self.scope.declarations[at].name.span).cloned().unwrap_or_default()
            }
            // Without bounds in every unit.
            None if name == "inf" => vec![Part { plain: true, ..Part::ANY }],
            None if name == "pi" => vec![Part::number(std::f64::consts::PI)],
            None => Value::new(),
        }
    }

    /// An argument of the function we are in, or a row of data.
    fn local(&self, name: &str) -> Option<&Value> {
        let visible = &self.locals[self.frame..];
        visible.iter().rev().find(|local| local.0 == name).map(|local| &local.1)
    }

    /// The unit of time.
    pub fn time(&self) -> Value {
        let is_time = |it: &&scope::Declaration<'_>| matches!(it.item.kind, ItemKind::Time { .. });
        let own = self.scope.declarations.iter().find(is_time);
        // What stands outside of all phases has the times of all, which measure the same.
        let others = self.phases.values().flat_map(|it| &it.declarations).filter(is_time);
        let time = own.or_else(|| others.min_by_key(|it| it.name.span.start));
        time.and_then(|it| self.values.get(&it.name.span).cloned()).unwrap_or_default()
    }

    fn chain(&mut self, expr: &'a Expr) -> Value {
        let (first, links) = walk::spine(expr);
        let mut left = self.evaluate(first);
        for (left_expr, operator, right_expr) in links {
            let right = self.operand(right_expr);
            left = self.binary(operator, (left, side(left_expr)), right, right_expr);
        }
        left
    }

    fn binary(
        &mut self,
        operator: BinaryOperator,
        left: Operand<'a>,
        right: Operand<'a>,
        exponent: &'a Expr,
    ) -> Value {
        match operator {
            BinaryOperator::Add | BinaryOperator::Subtract => {
                self.equal(Reason::Sum(operator), &left, &right)
            }
            BinaryOperator::Multiply => pairwise(&left.0, &right.0, Part::times),
            BinaryOperator::Divide => pairwise(&left.0, &right.0, Part::over),
            BinaryOperator::Power => self.power(left, right, exponent),
        }
    }

    /// `base ^ exponent`: the unit of the base to a number that must be fixed if there is a unit.
    fn power(&mut self, base: Operand<'a>, exponent: Operand<'a>, text: &'a Expr) -> Value {
        let site = base.1.span.to(exponent.1.span);
        if !self.need_none(Reason::Exponent, site, &exponent) {
            return vec![self.free(site)];
        }
        match self.fixed(text).and_then(Ratio::from_decimal) {
            Some(exponent) => base.0.iter().map(|part| part.power(exponent)).collect(),
            None if self.need_none(Reason::FixedPower, site, &base) => {
                let plain = base.0.iter().chain(&exponent.0).all(|part| part.plain);
                vec![Part { plain, ..Part::of(Dimension::none()) }]
            }
            None => vec![self.free(site)],
        }
    }

    /// The value of an exponent that is made of numbers and constants.
    fn fixed(&self, expr: &Expr) -> Option<f64> {
        match &expr.kind {
            ExprKind::Number(value) => Some(*value),
            ExprKind::Negate(inner) => Some(-self.fixed(inner)?),
            ExprKind::Binary(operator, left, right) => {
                let (left, right) = (self.fixed(left)?, self.fixed(right)?);
                Some(match operator {
                    BinaryOperator::Add => left + right,
                    BinaryOperator::Subtract => left - right,
                    BinaryOperator::Multiply => left * right,
                    BinaryOperator::Divide => left / right,
                    BinaryOperator::Power => left.powf(right),
                })
            }
            ExprKind::Name(name) => {
                match &self.scope.declarations[self.scope.find(name)?].item.kind {
                    ItemKind::Const { value, unit: None, .. } => match value.kind {
                        ExprKind::Number(value) => Some(value),
                        _ => None,
                    },
                    _ => None,
                }
            }
            _ => None,
        }
    }

    fn part(&mut self, base: &'a Expr, part: &'a Ident) -> Value {
        if let Some(value) = self.part_of_container(base, part) {
            return value;
        }
        let parts = self.evaluate(base);
        let found = parts.into_iter().find(|it| it.called.as_deref() == Some(part.name.as_str()));
        found.map(Part::alone).into_iter().collect()
    }

    /// `obs.t` of a data set, `coast.h` of a phase.
    fn part_of_container(&self, base: &Expr, part: &Ident) -> Option<Value> {
        let name = phase_named(base)?;
        if self.local(&name).is_some() {
            return None;
        }
        let at = match self.phases.get(&*name) {
            Some(phase) => phase.find(&part.name).map(|at| phase.declarations[at].name.span),
            None => Some(self.column(&name, part)?),
        };
        Some(at.and_then(|at| self.values.get(&at).cloned()).unwrap_or_default())
    }

    /// The place of a column of data.
    fn column(&self, name: &str, part: &Ident) -> Option<Span> {
        let item = self.scope.declarations[self.scope.find(name)?].item;
        let ItemKind::Data { columns, .. } = &item.kind else { return None };
        columns.iter().find(|column| column.0.name == part.name).map(|column| column.0.span)
    }

    fn piecewise(&mut self, arms: &'a [Arm], otherwise: &'a Expr) -> Value {
        let rest = self.operand(otherwise);
        let mut all = rest.0.clone();
        for arm in arms {
            let (left, right) = (self.operand(&arm.left), self.operand(&arm.right));
            self.compare(Reason::Comparison, &left, &right);
            [&left, &right].into_iter().for_each(|side| self.gaps_of(&side.0));
            let value = self.operand(&arm.value);
            all = self.equal(Reason::Alternatives, &value, &(all, rest.1.clone()));
        }
        all.into_iter().map(Part::into_formula).collect()
    }
}

/// What a written unit measures; one with an unknown name goes with everything.
pub(crate) fn written(unit: &Unit) -> Part {
    table::dimension(unit).map_or(Part::ANY, |it| Part::of(it).in_unit(Declared::of(unit)))
}
