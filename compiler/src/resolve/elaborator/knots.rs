//! Piecewise definitions and their knots.

use crate::expressions::graph::ExprId;
use fdcc_grammar::ast::{Arm, Expr};
use std::collections::BTreeSet;

/// A piecewise definition.
pub(crate) struct Site<'a> {
    /// The expression.
    pub expr: &'a Expr,
    /// The declaration it is part of.
    pub owner: Option<usize>,
    /// Where it is less than C^2.
    pub knots: Vec<Knot<'a>>,
    /// The two sides of each guard, by its arm, for all arguments that the definition was evaluated
    /// with.
    pub guards: BTreeSet<(usize, [ExprId; 2])>,
}

/// A place where two pieces meet less smoothly than C^2.
pub(crate) struct Knot<'a> {
    /// The arm whose guard changes there.
    pub arm: &'a Arm,
    /// Which of the arms that is.
    pub at: usize,
    /// The lowest derivative that jumps: 0 is the value itself.
    pub order: usize,
    /// That derivative on both sides, left first.
    pub limits: [f64; 2],
}
