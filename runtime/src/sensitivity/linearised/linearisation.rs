//! The right side in a regime with its derivatives by everything, selectors eliminated.
//!
//! With `w = (t, x, u, p)` and `r = psi'` on the sliding surfaces `A`, the selectors solve `r_A(w,
//! s_A) = 0`, so
//!
//! ```text
//! s_w = -r_s^-1 r_w,      f*_w = f_w + f_s s_w
//! ```
//!
//! Controls may be functions of time and parameters; see [`super::controls`].

use crate::problem::{Columns, Function, Layout};
use crate::simulate::{Ball, Controls, Mode, Regime, System};
use nalgebra::{DMatrix, DMatrixView, DVector};
use std::cell::RefCell;

/// A vector below this many times what it is made of is 0, as for the simulator.
const AT_ZERO: f64 = 1e-12;

/// Right side and derivatives at one point.
pub(crate) struct Linearisation {
    /// `f*`.
    pub rate: DVector<f64>,
    /// All selectors.
    pub selectors: Vec<f64>,
    /// `s_w`, one row for each selector; no rows where all are constant.
    pub selectors_by: DMatrix<f64>,
    /// `f*_w`, then `f_s`: `[t | x | U | p | s]`.
    whole: DMatrix<f64>,
    layout: Layout,
}

impl Linearisation {
    /// `f*_w`, with the columns `[t | x | U | p]`.
    pub fn by(&self) -> DMatrixView<'_, f64> {
        self.whole.columns(0, self.layout.selectors().start)
    }

    /// `f*_x`.
    pub fn by_state(&self) -> DMatrixView<'_, f64> {
        self.whole.columns(1, self.layout.x)
    }

    /// `f*_(U, p)`.
    pub fn by_inputs(&self) -> DMatrixView<'_, f64> {
        self.whole.columns(1 + self.layout.x, self.layout.u + self.layout.p)
    }

    /// `f_s`.
    pub fn by_selectors(&self) -> DMatrixView<'_, f64> {
        self.whole.columns(self.layout.selectors().start, self.layout.s)
    }

    /// Adds what the right side gains through selectors with these slopes.
    fn add_through(&mut self, surfaces: &[usize], slopes: &DMatrix<f64>) {
        let through = self.by_selectors().select_columns(surfaces) * slopes;
        let mut by = self.whole.columns_mut(0, self.layout.selectors().start);
        by += through;
        if self.selectors_by.is_empty() {
            self.selectors_by = DMatrix::zeros(self.layout.s, slopes.ncols());
        }
        for (row, &i) in surfaces.iter().enumerate() {
            self.selectors_by.row_mut(i).copy_from(&slopes.row(row));
        }
    }
}

/// Evaluates right sides and switching functions of one system.
pub(crate) struct Lineariser<'a> {
    pub system: &'a System,
    pub parameters: Vec<f64>,
    /// `d(t0, tf)/dp`.
    pub ends_by: DMatrix<f64>,
    pub controls: &'a Controls,
    /// Values and derivatives of the right side as its function gives them, again and again in the
    /// same memory.
    pub results: RefCell<[Columns; 2]>,
}

impl<'a> Lineariser<'a> {
    pub fn new(system: &'a System, controls: &'a Controls) -> Self {
        let parameters = system.parameter_values();
        let ends_by = Jacobian::of(&*system.interval_of, &Columns::new(0, 1), &parameters).by;
        let entries = system.flow.jacobian_pattern().entries.len();
        let results = RefCell::new([Columns::new(system.layout.x, 1), Columns::new(entries, 1)]);
        Lineariser { system, parameters, ends_by, controls, results }
    }

    /// The right side at a point of a regime; sliding selectors are searched from `near` on.
    pub fn at(&self, regime: &Regime, near: &[f64], t: f64, x: &DVector<f64>) -> Linearisation {
        let mut table = self.table(regime, near, t, x);
        let directions = self.follow_directions(&mut table, regime, x);
        let sliding = sliding(regime);
        let rates = (!sliding.is_empty()).then(|| self.solve(&mut table, &sliding, regime));
        let mut point = self.free(&table, regime);
        if let Some(slopes) = directions {
            point.add_through(&(0..self.system.layout.s).collect::<Vec<_>>(), &slopes);
        }
        if let Some(rates) = &rates {
            self.eliminate(&mut point, &rates.by, &sliding);
        }
        point.whole = self.spread(point.whole, regime, t);
        point.selectors_by = self.spread(point.selectors_by, regime, t);
        point.layout = self.layout(regime);
        point
    }

    /// The right side alone.
    pub fn rate(&self, regime: &Regime, near: &[f64], t: f64, x: &DVector<f64>) -> DVector<f64> {
        let is_given = |mode: &Mode| matches!(mode, Mode::Below | Mode::Above);
        if !regime.modes.iter().all(is_given) {
            return self.at(regime, near, t, x).rate;
        }
        let mut values = Columns::new(self.system.layout.x, 1);
        self.system.flow.value(&self.table(regime, near, t, x), &self.parameters, &mut values);
        DVector::from_fn(self.system.layout.x, |row, _| values.column(row)[0])
    }

    /// The columns `[t | x | u | s]`.
    pub fn table(&self, regime: &Regime, near: &[f64], t: f64, x: &DVector<f64>) -> Columns {
        let control = self.control(regime, t);
        let values = std::iter::once(&t).chain(x.iter()).chain(control.iter()).chain(near);
        let mut table = Columns::new(self.system.layout.point_inputs(), 1);
        values.enumerate().for_each(|(column, value)| table.column_mut(column)[0] = *value);
        table
    }

    /// Gives the selectors of moving balls their values, `psi/|psi|`; their slopes, `(I - s
    /// s')/|psi| psi_w`. At 0, where a ball departs or lands, they are those that the table has,
    /// and constant.
    fn follow_directions(
        &self,
        table: &mut Columns,
        regime: &Regime,
        x: &DVector<f64>,
    ) -> Option<DMatrix<f64>> {
        let is_moving = |ball: &&Ball| regime.modes[ball.surfaces.start] == Mode::Moving;
        let moving: Vec<&Ball> = self.system.balls.iter().filter(is_moving).collect();
        let layout = self.system.layout;
        let mut slopes =
            (!moving.is_empty()).then(|| DMatrix::zeros(layout.s, layout.selectors().start))?;
        let switching = Jacobian::of(&*self.system.switching, table, &self.parameters);
        let first = table.columns() - layout.s;
        for ball in moving {
            let (at, count) = (ball.surfaces.start, ball.surfaces.len());
            let psi = switching.values.rows(at, count);
            let by = switching.by.view((at, 0), (count, slopes.ncols()));
            let noise = (by.columns(1, layout.x).abs() * x.abs()).amax();
            if psi.norm() <= AT_ZERO * (1.0 + noise) {
                continue;
            }
            let s = psi / psi.norm();
            ball.surfaces
                .clone()
                .zip(s.iter())
                .for_each(|(i, s)| table.column_mut(first + i)[0] = *s);
            slopes.rows_mut(at, count).copy_from(&((by - &s * s.tr_mul(&by)) / psi.norm()));
        }
        Some(slopes)
    }

    /// Newton's method for the sliding selectors; the derivatives of the rates at the solution.
    fn solve(&self, table: &mut Columns, sliding: &[usize], regime: &Regime) -> Jacobian {
        let first = table.columns() - self.system.layout.s;
        for _ in 0..30 {
            let rates = self.rates(table, regime);
            let by = self.by_selectors(&rates.by).select_columns(sliding).select_rows(sliding);
            let r = DVector::from_iterator(sliding.len(), sliding.iter().map(|&i| rates.values[i]));
            let Some(change) = by.lu().solve(&r) else { break };
            for (&i, change) in sliding.iter().zip(change.iter()) {
                table.column_mut(first + i)[0] -= change;
            }
            if change.amax() <= 1e-13 {
                break;
            }
        }
        self.rates(table, regime)
    }

    /// `psi'` with its derivatives; states that stand still do not move the surfaces.
    fn rates(&self, table: &Columns, regime: &Regime) -> Jacobian {
        let rates = Jacobian::of(&*self.system.rates, table, &self.parameters);
        if regime.held.is_empty() {
            return rates;
        }
        let flow = Jacobian::of(&*self.system.flow, table, &self.parameters);
        let switching = Jacobian::of(&*self.system.switching, table, &self.parameters);
        rates.without_motion(&flow, &switching, &regime.held)
    }

    fn by_selectors<'m>(&self, by: &'m DMatrix<f64>) -> nalgebra::DMatrixView<'m, f64> {
        by.columns(self.system.layout.selectors().start, self.system.layout.s)
    }

    /// The right side with all selectors given.
    fn free(&self, table: &Columns, regime: &Regime) -> Linearisation {
        let layout = self.system.layout;
        let results = &mut *self.results.borrow_mut();
        let Jacobian { values: mut rate, mut by } =
            Jacobian::in_memory(&*self.system.flow, table, &self.parameters, results);
        for &state in &regime.held {
            rate[state] = 0.0;
            by.row_mut(state).fill(0.0);
        }
        let first = table.columns() - layout.s;
        let selectors = (first..table.columns()).map(|column| table.column(column)[0]).collect();
        Linearisation { rate, selectors, selectors_by: DMatrix::zeros(0, 0), whole: by, layout }
    }

    /// Sliding selectors are functions of the rest.
    fn eliminate(&self, point: &mut Linearisation, rates: &DMatrix<f64>, sliding: &[usize]) {
        let by_selectors = self.by_selectors(rates).select_columns(sliding).select_rows(sliding);
        let mut by_rest = rates.columns(0, self.system.layout.selectors().start).into_owned();
        if !point.selectors_by.is_empty() {
            by_rest += self.by_selectors(rates) * &point.selectors_by;
        }
        let Some(slopes) = by_selectors.lu().solve(&-by_rest.select_rows(sliding)) else { return };
        point.add_through(sliding, &slopes);
    }

    /// `dx(t0)/dp`.
    pub fn start_by_parameters(&self) -> DMatrix<f64> {
        Jacobian::of(&*self.system.start_of, &Columns::new(0, 1), &self.parameters).by
    }
}

/// The surfaces that a regime slides on.
pub(crate) fn sliding(regime: &Regime) -> Vec<usize> {
    (0..regime.modes.len()).filter(|&i| regime.modes[i] == Mode::Sliding).collect()
}

/// Values and first derivatives of a function at one point.
pub(crate) struct Jacobian {
    pub values: DVector<f64>,
    pub by: DMatrix<f64>,
}

impl Jacobian {
    pub fn of(function: &dyn Function, point: &Columns, parameters: &[f64]) -> Self {
        let entries = function.jacobian_pattern().entries.len();
        let mut results = [Columns::new(function.outputs(), 1), Columns::new(entries, 1)];
        Self::in_memory(function, point, parameters, &mut results)
    }

    /// The same with memory for the columns of values and entries.
    fn in_memory(
        function: &dyn Function,
        point: &Columns,
        parameters: &[f64],
        [values, entries]: &mut [Columns; 2],
    ) -> Self {
        let pattern = function.jacobian_pattern();
        function.jacobian(point, parameters, values, entries);
        let mut by = DMatrix::zeros(function.outputs(), function.layout().inputs());
        for (entry, &(row, column)) in pattern.entries.iter().enumerate() {
            by[(row as usize, column as usize)] = entries.column(entry)[0];
        }
        let values = DVector::from_fn(function.outputs(), |row, _| values.column(row)[0]);
        Jacobian { values, by }
    }

    /// Takes the motion of some states out of `psi'`. (Second derivatives of `psi` by a state that
    /// stands still are not taken out of the slopes; surfaces that are curved there would need
    /// them.)
    fn without_motion(mut self, flow: &Jacobian, switching: &Jacobian, states: &[usize]) -> Self {
        for surface in 0..self.values.len() {
            for &state in states {
                let normal = switching.by[(surface, 1 + state)];
                self.values[surface] -= normal * flow.values[state];
                let row = self.by.row(surface) - normal * flow.by.row(state);
                self.by.row_mut(surface).copy_from(&row);
            }
        }
        self
    }
}
