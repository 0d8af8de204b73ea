//! Whether a hold is worth having where a surface is crossed, or where the motion begins or ends on
//! it: the derivative of the objective by its duration, without solving.
//!
//! A phase of length `delta` with other modes takes that time from its neighbour, so that
//!
//! ```text
//! dJ/d delta = min over u, s of H' (t, x, p)  -  min over u, s of H (t, x, p)
//! ```
//!
//! with `H'` of the hold and `H` of the neighbour, and the costate `p` on that side of the event on
//! which no surface is left or reached that is not held. Where nothing holds the surface there is
//! no `H'`.

use super::contacts::Contacts;
use super::point::point_of;
use super::polynomials::polynomials;
use super::pressed::Selector;
use super::structure::Structure;
use super::tuning::insertion::{INSIDE, ON_SURFACE, RELEASED, SETTLED};
use super::{Located, Search};
use fdcc_compiler::{
    Mode, Model, PhaseOfModes, Point, compile_chain, hamiltonian, is_uncontrolled, may_hold,
};
use fdcc_runtime::nlp::{Nlp, Start, Status, Stop};
use fdcc_runtime::problem::Chain;
use fdcc_runtime::solve::warm_start::{Earlier, from_earlier};
use fdcc_runtime::solve::{Outcome, solve_chain};
use fdcc_runtime::transcribe::chain::ChainNlp;
use std::ops::ControlFlow;

/// A hold that could be inserted.
pub(super) struct Candidate {
    /// It begins where this phase does; behind the last one where there is none of this number.
    pub before: usize,
    /// What it is inserted into, where that is not the structure as it is.
    pub into: Option<Structure>,
    pub held: PhaseOfModes,
    /// The derivative of the objective of the minimisation problem by its duration, for the size of
    /// the Hamiltonian; less than nothing where it is not known.
    pub slope: f64,
    /// Whether nothing else is possible there: neither side can be left to.
    pub is_forced: bool,
    /// Whether it may be impossible: then nothing follows where it cannot be solved.
    pub is_doubtful: bool,
}

impl Search<'_> {
    /// All holds that could be inserted.
    pub(super) fn candidates(&self, located: &Located) -> Vec<Candidate> {
        let whole = located.whole(self.problem).outcome;
        let phases = &located.structure.phases;
        let mut all = Vec::new();
        let begin = self.held_where(&phases[0], &|at| is_zero(&whole, at, |column| column[0]));
        all.extend(begin.map(|held| (0, held)));
        for j in 1..phases.len() {
            // Beside a jump nothing is inserted.
            let pair = phases[j].jump.is_none().then(|| [&phases[j - 1], &phases[j]]);
            let held = pair.and_then(|[before, after]| self.crossing(before, after));
            all.extend(held.map(|held| (j, held)));
        }
        let last = phases.len() - 1;
        let end = |column: &[f64]| column[column.len() - 1];
        let held = self.held_where(&phases[last], &|at| is_zero(&whole, at, end));
        all.extend(held.map(|held| (last + 1, held)));
        let candidate = |(before, held)| {
            let (slope, is_forced) = self.worth(located, before, &held);
            Candidate { before, into: None, held, slope, is_forced, is_doubtful: false }
        };
        let mut candidates: Vec<Candidate> = all.into_iter().map(candidate).collect();
        candidates.extend(self.orders(&located.structure));
        for j in (1..phases.len()).filter(|j| phases[*j].jump.is_none()) {
            candidates.extend(self.releases(located, j));
        }
        candidates.extend(self.releases_at_ends(located));
        candidates.extend(self.departures(located));
        candidates.extend(self.across_links(located));
        candidates.extend(self.across_surfaces(located));
        candidates
    }

    /// Where something else changes during a hold whose selector is at its bound: a moment off the
    /// surface, before it or behind it.
    fn releases(&self, located: &Located, j: usize) -> Vec<Candidate> {
        let phases = &located.structure.phases;
        let [before, after] = [&phases[j - 1], &phases[j]];
        let goes_on = |at: usize| after.modes[at] == Mode::Held && before.modes != after.modes;
        let released = self.released(located, j - 1, 1).into_iter().filter(|it| goes_on(it.0));
        let both = |(at, mode)| [before, after].map(|beside| off_surface(j, beside, at, mode));
        released.flat_map(both).collect()
    }

    /// The same at the first and the last time.
    fn releases_at_ends(&self, located: &Located) -> Vec<Candidate> {
        let phases = &located.structure.phases;
        let last = phases.len() - 1;
        let ends = [(0, 0, 0), (last, 1, last + 1)].into_iter();
        ends.flat_map(|(j, end, before)| {
            let released = self.released(located, j, end).into_iter();
            released.map(move |(at, mode)| off_surface(before, &phases[j], at, mode))
        })
        .collect()
    }

    /// The surfaces whose selectors are at a bound where a hold begins (0) or ends (1), and the
    /// mode in which that is left; none that presses the motion onto it.
    fn released(&self, located: &Located, j: usize, end: usize) -> Vec<(usize, Mode)> {
        let (phase, contacts) = (&located.structure.phases[j], Contacts::new(self.model, located));
        let mut next = self.model.controls.len();
        let mut all = Vec::new();
        for (at, switch) in self.model.switches().iter().enumerate() {
            if phase.modes[at] != Mode::Held {
                continue;
            }
            let pieces = polynomials(&located.outcome.phases[j].trajectory, next);
            let piece = if end == 0 { pieces.first() } else { pieces.last() };
            let value = piece.map_or(0.0, |it| it.at(it.ends[end]));
            let mode = if value > 0.0 { Mode::Above } else { Mode::Below };
            let selector = Selector { phase: j, switch: at, control: next };
            next += switch.surfaces.len();
            let may_leave = value.abs() > RELEASED && !switch.is_ball;
            if may_leave && !contacts.is_pressed_on(selector, mode, end) {
                all.push((at, mode));
            }
        }
        all
    }

    /// The modes of a phase with those surfaces held that are 0.
    fn held_where(
        &self,
        phase: &PhaseOfModes,
        is_zero: &dyn Fn(usize) -> bool,
    ) -> Option<PhaseOfModes> {
        let mut held = phase.clone();
        for (switch, may_hold) in may_hold(self.model).into_iter().enumerate() {
            if may_hold && is_zero(switch) {
                held.modes[switch] = Mode::Held;
            }
        }
        held.release();
        held.jump = None;
        (held.modes != phase.modes).then_some(held)
    }

    /// A hold between two phases on different sides of a surface.
    fn crossing(&self, before: &PhaseOfModes, after: &PhaseOfModes) -> Option<PhaseOfModes> {
        let mut held = after.clone();
        let modes = held.modes.iter_mut().zip(&before.modes).zip(may_hold(self.model));
        for ((mode, before), may_hold) in modes {
            if may_hold && mode != before && *mode != Mode::Held && *before != Mode::Held {
                *mode = Mode::Held;
            }
        }
        held.release();
        (held.modes != after.modes).then_some(held)
    }

    /// The derivative of the objective, and whether there is no other way.
    fn worth(&self, located: &Located, before: usize, held: &PhaseOfModes) -> (f64, bool) {
        let phases = &located.structure.phases;
        let beside = before.min(phases.len() - 1);
        let outcome = &located.outcome.phases[beside];
        let ends = |column: &[f64]| match before == beside {
            true => [column[0], column[1]],
            false => [column[column.len() - 1], column[column.len() - 2]],
        };
        let point = self.point(outcome, &|column| ends(column)[0]);
        // A `Dir` has a direction only off its surface.
        let inside = self.point(outcome, &|column| {
            let [end, next] = ends(column);
            end + INSIDE * (next - end)
        });
        let size = outcome.trajectory.hamiltonian.scale.max(located.least_size(self.model));
        let mut own = phases[beside].clone();
        own.arcs.fill(fdcc_compiler::Arc::Free);
        let least = |of: &PhaseOfModes, point: &Point| match at_point(self.model, of, point) {
            Some(chain) => least(&chain, None, self.stop),
            None => Least::Unknown,
        };
        match (least(held, &point), least(&own, &inside)) {
            (Least::Nothing, _) => (f64::INFINITY, false),
            (Least::Value(least, controls), own_least) => {
                let is_forced = before == 0 && self.is_settled([&own, held], &controls);
                match own_least {
                    Least::Value(own, _) => ((least - own) / size, is_forced),
                    _ => (f64::NEG_INFINITY, is_forced),
                }
            }
            _ => (f64::NEG_INFINITY, false),
        }
    }

    /// Whether a selector that is held in the second phase and not in the first is inside of its
    /// bounds, and no control would change that.
    fn is_settled(&self, [own, held]: [&PhaseOfModes; 2], controls: &[f64]) -> bool {
        let mut next = self.model.controls.len();
        let switches = self.model.switches().into_iter().zip(is_uncontrolled(self.model));
        for (at, (switch, is_uncontrolled)) in switches.enumerate() {
            if held.modes[at] == Mode::Held {
                let is_inside = controls[next].abs() < 1.0 - SETTLED;
                if own.modes[at] != Mode::Held && is_uncontrolled && is_inside {
                    return true;
                }
                next += switch.surfaces.len();
            }
        }
        false
    }

    /// What a trajectory is where a phase begins, or ends.
    pub(super) fn point(&self, outcome: &Outcome, end: &dyn Fn(&[f64]) -> f64) -> Point {
        point_of(&outcome.trajectory, (self.problem, self.model.states.len()), end)
    }
}

/// A phase beside another one that is off a surface which that holds.
fn off_surface(before: usize, beside: &PhaseOfModes, at: usize, mode: Mode) -> Candidate {
    tried(before, off(beside, at, mode))
}

/// A phase that is off a surface which another one holds.
pub(super) fn off(held: &PhaseOfModes, at: usize, mode: Mode) -> PhaseOfModes {
    let mut off = PhaseOfModes { jump: None, ..held.clone() };
    off.modes[at] = mode;
    off.release();
    off
}

/// A candidate whose worth only a trial tells.
pub(super) fn tried(before: usize, held: PhaseOfModes) -> Candidate {
    Candidate {
        before,
        into: None,
        held,
        slope: f64::NEG_INFINITY,
        is_forced: false,
        is_doubtful: false,
    }
}

/// The problem of the least Hamiltonian at a point; nothing where its terms are not known.
pub(super) fn at_point(model: &Model, of: &PhaseOfModes, point: &Point) -> Option<Chain> {
    at_departure(model, of, point, &[])
}

/// The same over controls that lead off the surfaces of some switches.
pub(super) fn at_departure(
    model: &Model,
    of: &PhaseOfModes,
    point: &Point,
    leaving: &[usize],
) -> Option<Chain> {
    let model = hamiltonian(model, of, point, leaving).ok()?;
    compile_chain(&model).ok()
}

/// The least Hamiltonian of the minimisation problem, near these controls if they are given.
pub(super) fn least(
    chain: &Chain,
    near: Option<&[f64]>,
    stop: &(dyn Fn() -> ControlFlow<Stop> + Sync),
) -> Least {
    let start = near.map(|controls| with_controls(chain, controls));
    match solve_chain(chain, start, &mut |_, _| stop()) {
        Ok(outcome) if outcome.solution.status.is_solved() => {
            let controls = outcome.phases[0].trajectory.controls.iter().map(|it| it[0]);
            Least::Value(outcome.solution.objective, controls.collect())
        }
        Ok(outcome) if outcome.solution.status == Status::Infeasible => Least::Nothing,
        _ => Least::Unknown,
    }
}

/// A Hamiltonian with these controls and selectors.
pub(super) fn hamiltonian_at(chain: &Chain, controls: &[f64]) -> f64 {
    let mut nlp = ChainNlp::new(chain);
    let mut rows = vec![0.0; nlp.constraint_bounds().len()];
    nlp.values(&with_controls(chain, controls).v, &mut rows)
}

fn with_controls(chain: &Chain, controls: &[f64]) -> Start {
    let problem = &chain.phases[0];
    let control = |at: usize| Some(vec![*controls.get(at)?]);
    let earlier = Earlier {
        states: vec![None; problem.states.len()],
        controls: (0..problem.controls.len()).map(control).collect(),
        unknowns: Vec::new(),
        widths: Vec::new(),
        times: vec![0.0, 1.0],
        pieces: Vec::new(),
    };
    from_earlier(chain, &[earlier])
}

/// The least value of a Hamiltonian, with the controls and selectors there.
pub(super) enum Least {
    Value(f64, Vec<f64>),
    /// No control holds the surface.
    Nothing,
    /// It could not be found.
    Unknown,
}

/// Whether the function of a surface is 0 at an end.
fn is_zero(whole: &Outcome, surface: usize, end: fn(&[f64]) -> f64) -> bool {
    let own = &whole.trajectory.switching[surface];
    let largest = own.iter().fold(0.0, |a: f64, it| a.max(it.abs()));
    end(own).abs() <= ON_SURFACE * largest
}
