//! Random expressions, for what must hold of all.

use crate::random::Random;
use fdcc_compiler::builtins::Builtin;
use fdcc_compiler::graph::{ExprId, Graph};

/// Three random expressions of four inputs whose values and derivatives stay moderate, as the last
/// of `size` operations.
pub fn random_expressions(graph: &mut Graph, random: &mut Random, size: usize) -> Vec<ExprId> {
    let mut pool: Vec<ExprId> = (0..4).map(|input| graph.input(input)).collect();
    pool.extend([-1.0, 0.0, 0.5, 1.0, 3.0].map(|value| graph.number(value)));
    for _ in 0..size {
        let [a, b, c, d] = [0, 1, 2, 3].map(|_| pool[random.below(pool.len())]);
        let node = match random.below(14) {
            0 | 1 => graph.add(a, b),
            2 | 3 => graph.sub(a, b),
            4 | 5 => bounded_product(graph, a, b),
            6 => graph.neg(a),
            7 => graph.sin(a),
            8 => graph.cos(a),
            9 => graph.tanh(a),
            10 => bounded_exponential(graph, a),
            11 => bounded_quotient(graph, a, b),
            12 => graph.select_le(a, b, c, d),
            _ => graph.call([Builtin::Min, Builtin::Max][random.below(2)], &[a, b]),
        };
        pool.push(node);
    }
    pool.split_off(pool.len() - 3)
}

fn bounded_product(graph: &mut Graph, a: ExprId, b: ExprId) -> ExprId {
    let bounded = graph.sin(a);
    graph.mul(bounded, b)
}

fn bounded_exponential(graph: &mut Graph, a: ExprId) -> ExprId {
    let bounded = graph.cos(a);
    graph.exp(bounded)
}

fn bounded_quotient(graph: &mut Graph, a: ExprId, b: ExprId) -> ExprId {
    let square = graph.square(b);
    let one = graph.number(1.0);
    let denominator = graph.add(one, square);
    let root = graph.sqrt(denominator);
    graph.div(a, root)
}
