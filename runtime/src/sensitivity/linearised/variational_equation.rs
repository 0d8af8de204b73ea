//! The tape, linearised piece by piece.
//!
//! Each piece is a linear map `S+ = M S + N W`, with `W` the directions of `(U, p)` that act in it;
//! forward sensitivities apply the maps in order, the adjoint applies their transposes in reverse.

use super::event::{EventOnTape, LinearEvent};
use super::linearisation::Lineariser;
use super::sparse_step::SparseStep;
use super::step::LinearStep;
use super::surface::Projection;
use crate::simulate::{Instant, Piece, Regime, Tape};
use nalgebra::{DMatrix, DVector};

/// More pieces than this are linearised anew for each sweep, so that memory does not grow with the
/// length of a tape.
const MOST_KEPT: usize = 20_000;

/// All pieces of a tape.
pub(crate) struct LinearTape<'t> {
    pub lineariser: &'t Lineariser<'t>,
    pub tape: &'t Tape,
    kept: Vec<LinearPiece<'t>>,
}

impl<'t> LinearTape<'t> {
    pub fn new(lineariser: &'t Lineariser<'t>, tape: &'t Tape) -> Self {
        let count = if tape.pieces.len() <= MOST_KEPT { tape.pieces.len() } else { 0 };
        let kept = (0..count).map(|at| LinearPiece::new(lineariser, tape, at)).collect();
        LinearTape { lineariser, tape, kept }
    }

    /// Does something with one piece.
    pub fn with<R>(&self, at: usize, visit: impl FnOnce(&LinearPiece<'t>) -> R) -> R {
        match self.kept.get(at) {
            Some(piece) => visit(piece),
            None => visit(&LinearPiece::new(self.lineariser, self.tape, at)),
        }
    }
}

/// A piece as a linear map, followed by the projection to the surfaces on which the state slides
/// after it.
pub(crate) struct LinearPiece<'t> {
    pub map: Map<'t>,
    /// Whose controls act before the projection.
    pub regime: &'t Regime,
    /// Whose controls act in the projection.
    pub regime_after: &'t Regime,
    pub projection: Option<Projection>,
}

/// What happens before the projection.
pub(crate) enum Map<'t> {
    Sparse(SparseStep<'t>),
    Step(LinearStep),
    Event(LinearEvent),
}

impl<'t> LinearPiece<'t> {
    pub fn new(lineariser: &Lineariser<'t>, tape: &'t Tape, at: usize) -> Self {
        let regime = |instant: &Instant| &tape.regimes[instant.regime];
        match &tape.pieces[at] {
            Piece::Step { start, h, rule, .. }
                if SparseStep::fits(lineariser, regime(start), *rule) =>
            {
                LinearPiece {
                    map: Map::Sparse(SparseStep::new(lineariser, regime(start), start, *h)),
                    regime: regime(start),
                    regime_after: regime(start),
                    projection: None,
                }
            }
            Piece::Step { start, h, stages, rule, .. } => LinearPiece {
                map: Map::Step(LinearStep::new(
                    lineariser,
                    regime(start),
                    start,
                    *h,
                    stages,
                    *rule,
                )),
                regime: regime(start),
                regime_after: regime(start),
                projection: Projection::new(lineariser, regime(start), &tape.pieces[at].end()),
            },
            Piece::Event { cause, before, after, changes } => {
                let event = EventOnTape { cause: *cause, before, after, changes };
                LinearPiece {
                    map: Map::Event(LinearEvent::new(lineariser, tape, &event)),
                    regime: regime(before),
                    regime_after: regime(after),
                    projection: Projection::new(lineariser, regime(after), after),
                }
            }
        }
    }

    /// `S+`, given the directions of `(U, p)` in a regime.
    pub fn forward(&self, s: &DMatrix<f64>, w: &dyn Fn(&Regime) -> DMatrix<f64>) -> DMatrix<f64> {
        let inputs = w(self.regime);
        let after = match &self.map {
            Map::Sparse(step) => step.forward(s, &inputs),
            Map::Step(step) => step.forward(s, &step.forcing(&inputs)).1,
            Map::Event(event) => event.forward(s, &inputs),
        };
        match &self.projection {
            Some(projection) => projection.forward(&after, &w(self.regime_after)),
            None => after,
        }
    }

    /// The adjoint on the surfaces, in the canonical gauge, from the one after the piece. What
    /// inputs contribute goes to `add`, with the regime in which they act.
    pub fn unproject(
        &self,
        after: DVector<f64>,
        add: &mut dyn FnMut(&Regime, &DVector<f64>),
    ) -> DVector<f64> {
        let Some(projection) = &self.projection else { return after };
        let (before, inputs) = projection.adjoint(&after);
        add(self.regime_after, &inputs);
        before
    }

    /// The adjoint before the piece, from the one before the projection.
    pub fn adjoint(
        &self,
        after: &DVector<f64>,
        add: &mut dyn FnMut(&Regime, &DVector<f64>),
    ) -> DVector<f64> {
        let (before, inputs) = match &self.map {
            Map::Sparse(step) => step.adjoint(after),
            Map::Step(step) => step.adjoint(after),
            Map::Event(event) => event.adjoint(after),
        };
        add(self.regime, &inputs);
        before
    }
}
