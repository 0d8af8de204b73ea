//! Which modes follow at a point on some surfaces: the mixed linear complementarity problem, or a
//! refusal.
//!
//! The rates `r(s)` of the surfaces are linearised until nothing changes (selectors may multiply
//! each other). If `B` is a P-matrix, or positive definite where there are balls, the solution is
//! the only one. Otherwise all combinations of sides are tried, and only a single consistent one is
//! taken, or any of several that are the same motion ([`dissipation`]). Where there is none, those
//! in which the state rests on surfaces are told.

pub(crate) mod ball;
mod bends;
pub(crate) mod complementarity;
mod dissipation;
mod idle;

use super::field::direction::length;
use super::field::normals::Normals;
use super::field::{Field, surface_rates};
use super::result::{Candidate, Status};
use super::steps::Step;
use crate::simulate::mode::Mode;
use crate::simulate::tuning::modes::{AHEAD, AT_END, CONVERGED, MOST_COMBINED, TIE};
use ball::{blocks, is_unique, solution};
use nalgebra::{DMatrix, DVector};
use std::ops::Range;

/// A point on some surfaces.
struct Corner<'f, 'a> {
    field: &'f mut Field<'a>,
    t: f64,
    x: &'f [f64],
    surfaces: &'f [usize],
    /// With the sides of kinks that belong to the selectors looked at last.
    normals: Normals,
    /// The kinks of the functions of the surfaces that the point is on.
    bends: Vec<usize>,
    /// Whether the functions of the surfaces bend at others of them: `abs(x) - y` at `x`.
    turns: bool,
    /// Where the balls stand among the surfaces.
    balls: Vec<Range<usize>>,
}

/// The modes of the surfaces, with the selectors that belong to them.
struct Choice {
    modes: Vec<Mode>,
    s: DVector<f64>,
    /// Whether the selectors of surfaces that hold the state were solved for.
    is_solved: bool,
    /// Whether the state stays on a surface although it is not held there.
    rests: Vec<bool>,
}

/// What follows at a surface.
pub(crate) struct Next {
    pub surface: usize,
    pub mode: Mode,
    /// Whether the right side of this mode leaves the state on the surface: it crosses nothing.
    pub rests: bool,
}

/// Whether a state may stay on a surface that its selector does not move: a stone at rest on the
/// ground. Any value of the selector keeps it there, so that is never the only way to go on.
#[derive(Clone, Copy, PartialEq)]
enum Rest {
    Refused,
    /// If a short step with a selector between leaves the state there, too.
    Still,
    Told,
}

/// The modes of `surfaces` after a point that is on all of them. Balls that move from there find
/// their direction in the field.
pub(crate) fn decide(
    field: &mut Field,
    t: f64,
    x: &[f64],
    surfaces: &[usize],
) -> Result<Vec<Next>, Status> {
    if surfaces.is_empty() {
        return Ok(Vec::new());
    }
    let (acting, idle) = split(field, (t, x), surfaces);
    let normals = field.normals(t, x);
    field.follow_directions(t, x);
    let balls = blocks(&field.system.balls, &acting);
    let bends = field.bends_here(t, x, &acting);
    let turns = field.bend_each_other(t, x, &acting);
    let mut corner = Corner { field, t, x, surfaces: &acting, normals, bends, turns, balls };
    let choice = corner.choose()?;
    let beside = corner.beside(&choice, &idle);
    choice.note_directions(field, &acting);
    let next = |(at, &surface)| Next { surface, mode: choice.modes[at], rests: choice.rests[at] };
    let mut all: Vec<Next> = acting.iter().enumerate().map(next).chain(beside).collect();
    all.sort_by_key(|it| it.surface);
    Ok(all)
}

/// The surfaces that the motion depends on, or that those bend at, and the others.
fn split(field: &mut Field, (t, x): (f64, &[f64]), surfaces: &[usize]) -> (Vec<usize>, Vec<usize>) {
    let (acting, idle): (Vec<usize>, Vec<usize>) = surfaces.iter().partition(|&&i| field.acts[i]);
    let mut turns = |i: &usize| field.bends_at(*i, (t, x), &acting);
    let (turning, idle): (Vec<usize>, Vec<usize>) = idle.iter().partition(|i| turns(i));
    let mut acting = [acting, turning].concat();
    acting.sort_unstable();
    (acting, idle)
}

fn mode(side: i8) -> Mode {
    match side {
        1 => Mode::Above,
        -1 => Mode::Below,
        _ => Mode::Sliding,
    }
}

impl<'a> Corner<'_, 'a> {
    /// The modes that follow.
    fn choose(&mut self) -> Result<Choice, Status> {
        if self.surfaces.is_empty() {
            let (modes, s, rests) = (Vec::new(), DVector::zeros(0), Vec::new());
            return Ok(Choice { modes, s, is_solved: true, rests });
        }
        let choice = match self.unique() {
            Some(choice) => choice,
            None => self.only_combination()?,
        };
        // The sides of kinks are those of the motion that follows.
        self.rates(&choice.s);
        Ok(choice)
    }

    /// Rates of the surfaces, `B`, and what counts as 0, for selectors of the surfaces.
    fn rates(&mut self, s: &DVector<f64>) -> (DVector<f64>, DMatrix<f64>, Vec<f64>) {
        let mut all = self.field.selectors.clone();
        self.surfaces.iter().zip(s.iter()).for_each(|(&i, s)| all[i] = *s);
        let (rate, by_selector) = self.field.with_selectors(self.t, self.x, &all);
        self.go_behind_bends(&rate, &all);
        let (r, b) = surface_rates(&self.normals, &rate, &by_selector, self.surfaces);
        let size = |at: usize, i: usize| {
            let terms = self
                .normals
                .by_state
                .row(i)
                .iter()
                .zip(&rate)
                .map(|(d, f)| (d * f).abs())
                .sum::<f64>();
            TIE * (terms + self.normals.by_time[i].abs() + b.row(at).amax()).max(f64::MIN_POSITIVE)
        };
        let ties = self.surfaces.iter().enumerate().map(|(at, &i)| size(at, i)).collect();
        (r, b, ties)
    }

    /// The modes, if the linearised problem has one solution on the way to that of the whole.
    fn unique(&mut self) -> Option<Choice> {
        if !self.is_one_piece() {
            return None;
        }
        let mut s = DVector::zeros(self.surfaces.len());
        for _ in 0..50 {
            let (r, b, tie) = self.rates(&s);
            if !is_unique(&b, &self.balls) || !r.iter().all(|value| value.is_finite()) {
                return None;
            }
            let next = solution(&(&r + &b * &s), &b, &self.balls)?;
            if (&next - &s).amax() <= CONVERGED {
                let sides: Vec<i8> = (0..s.len()).map(|i| side(next[i], r[i], tie[i])).collect();
                return Some(self.choice(&sides, next, &r, &tie));
            }
            s = next;
        }
        None
    }

    /// Modes for sides, selectors and rates; a ball at the end of its selectors with no rate
    /// slides, too.
    fn choice(&self, sides: &[i8], s: DVector<f64>, r: &DVector<f64>, tie: &[f64]) -> Choice {
        let mut modes: Vec<Mode> = sides.iter().copied().map(mode).collect();
        for ball in self.balls.clone() {
            let [own, rate, tie] =
                [s.as_slice(), r.as_slice(), tie].map(|all| length(&all[ball.clone()]));
            let moves = own >= 1.0 - AT_END && rate > tie;
            modes[ball].fill(if moves { Mode::Moving } else { Mode::Sliding });
        }
        Choice { rests: vec![false; modes.len()], is_solved: true, modes, s }
    }

    fn is_in_ball(&self, at: usize) -> bool {
        self.balls.iter().any(|ball| ball.contains(&at))
    }

    /// The only consistent combination of sides; what the balls do follows from them.
    fn only_combination(&mut self) -> Result<Choice, Status> {
        let size = self.surfaces.len();
        let alone: Vec<usize> = (0..size).filter(|&at| !self.is_in_ball(at)).collect();
        let count = if alone.len() <= MOST_COMBINED { 3_usize.pow(alone.len() as u32) } else { 0 };
        let sides = |number: usize| -> Vec<i8> {
            let mut sides = vec![0; size];
            for (digit, &at) in alone.iter().enumerate() {
                sides[at] = [1, -1, 0][number / 3_usize.pow(digit as u32) % 3];
            }
            sides
        };
        let mut all = |rest| -> Vec<Choice> {
            (0..count).filter_map(|number| self.consistent(&sides(number), rest)).collect()
        };
        let ways = [Rest::Refused, Rest::Still, Rest::Told].into_iter();
        let mut told = ways.map(|rest| (rest, all(rest)));
        let (rest, mut found) = told.find(|(_, it)| !it.is_empty()).unwrap_or((Rest::Told, vec![]));
        if let [only] = &found[..]
            && (rest == Rest::Refused && self.attracts(only) || rest == Rest::Still && only.rests())
        {
            return Ok(found.swap_remove(0));
        }
        if !found.is_empty() && self.is_one_motion(&found) {
            return Ok(found.swap_remove(0));
        }
        let candidates = found.iter().map(|choice| self.candidate(choice)).collect();
        Err(Status::NotUnique { surface: self.surfaces[0], candidates })
    }

    /// Whether all ways to go on are the same motion, and there is no other.
    fn is_one_motion(&mut self, all: &[Choice]) -> bool {
        let (_, b, _) = self.rates(&all[0].s);
        if !self.balls.is_empty() || !dissipation::is_maximal(&b) {
            return false;
        }
        let rates: Vec<DVector<f64>> = all.iter().map(|it| self.rate(&it.s)).collect();
        let size = rates[0].amax().max(b.amax());
        rates.iter().all(|it| (it - &rates[0]).amax() <= TIE * size)
    }

    /// How fast the state changes.
    fn rate(&mut self, s: &DVector<f64>) -> DVector<f64> {
        let mut all = self.field.selectors.clone();
        self.surfaces.iter().zip(s.iter()).for_each(|(&i, s)| all[i] = *s);
        let (rate, _) = self.field.with_selectors(self.t, self.x, &all);
        DVector::from_iterator(rate.len(), rate.iter().copied())
    }

    fn candidate(&self, choice: &Choice) -> Candidate {
        let is_first =
            |at: &usize| self.balls.iter().all(|ball| !ball.contains(at) || ball.start == *at);
        let side = |at: usize| match choice.modes[at] {
            Mode::Above | Mode::Moving => 1,
            Mode::Below => -1,
            Mode::Sliding | Mode::Held => 0,
        };
        let firsts = (0..choice.modes.len()).filter(is_first);
        Candidate { sides: firsts.map(|at| (self.surfaces[at], side(at))).collect() }
    }

    /// Whether the surfaces that are held attract. Where several are held and do not, the state may
    /// also leave on a spiral, which is no combination of sides.
    fn attracts(&mut self, choice: &Choice) -> bool {
        let held: Vec<usize> =
            (0..choice.s.len()).filter(|&i| choice.modes[i] == Mode::Sliding).collect();
        let surfaces: Vec<usize> = held.iter().map(|&at| self.surfaces[at]).collect();
        let b = self.rates(&choice.s).1.select_rows(&held).select_columns(&held);
        held.len() < 2 || is_unique(&b, &blocks(&self.field.system.balls, &surfaces))
    }

    /// What happens if the state goes on with these sides, if it can.
    fn consistent(&mut self, sides: &[i8], rest: Rest) -> Option<Choice> {
        let rest = if self.balls.is_empty() { rest } else { Rest::Refused };
        let mut is_solved = true;
        let mut s = DVector::from_iterator(sides.len(), sides.iter().map(|side| f64::from(*side)));
        let free: Vec<usize> = (0..sides.len()).filter(|&i| sides[i] == 0).collect();
        for _ in 0..if free.is_empty() { 0 } else { 20 } {
            let (r, b, _) = self.rates(&s);
            let b = b.select_rows(&free).select_columns(&free);
            let found = self.change(&s.select_rows(&free), &r.select_rows(&free), b, &free);
            let Some(change) = found else {
                if rest == Rest::Refused {
                    return None;
                }
                is_solved = false;
                break;
            };
            free.iter().zip(change.iter()).for_each(|(&i, change)| s[i] += change);
        }
        let (r, _, tie) = self.rates(&s);
        let fits = |i: usize| {
            if self.is_in_ball(i) {
                s[i].is_finite()
            } else if sides[i] == 0 {
                s[i].abs() < 1.0 && r[i].abs() <= tie[i]
            } else {
                f64::from(sides[i]) * r[i] >= -tie[i]
            }
        };
        let is_tie = |i: usize| sides[i] != 0 && r[i].abs() <= tie[i];
        let (all_fit, has_tie) = ((0..sides.len()).all(fits), (0..sides.len()).any(is_tie));
        let mut choice = Choice { is_solved, ..self.choice(sides, s, &r, &tie) };
        let is_clear = is_solved && !has_tie;
        (all_fit && (is_clear || self.goes_there(sides, &mut choice, rest))).then_some(choice)
    }

    /// By how much the free selectors change in one iteration; those of balls stay in them.
    fn change(
        &self,
        s: &DVector<f64>,
        r: &DVector<f64>,
        b: DMatrix<f64>,
        free: &[usize],
    ) -> Option<DVector<f64>> {
        if self.balls.is_empty() {
            return b.lu().solve(r);
        }
        let surfaces: Vec<usize> = free.iter().map(|&at| self.surfaces[at]).collect();
        let balls = blocks(&self.field.system.balls, &surfaces);
        is_unique(&b, &balls).then(|| solution(&(r + &b * s), &b, &balls))?.map(|next| next - s)
    }

    /// Where rates vanish a short step tells on which side it ends, or that it stays where it is,
    /// which is on the surface but for rounding; notes where it does.
    fn goes_there(&mut self, sides: &[i8], choice: &mut Choice, rest: Rest) -> bool {
        let moved = self.moved(choice);
        let is_still = |at: &usize| moved[*at] == 0.0;
        let rests = |at: &usize| rest != Rest::Refused && sides[*at] != 0 && is_still(at);
        choice.rests = (0..sides.len()).map(|at| rests(&at)).collect();
        (0..sides.len()).all(|at| match sides[at] {
            0 => rest != Rest::Still || choice.is_solved || is_still(&at),
            side => f64::from(side) * moved[at] > 0.0 || choice.rests[at],
        })
    }

    /// By how much the functions of the surfaces change in a short step with some modes.
    fn moved(&mut self, choice: &Choice) -> Vec<f64> {
        let [first, last] = self.field.system.interval;
        let (t, x, h) = (self.t, self.x, AHEAD * (last - first));
        let psi = self.with_modes_of(choice, |field| {
            let end = Step::take(field, t, x, h).end;
            field.psi(t + h, &end)
        });
        self.surfaces.iter().map(|&i| psi[i] - self.normals.psi[i]).collect()
    }

    /// Looks at a field in some modes, and leaves it as it was.
    fn with_modes_of<R>(&mut self, choice: &Choice, look: impl FnOnce(&mut Field<'a>) -> R) -> R {
        let before = (self.field.modes.clone(), self.field.selectors.clone());
        let of_balls = (self.field.departure.clone(), self.field.direction.clone());
        choice.begin(self.field, self.surfaces, self.t);
        let seen = look(self.field);
        (self.field.modes, self.field.selectors) = before;
        (self.field.departure, self.field.direction) = of_balls;
        seen
    }
}

impl Choice {
    /// Whether the state stays where it is, though nothing holds it.
    fn rests(&self) -> bool {
        self.rests.contains(&true) && !self.modes.contains(&Mode::Sliding)
    }

    /// Puts a field into these modes.
    fn begin(&self, field: &mut Field, surfaces: &[usize], t: f64) {
        self.note_directions(field, surfaces);
        for (at, (&surface, &mode)) in surfaces.iter().zip(&self.modes).enumerate() {
            field.set_mode(surface, mode);
            field.departure[surface] = t;
            if mode == Mode::Sliding && !self.is_solved {
                // No equation has this selector: it is tried as it is.
                field.set_mode(surface, Mode::Held);
                field.selectors[surface] = self.s[at];
            }
        }
    }

    /// Notes in which direction balls depart.
    fn note_directions(&self, field: &mut Field, surfaces: &[usize]) {
        let moves = |at: &usize| self.modes[*at] == Mode::Moving;
        (0..surfaces.len()).filter(moves).for_each(|at| field.direction[surfaces[at]] = self.s[at]);
    }
}

/// The side of a selector; at the end of its interval with no rate it slides, as long as it stays
/// there.
fn side(s: f64, rate: f64, tie: f64) -> i8 {
    if s >= 1.0 - AT_END && rate > tie {
        1
    } else if s <= -1.0 + AT_END && rate < -tie {
        -1
    } else {
        0
    }
}
