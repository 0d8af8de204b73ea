//! What an expression measures: one arm per kind; calls are in the file beside this one.

use super::declared::Declared;
use super::requirement::Reason;
use super::value::{Part, Value, pairwise};
use super::{Inference, Operand, side};
use crate::syntax::DEEPEST;
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
            ExprKind::Index(base, index) => picked(&self.evaluate(base), index.wrapping_sub(1)),
            ExprKind::Prime(base) => {
                let (base, time) = (self.evaluate(base), self.time());
                pairwise(&base, &time, Part::over)
            }
            ExprKind::Tuple(parts) => {
                parts.iter().map(|part| self.evaluate(part).pop().unwrap_or(Part::ANY)).collect()
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
        if let Some((_, value)) =
            self.locals[self.frame..].iter().rev().find(|local| local.0 == name)
        {
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

    /// The unit of time.
    pub fn time(&self) -> Value {
        let is_time = |it: &&scope::Declaration<'_>| matches!(it.item.kind, ItemKind::Time { .. });
        let time = self.scope.declarations.iter().find(is_time);
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
        if let ExprKind::Name(name) = &base.kind {
            if let Some(column) = self.column(name, part) {
                return self.values.get(&column).cloned().unwrap_or_default();
            }
            if let Some(phase) = self.phases.get(name.as_str()) {
                let found = phase.find(&part.name).map(|at| phase.declarations[at].name.span);
                return found.and_then(|span| self.values.get(&span).cloned()).unwrap_or_default();
            }
        }
        let value = self.evaluate(base);
        let position = self.names_of_parts(base).iter().position(|it| it.name == part.name);
        position.map_or(Value::new(), |at| picked(&value, at))
    }

    /// The place of a column of data.
    fn column(&self, name: &str, part: &Ident) -> Option<Span> {
        let row = self.rows.iter().rev().find(|row| row.0 == name).map(|row| row.1);
        let item = row.or_else(|| Some(self.scope.declarations[self.scope.find(name)?].item))?;
        let ItemKind::Data { columns, .. } = &item.kind else { return None };
        columns.iter().find(|column| column.0.name == part.name).map(|column| column.0.span)
    }

    /// How the parts of a vector are called: those of the first declared vector in it.
    fn names_of_parts(&self, expr: &'a Expr) -> &'a [Ident] {
        let mut names: &'a [Ident] = &[];
        walk::visit(expr, &mut |inner| {
            let ExprKind::Name(name) = &inner.kind else { return };
            let item = self.scope.find(name).map(|at| self.scope.declarations[at].item);
            names = match item {
                Some(item) if names.is_empty() => scope::parts(item),
                _ => names,
            };
        });
        names
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

fn picked(value: &[Part], at: usize) -> Value {
    value.get(at).cloned().into_iter().collect()
}
