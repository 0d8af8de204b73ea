//! Pieces of straight lines as sums of `max`: tables and tariffs by blocks.
//!
//! With knots `k_1 < k_2 < ...` of a function of one value `x` whose pieces meet,
//!
//! ```text
//! f(x) = f_0(x) + sum over i of (f_i' - f_(i-1)') max(x - k_i, 0)
//! ```
//!
//! What is read beside `x` is the same in all pieces, or nothing is rewritten.

use crate::expressions::graph::builtins::Builtin;
use crate::expressions::graph::derivative::derivative;
use crate::expressions::graph::{ExprId, Graph};

/// Tables with more knots stay as they are.
const MOST: usize = 100;

/// What is left of the gap between two pieces where they meet, for their size.
const NOTHING: f64 = 1e-12;

/// The roots with sums of `max` where pieces of straight lines were; `fresh` is no input of theirs.
pub(super) fn with_hinges(graph: &mut Graph, roots: &[ExprId], fresh: u32) -> Vec<ExprId> {
    graph.rewrite(roots, |graph, original, rebuilt| {
        hinges(graph, original, fresh).unwrap_or(rebuilt)
    })
}

/// A selection by one value against numbers.
struct Selection {
    value: ExprId,
    knot: f64,
    below: ExprId,
    above: ExprId,
}

impl Selection {
    fn of(graph: &Graph, id: ExprId) -> Option<Self> {
        let &[a, b, x, y] = graph.as_call(id, Builtin::SelectLe)? else { return None };
        match (graph.as_number(a), graph.as_number(b)) {
            (None, Some(knot)) => Some(Selection { value: a, knot, below: x, above: y }),
            (Some(knot), None) => Some(Selection { value: b, knot, below: y, above: x }),
            _ => None,
        }
    }
}

/// The pieces of a function of one value, from below to above, with the knots between them.
struct Pieces {
    value: ExprId,
    knots: Vec<f64>,
    all: Vec<ExprId>,
}

impl Pieces {
    /// Adds what an expression is between two values.
    fn add(&mut self, graph: &Graph, id: ExprId, [from, to]: [f64; 2]) {
        match Selection::of(graph, id).filter(|it| it.value == self.value) {
            Some(it) if it.knot <= from => self.add(graph, it.above, [from, to]),
            Some(it) if it.knot >= to => self.add(graph, it.below, [from, to]),
            Some(it) => {
                self.add(graph, it.below, [from, it.knot]);
                self.knots.push(it.knot);
                self.add(graph, it.above, [it.knot, to]);
            }
            None => self.all.push(id),
        }
    }
}

fn hinges(graph: &mut Graph, id: ExprId, fresh: u32) -> Option<ExprId> {
    let value = Selection::of(graph, id)?.value;
    let mut pieces = Pieces { value, knots: Vec::new(), all: Vec::new() };
    pieces.add(graph, id, [f64::NEG_INFINITY, f64::INFINITY]);
    if pieces.knots.len() > MOST {
        return None;
    }
    let mut sum = pieces.all[0];
    for (pair, knot) in pieces.all.windows(2).zip(&pieces.knots) {
        let bend = bend(graph, [pair[0], pair[1]], (value, *knot), fresh)?;
        let (border, zero) = (graph.number(*knot), graph.number(0.0));
        let beyond = graph.sub(value, border);
        let hinge = graph.max(beyond, zero);
        let part = graph.scale(bend, hinge);
        sum = graph.add(sum, part);
    }
    Some(sum)
}

/// By how much the slope of a function by a value changes at a knot; nothing where its pieces do
/// not meet there, or differ by more than a straight line of the value.
fn bend(
    graph: &mut Graph,
    [below, above]: [ExprId; 2],
    (value, knot): (ExprId, f64),
    fresh: u32,
) -> Option<f64> {
    let input = graph.input(fresh);
    let gap = graph.sub(above, below);
    let gap = graph.rewrite(&[gap], |_, original, rebuilt| match original == value {
        true => input,
        false => rebuilt,
    })[0];
    let slope = derivative(graph, gap, fresh);
    let slope = graph.as_number(slope)?;
    let border = graph.number(knot);
    let there = graph.substitute(&[gap], &|at| (at == fresh).then_some(border))[0];
    let zero = graph.number(0.0);
    let at_zero = graph.substitute(&[gap], &|at| (at == fresh).then_some(zero))[0];
    let [there, at_zero] = [there, at_zero].map(|it| graph.as_number(it));
    let size = at_zero?.abs().max((slope * knot).abs()).max(slope.abs());
    (there?.abs() <= NOTHING * size).then_some(slope)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::expressions::graph::evaluate::evaluate;

    /// Three pieces of a tariff, from -1 to 4; a gap between two pieces is no bend.
    #[test]
    fn pieces_that_meet_are_sums_of_hinges() {
        let mut graph = Graph::default();
        let x = graph.input(0);
        let mut line = |slope: f64, from: f64, value: f64| {
            let begin = graph.number(from);
            let way = graph.sub(x, begin);
            let (rise, base) = (graph.scale(slope, way), graph.number(value));
            graph.add(base, rise)
        };
        let [first, second, third] =
            [line(0.5, 0.0, 0.0), line(2.0, 1.0, 0.5), line(-1.0, 2.0, 2.5)];
        let [one, two] = [1.0, 2.0].map(|it| graph.number(it));
        let rest = graph.select_le(x, two, second, third);
        let whole = graph.select_le(x, one, first, rest);
        let sum = with_hinges(&mut graph, &[whole], 1)[0];
        assert!(graph.as_call(sum, Builtin::SelectLe).is_none());
        for at in [-1.0, 0.5, 1.0, 1.5, 2.0, 4.0] {
            let [a, b] = [whole, sum].map(|it| evaluate(&graph, &[it], &[at], &[])[0]);
            assert!((a - b).abs() < 1e-14, "{at}: {a} {b}");
        }
        let jump = graph.select_le(x, one, first, third);
        assert_eq!(with_hinges(&mut graph, &[jump], 1)[0], jump);
    }
}
