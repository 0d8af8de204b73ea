//! The table of smoothing kernels, and the pass that applies one.
//!
//! A kernel is an odd step `S(u)` that rises from -1 to 1. With the width sigma,
//!
//! ```text
//! Sgn_sigma(z)    = S(z / sigma)
//! |z|_sigma       = sigma A(z / sigma)      with A' = S, A even, A(u) - |u| -> 0
//! Dir_sigma(z)    = S(|z| / sigma) z / |z|
//! max_sigma(a, b) = (a + b + |a - b|_sigma) / 2,   min_sigma(a, b) = (a + b - |a - b|_sigma) / 2
//! ```

use super::graph::builtins::Builtin;
use super::graph::{Expr, ExprId, Graph};

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
    /// `S(u) / u` over `u^2`, in which it is smooth at 0.
    ratio: fn(&mut Graph, ExprId) -> ExprId,
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
        ratio: ratio_of_tanh,
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
        ratio: |g, square| {
            let one = g.number(1.0);
            let sum = g.add(square, one);
            let root = g.sqrt(sum);
            g.reciprocal(root)
        },
    },
    Kernel {
        name: "linear",
        formula: "u",
        continuity: Some(0),
        compact: true,
        step: |_, u| u,
        // (u^2 + 1) / 2
        absolute: |g, u| polynomial_of_square(g, u, &[0.5, 0.5]),
        ratio: |g, _| g.number(1.0),
    },
    Kernel {
        name: "cubic",
        formula: "(3 u - u^3) / 2",
        continuity: Some(1),
        compact: true,
        step: |g, u| odd_polynomial(g, u, &[1.5, -0.5]),
        // (3 + 6 u^2 - u^4) / 8
        absolute: |g, u| polynomial_of_square(g, u, &[0.375, 0.75, -0.125]),
        ratio: |g, square| polynomial(g, square, &[1.5, -0.5]),
    },
    Kernel {
        name: "quintic",
        formula: "(15 u - 10 u^3 + 3 u^5) / 8",
        continuity: Some(2),
        compact: true,
        step: quintic,
        // (5 + 15 u^2 - 5 u^4 + u^6) / 16
        absolute: |g, u| polynomial_of_square(g, u, &[0.3125, 0.9375, -0.3125, 0.0625]),
        ratio: |g, square| polynomial(g, square, &[1.875, -1.25, 0.375]),
    },
];

impl Kernel {
    /// What editors say of it: `S(u) = tanh(u)`, how smooth it is, whether it is exact outside of
    /// the layer.
    pub fn doc(&self) -> String {
        let smoothness = self.continuity.map_or("smooth".into(), |times| format!("C^{times}"));
        let support = if self.compact { "exact outside of the layer" } else { "never quite exact" };
        format!("`S(u) = {}`, u = z/sigma: {smoothness}, {support}", self.formula)
    }

    /// `S'(0)`: how steep the step is.
    pub fn slope(&self) -> f64 {
        let mut graph = Graph::new();
        let zero = graph.number(0.0);
        let slope = (self.ratio)(&mut graph, zero);
        crate::expressions::graph::evaluate(&graph, &[slope], &[], &[])[0]
    }
}

/// `(15 u - 10 u^3 + 3 u^5) / 8`, between -1 and 1.
pub(crate) fn quintic(graph: &mut Graph, u: ExprId) -> ExprId {
    odd_polynomial(graph, u, &[1.875, -1.25, 0.375])
}

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

/// `Dir_sigma(z)`: `S(u)/u z/sigma` with `u = |z|/sigma`, all through `u^2`, so that nothing is
/// singular at 0.
pub fn direction(graph: &mut Graph, kernel: &Kernel, z: &[ExprId], sigma: ExprId) -> Vec<ExprId> {
    let scaled: Vec<ExprId> = z.iter().map(|&z| graph.div(z, sigma)).collect();
    let squares: Vec<ExprId> = scaled.iter().map(|&u| graph.square(u)).collect();
    let square = graph.sum(&squares);
    let inside = (kernel.ratio)(graph, square);
    let ratio = if kernel.compact { beyond_one(graph, square, inside) } else { inside };
    scaled.into_iter().map(|u| graph.mul(ratio, u)).collect()
}

/// `inside` for u <= 1, 1/u beyond; each branch has a value on both sides.
fn beyond_one(graph: &mut Graph, square: ExprId, inside: ExprId) -> ExprId {
    let one = graph.number(1.0);
    let clamped = graph.select_le(square, one, one, square);
    let root = graph.sqrt(clamped);
    let outside = graph.reciprocal(root);
    graph.select_le(square, one, inside, outside)
}

/// tanh(u)/u: near 0 its Taylor polynomial, which is exact to rounding there.
fn ratio_of_tanh(graph: &mut Graph, square: ExprId) -> ExprId {
    let series = polynomial(graph, square, &TANH);
    let limit = graph.number(TANH_LIMIT);
    let clamped = graph.select_le(square, limit, limit, square);
    let u = graph.sqrt(clamped);
    let tanh = graph.tanh(u);
    let far = graph.div(tanh, u);
    graph.select_le(square, limit, series, far)
}

/// tanh(u)/u as a polynomial in u^2.
const TANH: [f64; 9] = [
    1.0,
    -1.0 / 3.0,
    2.0 / 15.0,
    -17.0 / 315.0,
    62.0 / 2835.0,
    -1382.0 / 155_925.0,
    21_844.0 / 6_081_075.0,
    -929_569.0 / 638_512_875.0,
    6_404_582.0 / 10_854_718_875.0,
];

/// Up to here in u^2 the polynomial and its first two derivatives are exact to rounding.
const TANH_LIMIT: f64 = 0.02;

/// `|z|_sigma`.
pub fn absolute(graph: &mut Graph, kernel: &Kernel, z: ExprId, sigma: ExprId) -> ExprId {
    let u = graph.div(z, sigma);
    let inside = (kernel.absolute)(graph, u);
    let scaled = graph.mul(sigma, inside);
    let minus = graph.neg(z);
    if kernel.compact { outside(graph, u, [minus, scaled, z]) } else { scaled }
}

/// The roots with every `abs`, `min` and `max` in them smoothed, from the inside out.
pub fn smooth_nonsmooth(
    graph: &mut Graph,
    roots: &[ExprId],
    kernel: &Kernel,
    sigma: ExprId,
) -> Vec<ExprId> {
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

fn extremum(
    graph: &mut Graph,
    kernel: &Kernel,
    operands: &[ExprId],
    sigma: ExprId,
    sign: f64,
) -> ExprId {
    let (sum, difference) =
        (graph.add(operands[0], operands[1]), graph.sub(operands[0], operands[1]));
    let mean = graph.scale(0.5, sum);
    let distance = absolute(graph, kernel, difference, sigma);
    let half = graph.scale(sign, distance);
    graph.add(mean, half)
}

/// `below` for u <= -1, `inside`, `above` for u >= 1.
pub(crate) fn outside(graph: &mut Graph, u: ExprId, [below, inside, above]: [ExprId; 3]) -> ExprId {
    let [[u, minus], [plus, _]] = ends(graph, u);
    let right = graph.select_le(plus, u, above, inside);
    graph.select_le(u, minus, below, right)
}

/// What [`outside`] compares.
pub(crate) fn ends(graph: &mut Graph, u: ExprId) -> [[ExprId; 2]; 2] {
    let (minus, plus) = (graph.number(-1.0), graph.number(1.0));
    [[u, minus], [plus, u]]
}

/// sqrt(u^2 + 1).
fn hyperbola(graph: &mut Graph, u: ExprId) -> ExprId {
    let square = polynomial_of_square(graph, u, &[1.0, 1.0]);
    graph.sqrt(square)
}

/// c0 + c1 u^2 + c2 u^4 + ...
fn polynomial_of_square(graph: &mut Graph, u: ExprId, coefficients: &[f64]) -> ExprId {
    let square = graph.square(u);
    polynomial(graph, square, coefficients)
}

/// c0 + c1 q + c2 q^2 + ...
fn polynomial(graph: &mut Graph, q: ExprId, coefficients: &[f64]) -> ExprId {
    let zero = graph.number(0.0);
    coefficients.iter().rev().fold(zero, |sum, &coefficient| {
        let product = graph.mul(sum, q);
        let coefficient = graph.number(coefficient);
        graph.add(coefficient, product)
    })
}

/// c0 u + c1 u^3 + c2 u^5 + ...
fn odd_polynomial(graph: &mut Graph, u: ExprId, coefficients: &[f64]) -> ExprId {
    let polynomial = polynomial_of_square(graph, u, coefficients);
    graph.mul(u, polynomial)
}
