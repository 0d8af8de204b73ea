//! Kinks of the right side that are no surfaces, and of the functions of surfaces: of `abs`, `min`,
//! `max`, and the knots of `piecewise`.
//!
//! ```text
//! |e| = -e, e     min(a, b) = a, b     max(a, b) = b, a     select_le(a, b, x, y) = x, y
//! ```
//!
//! where `e`, which is `a - b` but for `|e|`, is below 0 and above.
//!
//! Each `e` that time, a state or a control moves gets a selector behind those of the surfaces,
//! which says on which side of 0 it is. So the right side is smooth on each side and goes on
//! smoothly beyond, and what crosses a kink can be found and differentiated like what crosses a
//! surface. Those that only parameters move stay in the right side: nothing crosses them. Where
//! `e` is the function of a surface, the selector of that surface says it already, unless the
//! right side has no value beyond: `sqrt(-x)` above 0 is none, and a step that crosses `x = 0` has
//! a stage there.

use super::function::VectorFunction;
use crate::expressions::blend::sides;
use crate::expressions::graph::builtins::Domain;
use crate::expressions::graph::{Expr, ExprId, Graph};
use fdcc_runtime::problem::Origin;
use std::collections::HashSet;

/// The kinks of a function.
#[derive(Default)]
pub(super) struct Kinks {
    /// Those that have selectors, each after those inside it.
    pub crossed: Zeros,
    /// Those that parameters alone move.
    pub of_parameters: Zeros,
}

/// What is 0 at kinks, and where each comes from.
#[derive(Default)]
pub(super) struct Zeros {
    pub values: Vec<ExprId>,
    pub origins: Vec<Origin>,
}

impl Zeros {
    /// The place of one, which is a new one if it is not among them.
    fn place_of(&mut self, zero: ExprId, origin: &Origin) -> usize {
        self.values.iter().position(|known| *known == zero).unwrap_or_else(|| {
            self.values.push(zero);
            self.origins.push(origin.clone());
            self.values.len() - 1
        })
    }
}

/// Where kinks are taken out of.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Of {
    Flow,
    /// What has no value beyond a kink, such as `sqrt(max(x, 0))`, keeps it there: no step may end
    /// where a surface has no value.
    Surfaces,
}

/// Takes the kinks out of a function whose layout has the selectors of the surfaces last, and adds
/// them to those that are known. `switching` are the functions of the surfaces that stand alone;
/// others have none.
pub(super) fn take_out(
    graph: &mut Graph,
    flow: &mut VectorFunction,
    of: Of,
    switching: &[Option<ExprId>],
    kinks: &mut Kinks,
) {
    let mut rewritten = Vec::new();
    let ends = ends_of_partial(graph, &flow.outputs);
    for (&output, origin) in flow.outputs.iter().zip(&flow.origins) {
        let root = graph.rewrite(&[output], |graph, original, rebuilt| {
            let Some((zero, [below, above])) = sides(graph, original, rebuilt) else {
                return rebuilt;
            };
            let is_end = ends.contains(&original);
            if is_end && of == Of::Surfaces {
                return rebuilt;
            }
            let surfaces = if is_end { &[][..] } else { switching };
            match side_of(graph, zero, flow, [surfaces, switching], (kinks, origin)) {
                Some(selector) => {
                    let middle = graph.number(0.0);
                    let side = graph.select_le(selector, middle, below, above);
                    defined_with(graph, zero, side)
                }
                None => rebuilt,
            }
        });
        rewritten.extend(root);
    }
    flow.outputs = rewritten;
}

/// What functions are made of that have no value below 0, such as `sqrt` and `log`.
fn ends_of_partial(graph: &Graph, outputs: &[ExprId]) -> HashSet<ExprId> {
    let all = graph.reachable(outputs).into_iter();
    let operands = all.filter_map(|id| match graph.expr(id) {
        Expr::Call(builtin, operands) => match builtin.row().domain {
            Domain::NonNegative(_) | Domain::Positive(_) => Some(operands),
            Domain::All | Domain::NonZero(_) | Domain::Unit(_) => None,
        },
        _ => None,
    });
    let operands: Vec<ExprId> = operands.flatten().copied().collect();
    graph.reachable(&operands).into_iter().collect()
}

/// `side` where the kink has a place; no number where it has none: `max(log(x), 0)` of a negative
/// `x` is not 0.
fn defined_with(graph: &mut Graph, zero: ExprId, side: ExprId) -> ExprId {
    let needed = graph.reachable(&[zero]);
    let is_partial = |id: &ExprId| match graph.expr(*id) {
        Expr::Call(builtin, _) => builtin.row().domain != Domain::All,
        _ => false,
    };
    if !needed.iter().any(is_partial) {
        return side;
    }
    // No comparison holds of what is not a number.
    let [all, none] = [f64::INFINITY, f64::NAN].map(|it| graph.number(it));
    graph.select_le(zero, all, side, none)
}

/// The selector of a kink; none if nothing but parameters moves it.
fn side_of(
    graph: &mut Graph,
    zero: ExprId,
    flow: &VectorFunction,
    [surfaces, switching]: [&[Option<ExprId>]; 2],
    (kinks, origin): (&mut Kinks, &Origin),
) -> Option<ExprId> {
    let layout = flow.layout;
    let first = layout.selectors().start;
    let is_moved = |input: &u32| !layout.parameters().contains(&(*input as usize));
    if !graph.inputs_of(&[zero]).iter().any(is_moved) {
        kinks.of_parameters.place_of(zero, origin);
        return None;
    }
    if let Some(surface) = surfaces.iter().position(|psi| *psi == Some(zero)) {
        return Some(graph.input((first + surface) as u32));
    }
    let place = kinks.crossed.place_of(zero, origin);
    Some(graph.input((first + switching.len() + place) as u32))
}
