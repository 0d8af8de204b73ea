//! The selectors of sliding surfaces during a part of a step, by the interval Newton method.
//!
//! ```text
//! r(s) = 0:   s_i in s0_i - (r_i(s0) + sum_{j != i} R_ij (S_j - s0_j)) / R_ii
//! r' = 0:     R s' = -(r_t + r_x x' + r_u u'),   R = dr/ds over S = [-1, 1]^k
//! ```
//!
//! Both after multiplication by the inverse of the middle of `R`. R. E. Moore, R. B. Kearfott,
//! M. J. Cloud: Introduction to Interval Analysis, SIAM 2009, chapter 8. Where a state stands still
//! or a `Dir` moves, a few values stand in for intervals.

use super::search::Signal;
use crate::simulate::bernstein::{slopes, through};
use crate::simulate::interval::{ALL, around, both, length, minus, plus, quotient, scaled, times};
use crate::simulate::system::Interval;
use nalgebra::DMatrix;

/// `M s = b` with a matrix near the unit matrix.
struct Nearly {
    matrix: Vec<Vec<Interval>>,
    /// Inverse of the middle of the matrix before.
    inverse: DMatrix<f64>,
}

/// `1 - |s|` of a sliding surface, or of the ball at rest that it begins, and its rate.
pub(crate) fn bounds(of: &mut Signal, part: [f64; 2], surface: usize) -> [Interval; 2] {
    let is_plain = of.field.held.is_empty() && of.field.moving().is_empty();
    let enclosed = if is_plain { enclosed(of, part, surface) } else { None };
    enclosed.unwrap_or_else(|| estimated(of, part))
}

/// From a few values, as if they were those of a polynomial, with as much beside it: a parabola, or
/// of the degree of the controls.
fn estimated(of: &mut Signal, [from, to]: [f64; 2]) -> [Interval; 2] {
    let degree = of.field.curve.as_ref().map_or(2, |curve| curve.degree().max(2));
    let nodes: Vec<f64> = (0..=degree).map(|k| k as f64 / degree as f64).collect();
    let values: Vec<f64> = nodes.iter().map(|node| of.value(from + node * (to - from))).collect();
    let bend = highest_difference(values.clone());
    let coefficients = through(&nodes, &values);
    let beside = |range: &[f64]| plus(around(range), [-bend, bend]);
    [beside(&coefficients), scaled(1.0 / (to - from), beside(&slopes(&coefficients)))]
}

fn highest_difference(mut values: Vec<f64>) -> f64 {
    while values.len() > 1 {
        values = values.windows(2).map(|pair| pair[1] - pair[0]).collect();
    }
    values[0].abs()
}

fn enclosed(of: &mut Signal, part: [f64; 2], surface: usize) -> Option<[Interval; 2]> {
    let sliding = of.field.sliding();
    let middle = 0.5 * (part[0] + part[1]);
    of.field.rate(of.step.t + middle * of.step.h, &of.step.at(middle));
    let start: Vec<f64> = sliding.iter().map(|&i| of.field.selectors[i]).collect();
    if !start.iter().all(|s| s.is_finite()) {
        return None;
    }
    let (system, values) = linearised(of, part, &sliding, &start)?;
    let selectors = system.selectors(&values, &start);
    let own = match of.field.ball_of(surface) {
        Some(ball) => ball.surfaces.clone(),
        None => surface..surface + 1,
    };
    let own: Vec<usize> = (0..sliding.len()).filter(|&at| own.contains(&sliding[at])).collect();
    let size = length(own.iter().map(|&at| selectors[at]));
    if size[1] <= 1.0 {
        return Some([minus([1.0; 2], size), ALL]);
    }
    let speeds = speeds(of, part, &sliding, &selectors, &system);
    let along = own.iter().map(|&at| times(selectors[at], speeds[at])).fold([0.0; 2], plus);
    Some([minus([1.0; 2], size), scaled(-1.0, quotient(along, size))])
}

/// The rates of the surfaces at some selectors, and how they depend on them.
fn linearised(
    of: &mut Signal,
    part: [f64; 2],
    sliding: &[usize],
    start: &[f64],
) -> Option<(Nearly, Vec<Interval>)> {
    let field = &*of.field;
    let first = field.system.layout.selectors().start;
    let (mut values, mut slopes) = (Vec::new(), Vec::new());
    for &row in sliding {
        let rate = &field.system.enclosures.rates[row];
        of.tube.go_to(field, of.step, part, rate);
        sliding.iter().zip(start).for_each(|(i, s)| of.tube.inputs[first + i] = [*s; 2]);
        of.tube.evaluate(rate);
        values.push(of.tube.ranges[0]);
        if !rate.is_affine {
            sliding.iter().for_each(|i| of.tube.inputs[first + i] = [-1.0, 1.0]);
            of.tube.evaluate(rate);
        }
        let by = |i: &usize| rate.by.iter().position(|input| *input == first + i);
        let slope = |i: &usize| by(i).map_or([0.0; 2], |at| of.tube.ranges[1 + at]);
        slopes.push(sliding.iter().map(slope).collect::<Vec<_>>());
    }
    let size = sliding.len();
    let middle = DMatrix::from_fn(size, size, |i, j| 0.5 * (slopes[i][j][0] + slopes[i][j][1]));
    let inverse = middle.try_inverse().filter(|it| it.iter().all(|entry| entry.is_finite()))?;
    let column = |j: usize| slopes.iter().map(|row| row[j]).collect::<Vec<_>>();
    let columns: Vec<Vec<Interval>> =
        (0..size).map(|j| preconditioned(&inverse, &column(j))).collect();
    let matrix = (0..size).map(|i| columns.iter().map(|column| column[i]).collect()).collect();
    let values = preconditioned(&inverse, &values);
    Some((Nearly { matrix, inverse }, values))
}

fn preconditioned(inverse: &DMatrix<f64>, column: &[Interval]) -> Vec<Interval> {
    let entry = |i: usize| {
        let terms = column.iter().enumerate().map(|(j, value)| scaled(inverse[(i, j)], *value));
        terms.fold([0.0; 2], plus)
    };
    (0..column.len()).map(entry).collect()
}

impl Nearly {
    /// All solutions in [-1, 1] of each unknown while the others are there; anywhere where that
    /// cannot be told.
    fn selectors(&self, values: &[Interval], start: &[f64]) -> Vec<Interval> {
        let size = start.len();
        let mut inside = vec![[-1.0, 1.0]; size];
        let mut found = inside.clone();
        for _ in 0..2 {
            for i in 0..size {
                let others = (0..size).filter(|j| *j != i);
                let terms =
                    others.map(|j| times(self.matrix[i][j], minus(inside[j], [start[j]; 2])));
                let sum = terms.fold(values[i], plus);
                found[i] = minus([start[i]; 2], quotient(sum, self.matrix[i][i]));
                inside[i] = both(found[i], inside[i]);
            }
        }
        found
    }

    /// All solutions of `M s = b`.
    fn solutions(&self, right: &[Interval]) -> Vec<Interval> {
        let size = right.len();
        let distance = |i: usize| -> f64 {
            let entry = |j: usize| minus(self.matrix[i][j], [f64::from(u8::from(i == j)); 2]);
            (0..size).map(|j| entry(j)[0].abs().max(entry(j)[1].abs())).sum()
        };
        let distance = (0..size).map(distance).fold(0.0, f64::max);
        let largest = right.iter().flatten().fold(0.0_f64, |most, end| most.max(end.abs()));
        if distance.is_nan() || distance >= 1.0 {
            return vec![ALL; size];
        }
        let beside = distance / (1.0 - distance) * largest;
        right.iter().map(|it| plus(*it, [-beside, beside])).collect()
    }
}

/// How fast the selectors change.
fn speeds(
    of: &mut Signal,
    part: [f64; 2],
    sliding: &[usize],
    selectors: &[Interval],
    system: &Nearly,
) -> Vec<Interval> {
    let field = &*of.field;
    let first = field.system.layout.selectors().start;
    let inside = sliding.iter().zip(selectors);
    inside.for_each(|(i, s)| of.tube.inputs[first + i] = both(*s, [-1.0, 1.0]));
    let accelerations = &field.system.enclosures.accelerations;
    let mut right = Vec::new();
    for &row in sliding {
        right.push(scaled(-1.0, of.tube.bounds(field, of.step, part, &accelerations[row])[1]));
    }
    system.solutions(&preconditioned(&system.inverse, &right))
}
