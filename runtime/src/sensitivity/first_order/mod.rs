//! First derivatives of an output at the end, forward and adjoint.
//!
//! ```text
//! dJ = J_x0 dx0 + J_xT (S(T) + f T_p dp) + J_p dp
//! lambda(T) = J_xT^T, backward through all pieces; dJ/dx0 = J_x0 + lambda(t0)
//! ```

pub(crate) mod gradient;
pub(crate) mod one_sided;
pub(crate) mod perturbed;
pub(crate) mod quantity;
pub(crate) mod resolved;

use super::linearised::linearisation::{Jacobian, Lineariser};
use super::linearised::variational_equation::LinearTape;
use crate::problem::Columns;
use crate::simulate::{Instant, Piece, Regime, Simulation, Tape};
use nalgebra::{DMatrix, DVector, RowDVector};
use quantity::{Directions, Gradient};

/// The objective at the ends of a simulation, linearised.
pub(crate) struct Objective {
    pub value: f64,
    pub by_start: RowDVector<f64>,
    pub by_end: RowDVector<f64>,
    pub by_parameters: RowDVector<f64>,
}

impl Objective {
    /// Nothing if the system has no objective.
    pub fn new(lineariser: &Lineariser, simulation: &Simulation) -> Option<Self> {
        let system = lineariser.system;
        let states = system.layout.x;
        let mut point = Columns::new(2 * states, 1);
        for (at, value) in system.start.iter().chain(&simulation.end).enumerate() {
            point.column_mut(at)[0] = *value;
        }
        let Jacobian { values, by } =
            Jacobian::of(&*system.objective, &point, &lineariser.parameters);
        (!values.is_empty()).then(|| Objective {
            value: values[0],
            by_start: by.row(0).columns(0, states).into_owned(),
            by_end: by.row(0).columns(states, states).into_owned(),
            by_parameters: by.row(0).columns(2 * states, system.layout.p).into_owned(),
        })
    }
}

/// The last instant of a tape.
pub(crate) fn last_instant(tape: &Tape) -> Option<Instant> {
    tape.pieces.last().map(Piece::end)
}

/// `dx(t0)` in each direction.
pub(crate) fn start(lineariser: &Lineariser, directions: &Directions) -> DMatrix<f64> {
    lineariser.start_by_parameters() * &directions.parameters + &directions.starts
}

/// `dx(T)` in each direction, along the tape; `visit` sees `S` at the end of every piece.
pub(crate) fn forward(
    pieces: &LinearTape,
    directions: &Directions,
    visit: &mut dyn FnMut(usize, &DMatrix<f64>),
) -> DMatrix<f64> {
    let LinearTape { lineariser, tape, .. } = *pieces;
    let mut s = start(lineariser, directions);
    for at in 0..tape.pieces.len() {
        s = pieces.with(at, |piece| piece.forward(&s, &|regime| directions.inputs(regime)));
        visit(at, &s);
    }
    s + end_shift(lineariser, tape) * &directions.parameters
}

/// `f T_p`: how the state at the end moves because the end does.
fn end_shift(lineariser: &Lineariser, tape: &Tape) -> DMatrix<f64> {
    let Some(last) = last_instant(tape) else {
        return DMatrix::zeros(lineariser.system.layout.x, lineariser.system.layout.p);
    };
    lineariser.at_instant(tape, &last).rate * lineariser.ends_by.row(1)
}

/// The derivative in each direction.
pub(crate) fn along(
    lineariser: &Lineariser,
    objective: &Objective,
    directions: &Directions,
    end: &DMatrix<f64>,
) -> Vec<f64> {
    let gradient = &objective.by_start * start(lineariser, directions)
        + &objective.by_end * end
        + &objective.by_parameters * &directions.parameters;
    gradient.iter().copied().collect()
}

/// The largest sum of the sizes of the terms in [`along`]: what rounding is to be compared with.
pub(crate) fn size(
    lineariser: &Lineariser,
    objective: &Objective,
    directions: &Directions,
    end: &DMatrix<f64>,
) -> f64 {
    let sizes = objective.by_start.abs() * start(lineariser, directions).abs()
        + objective.by_end.abs() * end.abs()
        + objective.by_parameters.abs() * directions.parameters.abs();
    sizes.iter().copied().fold(0.0, f64::max)
}

/// The whole gradient, backward; `visit` sees the adjoint at the end of every piece, then that at
/// the first time.
pub(crate) fn adjoint(
    pieces: &LinearTape,
    objective: &Objective,
    mut gradient: Gradient,
    visit: &mut dyn FnMut(Option<usize>, &DVector<f64>),
) -> Gradient {
    let LinearTape { lineariser, tape, .. } = *pieces;
    let mut lambda: DVector<f64> = objective.by_end.transpose();
    let at_end = end_shift(lineariser, tape).tr_mul(&lambda) + objective.by_parameters.transpose();
    gradient.parameters.iter_mut().zip(at_end.iter()).for_each(|(sum, value)| *sum += value);
    for at in (0..tape.pieces.len()).rev() {
        let mut add = |regime: &Regime, by: &DVector<f64>| {
            gradient.add_inputs(lineariser.rows(regime), by);
        };
        lambda = pieces.with(at, |piece| {
            let on_surfaces = piece.unproject(lambda, &mut add);
            visit(Some(at), &on_surfaces);
            piece.adjoint(&on_surfaces, &mut add)
        });
    }
    visit(None, &lambda);
    let by_start = lambda + objective.by_start.transpose();
    gradient.starts.iter_mut().zip(by_start.iter()).for_each(|(sum, value)| *sum += value);
    let through_start = lineariser.start_by_parameters().tr_mul(&by_start);
    gradient.parameters.iter_mut().zip(through_start.iter()).for_each(|(sum, value)| *sum += value);
    gradient
}
