//! The conditions that are expected to hold as equations at the solution of the subproblem: a guess
//! of its active set.

use super::point::Point;
use crate::nlp::{Multipliers, Nlp};
use crate::problem::Bounds;

/// A multiplier that is this part of the price of violations says that they are paid for.
const PAID: f64 = 0.99;

/// For each row and variable how far it is from its bound, `r`, if it is expected there.
pub(super) struct Working {
    pub(super) rows: Vec<Option<f64>>,
    pub(super) variables: Vec<Option<f64>>,
}

impl Working {
    /// Rows that are equations whatever happens.
    pub(super) fn equations(nlp: &dyn Nlp, at: &Point) -> Self {
        let rows = nlp.row_bounds().iter().zip(&at.rows);
        let residual =
            |(bounds, row): (&Bounds, &f64)| bounds.is_equality().then(|| row - bounds.lower);
        Working { rows: rows.map(residual).collect(), variables: vec![None; at.v.len()] }
    }

    /// Those, and the bounds whose multiplier is larger than the distance from them. Fixed
    /// variables stay where they are.
    pub(super) fn active(nlp: &dyn Nlp, at: &Point, known: &Multipliers) -> Self {
        let rows = nlp.row_bounds().iter().zip(&at.rows).zip(&known.rows);
        let rows = rows.map(|((bounds, row), lambda)| residual(bounds, *row, *lambda));
        let multipliers = known.lower.iter().zip(&known.upper).map(|(lower, upper)| upper - lower);
        let variables = nlp.variable_bounds().iter().zip(&at.v).zip(multipliers);
        let variables = variables
            .map(|((bounds, v), z)| residual(bounds, *v, z).filter(|_| !bounds.is_equality()));
        Working { rows: rows.collect(), variables: variables.collect() }
    }

    /// Those without the rows whose violation is paid for at this price.
    pub(super) fn tight(nlp: &dyn Nlp, at: &Point, known: &Multipliers, price: f64) -> Self {
        let mut working = Working::active(nlp, at, known);
        let rows = working.rows.iter_mut().zip(&known.rows);
        rows.filter(|(_, lambda)| lambda.abs() >= PAID * price)
            .for_each(|(expected, _)| *expected = None);
        working
    }
}

fn residual(bounds: &Bounds, value: f64, multiplier: f64) -> Option<f64> {
    if bounds.is_equality() {
        return Some(value - bounds.lower);
    }
    let bound = if multiplier > 0.0 { bounds.upper } else { bounds.lower };
    ((value - bound).abs() < multiplier.abs()).then_some(value - bound)
}
