//! Knots and kinks rounded over a width.
//!
//! What switches where a gap `g` changes its sign, from `below` to `above`, changes over on `|g| <
//! w/2` instead:
//!
//! ```text
//! (1 - q) below + q above,   q = (1 + S(2 g/w))/2,   S(u) = (15 u - 10 u^3 + 3 u^5)/8
//! ```
//!
//! `S` is -1 and 1 at the ends of the zone with two derivatives that vanish, so that the whole is
//! C^2 if both sides are. Beyond the zone the sides stay as they are, to the last bit.

use super::graph::builtins::Builtin;
use super::graph::{ExprId, Graph};
use super::kernels;
use std::collections::HashSet;

/// What selections compare. What `blend` has rounded needs a selection, too, at each end of its
/// zone: to round those again would change nothing but the number of them, which doubles from
/// `blend` to `blend`.
#[derive(Default)]
pub(crate) struct Guards {
    /// Of definitions in pieces, as somebody wrote them.
    pub written: HashSet<[ExprId; 2]>,
    /// At the ends of zones, where everything fits with two derivatives.
    joints: HashSet<[ExprId; 2]>,
}

impl Guards {
    fn is_joint(&self, graph: &Graph, selection: ExprId) -> bool {
        graph.as_call(selection, Builtin::SelectLe).is_some_and(|operands| {
            let guard = [operands[0], operands[1]];
            self.joints.contains(&guard) && !self.written.contains(&guard)
        })
    }
}

/// The roots with every switch in them rounded, from the inside out; nothing if nothing switches
/// that is not rounded already.
pub(crate) fn rounded(
    graph: &mut Graph,
    roots: &[ExprId],
    width: ExprId,
    guards: &mut Guards,
) -> Option<Vec<ExprId>> {
    let mut is_any = false;
    let rounded = graph.rewrite(roots, |graph, original, rebuilt| {
        if guards.is_joint(graph, original) {
            return rebuilt;
        }
        let Some((gap, sides)) = sides(graph, original, rebuilt) else { return rebuilt };
        is_any = true;
        crossover(graph, gap, sides, width, guards)
    });
    is_any.then_some(rounded)
}

/// What is 0 where a node switches, and what the node is below and above.
pub(crate) fn sides(
    graph: &mut Graph,
    original: ExprId,
    rebuilt: ExprId,
) -> Option<(ExprId, [ExprId; 2])> {
    let with_kinks = [Builtin::Abs, Builtin::Min, Builtin::Max, Builtin::SelectLe];
    let builtin = with_kinks.into_iter().find(|it| {
        graph.as_call(original, *it).is_some() && graph.as_call(rebuilt, *it).is_some()
    })?;
    let operands = graph.operands(rebuilt).to_vec();
    Some(match (builtin, &operands[..]) {
        (Builtin::Min, &[a, b]) => (graph.sub(a, b), [a, b]),
        (Builtin::Max, &[a, b]) => (graph.sub(a, b), [b, a]),
        (Builtin::SelectLe, &[a, b, below, above]) => (graph.sub(a, b), [below, above]),
        _ => (operands[0], [graph.neg(operands[0]), operands[0]]),
    })
}

fn crossover(
    graph: &mut Graph,
    gap: ExprId,
    [below, above]: [ExprId; 2],
    width: ExprId,
    guards: &mut Guards,
) -> ExprId {
    let half = graph.scale(0.5, width);
    let u = graph.div(gap, half);
    guards.joints.extend(kernels::ends(graph, u));
    let share = kernels::quintic(graph, u);
    let (sum, jump) = (graph.add(below, above), graph.sub(above, below));
    let change = graph.mul(share, jump);
    let twice = graph.add(sum, change);
    let inside = graph.scale(0.5, twice);
    kernels::outside(graph, u, [below, inside, above])
}
