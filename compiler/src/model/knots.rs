//! Times at which a model changes its formulas, such as the points of a curve through a table.

use super::{Model, Symbol};
use crate::expressions::graph::builtins::Builtin;
use crate::expressions::graph::{Expr, ExprId};

impl Model {
    /// Ascending.
    pub fn knots(&self) -> Vec<f64> {
        let Some(time) = self.input_of(Symbol::Time) else { return Vec::new() };
        let is_time = |id: ExprId| *self.graph.expr(id) == Expr::Input(time);
        let mut roots: Vec<ExprId> = self.states.iter().map(|it| it.rate).collect();
        roots.extend(self.integrals.iter().map(|it| it.integrand));
        let choices = self.graph.reachable(&roots).into_iter();
        let knot = |id: ExprId| match *self.graph.as_call(id, Builtin::SelectLe)? {
            [a, b, ..] if is_time(a) => self.graph.as_number(b),
            [a, b, ..] if is_time(b) => self.graph.as_number(a),
            _ => None,
        };
        let mut knots: Vec<f64> = choices.filter_map(knot).collect();
        knots.sort_by(f64::total_cmp);
        knots.dedup();
        knots
    }
}
