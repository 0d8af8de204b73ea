//! What an event does to the state itself, linearised: its resets one after the other, then coming
//! to rest on a surface.

use super::event::EventOnTape;
use super::linearisation::{Jacobian, Lineariser};
use crate::simulate::{EventKind, Instant, Mode, Regime, Tape};
use nalgebra::{DMatrix, DVector, RowDVector};

/// The derivatives of the state after an event by the state, the time and the inputs `(U, p)`
/// before it.
pub(crate) struct Reset {
    pub by_state: DMatrix<f64>,
    pub by_time: DVector<f64>,
    pub by_inputs: DMatrix<f64>,
}

impl Reset {
    pub fn new(lineariser: &Lineariser, tape: &Tape, event: &EventOnTape) -> Self {
        let states = event.before.state.len();
        let regime = &tape.regimes[event.before.regime];
        let mut reset = Reset {
            by_state: DMatrix::identity(states, states),
            by_time: DVector::zeros(states),
            by_inputs: DMatrix::zeros(states, lineariser.inputs(regime)),
        };
        let mut from = event.before;
        let changes = event.changes.iter().map(|it| (Some(it.kind), &it.after));
        for (kind, next) in changes.chain([(None, event.after)]) {
            let gap = next.time - from.time;
            if gap > 0.0 {
                reset.then(&straight_on(lineariser, tape, from, (gap, regime)));
            }
            if let Some(EventKind::Jump(jump)) = kind {
                reset.then(&jump_slopes(lineariser, tape, from, (jump, regime)));
            }
            for slopes in rest_slopes(lineariser, tape, [from, next], regime) {
                reset.then(&slopes);
            }
            from = next;
        }
        reset
    }

    /// Puts a map with the derivatives `[t | x | U | p]` behind.
    fn then(&mut self, slopes: &DMatrix<f64>) {
        let states = self.by_time.len();
        let by_state = slopes.columns(1, states);
        self.by_state = by_state * &self.by_state;
        self.by_time = by_state * &self.by_time + slopes.column(0);
        self.by_inputs =
            by_state * &self.by_inputs + slopes.columns(1 + states, self.by_inputs.ncols());
    }
}

/// `r_(t | x | U | p)` of one jump, with the `U` of a regime.
fn jump_slopes(
    lineariser: &Lineariser,
    tape: &Tape,
    from: &Instant,
    (jump, regime): (usize, &Regime),
) -> DMatrix<f64> {
    let states = from.state.len();
    let all = jacobian(lineariser, tape, from, &*lineariser.system.resets).by;
    let all = lineariser.spread(all, regime, from.time);
    all.view((jump * states, 0), (states, 1 + states + lineariser.inputs(regime))).into_owned()
}

/// Where jumps accumulate the state goes straight on until their limit: `x + gap f`, with the
/// controls of the regime before.
fn straight_on(
    lineariser: &Lineariser,
    tape: &Tape,
    from: &Instant,
    (gap, before): (f64, &Regime),
) -> DMatrix<f64> {
    let regime = Regime { segment: before.segment, ..tape.regimes[from.regime].clone() };
    let x = DVector::from_column_slice(&from.state);
    let mut slopes = lineariser.at(&regime, &from.selectors, from.time, &x).by() * gap;
    (0..from.state.len()).for_each(|state| slopes[(state, 1 + state)] += 1.0);
    slopes
}

/// Where the state comes to rest on surfaces: the Newton steps on `psi` and on `psi'` that bring it
/// there, with the `U` of a regime. What stands still on another surface is not moved.
fn rest_slopes(
    lineariser: &Lineariser,
    tape: &Tape,
    [from, next]: [&Instant; 2],
    regime: &Regime,
) -> Vec<DMatrix<f64>> {
    let [old, new] = [from, next].map(|at| &tape.regimes[at.regime]);
    let comes = |i: &usize| new.modes[*i] == Mode::Held && old.modes[*i] != Mode::Held;
    let slopes = |surface: usize| {
        let columns = 1 + next.state.len() + lineariser.inputs(regime);
        let [psi, rates] = [&lineariser.system.switching, &lineariser.system.rates].map(|of| {
            let by = jacobian(lineariser, tape, next, &**of).by;
            let by = lineariser.spread(by, regime, next.time);
            by.row(surface).columns(0, columns).into_owned()
        });
        let normal = |by: &RowDVector<f64>, is_moved: &dyn Fn(usize) -> bool| {
            RowDVector::from_fn(next.state.len(), |_, i| f64::from(is_moved(i)) * by[1 + i])
        };
        let along = normal(&psi, &|i| !old.held.contains(&i));
        let pushes = normal(&rates, &|i| new.held.contains(&i) && !old.held.contains(&i));
        [correction(&along, &psi), correction(&pushes, &rates)]
    };
    (0..new.modes.len()).filter(comes).flat_map(slopes).collect()
}

/// The derivative of `x - a c / |a|^2` where `c = 0`, given `c_(t | x | U | p)`.
fn correction(along: &RowDVector<f64>, slopes: &RowDVector<f64>) -> DMatrix<f64> {
    let states = along.len();
    let mut matrix = DMatrix::zeros(states, slopes.len());
    matrix.view_mut((0, 1), (states, states)).fill_with_identity();
    let square = along.norm_squared();
    if square > 0.0 { matrix - along.transpose() * slopes / square } else { matrix }
}

fn jacobian(
    lineariser: &Lineariser,
    tape: &Tape,
    at: &Instant,
    function: &dyn crate::problem::Function,
) -> Jacobian {
    let x = DVector::from_column_slice(&at.state);
    let table = lineariser.table(&tape.regimes[at.regime], &at.selectors, at.time, &x);
    Jacobian::of(function, &table, &lineariser.parameters)
}
