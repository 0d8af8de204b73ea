//! The constant parts of formulas, for the check that all of them are finite numbers.
//!
//! Only the largest parts are kept: `1/exp(1000)` is 0, though `exp(1000)` overflows.

use super::Elaborator;
use super::value::Value;
use crate::expressions::graph::ExprId;
use fdcc_grammar::ast::Expr;

/// A part of a formula that is made of numbers, constants and parameters alone.
pub(crate) struct ConstantPart<'a> {
    /// As it is written.
    pub expr: &'a Expr,
    /// Its value.
    pub value: ExprId,
    /// Whether something that is no constant is divided by it.
    pub is_divisor: bool,
}

impl<'a> Elaborator<'a> {
    /// Keeps a value that is constant, instead of the parts of it that were kept since `before`.
    pub fn keep_constant(&mut self, expr: &'a Expr, value: &Value, before: usize) {
        if self.is_own_constant(value) {
            self.constants.truncate(before);
            let parts = value.parts.as_slice().iter();
            let all = parts.map(|&value| ConstantPart { expr, value, is_divisor: false });
            self.constants.extend(all);
        }
    }

    /// Keeps what something that varies is divided by.
    pub fn keep_divisor(&mut self, expr: &'a Expr, value: &Value) {
        if self.is_own_constant(value) {
            let parts = value.parts.as_slice().iter();
            let all = parts.map(|&value| ConstantPart { expr, value, is_divisor: true });
            self.constants.extend(all);
        }
    }

    /// Keeps a constant that is divided by itself: simplified that is 1, whatever the constant is.
    pub fn keep_cancelled(&mut self, dividend: &Value, expr: &'a Expr, divisor: &Value) {
        if self.is_own_constant(divisor) && dividend.parts.as_slice() == divisor.parts.as_slice() {
            let named = divisor.parts.as_slice().iter();
            let named = named.filter(|it| self.graph.as_number(**it).is_none());
            let all = named.map(|&value| ConstantPart { expr, value, is_divisor: true });
            self.cancelled.extend(all);
        }
    }

    /// A choice between constants decides which of its pieces count, so none is kept.
    pub fn forget_constants(&mut self, before: usize) {
        self.constants.truncate(before);
    }

    /// Whether a value is constant, and no bound, which may be infinite, nor an argument of a
    /// function that is looked at by itself.
    fn is_own_constant(&self, value: &Value) -> bool {
        Self::is_constant(value) && !self.context.is_bound && !self.examining
    }
}
