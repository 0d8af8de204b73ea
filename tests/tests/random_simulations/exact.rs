//! The solution of an affine system from event to event.
//!
//! At an event all 3^k combinations of sides are tried. What no program could tell reliably (a root
//! that is nearly double, two events at nearly one time, a rate that is nearly 0) is given up as
//! delicate. Surfaces that hold each other without a P-matrix are no unique continuation: solutions
//! may leave on spirals, which no combination of sides describes.

use super::affine::{Affine, LAST, Matrix, dot};
use super::flow::{Condition, Flow, NEAR};
use fdcc_runtime::simulate::EventKind;

/// A step of the search for events.
const STEP: f64 = 0.04;

/// More events than this are no fair question.
const MOST: usize = 60;

pub enum Ending {
    Completed,
    /// None or several combinations of sides are consistent, or the only one does not attract.
    NotUnique(Vec<Vec<(usize, i8)>>),
    Delicate,
}

/// When, at which surface, what.
pub type Event = (f64, usize, EventKind);

pub struct Exact {
    pub events: Vec<Event>,
    pub ending: Ending,
    /// `y` where it ended.
    pub end: Vec<f64>,
    /// The most surfaces that were held at once.
    pub most_held: usize,
}

/// Whether all principal minors are positive: the first entry is, and so are those without it and
/// those of its Schur complement.
fn is_p_matrix(matrix: &[Vec<f64>]) -> bool {
    let Some((first, rest)) = matrix.split_first() else { return true };
    let without: Matrix = rest.iter().map(|row| row[1..].to_vec()).collect();
    let reduced =
        |row: &Vec<f64>| (1..row.len()).map(|j| row[j] - row[0] / first[0] * first[j]).collect();
    first[0] > 0.0
        && is_p_matrix(&without)
        && is_p_matrix(&rest.iter().map(reduced).collect::<Matrix>())
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
            let end = flow.after(&self.y, h);
            // Beyond a singularity of the selectors nothing is known.
            if end.iter().any(|value| value.is_nan()) {
                return Err(Ending::Delicate);
            }
            let event = self.first(&flow, &end, h)?;
            if let Some(h) = self.attraction_ends(&flow, event.map_or(h, |(time, _)| time))? {
                self.y = flow.after(&self.y, h);
                return self.choose(&flow.held, false).and(Err(Ending::Delicate));
            }
            self.y = event.map_or(end, |(time, _)| flow.after(&self.y, time));
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
        let attracts =
            |h: f64| is_p_matrix(&self.system.attraction(&flow.after(&self.y, h), &flow.held));
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

    /// The first event of a step to `end`.
    fn first(&self, flow: &Flow, end: &[f64], h: f64) -> Result<Option<(f64, usize)>, Ending> {
        let mut found = Vec::new();
        for condition in self.conditions() {
            let root = flow.first(condition, &self.y, end, h).map_err(|()| Ending::Delicate)?;
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
            let side =
                if flow.value(Condition::Within(surface, 1.0), &self.y) < 1.0 { 1 } else { -1 };
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
            _ if is_start && side == 0 => EventKind::StartsSliding,
            _ if is_start || before == side => return,
            (_, 0) => EventKind::EntersSliding,
            (0, 1) => EventKind::LeavesUp,
            (0, _) => EventKind::LeavesDown,
            (_, 1) => EventKind::CrossesUp,
            _ => EventKind::CrossesDown,
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
        let held: Vec<usize> =
            only.iter().filter(|(_, side)| *side == 0).map(|(i, _)| *i).collect();
        if !is_p_matrix(&self.system.attraction(&self.y, &held)) {
            return Err(Ending::NotUnique(found));
        }
        only.iter().for_each(|&(i, side)| self.change(i, side, is_start));
        Ok(())
    }

    /// By how much sides are consistent: `1 - |s|` where held, the rate away from the surface
    /// elsewhere.
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
