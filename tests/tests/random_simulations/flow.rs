//! A mode of an affine system, followed by means that are simple and slow.
//!
//! Where nothing is held `y' = M y`, so `y(t + h) = sum_k (h M)^k y / k!`; where something is, the
//! classical Runge-Kutta method takes steps as short as it must.

use super::affine::{Affine, Matrix, dot, solve};

/// The shortest step of the Runge-Kutta method.
const SHORTEST: f64 = 1e-5;

/// What is closer to 0 is delicate.
pub const NEAR: f64 = 1e-4;

/// What is positive while a mode lasts.
#[derive(Clone, Copy)]
pub enum Condition {
    /// `side psi`.
    Beside(usize, f64),
    /// `1 - sign s`.
    Within(usize, f64),
}

impl Condition {
    /// Whose it is.
    pub fn surface(self) -> usize {
        let (Condition::Beside(surface, _) | Condition::Within(surface, _)) = self;
        surface
    }
}

/// A mode.
pub struct Flow<'a> {
    system: &'a Affine,
    /// `M` without what is held.
    matrix: Matrix,
    pub held: Vec<usize>,
}

impl<'a> Flow<'a> {
    pub fn new(system: &'a Affine, sides: &[i8]) -> Self {
        let width = system.size() + 2;
        let mut matrix = system.drift.clone();
        for (push, side) in system.push.iter().zip(sides) {
            for (row, by) in matrix.iter_mut().zip(push) {
                row.iter_mut().zip(by).for_each(|(entry, by)| *entry += f64::from(*side) * by);
            }
        }
        matrix.extend([vec![0.0; width], vec![0.0; width]]);
        matrix[width - 2][width - 1] = 1.0;
        let held = (0..sides.len()).filter(|&i| sides[i] == 0).collect();
        Flow { system, matrix, held }
    }

    /// The selectors of what is held; none if they are not determined.
    pub fn selectors(&self, y: &[f64]) -> Option<Vec<f64>> {
        let free: Vec<f64> = self.matrix.iter().map(|row| dot(row, y)).collect();
        let rates = self.held.iter().map(|&i| vec![dot(&self.system.normal[i], &free)]).collect();
        Some(solve(self.system.attraction(y, &self.held), rates)?.concat())
    }

    pub fn rate(&self, y: &[f64]) -> Vec<f64> {
        let mut rate: Vec<f64> = self.matrix.iter().map(|row| dot(row, y)).collect();
        let selectors = self.selectors(y).unwrap_or_else(|| vec![f64::NAN; self.held.len()]);
        for (&i, s) in self.held.iter().zip(selectors) {
            rate.iter_mut()
                .zip(&self.system.push[i])
                .for_each(|(rate, row)| *rate += s * dot(row, y));
        }
        rate
    }

    pub fn after(&self, y: &[f64], h: f64) -> Vec<f64> {
        if self.held.is_empty() {
            return self.series(y, h);
        }
        let whole = self.runge_kutta(y, h);
        let halves = self.runge_kutta(&self.runge_kutta(y, 0.5 * h), 0.5 * h);
        let differs = |(a, b): (&f64, &f64)| (a - b).abs() > 1e-11;
        if h > SHORTEST && whole.iter().zip(&halves).any(differs) {
            return self.after(&self.after(y, 0.5 * h), 0.5 * h);
        }
        whole.iter().zip(&halves).map(|(whole, halves)| halves + (halves - whole) / 15.0).collect()
    }

    fn series(&self, y: &[f64], h: f64) -> Vec<f64> {
        let (mut sum, mut term) = (y.to_vec(), y.to_vec());
        for k in 1..40 {
            term = self.rate(&term).iter().map(|value| value * h / f64::from(k)).collect();
            sum.iter_mut().zip(&term).for_each(|(sum, term)| *sum += term);
            if term.iter().all(|value| value.abs() < 1e-18) {
                break;
            }
        }
        sum
    }

    fn runge_kutta(&self, y: &[f64], h: f64) -> Vec<f64> {
        let moved = |by: f64, rate: &[f64]| -> Vec<f64> {
            y.iter().zip(rate).map(|(y, f)| y + by * f).collect()
        };
        let a = self.rate(y);
        let b = self.rate(&moved(0.5 * h, &a));
        let c = self.rate(&moved(0.5 * h, &b));
        let d = self.rate(&moved(h, &c));
        let mean: Vec<f64> =
            (0..y.len()).map(|i| (a[i] + 2.0 * (b[i] + c[i]) + d[i]) / 6.0).collect();
        moved(h, &mean)
    }

    pub fn value(&self, condition: Condition, y: &[f64]) -> f64 {
        match condition {
            Condition::Beside(i, side) => side * dot(&self.system.normal[i], y),
            Condition::Within(i, sign) => {
                let at = self.held.iter().position(|&held| held == i).expect("the surface is held");
                self.selectors(y).map_or(f64::NAN, |s| 1.0 - sign * s[at])
            }
        }
    }

    fn slope(&self, condition: Condition, y: &[f64]) -> f64 {
        match condition {
            Condition::Beside(i, side) => side * dot(&self.system.normal[i], &self.rate(y)),
            Condition::Within(..) => {
                let by = 1e-4;
                let at = |h: f64| self.value(condition, &self.runge_kutta(y, h));
                (at(by) - at(-by)) / (2.0 * by)
            }
        }
    }

    /// Where in a step to `end` a condition first becomes negative; an error if that is delicate.
    pub fn first(
        &self,
        condition: Condition,
        y: &[f64],
        end: &[f64],
        h: f64,
    ) -> Result<Option<f64>, ()> {
        let value = |h: f64| self.value(condition, &self.after(y, h));
        let slope = |h: f64| self.slope(condition, &self.after(y, h));
        let (at_start, at_end) = (self.value(condition, y), self.value(condition, end));
        let turns = self.slope(condition, y) * self.slope(condition, end) < 0.0;
        let extremum = if turns { root(&slope, 0.0, h) } else { h };
        let least = if turns { value(extremum) } else { at_end };
        let is_new = at_start < 1e-9;
        let root = match (at_end < 0.0, turns, is_new) {
            (true, true, true) if least > 0.0 => root(&value, extremum, h),
            (true, _, true) => return Err(()),
            (true, _, false) => root(&value, 0.0, h),
            (false, true, false) if least < 0.0 => root(&value, 0.0, extremum),
            (false, true, false) if least < NEAR => return Err(()),
            _ => return Ok(None),
        };
        if slope(root).abs() < 10.0 * NEAR { Err(()) } else { Ok(Some(root)) }
    }
}

/// Where a function changes its sign: the secant of the bracket, an end that stays counts half (the
/// Illinois rule).
fn root(f: &dyn Fn(f64) -> f64, mut low: f64, mut high: f64) -> f64 {
    let (mut at_low, mut at_high) = (f(low), f(high));
    for _ in 0..60 {
        let middle = high - at_high * (high - low) / (at_high - at_low);
        let at_middle = f(middle);
        if at_middle.abs() < 1e-15 || high - low < 1e-14 {
            return middle;
        }
        if at_middle * at_high > 0.0 {
            (high, at_high, at_low) = (middle, at_middle, 0.5 * at_low);
        } else {
            (low, at_low, at_high) = (middle, at_middle, 0.5 * at_high);
        }
    }
    high
}
