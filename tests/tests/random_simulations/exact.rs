//! The solution of an affine system, mode by mode, from rounding errors alone.
//!
//! In a mode `y' = M y`, so `y(t + h) = sum_k (h M)^k y / k!`, and every condition that ends the mode is a row `w y >= 0`. At an
//! event all 3^k combinations of sides are tried. What no program could tell reliably (a root that is nearly double, two
//! events at nearly one time, a rate that is nearly 0) is given up as delicate. Surfaces that hold each other without a P-matrix
//! are no unique continuation: solutions may leave on spirals, which no combination of sides describes.

use crate::affine::{Affine, LAST, Matrix, dot, solve};
use fdcc_runtime::simulate::Kind;

/// A step of the search for events.
const STEP: f64 = 0.02;

/// What is closer to 0 is delicate.
const NEAR: f64 = 1e-4;

/// More events than this are no fair question.
const MOST: usize = 60;

pub enum Ending {
    Completed,
    /// None or several combinations of sides are consistent, or the only one does not attract.
    NotUnique(Vec<Vec<(usize, i8)>>),
    Delicate,
}

/// When, at which surface, what.
pub type Event = (f64, usize, Kind);

pub struct Exact {
    pub events: Vec<Event>,
    pub ending: Ending,
    /// `y` where it ended.
    pub end: Vec<f64>,
    /// The most surfaces that were held at once.
    pub most_held: usize,
}

/// A mode: `M`, and the selector of each surface as a row over `y`.
struct Flow {
    matrix: Matrix,
    selectors: Matrix,
}

impl Flow {
    /// The flow with these sides; none if they do not determine the selectors.
    fn new(system: &Affine, sides: &[i8]) -> Option<Self> {
        let width = system.size() + 2;
        let mut matrix = system.drift.clone();
        matrix.extend([vec![0.0; width], vec![0.0; width]]);
        matrix[width - 2][width - 1] = 1.0;
        let mut selectors = vec![vec![0.0; width]; sides.len()];
        for (i, &side) in sides.iter().enumerate() {
            selectors[i][width - 1] = f64::from(side);
            (0..width - 2).for_each(|at| matrix[at][width - 1] += f64::from(side) * system.push[i][at]);
        }
        let held: Vec<usize> = (0..sides.len()).filter(|&i| sides[i] == 0).collect();
        let rate = |i: usize| -> Vec<f64> {
            (0..width).map(|j| (0..width).map(|at| system.normal[i][at] * matrix[at][j]).sum()).collect()
        };
        let by =
            held.iter().map(|&i| held.iter().map(|&j| -dot(&system.normal[i], &system.push[j])).collect());
        let found = solve(by.collect(), held.iter().map(|&i| rate(i)).collect())?;
        for (&i, row) in held.iter().zip(found) {
            for (at, entries) in matrix.iter_mut().take(width - 2).enumerate() {
                entries.iter_mut().zip(&row).for_each(|(entry, s)| *entry += system.push[i][at] * s);
            }
            selectors[i] = row;
        }
        Some(Flow { matrix, selectors })
    }

    fn rate(&self, y: &[f64]) -> Vec<f64> {
        self.matrix.iter().map(|row| dot(row, y)).collect()
    }

    fn after(&self, y: &[f64], h: f64) -> Vec<f64> {
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

    /// Between two times within a step, where a row over `y` changes from the sign that it has at `low`.
    fn root(&self, y: &[f64], row: &[f64], mut low: f64, mut high: f64) -> f64 {
        let sign = dot(row, &self.after(y, low)).signum();
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            if dot(row, &self.after(y, middle)) * sign > 0.0 { low = middle } else { high = middle }
        }
        high
    }

    /// The row whose value is the derivative of another.
    fn derivative(&self, row: &[f64]) -> Vec<f64> {
        (0..row.len())
            .map(|j| row.iter().zip(&self.matrix).map(|(w, entries)| w * entries[j]).sum())
            .collect()
    }

    /// Where in a step `row y` first becomes negative; an error if that is delicate.
    fn first(&self, y: &[f64], row: &[f64], h: f64) -> Result<Option<f64>, ()> {
        let slope = self.derivative(row);
        let end = self.after(y, h);
        let (at_start, at_end) = (dot(row, y), dot(row, &end));
        let turns = dot(&slope, y) * dot(&slope, &end) < 0.0;
        let extremum = if turns { self.root(y, &slope, 0.0, h) } else { h };
        let least = dot(row, &self.after(y, extremum));
        let is_new = at_start < 1e-12;
        let root = match (at_end < 0.0, turns, is_new) {
            (true, true, true) if least > 0.0 => self.root(y, row, extremum, h),
            (true, _, true) => return Err(()),
            (true, _, false) => self.root(y, row, 0.0, h),
            (false, true, false) if least < 0.0 => self.root(y, row, 0.0, extremum),
            (false, true, false) if least < NEAR => return Err(()),
            _ => return Ok(None),
        };
        let is_flat = dot(&slope, &self.after(y, root)).abs() < 10.0 * NEAR;
        if is_flat { Err(()) } else { Ok(Some(root)) }
    }
}

/// Whether all principal minors are positive: the first entry is, and so are those without it and those of its Schur complement.
fn is_p_matrix(matrix: &[Vec<f64>]) -> bool {
    let Some((first, rest)) = matrix.split_first() else { return true };
    let without: Matrix = rest.iter().map(|row| row[1..].to_vec()).collect();
    let reduced = |row: &Vec<f64>| (1..row.len()).map(|j| row[j] - row[0] / first[0] * first[j]).collect();
    first[0] > 0.0 && is_p_matrix(&without) && is_p_matrix(&rest.iter().map(reduced).collect::<Matrix>())
}

/// A system on its way.
struct Way<'a> {
    system: &'a Affine,
    y: Vec<f64>,
    sides: Vec<i8>,
    events: Vec<Event>,
    most_held: usize,
}

pub fn exact(system: &Affine) -> Exact {
    let sides = system.normal.iter().map(|row| dot(row, &system.start).signum() as i8).collect();
    let mut way = Way { system, y: system.start.clone(), sides, events: Vec::new(), most_held: 0 };
    let ending = way.follow().err().unwrap_or(Ending::Completed);
    Exact { events: way.events, ending, end: way.y, most_held: way.most_held }
}

impl Way<'_> {
    fn time(&self) -> f64 {
        self.y[self.y.len() - 2]
    }

    fn follow(&mut self) -> Result<(), Ending> {
        self.choose(&self.system.begins_on.clone(), true)?;
        while self.time() < LAST {
            let flow = Flow::new(self.system, &self.sides).ok_or(Ending::Delicate)?;
            let h = STEP.min(LAST - self.time());
            match self.first(&flow, h)? {
                Some((h, surface)) => {
                    self.y = flow.after(&self.y, h);
                    self.event(&flow, surface)?;
                }
                None if h < STEP => {
                    self.y = flow.after(&self.y, h);
                    return Ok(());
                }
                None => self.y = flow.after(&self.y, h),
            }
        }
        Ok(())
    }

    /// The rows that are positive while the mode lasts, with their surfaces.
    fn conditions(&self, flow: &Flow) -> Vec<(usize, Vec<f64>)> {
        let mut conditions = Vec::new();
        for (i, &side) in self.sides.iter().enumerate() {
            let times = |row: &[f64], by: f64| -> Vec<f64> { row.iter().map(|entry| by * entry).collect() };
            if side != 0 {
                conditions.push((i, times(&self.system.normal[i], f64::from(side))));
                continue;
            }
            for sign in [-1.0, 1.0] {
                let mut row = times(&flow.selectors[i], sign);
                *row.last_mut().expect("y ends with 1") += 1.0;
                conditions.push((i, row));
            }
        }
        conditions
    }

    /// The first event of a step.
    fn first(&self, flow: &Flow, h: f64) -> Result<Option<(f64, usize)>, Ending> {
        let mut found = Vec::new();
        for (surface, row) in self.conditions(flow) {
            let root = flow.first(&self.y, &row, h).map_err(|()| Ending::Delicate)?;
            found.extend(root.map(|root| (root, surface)));
        }
        found.sort_by(|a, b| a.0.total_cmp(&b.0));
        match found.as_slice() {
            [first, second, ..] if second.0 - first.0 < NEAR => Err(Ending::Delicate),
            found => Ok(found.first().copied()),
        }
    }

    fn event(&mut self, flow: &Flow, surface: usize) -> Result<(), Ending> {
        if self.events.len() > MOST {
            return Err(Ending::Delicate);
        }
        if self.sides[surface] == 0 {
            let side = dot(&flow.selectors[surface], &self.y).signum() as i8;
            self.change(surface, side, false);
            return Ok(());
        }
        let here: Vec<usize> =
            (0..self.sides.len()).filter(|&i| self.sides[i] == 0 || i == surface).collect();
        self.choose(&here, false)
    }

    fn change(&mut self, surface: usize, side: i8, is_start: bool) {
        let before = std::mem::replace(&mut self.sides[surface], side);
        let kind = match (before, side) {
            _ if is_start && side == 0 => Kind::StartsSliding,
            _ if is_start || before == side => return,
            (_, 0) => Kind::EntersSliding,
            (0, 1) => Kind::LeavesUp,
            (0, _) => Kind::LeavesDown,
            (_, 1) => Kind::CrossesUp,
            _ => Kind::CrossesDown,
        };
        self.events.push((self.time(), surface, kind));
        self.most_held = self.most_held.max(self.sides.iter().filter(|side| **side == 0).count());
    }

    /// Takes the only consistent sides of the surfaces that the state is on.
    fn choose(&mut self, here: &[usize], is_start: bool) -> Result<(), Ending> {
        let mut found = Vec::new();
        for number in 0..3_usize.pow(here.len() as u32) {
            let mut sides = self.sides.clone();
            here.iter()
                .enumerate()
                .for_each(|(at, &i)| sides[i] = (number / 3_usize.pow(at as u32) % 3) as i8 - 1);
            let margin = self.margin(here, &sides);
            if margin.abs() < NEAR {
                return Err(Ending::Delicate);
            }
            if margin > 0.0 {
                found.push(here.iter().map(|&i| (i, sides[i])).collect::<Vec<_>>());
            }
        }
        let [only] = found.as_slice() else { return Err(Ending::NotUnique(found)) };
        let held: Vec<usize> = only.iter().filter(|(_, side)| *side == 0).map(|(i, _)| *i).collect();
        if !is_p_matrix(&self.system.attraction(&held)) {
            return Err(Ending::NotUnique(found));
        }
        only.iter().for_each(|&(i, side)| self.change(i, side, is_start));
        Ok(())
    }

    /// By how much sides are consistent: `1 - |s|` where held, the rate away from the surface elsewhere.
    fn margin(&self, here: &[usize], sides: &[i8]) -> f64 {
        let Some(flow) = Flow::new(self.system, sides) else { return -1.0 };
        let rate = flow.rate(&self.y);
        let margin = |&i: &usize| match sides[i] {
            0 => 1.0 - dot(&flow.selectors[i], &self.y).abs(),
            side => f64::from(side) * dot(&self.system.normal[i], &rate),
        };
        here.iter().map(margin).fold(f64::INFINITY, f64::min)
    }
}
