//! Second derivatives of the right side in a regime, selectors eliminated, along pairs of
//! directions.
//!
//! With `W_i` a direction of `(t, x, U, p)` completed by the controls and `s_i = s_w W_i`
//!
//! ```text
//! f*_ww[W_i, W_j] = f_zz[W_i, W_j] + f_s s_ij + f*_u u_ij,     s_ij = -r_s^-1 (r_zz[W_i, W_j])
//! ```
//!
//! where `u_ij` is the curvature of controls that change with time.

use crate::problem::{Columns, Function};
use crate::sensitivity::linearised::linearisation::{Jacobian, Linearisation, Lineariser, sliding};
use crate::simulate::Regime;
use nalgebra::{DMatrix, DVector};

/// The Hessians of all outputs of a function at one point.
pub(crate) struct Hessians {
    entries: Columns,
    pattern: Vec<(u32, u32)>,
    outputs: usize,
}

impl Hessians {
    /// One evaluation at as many copies of the point as there are outputs.
    pub fn of(function: &dyn Function, point: &Columns, parameters: &[f64]) -> Self {
        let outputs = function.outputs();
        let mut points = Columns::new(point.columns(), outputs);
        for column in 0..point.columns() {
            points.column_mut(column).fill(point.column(column)[0]);
        }
        let mut multipliers = Columns::new(outputs, outputs);
        (0..outputs).for_each(|at| multipliers.column_mut(at)[at] = 1.0);
        let pattern = function.hessian_pattern().entries.clone();
        let mut values = Columns::new(outputs, outputs);
        let mut jacobian = Columns::new(function.jacobian_pattern().entries.len(), outputs);
        let mut entries = Columns::new(pattern.len(), outputs);
        function.derivatives(
            &points,
            parameters,
            &multipliers,
            &mut values,
            &mut jacobian,
            &mut entries,
        );
        Hessians { entries, pattern, outputs }
    }

    /// `f_zz[a, b]`, one entry for each output.
    pub fn along(&self, a: &DVector<f64>, b: &DVector<f64>) -> DVector<f64> {
        let mut sum = DVector::zeros(self.outputs);
        for (entry, &(row, column)) in self.pattern.iter().enumerate() {
            let (row, column) = (row as usize, column as usize);
            let weight = if row == column {
                a[row] * b[row]
            } else {
                a[row] * b[column] + a[column] * b[row]
            };
            if weight != 0.0 {
                self.entries
                    .column(entry)
                    .iter()
                    .zip(sum.iter_mut())
                    .for_each(|(h, sum)| *sum += weight * h);
            }
        }
        sum
    }
}

/// A direction.
pub(crate) struct Completed {
    /// `[t | x | u | p | s]`.
    pub whole: DVector<f64>,
    /// How the rate of the controls moves with the numbers that make them.
    slope: DVector<f64>,
}

/// The right side at one point to the second order.
pub(crate) struct Curvature<'l, 'a> {
    lineariser: &'l Lineariser<'a>,
    regime: &'l Regime,
    point: &'l Linearisation,
    flow: Hessians,
    /// Second derivatives of the rates of the sliding surfaces, and `-f_s r_s^-1`.
    rates: Option<(Hessians, Vec<usize>, DMatrix<f64>)>,
    time: f64,
}

impl<'l, 'a> Curvature<'l, 'a> {
    pub fn new(
        lineariser: &'l Lineariser<'a>,
        point: &'l Linearisation,
        regime: &'l Regime,
        time: f64,
        x: &DVector<f64>,
    ) -> Self {
        let table = lineariser.table(regime, &point.selectors, time, x);
        let flow = Hessians::of(&*lineariser.system.flow, &table, &lineariser.parameters);
        let sliding = sliding(regime);
        let rates =
            if sliding.is_empty() { None } else { rates(lineariser, point, &table, sliding) };
        Curvature { lineariser, regime, point, flow, rates, time }
    }

    /// A direction `(t, x, U, p)` with what follows it.
    pub fn complete(&self, direction: &DVector<f64>) -> Completed {
        let mut completed = self.lineariser.completed(direction, self.regime, self.time);
        if !self.point.selectors_by.is_empty() {
            let selectors = &self.point.selectors_by * direction;
            let layout = self.lineariser.system.layout;
            completed.whole.rows_range_mut(layout.selectors()).copy_from(&selectors);
        }
        completed
    }

    /// `f*_ww` along two completed directions.
    pub fn along(&self, a: &Completed, b: &Completed) -> DVector<f64> {
        let mut sum = self.flow.along(&a.whole, &b.whole);
        if let Some((hessians, sliding, push)) = &self.rates {
            sum += push * hessians.along(&a.whole, &b.whole).select_rows(sliding);
        }
        if self.lineariser.is_curved(self.regime) {
            let curvature = self.lineariser.control_curvature(self.regime, self.time, [a, b], 0.0);
            sum += self.by_controls() * curvature;
        }
        sum
    }

    /// `f*_u`: what the numbers of a polynomial contribute to it are parts of 1.
    fn by_controls(&self) -> DMatrix<f64> {
        let own = self.lineariser.layout(self.regime).controls();
        let count = self.lineariser.system.layout.u;
        let by = self.point.by();
        let blocks = own.clone().step_by(count).map(|first| by.columns(first, count));
        blocks.fold(DMatrix::zeros(by.nrows(), count), |sum, block| sum + block)
    }
}

fn rates(
    lineariser: &Lineariser,
    point: &Linearisation,
    table: &Columns,
    sliding: Vec<usize>,
) -> Option<(Hessians, Vec<usize>, DMatrix<f64>)> {
    let system = lineariser.system;
    let by = Jacobian::of(&*system.rates, table, &lineariser.parameters).by;
    let by_selectors = by.columns(system.layout.selectors().start, system.layout.s);
    let inverse = by_selectors.select_columns(&sliding).select_rows(&sliding).try_inverse()?;
    let push = -(point.by_selectors().select_columns(&sliding) * inverse);
    let hessians = Hessians::of(&*system.rates, table, &lineariser.parameters);
    Some((hessians, sliding, push))
}

impl Lineariser<'_> {
    /// `d2(t0, tf)` along two directions of parameters.
    pub fn interval_curvature(&self, a: &DVector<f64>, b: &DVector<f64>) -> DVector<f64> {
        Hessians::of(&*self.system.interval_of, &Columns::new(0, 1), &self.parameters).along(a, b)
    }

    /// `d2x(t0)` along two directions of parameters.
    pub fn start_curvature(&self, a: &DVector<f64>, b: &DVector<f64>) -> DVector<f64> {
        Hessians::of(&*self.system.start_of, &Columns::new(0, 1), &self.parameters).along(a, b)
    }

    /// A direction `(t, x, U, p)` with the controls; selectors do not move.
    pub fn completed(&self, direction: &DVector<f64>, regime: &Regime, time: f64) -> Completed {
        let whole = self.whole(direction, regime, time);
        Completed { whole, slope: self.of_numbers(direction, regime, time, 1) }
    }

    /// `u_ij` of controls that change with time, where the time itself moves by `t_ij`.
    pub fn control_curvature(
        &self,
        regime: &Regime,
        time: f64,
        [a, b]: [&Completed; 2],
        t_ij: f64,
    ) -> DVector<f64> {
        let [first, last] = self.system.interval;
        let [tau_a, tau_b, tau_ab] = self.moved_tau(time, [&a.whole, &b.whole], t_ij);
        if self.is_guessed() {
            return self.guess_curvature(time, [tau_a, tau_b, tau_ab], [&a.whole, &b.whole]);
        }
        let [t_a, t_b, t_ab] = [tau_a, tau_b, tau_ab].map(|tau| tau * (last - first));
        let of_order = |order: usize| {
            DVector::from_vec(self.controls.derivatives(regime.segment, time, order))
        };
        of_order(2) * (t_a * t_b) + of_order(1) * t_ab + &a.slope * t_b + &b.slope * t_a
    }

    /// How normalised time moves along two directions, at first and at second order.
    fn moved_tau(&self, time: f64, [a, b]: [&DVector<f64>; 2], t_ij: f64) -> [f64; 3] {
        let ([first, last], layout) = (self.system.interval, self.system.layout);
        let (tau, duration) = (self.tau(time), last - first);
        if !self.is_guessed() && !self.is_stretched() {
            return [a[0] / duration, b[0] / duration, t_ij / duration];
        }
        let parameters = |whole: &DVector<f64>| whole.rows_range(layout.parameters()).into_owned();
        let slopes = |whole: &DVector<f64>| {
            let ends = &self.ends_by * parameters(whole);
            let stretch = ends[1] - ends[0];
            ((whole[0] - ends[0] - tau * stretch) / duration, stretch)
        };
        let ((tau_a, stretch_a), (tau_b, stretch_b)) = (slopes(a), slopes(b));
        let curvature = self.interval_curvature(&parameters(a), &parameters(b));
        let ends = curvature[0] + tau * (curvature[1] - curvature[0]);
        let tau_ab = (t_ij - ends - tau_a * stretch_b - tau_b * stretch_a) / duration;
        [tau_a, tau_b, tau_ab]
    }

    /// The same of controls that follow the guess.
    fn guess_curvature(
        &self,
        time: f64,
        [tau_a, tau_b, tau_ab]: [f64; 3],
        [a, b]: [&DVector<f64>; 2],
    ) -> DVector<f64> {
        let layout = self.system.layout;
        let table = Columns::of_point(&[self.tau(time)]);
        let over_curve = |tau: f64, whole: &DVector<f64>| {
            whole.rows_range(layout.parameters()).into_owned().insert_row(0, tau)
        };
        let guess = &*self.system.guess;
        let hessians = Hessians::of(guess, &table, &self.parameters);
        let second = hessians.along(&over_curve(tau_a, a), &over_curve(tau_b, b));
        let by_tau = Jacobian::of(guess, &table, &self.parameters).by.column(0).into_owned();
        (second + by_tau * tau_ab).rows(layout.x, layout.u).into_owned()
    }
}
