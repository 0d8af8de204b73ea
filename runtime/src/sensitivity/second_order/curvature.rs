//! Second derivatives of the right side in a regime, selectors eliminated, along pairs of
//! directions.
//!
//! With `W_i` a direction of `(t, x, u, p)` completed by `s_i = s_w W_i`
//!
//! ```text
//! f*_ww[W_i, W_j] = f_zz[W_i, W_j] + f_s s_ij + f*_u u_ij,     s_ij = -r_s^-1 (r_zz[W_i, W_j])
//! ```
//!
//! where `u_ij` is the curvature of controls that follow the guess.

use crate::problem::{Columns, Function};
use crate::sensitivity::linearized::linearization::{Jacobian, Linearization, Linearizer, sliding};
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

/// The right side at one point to the second order.
pub(crate) struct Curvature<'l, 'a> {
    linearizer: &'l Linearizer<'a>,
    point: &'l Linearization,
    flow: Hessians,
    /// Second derivatives of the rates of the sliding surfaces, and `-f_s r_s^-1`.
    rates: Option<(Hessians, Vec<usize>, DMatrix<f64>)>,
    time: f64,
}

impl<'l, 'a> Curvature<'l, 'a> {
    pub fn new(
        linearizer: &'l Linearizer<'a>,
        point: &'l Linearization,
        regime: &Regime,
        time: f64,
        x: &DVector<f64>,
    ) -> Self {
        let table = linearizer.table(regime, &point.selectors, time, x);
        let flow = Hessians::of(&*linearizer.system.flow, &table, &linearizer.parameters);
        let sliding = sliding(regime);
        let rates =
            if sliding.is_empty() { None } else { rates(linearizer, point, &table, sliding) };
        Curvature { linearizer, point, flow, rates, time }
    }

    /// A direction `(t, x, u, p)` with the controls that follow the guess and the selectors: `[t |
    /// x | u | p | s]`.
    pub fn complete(&self, direction: &DVector<f64>) -> DVector<f64> {
        let layout = self.linearizer.system.layout;
        let mut whole = direction.clone().resize_vertically(layout.inputs(), 0.0);
        if self.linearizer.is_guessed() {
            let slopes = self.linearizer.guess_slopes(self.time);
            let parameters = direction.rows(layout.parameters().start, layout.p);
            let moved = slopes.column(0) * direction[0] + slopes.columns(1, layout.p) * parameters;
            whole.rows_mut(layout.controls().start, layout.u).copy_from(&moved);
        }
        if !self.point.selectors_by.is_empty() {
            let selectors = &self.point.selectors_by * direction;
            whole.rows_mut(layout.selectors().start, layout.s).copy_from(&selectors);
        }
        whole
    }

    /// `f*_ww` along two completed directions.
    pub fn along(&self, a: &DVector<f64>, b: &DVector<f64>) -> DVector<f64> {
        let mut sum = self.flow.along(a, b);
        if let Some((hessians, sliding, push)) = &self.rates {
            sum += push * hessians.along(a, b).select_rows(sliding);
        }
        if self.linearizer.is_guessed() {
            let layout = self.linearizer.system.layout;
            let by = self.point.by();
            let by_controls = by.columns(layout.controls().start, layout.u);
            sum += by_controls * self.linearizer.guess_curvature(self.time, a, b);
        }
        sum
    }
}

fn rates(
    linearizer: &Linearizer,
    point: &Linearization,
    table: &Columns,
    sliding: Vec<usize>,
) -> Option<(Hessians, Vec<usize>, DMatrix<f64>)> {
    let system = linearizer.system;
    let by = Jacobian::of(&*system.rates, table, &linearizer.parameters).by;
    let by_selectors = by.columns(system.layout.selectors().start, system.layout.s);
    let inverse = by_selectors.select_columns(&sliding).select_rows(&sliding).try_inverse()?;
    let push = -(point.by_selectors().select_columns(&sliding) * inverse);
    let hessians = Hessians::of(&*system.rates, table, &linearizer.parameters);
    Some((hessians, sliding, push))
}

impl Linearizer<'_> {
    /// `d2(t0, tf)` along two directions of parameters.
    pub fn interval_curvature(&self, a: &DVector<f64>, b: &DVector<f64>) -> DVector<f64> {
        Hessians::of(&*self.system.interval_of, &Columns::new(0, 1), &self.parameters).along(a, b)
    }

    /// `d2x(t0)` along two directions of parameters.
    pub fn start_curvature(&self, a: &DVector<f64>, b: &DVector<f64>) -> DVector<f64> {
        Hessians::of(&*self.system.start_of, &Columns::new(0, 1), &self.parameters).along(a, b)
    }

    /// `u_ij` of controls that follow the guess, along two directions `[t | x | u | p | ...]`.
    fn guess_curvature(&self, time: f64, a: &DVector<f64>, b: &DVector<f64>) -> DVector<f64> {
        let layout = self.system.layout;
        let [first, last] = self.system.interval;
        let (tau, duration) = (self.tau(time), last - first);
        let parameters =
            |whole: &DVector<f64>| whole.rows(layout.parameters().start, layout.p).into_owned();
        let ends = &self.ends_by;
        let slopes = |whole: &DVector<f64>| {
            let ends = ends * parameters(whole);
            let stretch = ends[1] - ends[0];
            ((whole[0] - ends[0] - tau * stretch) / duration, stretch)
        };
        let ((tau_a, stretch_a), (tau_b, stretch_b)) = (slopes(a), slopes(b));
        let bent = self.interval_curvature(&parameters(a), &parameters(b));
        let tau_ab = (-bent[0] - tau_a * stretch_b - tau_b * stretch_a - tau * (bent[1] - bent[0]))
            / duration;
        let mut table = Columns::new(1, 1);
        table.column_mut(0)[0] = tau;
        let over_curve = |tau: f64, whole: &DVector<f64>| parameters(whole).insert_row(0, tau);
        let hessians = Hessians::of(&*self.system.guess, &table, &self.parameters);
        let second = hessians.along(&over_curve(tau_a, a), &over_curve(tau_b, b));
        let by_tau =
            Jacobian::of(&*self.system.guess, &table, &self.parameters).by.column(0).into_owned();
        (second + by_tau * tau_ab).rows(layout.x, layout.u).into_owned()
    }
}
