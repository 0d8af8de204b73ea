//! A step in which a ball leaves 0 or is near it. There `s = psi/|psi|` turns with a rate of order
//! `1/|psi|`, which no explicit step can follow, but the solution is smooth. It is found by
//! collocation at Radau points, with selectors and lengths as unknowns:
//!
//! ```text
//! X_i = x + h sum_j a_ij f(t_j, X_j, s_j)
//! psi(X_i) = q_i s_i,   |s_i| = 1,   q_i > 0      the balls that move
//! r(X_i, s_i) = 0                                 the surfaces that are slid on
//! ```
//!
//! by Newton's method, from the direction at the beginning. Five points against four give the
//! error.

use super::Step;
use crate::problem::RADAU;
use crate::simulate::field::Field;
use crate::simulate::system::Ball;
use crate::simulate::tuning::departure::{CONVERGED, INSIDE, INSIDE_WEIGHT, MOST_ITERATIONS};
use nalgebra::{DMatrix, DVector};

/// The points of the solution.
pub(crate) const FINE: &[f64] = RADAU[4];

const COARSE: &[f64] = RADAU[3];

/// One point: its state without the start, all selectors, the lengths of the moving balls.
#[derive(Clone)]
struct Node {
    added: Vec<f64>,
    selectors: Vec<f64>,
    lengths: Vec<f64>,
}

/// A right side with its derivatives by the state and the unknown selectors.
struct Slope {
    rate: Vec<f64>,
    by_state: DMatrix<f64>,
    by_selector: DMatrix<f64>,
}

/// The equations of one step. The unknowns of a point are its state, the selectors of the moving
/// balls and of the sliding surfaces, and the lengths.
struct Collocation<'f, 'a> {
    field: &'f mut Field<'a>,
    t: f64,
    x: &'f [f64],
    h: f64,
    balls: Vec<&'a Ball>,
    sliding: Vec<usize>,
    unknown: Vec<usize>,
    times: &'static [f64],
    weights: DMatrix<f64>,
}

/// Takes a step that has begun.
pub(crate) fn attempt(step: &mut Step, field: &mut Field) {
    let (t, h, x) = (step.t, step.h, step.start.clone());
    field.follow_directions(t, &x);
    field.find_doubts(t, &x, h, 0.0);
    let coarse = Collocation::new(field, [t, h], &x, COARSE).nodes();
    let fine = Collocation::new(field, [t, h], &x, FINE).nodes();
    step.error = f64::INFINITY;
    let (Some(coarse), Some(fine)) = (coarse, fine) else { return };
    let end = &fine[FINE.len() - 1];
    field.selectors.copy_from_slice(&end.selectors);
    let at_end = sum(&x, &end.added);
    let last = field.with_selectors(t + h, &at_end, &end.selectors).0;
    let curve = |theta: f64| sum(&x, &interpolated(&fine, theta));
    step.end_smoothly(&curve(0.5), &at_end, &last);
    let error = field.tolerance.error(&x, &coarse[COARSE.len() - 1].added, &end.added, h);
    let inside = field.tolerance.error(&x, &step.at(INSIDE), &curve(INSIDE), h);
    step.error = error.max(INSIDE_WEIGHT * inside);
}

impl<'f, 'a> Collocation<'f, 'a> {
    fn new(
        field: &'f mut Field<'a>,
        [t, h]: [f64; 2],
        x: &'f [f64],
        times: &'static [f64],
    ) -> Self {
        let (balls, sliding) = (field.moving(), field.sliding());
        let unknown =
            balls.iter().flat_map(|ball| ball.surfaces.clone()).chain(sliding.clone()).collect();
        Collocation { field, t, x, h, balls, sliding, unknown, times, weights: weights(times) }
    }

    /// How many unknowns a point has.
    fn width(&self) -> usize {
        self.x.len() + self.unknown.len() + self.balls.len()
    }

    /// The points; `None` where Newton's method does not converge.
    fn nodes(mut self) -> Option<Vec<Node>> {
        let mut nodes = self.in_one_direction();
        for _ in 0..MOST_ITERATIONS {
            let (residual, matrix) = self.linearised(&nodes);
            let change = matrix.lu().solve(&residual)?;
            let size = self.subtract(&change, &mut nodes);
            if size <= CONVERGED {
                let are_positive =
                    nodes.iter().flat_map(|node| &node.lengths).all(|length| *length > 0.0);
                return are_positive.then_some(nodes);
            } else if !size.is_finite() {
                return None;
            }
        }
        None
    }

    /// Nearly the solution if no selector changed.
    fn in_one_direction(&mut self) -> Vec<Node> {
        let selectors = self.field.selectors.clone();
        let node = Node {
            added: vec![0.0; self.x.len()],
            selectors,
            lengths: vec![0.0; self.balls.len()],
        };
        let mut nodes = vec![node; self.times.len()];
        for _ in 0..3 {
            let rates: Vec<Vec<f64>> = (0..nodes.len()).map(|j| self.rate(j, &nodes[j])).collect();
            nodes.iter_mut().enumerate().for_each(|(i, node)| node.added = self.added(i, &rates));
        }
        for (j, node) in nodes.iter_mut().enumerate() {
            let psi = self.field.psi(self.t + self.times[j] * self.h, &sum(self.x, &node.added));
            let along = |i: usize| psi[i] * node.selectors[i];
            let lengths = self.balls.iter().map(|ball| ball.surfaces.clone().map(along).sum());
            node.lengths = lengths.collect();
        }
        nodes
    }

    fn rate(&mut self, j: usize, node: &Node) -> Vec<f64> {
        let t = self.t + self.times[j] * self.h;
        self.field.with_selectors(t, &sum(self.x, &node.added), &node.selectors).0
    }

    /// `h sum_j a_ij f_j`.
    fn added(&self, i: usize, rates: &[Vec<f64>]) -> Vec<f64> {
        let weighted =
            |(j, rate): (usize, &Vec<f64>), state: usize| self.weights[(i, j)] * rate[state];
        let total =
            |state: usize| rates.iter().enumerate().map(|it| weighted(it, state)).sum::<f64>();
        (0..self.x.len()).map(|state| self.h * total(state)).collect()
    }

    /// Residuals and their derivatives, point after point.
    fn linearised(&mut self, nodes: &[Node]) -> (DVector<f64>, DMatrix<f64>) {
        let (states, width) = (self.x.len(), self.width());
        let mut residual = DVector::zeros(nodes.len() * width);
        let mut matrix = DMatrix::zeros(nodes.len() * width, nodes.len() * width);
        let mut rates = Vec::new();
        for (j, node) in nodes.iter().enumerate() {
            let slope = self.slope(j, node);
            for i in 0..nodes.len() {
                let weight = -self.h * self.weights[(i, j)];
                let mut block = matrix.view_mut((i * width, j * width), (states, width));
                block.columns_mut(0, states).copy_from(&(&slope.by_state * weight));
                block
                    .columns_mut(states, self.unknown.len())
                    .copy_from(&(&slope.by_selector * weight));
            }
            let (from, height) = (j * width + states, width - states);
            let (values, rows) = self.conditions(j, node, &slope);
            residual.rows_mut(from, height).copy_from(&values);
            matrix.view_mut((from, j * width), (height, width)).copy_from(&rows);
            rates.push(slope.rate);
        }
        for (i, node) in nodes.iter().enumerate() {
            for (state, added) in self.added(i, &rates).into_iter().enumerate() {
                matrix[(i * width + state, i * width + state)] += 1.0;
                residual[i * width + state] = node.added[state] - added;
            }
        }
        (residual, matrix)
    }

    fn slope(&mut self, j: usize, node: &Node) -> Slope {
        let (t, x) = (self.t + self.times[j] * self.h, sum(self.x, &node.added));
        let (rate, by_state) = self.field.by_state_with(t, &x, &node.selectors);
        let by_selector =
            self.field.with_selectors(t, &x, &node.selectors).1.select_columns(&self.unknown);
        Slope { rate, by_state, by_selector }
    }

    /// What holds in one point, with its derivatives.
    fn conditions(&mut self, j: usize, node: &Node, slope: &Slope) -> (DVector<f64>, DMatrix<f64>) {
        let normals =
            self.field.normals(self.t + self.times[j] * self.h, &sum(self.x, &node.added));
        let (states, count) = (self.x.len(), self.unknown.len());
        let mut residual = DVector::zeros(count + self.balls.len());
        let mut rows = DMatrix::zeros(residual.len(), self.width());
        let mut at = 0;
        for (k, (ball, length)) in self.balls.iter().zip(&node.lengths).enumerate() {
            for i in ball.surfaces.clone() {
                let s = node.selectors[i];
                rows.view_mut((at, 0), (1, states)).copy_from(&(normals.by_state.row(i) / self.h));
                rows[(at, states + at)] = -length / self.h;
                rows[(at, states + count + k)] = -s / self.h;
                residual[at] = (normals.psi[i] - length * s) / self.h;
                rows[(count + k, states + at)] = s;
                residual[count + k] += 0.5 * s * s;
                at += 1;
            }
            residual[count + k] -= 0.5;
        }
        for (at, &i) in (at..).zip(&self.sliding) {
            let gradient = normals.by_state.row(i);
            // Second derivatives of psi are left out: that only slows the convergence down.
            rows.view_mut((at, 0), (1, states)).copy_from(&(gradient * &slope.by_state));
            rows.view_mut((at, states), (1, count)).copy_from(&(gradient * &slope.by_selector));
            residual[at] = normals.rate(i, &slope.rate);
        }
        (residual, rows)
    }

    /// A step of Newton's method; its size in units of the tolerance.
    fn subtract(&self, change: &DVector<f64>, nodes: &mut [Node]) -> f64 {
        let mut largest: f64 = 0.0;
        for (j, node) in nodes.iter_mut().enumerate() {
            let mut change = change.rows(j * self.width(), self.width()).into_iter();
            let before = node.added.clone();
            node.added.iter_mut().zip(&mut change).for_each(|(value, change)| *value -= change);
            self.unknown
                .iter()
                .zip(&mut change)
                .for_each(|(&at, change)| node.selectors[at] -= change);
            node.lengths.iter_mut().zip(&mut change).for_each(|(value, change)| *value -= change);
            let size = self.field.tolerance.error(self.x, &before, &node.added, self.h);
            largest = if size.is_nan() { f64::NAN } else { largest.max(size) };
        }
        largest
    }
}

fn sum(x: &[f64], added: &[f64]) -> Vec<f64> {
    x.iter().zip(added).map(|(x, added)| x + added).collect()
}

/// `a_ij`, which integrates polynomials exactly: `sum_j a_ij c_j^(q-1) = c_i^q / q`.
pub(crate) fn weights(times: &[f64]) -> DMatrix<f64> {
    let size = times.len();
    let powers = DMatrix::from_fn(size, size, |j, q| times[j].powi(q as i32));
    let integrals =
        DMatrix::from_fn(size, size, |i, q| times[i].powi(q as i32 + 1) / (q + 1) as f64);
    integrals * powers.try_inverse().expect("the times differ")
}

/// What is added to the start inside the step: the polynomial through the start and the points.
fn interpolated(nodes: &[Node], theta: f64) -> Vec<f64> {
    let others = |j: usize| FINE.iter().enumerate().filter(move |(i, _)| *i != j).map(|(_, c)| *c);
    let factor = |j: usize| {
        others(j).fold(theta / FINE[j], |product, c| product * (theta - c) / (FINE[j] - c))
    };
    let factors: Vec<f64> = (0..nodes.len()).map(factor).collect();
    let total = |state: usize| {
        nodes.iter().zip(&factors).map(|(node, factor)| factor * node.added[state]).sum()
    };
    (0..nodes[0].added.len()).map(total).collect()
}
