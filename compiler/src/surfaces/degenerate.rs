//! Functions whose gradient vanishes wherever they do: `g^n` with `n > 1`, and sums of squares.

use super::local::Local;
use super::sample;
use crate::expressions::graph::builtins::Builtin;
use crate::expressions::graph::{Expr, ExprId};
use crate::expressions::interval::{Claim, Prover};
use std::collections::BTreeMap;

/// A function that is 0 together with its gradient.
pub(crate) struct Degenerate {
    /// What it is a power of, if it is one.
    pub base: Option<ExprId>,
    /// The sign that it never has, -1 or 1, if there is one.
    pub never: Option<f64>,
}

/// Finds out whether the surface is degenerate, and not just out of reach.
pub(crate) fn degenerate(local: &mut Local) -> Option<Degenerate> {
    power(local).or_else(|| sum_of_squares(local))
}

/// `c g^n`, read off the product as it was written or its normal form.
fn power(local: &mut Local) -> Option<Degenerate> {
    let normal = local.normal(local.psi);
    [local.psi, normal].into_iter().find_map(|psi| {
        let (factor, powers) = factors(local, psi)?;
        let (&base, &power) = powers.iter().next().filter(|it| powers.len() == 1 && *it.1 > 1)?;
        let moves = local.gradient.iter().any(|_| !local.graph.inputs_of(&[base]).is_empty());
        let never = (power % 2 == 0).then_some(-factor.signum());
        (moves && vanishes(local, base)).then_some(Degenerate { base: Some(base), never })
    })
}

/// The factors of a product with their powers, and the number in front.
fn factors(local: &Local, product: ExprId) -> Option<(f64, BTreeMap<ExprId, u32>)> {
    let (mut number, mut powers) = (1.0, BTreeMap::new());
    let mut pending = vec![product];
    while let Some(next) = pending.pop() {
        match local.graph.expr(next) {
            Expr::Number(value) => number *= value.value(),
            Expr::Call(Builtin::Neg, operands) => {
                number = -number;
                pending.push(operands[0]);
            }
            Expr::Call(Builtin::Mul, operands) => pending.extend(operands),
            Expr::Call(Builtin::Div, _) => return None,
            _ => *powers.entry(next).or_default() += 1,
        }
    }
    Some((number, powers))
}

/// Whether an expression takes the value 0 within the bounds.
fn vanishes(local: &mut Local, base: ExprId) -> bool {
    let mut everywhere = Prover::new(local.domain.clone(), Vec::new());
    let graph = &local.graph;
    if everywhere.proves(graph, &[(base, Claim::Positive)])
        || everywhere.proves(graph, &[(base, Claim::Negative)])
    {
        return false;
    }
    sample::zero(local, base)
}

/// `c_1 a^2 + c_2 b^4 + ...` with factors of one sign, over inputs that can all be 0.
fn sum_of_squares(local: &mut Local) -> Option<Degenerate> {
    let form = local.form(local.psi);
    let sign = form.terms.values().next()?.signum();
    let is_square = |power: &(ExprId, i32)| {
        let can_be_zero = match local.graph.expr(power.0) {
            Expr::Input(at) => local.domain[*at as usize].contains(0.0),
            _ => false,
        };
        power.1 > 0 && power.1 % 2 == 0 && can_be_zero
    };
    let fits = |(monomial, factor): (&Vec<(ExprId, i32)>, &f64)| {
        !monomial.is_empty() && monomial.iter().all(is_square) && factor.signum() == sign
    };
    let degenerate = !local.gradient.is_empty() && form.terms.iter().all(fits);
    degenerate.then_some(Degenerate { base: None, never: Some(-sign) })
}
