//! Which modes follow at a point on some surfaces: the mixed linear complementarity problem, or a refusal.
//!
//! The rates `r(s)` of the surfaces are linearised until nothing changes (selectors may multiply each other). If `B` is a P-matrix,
//! or positive definite where there are balls, the solution is the only one. Otherwise all combinations of sides are tried, and only a single consistent one is taken.

use super::ball::{blocks, is_unique, solution};
use super::direction::length;
use super::field::{Field, Mode, Normals, surface_rates};
use super::result::{Candidate, Options, Status};
use super::step::Step;
use nalgebra::{DMatrix, DVector};
use std::ops::Range;

/// Rates below this part of what they are made of are 0.
const TIE: f64 = 1e-11;

/// Beyond this many surfaces at a point, combinations are too many to list.
const MOST_COMBINED: usize = 6;

/// A point on some surfaces.
struct Corner<'f, 'a> {
    field: &'f mut Field<'a>,
    t: f64,
    x: &'f [f64],
    surfaces: &'f [usize],
    normals: Normals,
    /// Where the balls stand among the surfaces.
    balls: Vec<Range<usize>>,
    options: &'f Options,
}

/// The modes of `surfaces` after a point that is on all of them.
pub(super) fn decide(
    field: &mut Field,
    t: f64,
    x: &[f64],
    surfaces: &[usize],
    options: &Options,
) -> Result<Vec<Mode>, Status> {
    if surfaces.is_empty() {
        return Ok(Vec::new());
    }
    let normals = field.normals(t, x);
    field.follow_directions(t, x);
    let balls = blocks(&field.system.balls, surfaces);
    let mut corner = Corner { field, t, x, surfaces, normals, balls, options };
    match corner.unique() {
        Some(modes) => Ok(modes),
        None => corner.only_combination(),
    }
}

fn mode(side: i8) -> Mode {
    match side {
        1 => Mode::Above,
        -1 => Mode::Below,
        _ => Mode::Sliding,
    }
}

impl Corner<'_, '_> {
    /// Rates of the surfaces, `B`, and what counts as 0, for selectors of the surfaces.
    fn rates(&mut self, s: &DVector<f64>) -> (DVector<f64>, DMatrix<f64>, Vec<f64>) {
        let mut all = self.field.selectors.clone();
        self.surfaces.iter().zip(s.iter()).for_each(|(&i, s)| all[i] = *s);
        let (rate, by_selector) = self.field.with_selectors(self.t, self.x, &all);
        let (r, b) = surface_rates(&self.normals, &rate, &by_selector, self.surfaces);
        let size = |at: usize, i: usize| {
            let terms =
                self.normals.by_state.row(i).iter().zip(&rate).map(|(d, f)| (d * f).abs()).sum::<f64>();
            TIE * (terms + self.normals.by_time[i].abs() + b.row(at).amax()).max(f64::MIN_POSITIVE)
        };
        let ties = self.surfaces.iter().enumerate().map(|(at, &i)| size(at, i)).collect();
        (r, b, ties)
    }

    /// The modes, if the linearised problem has one solution on the way to that of the whole.
    fn unique(&mut self) -> Option<Vec<Mode>> {
        let mut s = DVector::zeros(self.surfaces.len());
        for _ in 0..50 {
            let (r, b, tie) = self.rates(&s);
            if !is_unique(&b, &self.balls) || !r.iter().all(|value| value.is_finite()) {
                return None;
            }
            let next = solution(&(&r + &b * &s), &b, &self.balls)?;
            if (&next - &s).amax() <= 1e-13 {
                return Some(self.modes(&next, &r, &tie));
            }
            s = next;
        }
        None
    }

    /// The modes that belong to selectors and rates.
    fn modes(&mut self, s: &DVector<f64>, r: &DVector<f64>, tie: &[f64]) -> Vec<Mode> {
        let mut modes: Vec<Mode> = (0..s.len()).map(|i| mode(side(s[i], r[i], tie[i]))).collect();
        for ball in self.balls.clone() {
            let (own, rate) = (&s.as_slice()[ball.clone()], &r.as_slice()[ball.clone()]);
            let moves = length(own) >= 1.0 - 1e-12 && length(rate) > length(&tie[ball.clone()]);
            modes[ball.clone()].fill(if moves { Mode::Moving } else { Mode::Sliding });
            let surfaces = self.surfaces[ball.start]..self.surfaces[ball.start] + ball.len();
            self.field.direction[surfaces].copy_from_slice(own);
        }
        modes
    }

    /// The only consistent combination of sides; none are told where a ball is among them.
    fn only_combination(&mut self) -> Result<Vec<Mode>, Status> {
        let size = self.surfaces.len();
        let count = if size <= MOST_COMBINED && self.balls.is_empty() { 3_usize.pow(size as u32) } else { 0 };
        let sides = |number: usize| -> Vec<i8> {
            (0..size).map(|at| [1, -1, 0][number / 3_usize.pow(at as u32) % 3]).collect()
        };
        let mut found: Vec<Vec<i8>> =
            (0..count).map(sides).filter(|sides| self.is_consistent(sides)).collect();
        if let [only] = found.as_mut_slice() {
            return Ok(only.iter().copied().map(mode).collect());
        }
        let named = |sides: Vec<i8>| Candidate { sides: self.surfaces.iter().copied().zip(sides).collect() };
        let candidates = found.into_iter().map(named).collect();
        Err(Status::NotUnique { surface: self.surfaces[0], candidates })
    }

    /// Whether the state can go on with these sides.
    fn is_consistent(&mut self, sides: &[i8]) -> bool {
        let mut s = DVector::from_iterator(sides.len(), sides.iter().map(|side| f64::from(*side)));
        let slides: Vec<usize> = (0..sides.len()).filter(|&i| sides[i] == 0).collect();
        for _ in 0..if slides.is_empty() { 0 } else { 20 } {
            let (r, b, _) = self.rates(&s);
            let b = b.select_rows(&slides).select_columns(&slides);
            let Some(change) = b.lu().solve(&r.select_rows(&slides)) else { return false };
            slides.iter().zip(change.iter()).for_each(|(&i, change)| s[i] += change);
        }
        let (r, _, tie) = self.rates(&s);
        let fits = |i: usize| {
            if sides[i] == 0 {
                s[i].abs() < 1.0 && r[i].abs() <= tie[i]
            } else {
                f64::from(sides[i]) * r[i] >= -tie[i]
            }
        };
        let is_tie = |i: usize| sides[i] != 0 && r[i].abs() <= tie[i];
        (0..sides.len()).all(fits) && (!(0..sides.len()).any(is_tie) || self.goes_there(sides))
    }

    /// Where rates vanish a short step tells on which side it ends.
    fn goes_there(&mut self, sides: &[i8]) -> bool {
        let before = (self.field.modes.clone(), self.field.selectors.clone());
        let modes: Vec<Mode> = sides.iter().copied().map(mode).collect();
        self.surfaces.iter().zip(modes).for_each(|(&i, mode)| self.field.set_mode(i, mode));
        let [first, last] = self.field.system.interval;
        let h = 1e-5 * (last - first);
        let end = Step::take(self.field, self.t, self.x, h, self.options).end;
        let psi = self.field.psi(self.t + h, &end);
        (self.field.modes, self.field.selectors) = before;
        self.surfaces.iter().zip(sides).all(|(&i, &side)| side == 0 || f64::from(side) * psi[i] > 0.0)
    }
}

/// The side of a selector; at the end of its interval with no rate it slides, as long as it stays there.
fn side(s: f64, rate: f64, tie: f64) -> i8 {
    if s >= 1.0 - 1e-12 && rate > tie {
        1
    } else if s <= -1.0 + 1e-12 && rate < -tie {
        -1
    } else {
        0
    }
}
