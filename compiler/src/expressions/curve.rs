//! Curves through tables of numbers, as choices between polynomials.
//!
//! Outside the table a curve has the value at the end. The natural cubic spline (de Boor, A
//! Practical Guide to Splines, chapter IV) has two continuous derivatives between the ends and
//! second derivatives of 0 at them.

use super::graph::{ExprId, Graph};

/// How a curve goes from point to point.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Shape {
    /// Straight.
    Linear,
    /// As the natural cubic spline.
    Cubic,
}

/// The curve through `(times[i], values[i])`, at a place; the times ascend.
pub(crate) fn curve(
    graph: &mut Graph,
    shape: Shape,
    times: &[f64],
    values: &[f64],
    at: ExprId,
) -> ExprId {
    let second = match shape {
        Shape::Linear => vec![0.0; times.len()],
        Shape::Cubic => second_derivatives(times, values),
    };
    let mut pieces = vec![graph.number(values[0])];
    for i in 1..times.len() {
        pieces.push(piece(graph, [i - 1, i], times, values, &second, at));
    }
    pieces.push(graph.number(values[values.len() - 1]));
    chosen(graph, times, &pieces, at)
}

/// The broken line through values at 0, 1, 2, ...; it goes on beyond its ends.
pub(crate) fn broken_line(graph: &mut Graph, values: &[ExprId], at: ExprId) -> ExprId {
    let mut pieces = Vec::new();
    for (begin, pair) in values.windows(2).enumerate() {
        let (change, begin) = (graph.sub(pair[1], pair[0]), graph.number(begin as f64));
        let way = graph.sub(at, begin);
        let part = graph.mul(change, way);
        pieces.push(graph.add(pair[0], part));
    }
    let borders: Vec<f64> = (1..pieces.len()).map(|it| it as f64).collect();
    chosen(graph, &borders, &pieces, at)
}

/// The polynomial between two neighbours, over the way from the first of them.
fn piece(
    graph: &mut Graph,
    [i, j]: [usize; 2],
    times: &[f64],
    values: &[f64],
    second: &[f64],
    at: ExprId,
) -> ExprId {
    let h = times[j] - times[i];
    let slope = (values[j] - values[i]) / h - h * (2.0 * second[i] + second[j]) / 6.0;
    let coefficients = [values[i], slope, 0.5 * second[i], (second[j] - second[i]) / (6.0 * h)];
    let begin = graph.number(times[i]);
    let way = graph.sub(at, begin);
    let zero = graph.number(0.0);
    coefficients.into_iter().rev().fold(zero, |sum, coefficient| {
        let (coefficient, product) = (graph.number(coefficient), graph.mul(sum, way));
        graph.add(coefficient, product)
    })
}

/// Piece `i` where the place is at most `times[i]` and above the one before.
fn chosen(graph: &mut Graph, times: &[f64], pieces: &[ExprId], at: ExprId) -> ExprId {
    if times.is_empty() {
        return pieces[0];
    }
    let middle = times.len() / 2;
    let below = chosen(graph, &times[..middle], &pieces[..=middle], at);
    let above = chosen(graph, &times[middle + 1..], &pieces[middle + 1..], at);
    let border = graph.number(times[middle]);
    graph.select_le(at, border, below, above)
}

/// The second derivatives at the points: a tridiagonal system, solved from the first to the last.
fn second_derivatives(times: &[f64], values: &[f64]) -> Vec<f64> {
    let count = times.len();
    let mut second = vec![0.0; count];
    let mut factors = vec![0.0; count];
    for i in 1..count.saturating_sub(1) {
        let [before, after] = [times[i] - times[i - 1], times[i + 1] - times[i]];
        let bend = (values[i + 1] - values[i]) / after - (values[i] - values[i - 1]) / before;
        let pivot = 2.0 * (before + after) - before * factors[i - 1];
        factors[i] = after / pivot;
        second[i] = (6.0 * bend - before * second[i - 1]) / pivot;
    }
    for i in (1..count.saturating_sub(1)).rev() {
        second[i] -= factors[i] * second[i + 1];
    }
    second
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::expressions::graph::derivative::derivative;
    use crate::expressions::graph::evaluate;

    /// Value and two derivatives at a place.
    fn at(shape: Shape, times: &[f64], values: &[f64], place: f64) -> Vec<f64> {
        let mut graph = Graph::new();
        let t = graph.input(0);
        let value = curve(&mut graph, shape, times, values, t);
        let first = derivative(&mut graph, value, 0);
        let second = derivative(&mut graph, first, 0);
        evaluate(&graph, &[value, first, second], &[place], &[])
    }

    #[test]
    fn a_curve_goes_through_its_points_and_keeps_the_value_at_the_ends() {
        let (times, values) = ([0.0, 1.0, 3.0, 3.5, 7.0], [2.0, -1.0, 0.5, 4.0, 4.0]);
        for shape in [Shape::Linear, Shape::Cubic] {
            for (time, value) in times.iter().zip(values) {
                assert!((at(shape, &times, &values, *time)[0] - value).abs() < 1e-14);
            }
            assert_eq!(at(shape, &times, &values, -1.0), [2.0, 0.0, 0.0]);
            assert_eq!(at(shape, &times, &values, 9.0), [4.0, 0.0, 0.0]);
        }
        assert_eq!(at(Shape::Linear, &times, &values, 2.0)[0], -0.25);
    }

    /// Of the sine between its zeros, where its second derivative is 0, too, the error of the
    /// spline is at most `5/384 h^4`.
    #[test]
    fn a_spline_is_of_order_four_with_two_continuous_derivatives() {
        let count = 20;
        let h = std::f64::consts::PI / count as f64;
        let times: Vec<f64> = (0..=count).map(|i| i as f64 * h).collect();
        let values: Vec<f64> = times.iter().map(|t| t.sin()).collect();
        for i in 0..count {
            let place = (i as f64 + 0.5) * h;
            let error = at(Shape::Cubic, &times, &values, place)[0] - place.sin();
            assert!(error.abs() <= 5.0 / 384.0 * h.powi(4) + 1e-15, "{error:e}");
        }
        for time in &times[1..count] {
            let [left, right] =
                [-1e-9, 1e-9].map(|way| at(Shape::Cubic, &times, &values, time + way));
            (1..3).for_each(|order| assert!((left[order] - right[order]).abs() < 1e-7));
        }
    }
}
