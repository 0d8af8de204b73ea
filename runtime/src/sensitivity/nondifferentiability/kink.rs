//! A trajectory that stays on a kink of the right side which is no surface: only derivatives of one
//! side are known there.
//!
//! With `e = 0` at the kink, it does no harm where nothing moves `e`: where `e_(x, U, p)` is a
//! combination of the normals of the surfaces that the state slides on.

use super::{TANGENT, TOUCHING};
use crate::problem::Origin;
use crate::sensitivity::linearised::linearisation::{Jacobian, Lineariser, sliding};
use crate::simulate::{Cause, Instant, Piece, Tape};
use nalgebra::{DMatrix, DVector, RowDVector};

/// A kink that a trajectory stays on, jumps on, meets a surface on, or ends on.
#[derive(Clone, Debug, PartialEq)]
pub struct Kink {
    /// The right side, what a jump assigns, the function of a surface, or the objective.
    pub of: Origin,
    /// Who is on it.
    pub met: KinkMet,
}

/// When a trajectory is on a kink.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum KinkMet {
    /// From this time on.
    Since(f64),
    /// Where it jumps, at this time.
    ByJump(f64),
    /// Where it meets a surface, at this time.
    BySurface(f64),
    /// Where jumps pile up, at this time: what they come to is extrapolated, and its derivative is
    /// not known.
    ByPile(f64),
    /// At its end.
    AtEnd,
    /// At no time: the parameters alone are on it, wherever the state is.
    ByParameters,
}

/// The first.
pub(crate) fn first_kink(lineariser: &Lineariser, tape: &Tape) -> Option<Kink> {
    let kinks = &lineariser.system.kinks;
    if kinks.outputs() == 0 {
        return None;
    }
    tape.pieces.iter().find_map(|piece| {
        let Piece::Step { start, h, .. } = piece else { return None };
        if *h == 0.0 {
            return None;
        }
        let here = Here::new(lineariser, tape, start);
        let end = Here::new(lineariser, tape, &piece.end());
        let stays = |k: &usize| here.is_on(*k) && end.is_on(*k) && !here.is_fixed(*k);
        let kink = (0..lineariser.system.kinks_of_flow).find(stays)?;
        Some(Kink { of: kinks.origin(kink), met: KinkMet::Since(start.time) })
    })
}

/// Whether a kink is met almost along itself, so that the second derivative of the time is nothing
/// to rely on; or together with another event, so that their order is not fixed; or moved by
/// controls that change with time.
pub(crate) fn is_doubtful(lineariser: &Lineariser, tape: &Tape, at: usize) -> bool {
    let Piece::Event { cause: Cause::CrossesKink(kink), before, .. } = &tape.pieces[at] else {
        return false;
    };
    let regime = &tape.regimes[before.regime];
    let controls = lineariser.layout(regime).controls();
    let here = Here::new(lineariser, tape, before);
    let follows =
        lineariser.is_curved(regime) && here.by.row(*kink).columns_range(controls).amax() > 0.0;
    let [first, last] = lineariser.system.interval;
    let is_near = |piece: &Piece| match piece {
        Piece::Event { before: other, .. } => {
            (other.time - before.time).abs() <= TOUCHING * (last - first)
        }
        Piece::Step { .. } => false,
    };
    let others = tape.pieces[..at].iter().rev().take(2).chain(tape.pieces[at + 1..].iter().take(2));
    follows || here.is_along(*kink) || others.into_iter().any(is_near)
}

/// Whether a kink is met almost along itself, or together with another that moves otherwise.
pub(crate) fn is_met_oddly(
    lineariser: &Lineariser,
    tape: &Tape,
    at: &Instant,
    kink: usize,
) -> bool {
    let here = Here::new(lineariser, tape, at);
    let inputs = here.by.ncols() - here.selectors;
    let moved = |kink: usize| here.by.view((kink, 0), (1, inputs)).into_owned();
    let own = moved(kink).normalize();
    let is_other = |other: usize| {
        let by = moved(other);
        let size = (here.by_state(other).abs() * here.state.abs())[0];
        let is_here = here.e[other].abs() <= TOUCHING * (1.0 + size);
        is_here && by.norm() > 0.0 && own.dot(&by.normalize()).abs() < 1.0 - TOUCHING
    };
    here.is_along(kink) || (0..here.e.len()).any(is_other)
}

/// The kinks at one instant.
struct Here {
    e: DVector<f64>,
    /// `e_(t, x, U, p, s)`
    by: DMatrix<f64>,
    state: DVector<f64>,
    rate: DVector<f64>,
    /// `psi_(x, U, p)` of the surfaces that the state slides on.
    normals: DMatrix<f64>,
    /// How many selectors there are.
    selectors: usize,
}

impl Here {
    fn new(lineariser: &Lineariser, tape: &Tape, at: &Instant) -> Self {
        let regime = &tape.regimes[at.regime];
        let state = DVector::from_column_slice(&at.state);
        let table = lineariser.table(regime, &at.selectors, at.time, &state);
        let system = lineariser.system;
        let Jacobian { values, by } = Jacobian::of(&*system.kinks, &table, &lineariser.parameters);
        let switching = Jacobian::of(&*system.switching, &table, &lineariser.parameters).by;
        let [by, switching] = [by, switching].map(|by| lineariser.spread(by, regime, at.time));
        let moving = 1..lineariser.layout(regime).selectors().start;
        let normals = switching.select_rows(&sliding(regime)).columns_range(moving).into_owned();
        let rate = lineariser.rate_at_instant(tape, at);
        Here { e: values, by, state, rate, normals, selectors: system.layout.s }
    }

    /// Neither away from it nor leaving it.
    fn is_on(&self, kink: usize) -> bool {
        let size = (self.by_state(kink).abs() * self.state.abs())[0];
        self.e[kink].abs() <= TOUCHING * (1.0 + size) && self.is_along(kink)
    }

    fn is_along(&self, kink: usize) -> bool {
        let (by_state, by_time) = (self.by_state(kink), self.by[(kink, 0)]);
        let size = by_state.norm() * self.rate.norm() + by_time.abs();
        ((by_state * &self.rate)[0] + by_time).abs() <= TANGENT * size
    }

    fn by_state(&self, kink: usize) -> RowDVector<f64> {
        self.by.row(kink).columns(1, self.state.len()).into_owned()
    }

    /// Whether sliding keeps the kink in its place.
    fn is_fixed(&self, kink: usize) -> bool {
        let along = self.by.row(kink).columns(1, self.normals.ncols()).transpose();
        let rest = match self.normals.nrows() {
            0 => along.norm(),
            _ => {
                let normals = self.normals.transpose();
                let parts = normals.clone().svd(true, true).solve(&along, TOUCHING);
                parts.map_or(along.norm(), |parts| (&along - normals * parts).norm())
            }
        };
        rest <= TOUCHING * along.norm()
    }
}
