//! The step in which a ball leaves 0. There `s = psi/|psi|` turns with a rate of order `1/|psi|`, which no explicit step
//! can follow, but the solution is smooth. It is found by collocation at Radau points, with the selectors as unknowns:
//!
//! ```text
//! X_i = x + h sum_j a_ij f(t_j, X_j, s_j)
//! psi(X_i) = |psi(X_i)| s_i       the balls that move
//! r(X_i, s_i) = 0                 the surfaces that are slid on
//! ```
//!
//! by Newton's method, from the direction in which the ball sets out. Five points against four give the error.

use super::direction::length;
use super::field::Field;
use super::result::Options;
use super::step::Step;
use nalgebra::{DMatrix, DVector};

const FINE: [f64; 5] = [
    0.057_104_196_114_517_68,
    0.276_843_013_638_123_83,
    0.583_590_432_368_916_8,
    0.860_240_135_656_219_5,
    1.0,
];

const COARSE: [f64; 4] = [0.088_587_959_512_703_95, 0.409_466_864_440_734_7, 0.787_659_461_760_847, 1.0];

/// Newton's method is given up after so many iterations.
const MOST_ITERATIONS: usize = 20;

/// One point of the collocation: what is added to the start, and all selectors.
struct Node {
    added: Vec<f64>,
    selectors: Vec<f64>,
}

/// The equations of one step.
struct Collocation<'f, 'a> {
    field: &'f mut Field<'a>,
    t: f64,
    x: &'f [f64],
    h: f64,
    options: &'f Options,
    /// The selectors that are unknown: those of moving balls, then of sliding surfaces.
    unknown: Vec<usize>,
    times: &'static [f64],
    weights: DMatrix<f64>,
}

/// A step from `t` to `t + h`.
pub(super) fn step(field: &mut Field, t: f64, x: &[f64], h: f64, options: &Options) -> Step {
    let first = field.rate(t, x);
    let coarse = Collocation::new(field, t, x, h, options, &COARSE).nodes();
    let fine = Collocation::new(field, t, x, h, options, &FINE).nodes();
    let (Some(coarse), Some(fine)) = (coarse, fine) else { return Step::refused(t, x, h) };
    let [at_coarse, at_end] = [&coarse, &fine].map(|nodes| &nodes[nodes.len() - 1].added);
    let error = options.error(x, at_coarse, at_end);
    field.selectors = fine[fine.len() - 1].selectors.clone();
    let at = |added: &[f64]| x.iter().zip(added).map(|(x, added)| x + added).collect::<Vec<f64>>();
    let end = at(at_end);
    let (last, _) = field.with_selectors(t + h, &end, &fine[fine.len() - 1].selectors);
    let curve = |theta: f64| at(&interpolated(&fine, theta));
    let mut step = Step::smooth([t, h], [x.to_vec(), curve(0.5), end], [first, last], error);
    let dense = options.error(x, &step.at(0.25), &curve(0.25));
    step.error = error.max(0.1 * dense);
    step
}

impl<'f, 'a> Collocation<'f, 'a> {
    fn new(
        field: &'f mut Field<'a>,
        t: f64,
        x: &'f [f64],
        h: f64,
        options: &'f Options,
        times: &'static [f64],
    ) -> Self {
        let balls = field.moving().into_iter().flat_map(|ball| ball.surfaces.clone());
        let unknown = balls.chain(field.sliding()).collect();
        Collocation { field, t, x, h, options, unknown, times, weights: weights(times) }
    }

    /// The points; `None` where Newton's method does not converge.
    fn nodes(mut self) -> Option<Vec<Node>> {
        let mut nodes = self.held_direction();
        for _ in 0..MOST_ITERATIONS {
            let (residual, matrix) = self.linearised(&nodes);
            let change =
                matrix.lu().solve(&residual).filter(|it| it.iter().all(|value| value.is_finite()))?;
            if self.subtract(&change, &mut nodes) <= 0.01 {
                return Some(nodes);
            }
        }
        None
    }

    /// The solution if no selector changed, nearly.
    fn held_direction(&mut self) -> Vec<Node> {
        let selectors = self.field.selectors.clone();
        let node = |_| Node { added: vec![0.0; self.x.len()], selectors: selectors.clone() };
        let mut nodes: Vec<Node> = (0..self.times.len()).map(node).collect();
        for _ in 0..3 {
            let rates: Vec<Vec<f64>> = (0..nodes.len())
                .map(|j| {
                    let (t, x) = self.point(j, &nodes[j]);
                    self.field.with_selectors(t, &x, &selectors).0
                })
                .collect();
            for (i, node) in nodes.iter_mut().enumerate() {
                node.added = self.added(i, &rates);
            }
        }
        nodes
    }

    fn point(&self, j: usize, node: &Node) -> (f64, Vec<f64>) {
        let x = self.x.iter().zip(&node.added).map(|(x, added)| x + added).collect();
        (self.t + self.times[j] * self.h, x)
    }

    /// `h sum_j a_ij f_j`.
    fn added(&self, i: usize, rates: &[Vec<f64>]) -> Vec<f64> {
        let sum = |state: usize| {
            rates.iter().enumerate().map(|(j, rate)| self.weights[(i, j)] * rate[state]).sum::<f64>()
        };
        (0..self.x.len()).map(|state| self.h * sum(state)).collect()
    }

    /// Residuals and their derivatives; in each point first the states, then the selectors.
    fn linearised(&mut self, nodes: &[Node]) -> (DVector<f64>, DMatrix<f64>) {
        let (states, count) = (self.x.len(), self.unknown.len());
        let width = states + count;
        let mut residual = DVector::zeros(nodes.len() * width);
        let mut matrix = DMatrix::zeros(nodes.len() * width, nodes.len() * width);
        let mut rates = Vec::new();
        for (j, node) in nodes.iter().enumerate() {
            let (t, x) = self.point(j, node);
            let (rate, by_state) = self.field.by_state_with(t, &x, &node.selectors);
            let by_selector =
                self.field.with_selectors(t, &x, &node.selectors).1.select_columns(&self.unknown);
            for i in 0..nodes.len() {
                let weight = -self.h * self.weights[(i, j)];
                matrix.view_mut((i * width, j * width), (states, states)).copy_from(&(&by_state * weight));
                matrix
                    .view_mut((i * width, j * width + states), (states, count))
                    .copy_from(&(&by_selector * weight));
            }
            let normals = self.field.normals(t, &x);
            let own = j * width + states;
            let mut rows = matrix.view_mut((own, j * width), (count, width));
            for (at, &surface) in self.unknown.iter().enumerate() {
                let gradient = normals.by_state.row(surface);
                // Second derivatives of psi are left out: they only slow the convergence down.
                rows.view_mut((at, 0), (1, states)).copy_from(&(gradient * &by_state));
                rows.view_mut((at, states), (1, count)).copy_from(&(gradient * &by_selector));
                residual[own + at] = normals.rate(surface, &rate);
            }
            for ball in self.field.moving() {
                let psi = &normals.psi[ball.surfaces.clone()];
                let size = length(psi).max(f64::MIN_POSITIVE);
                let gradients = normals.by_state.rows(ball.surfaces.start, psi.len());
                let along = DVector::from_iterator(psi.len(), psi.iter().map(|psi| psi / size)).transpose()
                    * gradients;
                for (i, surface) in ball.surfaces.clone().enumerate() {
                    let at =
                        self.unknown.iter().position(|it| *it == surface).expect("moving balls are unknown");
                    let s = node.selectors[surface];
                    let by_state = (gradients.row(i) - &along * s) / self.h;
                    rows.row_mut(at).fill(0.0);
                    rows.view_mut((at, 0), (1, states)).copy_from(&by_state);
                    rows[(at, states + at)] = -size / self.h;
                    residual[own + at] = (psi[i] - size * s) / self.h;
                }
            }
            rates.push(rate);
        }
        for (i, node) in nodes.iter().enumerate() {
            for (state, added) in self.added(i, &rates).into_iter().enumerate() {
                matrix[(i * width + state, i * width + state)] += 1.0;
                residual[i * width + state] = node.added[state] - added;
            }
        }
        (residual, matrix)
    }

    /// A step of Newton's method; its size in units of the tolerance.
    fn subtract(&self, change: &DVector<f64>, nodes: &mut [Node]) -> f64 {
        let width = self.x.len() + self.unknown.len();
        let mut largest: f64 = 0.0;
        for (j, node) in nodes.iter_mut().enumerate() {
            let change = change.rows(j * width, width);
            let before = node.added.clone();
            node.added.iter_mut().zip(change.iter()).for_each(|(added, change)| *added -= change);
            let by_selector = change.iter().skip(self.x.len());
            self.unknown.iter().zip(by_selector).for_each(|(&at, change)| node.selectors[at] -= change);
            largest = largest.max(self.options.error(self.x, &before, &node.added));
        }
        largest
    }
}

/// `a_ij`, which integrates polynomials exactly: `sum_j a_ij c_j^(q-1) = c_i^q / q`.
fn weights(times: &[f64]) -> DMatrix<f64> {
    let size = times.len();
    let powers = DMatrix::from_fn(size, size, |j, q| times[j].powi(q as i32));
    let integrals = DMatrix::from_fn(size, size, |i, q| times[i].powi(q as i32 + 1) / (q + 1) as f64);
    integrals * powers.try_inverse().expect("the times differ")
}

/// What is added to the start inside the step: the polynomial through the start and the points.
fn interpolated(nodes: &[Node], theta: f64) -> Vec<f64> {
    let others = |j: usize| FINE.iter().enumerate().filter(move |(i, _)| *i != j).map(|(_, c)| *c);
    let factor =
        |j: usize| others(j).fold(theta / FINE[j], |product, c| product * (theta - c) / (FINE[j] - c));
    let factors: Vec<f64> = (0..nodes.len()).map(factor).collect();
    let sum =
        |state: usize| nodes.iter().zip(&factors).map(|(node, factor)| factor * node.added[state]).sum();
    (0..nodes[0].added.len()).map(sum).collect()
}
