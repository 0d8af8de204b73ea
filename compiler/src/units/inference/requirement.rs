//! What the text demands of units: two sides that must be equal, with all that a message needs to
//! say about them.

use super::declared::Declared;
use super::solve::Rank;
use crate::units::dimension::Dimension;
use fdcc_grammar::Span;
use fdcc_grammar::ast::{BinaryOperator, Expr, Ident};

/// Why two sides must have one unit.
#[derive(Clone, Copy)]
pub(crate) enum Reason<'a> {
    /// `a + b` or `a - b`.
    Sum(BinaryOperator),
    /// `a <= b`, `a == b`.
    Comparison,
    /// `m * v' = b`: the state.
    Equation(&'a Ident),
    /// The pieces of a `piecewise`, the sides of a `match`.
    Alternatives,
    /// The arguments or parts of a function such as `max` or `norm`.
    Together(&'a str),
    /// A value for a declared name: `the start`, `a bound`, and the name.
    Given(&'static str, &'a Ident),
    /// A definition whose uses do not fit its value: the name.
    Uses(&'a Ident),
    /// `blend(a, b)`: what is 0 where something within `a` changes sides, and the width `b`.
    Blend,
    /// The argument of `sin`: the right side is no unit.
    NoUnit(&'a str),
    /// A setting, or a number of jumps: the right side is no unit.
    Plain(&'a str),
    /// `a ^ b` where `b` has a unit: the right side is no unit.
    Exponent,
    /// `a ^ b` with a number `b` that may change: the right side is no unit.
    FixedPower,
}

/// One of the two sides.
#[derive(Clone)]
pub(crate) struct Side<'a> {
    /// Where it stands.
    pub span: Span,
    /// The expression; none where a declared name is meant.
    pub expr: Option<&'a Expr>,
    /// What it measures.
    pub dimension: Dimension,
    /// Whether it is made of nothing but numbers without units.
    pub plain: bool,
    /// The unit in which a plain number beside it is read.
    pub declared: Declared,
}

/// A function of the model at work.
#[derive(Clone, Copy)]
pub(crate) struct Call<'a> {
    /// The call.
    pub span: Span,
    /// The function.
    pub name: &'a Ident,
    /// What it calls its arguments.
    pub arguments: &'a [Ident],
    /// What it computes.
    pub body: &'a Expr,
}

/// Two sides that must have one unit.
#[derive(Clone)]
pub(crate) struct Requirement<'a> {
    /// Why.
    pub reason: Reason<'a>,
    /// The smallest text that holds the mistake, if it is one.
    pub site: Span,
    /// The first side.
    pub left: Side<'a>,
    /// The second side.
    pub right: Side<'a>,
    /// The functions we are in, from the outermost.
    pub calls: Vec<Call<'a>>,
}

impl Requirement<'_> {
    /// What must be no unit, and how sure it is that it must.
    pub fn equation(&self) -> (Rank, Dimension) {
        let difference = self.left.dimension.over(&self.right.dimension).unwrap_or_default();
        let rank = match self.reason {
            Reason::Uses(_) => Rank::Suspect,
            _ if difference.has_number() => Rank::Doubtful,
            Reason::Given(..) if self.left.dimension.is_unknown() => Rank::Direct,
            _ => Rank::Formula,
        };
        (rank, difference)
    }
}
