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

    /// Keeps what a constant is divided by: simplified `2*p/p` is 2, whatever `p` is.
    pub fn keep_constant_divisor(&mut self, expr: &'a Expr, value: &Value) {
        if self.is_own_constant(value) {
            let parts = value.parts.as_slice().iter();
            let named = parts.filter(|it| self.graph.as_number(**it).is_none());
            let all = named.map(|&value| ConstantPart { expr, value, is_divisor: true });
            self.constant_divisors.extend(all);
        }
    }

    /// How many constants and divisors are kept.
    pub fn kept_constants(&self) -> [usize; 2] {
        [self.constants.len(), self.constant_divisors.len()]
    }

    /// A choice between constants decides which of its pieces count, so none is kept.
    pub fn forget_constants(&mut self, [constants, divisors]: [usize; 2]) {
        self.constants.truncate(constants);
        self.constant_divisors.truncate(divisors);
    }

    /// Whether a value is constant, and no bound, which may be infinite, nor an argument of a
    /// function that is looked at by itself.
    fn is_own_constant(&self, value: &Value) -> bool {
        Self::is_constant(value) && !self.here.context.is_bound && !self.here.examining
    }
}
