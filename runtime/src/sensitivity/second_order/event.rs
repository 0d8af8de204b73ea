//! The second-order part of an event: to the moved time, through the resets, back to the fixed
//! time.

use super::curvature::{Completed, Hessians};
use crate::problem::Columns;
use crate::sensitivity::linearised::event::EventOnTape;
use crate::sensitivity::linearised::linearisation::{Jacobian, Linearisation, Lineariser};
use crate::simulate::{Cause, EventKind, Instant, Regime, Tape};
use nalgebra::{DMatrix, DVector, DVectorView, RowDVector};

/// One vector for each pair of directions.
#[derive(Clone)]
pub(crate) struct Pairs {
    count: usize,
    /// Columns are the pairs `(i, j)` with `j <= i`, row by row.
    pub columns: DMatrix<f64>,
}

impl Pairs {
    pub fn new(count: usize, mut of: impl FnMut(usize, usize) -> DVector<f64>) -> Self {
        let pairs = (0..count).flat_map(|i| (0..=i).map(move |j| (i, j)));
        let vectors: Vec<DVector<f64>> = pairs.map(|(i, j)| of(i, j)).collect();
        Pairs { count, columns: DMatrix::from_columns(&vectors) }
    }

    pub fn at(&self, i: usize, j: usize) -> DVectorView<'_, f64> {
        let (i, j) = (i.max(j), i.min(j));
        self.columns.column(i * (i + 1) / 2 + j)
    }

    pub fn map(
        &self,
        mut of: impl FnMut(usize, usize, DVectorView<'_, f64>) -> DVector<f64>,
    ) -> Self {
        Pairs::new(self.count, |i, j| of(i, j, self.at(i, j)))
    }

    /// The same pairs with other vectors.
    pub fn with(&self, columns: DMatrix<f64>) -> Self {
        Pairs { count: self.count, columns }
    }
}

/// An event whose time moves by `tau` in each direction.
pub(crate) struct SecondOrderEvent<'b> {
    pub lineariser: &'b Lineariser<'b>,
    pub tape: &'b Tape,
    pub event: &'b EventOnTape<'b>,
    pub tau: &'b RowDVector<f64>,
}

/// Derivatives of the state at the moved time of an event, and second ones of that time.
pub(crate) struct Moved {
    pub s: DMatrix<f64>,
    pub x: Pairs,
    tau: Pairs,
}

impl SecondOrderEvent<'_> {
    /// The state that meets the event, from what it is at a fixed time; `directions` are `(t, x, U,
    /// p)`.
    pub fn meet(&self, s: &DMatrix<f64>, x: &Pairs, directions: &[DVector<f64>]) -> Moved {
        if self.event.cause == Cause::Start {
            return Moved { s: s.clone(), x: x.clone(), tau: self.clock(directions) };
        }
        let arriving = self.lineariser.at_instant(self.tape, self.event.before);
        let swept = self.swept(&arriving, directions);
        let x = x.map(|i, j, x| x + swept(i, j));
        let s = s + &arriving.rate * self.tau;
        let tau = self.second_tau(&arriving, &s, &x, directions);
        let x = x.map(|i, j, x| x + &arriving.rate * tau.at(i, j)[0]);
        Moved { s, x, tau }
    }

    /// Through all resets, one after the other.
    pub fn reset(&self, mut moved: Moved, directions: &[DVector<f64>]) -> Moved {
        let system = self.lineariser.system;
        let states = system.layout.x;
        let mut from = self.event.before;
        for change in self.event.changes {
            if let EventKind::Jump(jump) = change.kind {
                let table = self.table(from);
                let by = Jacobian::of(&*system.resets, &table, &self.lineariser.parameters).by;
                let by = by.rows(jump * states, states);
                let hessians = Hessians::of(&*system.resets, &table, &self.lineariser.parameters);
                let whole = self.moved(directions, &moved.s);
                let (by_state, by_time) = (by.columns(1, states), by.column(0));
                let by_controls = by.columns_range(system.layout.controls());
                moved.x = moved.x.map(|i, j, x| {
                    let (pair, tau) = ([&whole[i], &whole[j]], moved.tau.at(i, j)[0]);
                    let curvature = hessians.along(&pair[0].whole, &pair[1].whole);
                    let curvature = curvature.rows(jump * states, states) + by_time * tau;
                    by_state * x + curvature + by_controls * self.control_curvature(pair, tau)
                });
                for (i, whole) in whole.iter().enumerate() {
                    moved.s.set_column(i, &(by * &whole.whole));
                }
            }
            from = &change.after;
        }
        moved
    }

    /// Back to the fixed time, along the right side after the event; `directions` are those there.
    pub fn leave(
        &self,
        onward: &Linearisation,
        moved: &Moved,
        directions: &[DVector<f64>],
    ) -> Pairs {
        let swept = self.swept(onward, directions);
        moved.x.map(|i, j, x| x - swept(i, j) - &onward.rate * moved.tau.at(i, j)[0])
    }

    /// `f_i tau_j + f_j tau_i + f_t tau_i tau_j` with derivatives along the path at fixed time and
    /// along the flow.
    fn swept(
        &self,
        point: &Linearisation,
        directions: &[DVector<f64>],
    ) -> impl Fn(usize, usize) -> DVector<f64> {
        let mut along_flow = DVector::zeros(point.by().ncols());
        along_flow[0] = 1.0;
        along_flow.rows_mut(1, point.rate.len()).copy_from(&point.rate);
        let by_flow = point.by() * along_flow;
        let by_direction: Vec<DVector<f64>> = directions.iter().map(|it| point.by() * it).collect();
        let tau = self.tau.clone();
        move |i, j| {
            &by_direction[i] * tau[j] + &by_direction[j] * tau[i] + &by_flow * (tau[i] * tau[j])
        }
    }

    /// `tau_ij`. Where a selector reaches its end nothing depends on it, because the right side has
    /// no jump there.
    fn second_tau(
        &self,
        arriving: &Linearisation,
        s: &DMatrix<f64>,
        x: &Pairs,
        directions: &[DVector<f64>],
    ) -> Pairs {
        let system = self.lineariser.system;
        let (function, row) = match self.event.cause {
            Cause::Reaches(surface) => (&system.switching, surface),
            Cause::CrossesKink(kink) => (&system.kinks, kink),
            Cause::Controls if !self.lineariser.is_stretched() => {
                return Pairs::new(directions.len(), |_, _| DVector::zeros(1));
            }
            _ => return self.clock(directions),
        };
        let table = self.table(self.event.before);
        let by = Jacobian::of(&**function, &table, &self.lineariser.parameters).by;
        let (normal, by_time) =
            (by.row(row).columns(1, system.layout.x).into_owned(), by[(row, 0)]);
        let speed = (&normal * &arriving.rate)[0] + by_time;
        let hessians = Hessians::of(&**function, &table, &self.lineariser.parameters);
        let whole = self.moved(directions, s);
        x.map(|i, j, x| {
            let curvature = hessians.along(&whole[i].whole, &whole[j].whole)[row];
            DVector::from_element(1, -((&normal * x)[0] + curvature) / speed)
        })
    }

    /// `tau_ij` of a time that is a fixed part of the interval.
    fn clock(&self, directions: &[DVector<f64>]) -> Pairs {
        let layout = self.lineariser.layout(self.regime());
        let tau = self.lineariser.tau(self.event.before.time);
        let parameters = |i: usize| directions[i].rows_range(layout.parameters()).into_owned();
        Pairs::new(directions.len(), |i, j| {
            let ends = self.lineariser.interval_curvature(&parameters(i), &parameters(j));
            DVector::from_element(1, (1.0 - tau) * ends[0] + tau * ends[1])
        })
    }

    fn table(&self, at: &Instant) -> Columns {
        let state = DVector::from_column_slice(&at.state);
        self.lineariser.table(&self.tape.regimes[at.regime], &at.selectors, at.time, &state)
    }

    /// `u_ij` at the moved time.
    fn control_curvature(&self, pair: [&Completed; 2], t_ij: f64) -> DVector<f64> {
        let (regime, time) = (self.regime(), self.event.before.time);
        if self.lineariser.is_curved(regime) {
            self.lineariser.control_curvature(regime, time, pair, t_ij)
        } else {
            DVector::zeros(self.lineariser.system.layout.u)
        }
    }

    fn regime(&self) -> &Regime {
        &self.tape.regimes[self.event.before.regime]
    }

    /// Directions with the moved time and state, `[t | x | u | p | s]`; selectors enter neither
    /// surfaces nor resets.
    fn moved(&self, directions: &[DVector<f64>], s: &DMatrix<f64>) -> Vec<Completed> {
        let one = |(i, direction): (usize, &DVector<f64>)| {
            let mut moved = direction.clone();
            moved[0] = self.tau[i];
            moved.rows_mut(1, s.nrows()).copy_from(&s.column(i));
            self.lineariser.completed(&moved, self.regime(), self.event.before.time)
        };
        directions.iter().enumerate().map(one).collect()
    }
}
