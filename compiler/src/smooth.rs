//! The table of smoothing kernels, and the pass that applies one.
//!
//! A kernel is an odd step `S(u)` that rises from -1 to 1. With the width sigma,
//!
//! ```text
//! Sgn_sigma(z)    = S(z / sigma)
//! |z|_sigma       = sigma A(z / sigma)      with A' = S, A even, A(u) - |u| -> 0
//! max_sigma(a, b) = (a + b + |a - b|_sigma) / 2,   min_sigma(a, b) = (a + b - |a - b|_sigma) / 2
//! ```

use crate::builtins::Builtin;
use crate::graph::{Expr, ExprId, Graph};

/// One smoothing kernel.
pub struct Kernel {
    /// Its name in the language.
    pub name: &'static str,
    /// `S(u)` as a formula.
    pub formula: &'static str,
    /// How often `S` can be differentiated continuously; none if without end.
    pub continuity: Option<u32>,
    /// Whether `S(u) = sign(u)` for `|u| >= 1`; then `step` and `absolute` hold only inside.
    pub compact: bool,
    step: fn(&mut Graph, ExprId) -> ExprId,
    absolute: fn(&mut Graph, ExprId) -> ExprId,
}

/// All kernels.
pub static KERNELS: [Kernel; 5] = [
    Kernel {
        name: "tanh",
        formula: "tanh(u)",
        continuity: None,
        compact: false,
        step: |g, u| g.tanh(u),
        // log(2 cosh u)
        absolute: |g, u| {
            let shifted = g.call(Builtin::LogCosh, &[u]);
            let shift = g.number(std::f64::consts::LN_2);
            g.add(shifted, shift)
        },
    },
    Kernel {
        name: "sqrt",
        formula: "u / sqrt(u^2 + 1)",
        continuity: None,
        compact: false,
        step: |g, u| {
            let root = hyperbola(g, u);
            g.div(u, root)
        },
        absolute: hyperbola,
    },
    Kernel {
        name: "linear",
        formula: "u",
        continuity: Some(0),
        compact: true,
        step: |_, u| u,
        // (u^2 + 1) / 2
        absolute: |g, u| polynomial_of_square(g, u, &[0.5, 0.5]),
    },
    Kernel {
        name: "cubic",
        formula: "(3 u - u^3) / 2",
        continuity: Some(1),
        compact: true,
        step: |g, u| odd_polynomial(g, u, &[1.5, -0.5]),
        // (3 + 6 u^2 - u^4) / 8
        absolute: |g, u| polynomial_of_square(g, u, &[0.375, 0.75, -0.125]),
    },
    Kernel {
        name: "quintic",
        formula: "(15 u - 10 u^3 + 3 u^5) / 8",
        continuity: Some(2),
        compact: true,
        step: |g, u| odd_polynomial(g, u, &[1.875, -1.25, 0.375]),
        // (5 + 15 u^2 - 5 u^4 + u^6) / 16
        absolute: |g, u| polynomial_of_square(g, u, &[0.3125, 0.9375, -0.3125, 0.0625]),
    },
];

/// The kernel of that name.
pub fn find(name: &str) -> Option<&'static Kernel> {
    KERNELS.iter().find(|kernel| kernel.name == name)
}

/// `Sgn_sigma(z)`.
pub fn step(graph: &mut Graph, kernel: &Kernel, z: ExprId, sigma: ExprId) -> ExprId {
    let u = graph.div(z, sigma);
    let inside = (kernel.step)(graph, u);
    let (minus, plus) = (graph.number(-1.0), graph.number(1.0));
    if kernel.compact { outside(graph, u, [minus, inside, plus]) } else { inside }
}

/// `|z|_sigma`.
pub fn absolute(graph: &mut Graph, kernel: &Kernel, z: ExprId, sigma: ExprId) -> ExprId {
    let u = graph.div(z, sigma);
    let inside = (kernel.absolute)(graph, u);
    let scaled = graph.mul(sigma, inside);
    let minus = graph.neg(z);
    if kernel.compact { outside(graph, u, [minus, scaled, z]) } else { scaled }
}

/// The roots with every `abs`, `min` and `max` in them smoothed, from the inside out.
pub fn smooth_nonsmooth(graph: &mut Graph, roots: &[ExprId], kernel: &Kernel, sigma: ExprId) -> Vec<ExprId> {
    graph.rewrite(roots, |graph, original, rebuilt| {
        let (builtin, operands) = match (graph.expr(original), graph.expr(rebuilt)) {
            (Expr::Call(was, _), Expr::Call(is, operands)) if was == is => (*is, operands.clone()),
            _ => return rebuilt,
        };
        match builtin {
            Builtin::Abs => absolute(graph, kernel, operands[0], sigma),
            Builtin::Max => extremum(graph, kernel, &operands, sigma, 0.5),
            Builtin::Min => extremum(graph, kernel, &operands, sigma, -0.5),
            _ => rebuilt,
        }
    })
}

fn extremum(graph: &mut Graph, kernel: &Kernel, operands: &[ExprId], sigma: ExprId, sign: f64) -> ExprId {
    let (sum, difference) = (graph.add(operands[0], operands[1]), graph.sub(operands[0], operands[1]));
    let mean = graph.scale(0.5, sum);
    let distance = absolute(graph, kernel, difference, sigma);
    let half = graph.scale(sign, distance);
    graph.add(mean, half)
}

/// `below` for u <= -1, `inside`, `above` for u >= 1.
fn outside(graph: &mut Graph, u: ExprId, [below, inside, above]: [ExprId; 3]) -> ExprId {
    let (minus, plus) = (graph.number(-1.0), graph.number(1.0));
    let right = graph.select_le(plus, u, above, inside);
    graph.select_le(u, minus, below, right)
}

/// sqrt(u^2 + 1).
fn hyperbola(graph: &mut Graph, u: ExprId) -> ExprId {
    let square = polynomial_of_square(graph, u, &[1.0, 1.0]);
    graph.sqrt(square)
}

/// c0 + c1 u^2 + c2 u^4 + ...
fn polynomial_of_square(graph: &mut Graph, u: ExprId, coefficients: &[f64]) -> ExprId {
    let square = graph.square(u);
    let zero = graph.number(0.0);
    coefficients.iter().rev().fold(zero, |sum, &coefficient| {
        let product = graph.mul(sum, square);
        let coefficient = graph.number(coefficient);
        graph.add(coefficient, product)
    })
}

/// c0 u + c1 u^3 + c2 u^5 + ...
fn odd_polynomial(graph: &mut Graph, u: ExprId, coefficients: &[f64]) -> ExprId {
    let polynomial = polynomial_of_square(graph, u, coefficients);
    graph.mul(u, polynomial)
}
