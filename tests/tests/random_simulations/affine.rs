//! Random systems that are affine on each side of their surfaces:
//!
//! ```text
//! x' = A x + a + sum_i s_i (A_i x + b_i),   s_i in Sgn(psi_i)
//! psi_i = c_i x + e_i t - d_i,              c_i b_j = -D_ij
//! ```
//!
//! `D` decides what the surfaces do, with the `A_i` where they are not 0: where it is a P-matrix
//! the solution is unique. It need not be one, and need not remain one.

use fdcc_tests::random::Random;
use std::fmt::Write;

pub const LAST: f64 = 4.0;

pub type Matrix = Vec<Vec<f64>>;

/// A system; everything acts on `y = (x, t, 1)`.
pub struct Affine {
    /// `y` at the first time.
    pub start: Vec<f64>,
    /// `A` and `a`.
    pub drift: Matrix,
    /// `A_i` and `b_i` of each surface.
    pub push: Vec<Matrix>,
    /// One row for each surface: `psi`.
    pub normal: Matrix,
    /// The surfaces that the start is on.
    pub begins_on: Vec<usize>,
}

pub fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// Solves `matrix z = right` for several right sides, by elimination with pivots; none if a pivot
/// is small.
pub fn solve(mut matrix: Matrix, mut right: Matrix) -> Option<Matrix> {
    let size = matrix.len();
    for at in 0..size {
        let pivot =
            (at..size).max_by(|&i, &j| matrix[i][at].abs().total_cmp(&matrix[j][at].abs()))?;
        matrix.swap(at, pivot);
        right.swap(at, pivot);
        if matrix[at][at].abs() < 1e-3 {
            return None;
        }
        for row in (0..size).filter(|&row| row != at) {
            let factor = matrix[row][at] / matrix[at][at];
            for of in [&mut matrix, &mut right] {
                let above = of[at].clone();
                of[row].iter_mut().zip(above).for_each(|(entry, above)| *entry -= factor * above);
            }
        }
    }
    right
        .iter_mut()
        .enumerate()
        .for_each(|(i, row)| row.iter_mut().for_each(|entry| *entry /= matrix[i][i]));
    Some(right)
}

fn table(rows: usize, columns: usize, mut entry: impl FnMut(usize, usize) -> f64) -> Matrix {
    (0..rows).map(|i| (0..columns).map(|j| entry(i, j)).collect()).collect()
}

/// `sum_i weight_i row_i`.
fn combined(rows: &[Vec<f64>], weights: &[f64]) -> Vec<f64> {
    (0..rows[0].len())
        .map(|at| rows.iter().zip(weights).map(|(row, weight)| weight * row[at]).sum())
        .collect()
}

/// The shortest `x` with `rows x = right`, for several right sides.
fn shortest(rows: &[Vec<f64>], right: Matrix) -> Option<Matrix> {
    let weights = solve(table(rows.len(), rows.len(), |i, j| dot(&rows[i], &rows[j])), right)?;
    Some(
        (0..weights[0].len())
            .map(|k| combined(rows, &weights.iter().map(|row| row[k]).collect::<Vec<_>>()))
            .collect(),
    )
}

/// `D`: from one that makes every surface attract by itself to one that may do anything.
fn random_attraction(random: &mut Random, surfaces: usize) -> Matrix {
    let beside = [0.4 / surfaces as f64, 1.0, 3.0][random.below(3)];
    let least = [0.5, -1.0][random.below(2)];
    table(surfaces, surfaces, |i, j| {
        if i == j { random.between(least, 2.0) } else { random.between(-beside, beside) }
    })
}

impl Affine {
    /// A system with so many surfaces; none if they are nearly parallel.
    pub fn new(random: &mut Random, surfaces: usize) -> Option<Self> {
        let size = surfaces + random.below(3);
        let rows = table(surfaces, size, |_, _| random.between(-1.0, 1.0));
        let ahead = table(surfaces, size, |_, _| random.between(-0.5, 0.5));
        let d = random_attraction(random, surfaces);
        let missing = table(surfaces, surfaces, |i, j| -d[i][j] - dot(&rows[i], &ahead[j]));
        let push = shortest(&rows, missing)?;
        let slope = [0.0, 0.4][random.below(2)];
        let mut push_of = |k: usize| {
            table(size, size + 2, |i, j| match j {
                _ if j < size => random.between(-slope, slope),
                _ if j == size => 0.0,
                _ => ahead[k][i] + push[k][i],
            })
        };
        let push = (0..surfaces).map(&mut push_of).collect();
        let drift = table(size, size + 2, |i, j| match j {
            _ if j == i => random.between(-1.5, 0.0),
            _ if j == size => 0.0,
            _ => random.between(-1.0, 1.0),
        });
        let normal = rows.iter().map(|row| {
            let moves = if random.below(2) == 0 { random.between(-0.5, 0.5) } else { 0.0 };
            row.iter().copied().chain([moves, random.between(-0.5, 0.5)]).collect()
        });
        let normal: Matrix = normal.collect();
        let begins_on: Vec<usize> = (0..surfaces).filter(|_| random.below(2) == 0).collect();
        let mut start: Vec<f64> = (0..size).map(|_| random.between(-1.0, 1.0)).collect();
        // The second time takes off what rounding left of the first.
        for _ in 0..if begins_on.is_empty() { 0 } else { 2 } {
            let on: Matrix = begins_on.iter().map(|&i| rows[i].clone()).collect();
            let away = begins_on
                .iter()
                .map(|&i| vec![-dot(&rows[i], &start) - normal[i][size + 1]])
                .collect();
            start.iter_mut().zip(&shortest(&on, away)?[0]).for_each(|(x, by)| *x += by);
        }
        start.extend([0.0, 1.0]);
        Some(Affine { start, drift, push, normal, begins_on })
    }

    /// How some surfaces attract, themselves and each other: `-c_i (A_j x + b_j)`.
    pub fn attraction(&self, y: &[f64], of: &[usize]) -> Matrix {
        let pushed = |i: usize, j: usize| -> f64 {
            self.normal[i].iter().zip(&self.push[j]).map(|(c, row)| c * dot(row, y)).sum()
        };
        of.iter().map(|&i| of.iter().map(|&j| -pushed(i, j)).collect()).collect()
    }

    /// The number of states.
    pub fn size(&self) -> usize {
        self.drift.len()
    }

    /// The model.
    pub fn text(&self) -> String {
        let names = |row: &[f64]| -> String {
            let of = |(j, a): (usize, &f64)| {
                if j < self.size() { format!("({a})*x{j} + ") } else { format!("({a})*t + ") }
            };
            let (constant, others) = row.split_last().expect("y ends with 1");
            let terms = others.iter().enumerate().filter(|(_, a)| **a != 0.0).map(of);
            terms.collect::<String>() + &format!("({constant})")
        };
        let mut text = format!("time t in [0, {LAST}]\n");
        let mut equations = String::new();
        for (i, row) in self.drift.iter().enumerate() {
            writeln!(text, "state x{i} start {}", self.start[i]).expect("text");
            write!(equations, "x{i}' in {}", names(row)).expect("text");
            for (k, push) in self.push.iter().enumerate() {
                write!(equations, " + ({})*Sgn(p{k})", names(&push[i])).expect("text");
            }
            equations.push('\n');
        }
        for (k, row) in self.normal.iter().enumerate() {
            writeln!(text, "surface p{k} = {}", names(row)).expect("text");
        }
        format!("{text}dynamics {{\n{equations}}}\n")
    }
}
