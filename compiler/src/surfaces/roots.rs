//! Square roots and powers at 0: how often they can be differentiated there.

use super::local::Local;
use super::sample;
use super::smoothness::{HIGHEST, Order, along, is_affine, may_vanish, steepest};
use crate::expressions::graph::derivative::derivative;
use crate::expressions::graph::{Expr, ExprId, evaluate};
use crate::expressions::polynomial::Polynomial;

/// A square root at 0: the order to which its factor vanishes there.
pub(super) fn at_root(
    local: &mut Local,
    root: ExprId,
    node: ExprId,
    operand: ExprId,
) -> Option<(Order, Polynomial)> {
    if !may_vanish(local, operand) {
        return None;
    }
    let points = sample::zeros(local, operand);
    let form = local.form(operand);
    let order = match factor(local, root, node, operand) {
        Some(factor) if !points.is_empty() && is_affine(local, operand) => {
            vanishing(local, factor, operand, &points)
        }
        _ => Order::Times(0),
    };
    Some((order, form))
}

/// `Q` of `P + Q sqrt(a)`, if the expression is of that form.
fn factor(local: &mut Local, root: ExprId, node: ExprId, operand: ExprId) -> Option<ExprId> {
    let symbol = local.add_input();
    let negative = local.graph.neg(symbol);
    let [plus, minus] = [symbol, negative].map(|with| {
        local
            .graph
            .rewrite(&[root], |_, original, rebuilt| if original == node { with } else { rebuilt })
            [0]
    });
    let difference = local.graph.sub(plus, minus);
    let odd = local.form(difference).divided(&Polynomial::atom(symbol))?;
    // What is left has even powers of the root, which are powers of what it is taken of.
    let root = local.graph.sqrt(operand);
    let Expr::Input(position) = *local.graph.expr(symbol) else { return None };
    let even = odd.to_expr(&mut local.graph);
    let even = local.graph.substitute(&[even], &|input| (input == position).then_some(root))[0];
    let even = local.normal(even);
    (!local.graph.reachable(&[even]).contains(&root)).then_some(even)
}

/// To which order a factor vanishes where another function does, with a gradient that does not.
fn vanishing(local: &mut Local, factor: ExprId, zero: ExprId, points: &[Vec<f64>]) -> Order {
    let varying = steepest(local, zero, points);
    for times in 0..=HIGHEST {
        let vanishes = points.iter().zip(&varying).all(|(point, input)| {
            let roots =
                [along(local, factor, *input, times), derivative(&mut local.graph, zero, *input)];
            let values = evaluate(&local.graph, &roots, point, &[]);
            values[0].abs() <= 1e-9 && values[1].abs() > 1e-6
        });
        if !vanishes {
            return Order::Times(times);
        }
    }
    Order::Times(HIGHEST)
}

/// `a^p` at 0, for a power that is no whole number.
pub(super) fn at_power(
    local: &mut Local,
    base: ExprId,
    exponent: ExprId,
) -> Option<(Order, Polynomial)> {
    let power =
        local.graph.as_number(exponent).filter(|power| power.fract() != 0.0 && *power > 0.0)?;
    let reached = may_vanish(local, base);
    let order = (power.floor() as u32).min(HIGHEST);
    reached.then(|| (Order::Times(order), local.form(base)))
}
