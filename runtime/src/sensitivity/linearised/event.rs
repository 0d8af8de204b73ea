//! An event, a change of controls or the start as a linear map of derivatives: the saltation
//! matrix.
//!
//! The time of an event on `g(t, x, p) = 0` moves by `tau = -(g_x S + g_p P) / (g_x f- + g_t)`. The
//! state there is reset to `r(t, x, p)` (the identity at crossings, entries and exits) and goes on
//! with `f+`, so at a fixed time after it
//!
//! ```text
//! S+ = r_x S + r_p P + c tau,     c = r_x f- + r_t - f+
//! ```
//!
//! At crossings this is (3.6) in either direction, at entries into sliding (3.5), at exits and
//! kinks of the right side the identity, because `f- = f+` there. What slides across a kink of
//! `psi` turns there, or leaves. Transposed: `lambda- = r_x^T lambda+ + (c^T
//! lambda+) tau_x^T`. Where a change of controls or an end of the interval moves with parameters,
//! `tau` is its derivative.

use super::linearisation::{Jacobian, Linearisation, Lineariser, sliding};
use super::reset::Reset;
use crate::problem::Function;
use crate::simulate::{Cause, Change, Instant, Regime, Tape};
use nalgebra::{DMatrix, DVector, RowDVector};

/// An event, linearised.
pub(crate) struct LinearEvent {
    /// `r_x`.
    pub by_state: DMatrix<f64>,
    /// `r_(U, p)`.
    pub by_inputs: DMatrix<f64>,
    /// `c`.
    pub shift: DVector<f64>,
    /// `tau = tau_x S + tau_(U, p) W`.
    pub timing: Timing,
}

/// How the time of an event depends on what was before.
pub(crate) struct Timing {
    pub by_state: RowDVector<f64>,
    pub by_inputs: RowDVector<f64>,
}

/// What happens at an event.
pub(crate) struct EventOnTape<'t> {
    pub cause: Cause,
    pub before: &'t Instant,
    pub after: &'t Instant,
    pub changes: &'t [Change],
}

impl LinearEvent {
    pub fn new(lineariser: &Lineariser, tape: &Tape, event: &EventOnTape) -> Self {
        let EventOnTape { before, after, .. } = *event;
        let Reset { by_state, by_time, by_inputs } = Reset::new(lineariser, tape, event);
        let arriving = match event.cause {
            Cause::Start => DVector::zeros(before.state.len()),
            _ => &by_state * lineariser.rate_at_instant(tape, before),
        };
        // On no surface, or where none is left, a kink changes no rate.
        let is_smooth =
            event.changes.is_empty() && sliding(&tape.regimes[before.regime]).is_empty();
        let shift = match event.cause {
            Cause::CrossesKink(_) if is_smooth => DVector::zeros(arriving.len()),
            _ => arriving + by_time - lineariser.rate_at_instant(tape, after),
        };
        let timing = Timing::new(lineariser, tape, event);
        LinearEvent { by_state, by_inputs, shift, timing }
    }

    /// `w` are the directions of `(U, p)` before the event.
    pub fn forward(&self, s: &DMatrix<f64>, w: &DMatrix<f64>) -> DMatrix<f64> {
        let moved = self.timing.of(s, w);
        &self.by_state * s + &self.by_inputs * w + &self.shift * moved
    }

    /// The adjoint before the event and the derivative by the `(U, p)` before it.
    pub fn adjoint(&self, after: &DVector<f64>) -> (DVector<f64>, DVector<f64>) {
        let by_time = self.shift.dot(after);
        let before = self.by_state.tr_mul(after) + self.timing.by_state.transpose() * by_time;
        let inputs = self.by_inputs.tr_mul(after) + self.timing.by_inputs.transpose() * by_time;
        (before, inputs)
    }
}

impl Timing {
    /// `tau`, one entry for each direction.
    pub fn of(&self, s: &DMatrix<f64>, w: &DMatrix<f64>) -> RowDVector<f64> {
        &self.by_state * s + &self.by_inputs * w
    }

    pub fn new(lineariser: &Lineariser, tape: &Tape, event: &EventOnTape) -> Self {
        let regime = &tape.regimes[event.before.regime];
        match event.cause {
            Cause::Controls if !lineariser.is_stretched() => {
                return Timing::fixed(lineariser, regime);
            }
            Cause::Start | Cause::Controls => {
                return Timing::of_clock(lineariser, regime, event.before.time);
            }
            _ => {}
        }
        let reached = lineariser.at_instant(tape, event.before);
        let slopes_of = |function: &dyn Function| {
            let x = DVector::from_column_slice(&event.before.state);
            let table = lineariser.table(regime, &reached.selectors, event.before.time, &x);
            let by = Jacobian::of(function, &table, &lineariser.parameters).by;
            let by = lineariser.spread(by, regime, event.before.time);
            by.columns(0, reached.by().ncols()).into_owned()
        };
        match event.cause {
            Cause::Reaches(surface) => {
                let by = slopes_of(&*lineariser.system.switching);
                let slopes = normal(lineariser, &by, &reached.selectors, surface);
                Timing::implicit(&slopes, &reached.rate)
            }
            Cause::CrossesKink(kink) => {
                let by = slopes_of(&*lineariser.system.kinks);
                Timing::implicit(&by.row(kink).into_owned(), &reached.rate)
            }
            Cause::Leaves(surface) => {
                Timing::implicit(&reached.selectors_by.row(surface).into_owned(), &reached.rate)
            }
            _ => Timing::implicit(&RowDVector::zeros(reached.by().ncols()), &reached.rate),
        }
    }

    /// A time that does not move.
    fn fixed(lineariser: &Lineariser, regime: &Regime) -> Self {
        let by_inputs = RowDVector::zeros(lineariser.inputs(regime));
        Timing { by_state: RowDVector::zeros(lineariser.system.layout.x), by_inputs }
    }

    /// A time that is a fixed part of the interval.
    fn of_clock(lineariser: &Lineariser, regime: &Regime, time: f64) -> Self {
        Timing::by_parameters(lineariser, regime, &lineariser.clock(time))
    }

    /// The last time, also where it is the first.
    pub fn of_end(lineariser: &Lineariser, regime: &Regime) -> Self {
        Timing::by_parameters(lineariser, regime, &lineariser.ends_by.row(1).into_owned())
    }

    fn by_parameters(lineariser: &Lineariser, regime: &Regime, by: &RowDVector<f64>) -> Self {
        let layout = lineariser.layout(regime);
        let mut timing = Timing::fixed(lineariser, regime);
        timing.by_inputs.columns_mut(layout.u, layout.p).copy_from(by);
        timing
    }

    /// The time at which `g = 0`, from `g_(t | x | U | p)`; it does not move if nothing moves `g`.
    fn implicit(slopes: &RowDVector<f64>, rate: &DVector<f64>) -> Self {
        let states = rate.len();
        let normal = slopes.columns(1, states);
        let speed = (normal * rate)[0] + slopes[0];
        let factor = if speed == 0.0 { 0.0 } else { -1.0 / speed };
        let rest = slopes.columns(1 + states, slopes.len() - 1 - states);
        Timing { by_state: normal * factor, by_inputs: rest * factor }
    }
}

/// `psi_z` of a surface; of a ball that comes to 0, that of its length.
fn normal(
    lineariser: &Lineariser,
    by: &DMatrix<f64>,
    selectors: &[f64],
    surface: usize,
) -> RowDVector<f64> {
    match lineariser.system.balls.iter().find(|ball| ball.surfaces.contains(&surface)) {
        Some(ball) => {
            let zero = RowDVector::zeros(by.ncols());
            ball.surfaces.clone().fold(zero, |sum, i| sum + by.row(i) * selectors[i])
        }
        None => by.row(surface).into_owned(),
    }
}

impl Lineariser<'_> {
    pub fn rate_at_instant(&self, tape: &Tape, at: &Instant) -> DVector<f64> {
        let x = DVector::from_column_slice(&at.state);
        self.rate(&tape.regimes[at.regime], &at.selectors, at.time, &x)
    }

    pub fn at_instant(&self, tape: &Tape, at: &Instant) -> Linearisation {
        let x = DVector::from_column_slice(&at.state);
        self.at(&tape.regimes[at.regime], &at.selectors, at.time, &x)
    }
}
