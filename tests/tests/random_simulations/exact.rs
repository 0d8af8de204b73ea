//! The solution of an affine system, mode by mode, by means that are simple and slow.
//!
//! Where nothing is held `y' = M y`, so `y(t + h) = sum_k (h M)^k y / k!`; where something is, the classical Runge-Kutta method takes
//! short steps. At an event all 3^k combinations of sides are tried. What no program could tell reliably (a root that is nearly
//! double, two events at nearly one time, a rate that is nearly 0) is given up as delicate. Surfaces that hold each other without a
//! P-matrix are no unique continuation: solutions may leave on spirals, which no combination of sides describes.

use crate::affine::{Affine, LAST, Matrix, dot, solve};
use fdcc_runtime::simulate::Kind;

/// A step of the search for events.
const STEP: f64 = 0.02;

/// The shortest step of the Runge-Kutta method.
const SHORTEST: f64 = 1e-5;

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

/// What is positive while a mode lasts.
#[derive(Clone, Copy)]
enum Condition {
    /// `side psi`.
    Beside(usize, f64),
    /// `1 - sign s`.
    Within(usize, f64),
}

impl Condition {
    fn surface(self) -> usize {
        let (Condition::Beside(surface, _) | Condition::Within(surface, _)) = self;
        surface
    }
}

/// A mode.
struct Flow<'a> {
    system: &'a Affine,
    /// `M` without what is held.
    matrix: Matrix,
    sides: Vec<i8>,
    held: Vec<usize>,
}

impl<'a> Flow<'a> {
    fn new(system: &'a Affine, sides: &[i8]) -> Self {
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
        Flow { system, matrix, sides: sides.to_vec(), held }
    }

    /// The selectors of what is held; none if they are not determined.
    fn selectors(&self, y: &[f64]) -> Option<Vec<f64>> {
        let free: Vec<f64> = self.matrix.iter().map(|row| dot(row, y)).collect();
        let rates = self.held.iter().map(|&i| vec![dot(&self.system.normal[i], &free)]).collect();
        Some(solve(self.system.attraction(y, &self.held), rates)?.concat())
    }

    fn rate(&self, y: &[f64]) -> Vec<f64> {
        let mut rate: Vec<f64> = self.matrix.iter().map(|row| dot(row, y)).collect();
        let selectors = self.selectors(y).unwrap_or_else(|| vec![f64::NAN; self.held.len()]);
        for (&i, s) in self.held.iter().zip(selectors) {
            rate.iter_mut().zip(&self.system.push[i]).for_each(|(rate, row)| *rate += s * dot(row, y));
        }
        rate
    }

    fn after(&self, y: &[f64], h: f64) -> Vec<f64> {
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
        let moved =
            |by: f64, rate: &[f64]| -> Vec<f64> { y.iter().zip(rate).map(|(y, f)| y + by * f).collect() };
        let a = self.rate(y);
        let b = self.rate(&moved(0.5 * h, &a));
        let c = self.rate(&moved(0.5 * h, &b));
        let d = self.rate(&moved(h, &c));
        let mean: Vec<f64> = (0..y.len()).map(|i| (a[i] + 2.0 * (b[i] + c[i]) + d[i]) / 6.0).collect();
        moved(h, &mean)
    }

    fn value(&self, condition: Condition, y: &[f64]) -> f64 {
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

    /// Where in a step a condition first becomes negative; an error if that is delicate.
    fn first(&self, condition: Condition, y: &[f64], h: f64) -> Result<Option<f64>, ()> {
        let value = |h: f64| self.value(condition, &self.after(y, h));
        let slope = |h: f64| self.slope(condition, &self.after(y, h));
        let (at_start, at_end) = (self.value(condition, y), value(h));
        let turns = self.slope(condition, y) * slope(h) < 0.0;
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

/// Where a function changes its sign: the secant of the bracket, an end that stays counts half (the Illinois rule).
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
            let flow = Flow::new(self.system, &self.sides);
            let h = STEP.min(LAST - self.time());
            let event = self.first(&flow, h)?;
            // Beyond a singularity of the selectors nothing is known.
            if flow.after(&self.y, h).iter().any(|value| value.is_nan()) {
                return Err(Ending::Delicate);
            }
            if let Some(h) = self.attraction_ends(&flow, event.map_or(h, |(time, _)| time))? {
                self.y = flow.after(&self.y, h);
                return self.choose(&flow.held, false).and(Err(Ending::Delicate));
            }
            self.y = flow.after(&self.y, event.map_or(h, |(time, _)| time));
            match event {
                Some((_, surface)) => self.event(&flow, surface)?,
                None if h < STEP => return Ok(()),
                None => {}
            }
        }
        Ok(())
    }

    /// When in a step what is held ceases to attract.
    fn attraction_ends(&self, flow: &Flow, h: f64) -> Result<Option<f64>, Ending> {
        let attracts = |h: f64| is_p_matrix(&self.system.attraction(&flow.after(&self.y, h), &flow.held));
        if attracts(h) {
            return Ok(None);
        }
        let (mut low, mut high) = (0.0, h);
        for _ in 0..45 {
            let middle = 0.5 * (low + high);
            if attracts(middle) { low = middle } else { high = middle }
        }
        if h - high < NEAR { Err(Ending::Delicate) } else { Ok(Some(high)) }
    }

    /// What is positive while the mode lasts.
    fn conditions(&self) -> Vec<Condition> {
        let of = |(i, &side): (usize, &i8)| match side {
            0 => vec![Condition::Within(i, 1.0), Condition::Within(i, -1.0)],
            side => vec![Condition::Beside(i, f64::from(side))],
        };
        self.sides.iter().enumerate().flat_map(of).collect()
    }

    /// The first event of a step.
    fn first(&self, flow: &Flow, h: f64) -> Result<Option<(f64, usize)>, Ending> {
        let mut found = Vec::new();
        for condition in self.conditions() {
            let root = flow.first(condition, &self.y, h).map_err(|()| Ending::Delicate)?;
            found.extend(root.map(|root| (root, condition.surface())));
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
            let side = if flow.value(Condition::Within(surface, 1.0), &self.y) < 1.0 { 1 } else { -1 };
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
        if !is_p_matrix(&self.system.attraction(&self.y, &held)) {
            return Err(Ending::NotUnique(found));
        }
        only.iter().for_each(|&(i, side)| self.change(i, side, is_start));
        Ok(())
    }

    /// By how much sides are consistent: `1 - |s|` where held, the rate away from the surface elsewhere.
    fn margin(&self, here: &[usize], sides: &[i8]) -> f64 {
        let flow = Flow::new(self.system, sides);
        let Some(selectors) = flow.selectors(&self.y) else { return -1.0 };
        let rate = flow.rate(&self.y);
        let within = selectors.iter().map(|s| 1.0 - s.abs());
        let beside = here.iter().filter(|&&i| sides[i] != 0);
        let away = beside.map(|&i| f64::from(sides[i]) * dot(&self.system.normal[i], &rate));
        within.chain(away).fold(f64::INFINITY, f64::min)
    }
}
