//! Controls as functions of time, parameters and the numbers `U` that make them.
//!
//! ```text
//! u = U                                   rows that are held
//! u = g(tau(t, p), p)                     the guess, whose numbers are those of the model
//! u = sum_k L_k(t, p) U_k                 polynomials; where they are stretched, of tau(t, p)
//! ```
//!
//! So derivatives by `[t | x | u | p]` become those by `[t | x | U | p]`, and directions in the
//! space of these become directions in that of those.

use super::linearisation::{Jacobian, Lineariser};
use crate::problem::{Columns, Layout};
use crate::simulate::{Controls, Regime};
use nalgebra::{DMatrix, DVector, RowDVector};
use std::borrow::Cow;
use std::ops::Range;

impl<'a> Lineariser<'a> {
    /// The rows of controls that act in a regime.
    pub fn rows(&self, regime: &Regime) -> Range<usize> {
        self.controls.range(regime.segment)
    }

    /// The layout with `U` in the place of `u`.
    pub fn layout(&self, regime: &Regime) -> Layout {
        let layout = self.system.layout;
        Layout { u: layout.u * self.rows(regime).len().max(1), ..layout }
    }

    /// How many of `[U | p]` there are.
    pub fn inputs(&self, regime: &Regime) -> usize {
        let layout = self.layout(regime);
        layout.u + layout.p
    }

    /// The controls that act.
    pub fn control(&self, regime: &Regime, t: f64) -> Cow<'a, [f64]> {
        let rows = self.rows(regime);
        match rows.len() {
            _ if self.system.layout.u == 0 => Cow::Borrowed(&[]),
            0 => Cow::Owned(self.system.guessed(self.tau(t))[self.system.layout.x..].to_vec()),
            1 => Cow::Borrowed(&self.controls.rows()[rows.start]),
            _ => Cow::Owned(self.controls.values(regime.segment, t)),
        }
    }

    pub fn is_guessed(&self) -> bool {
        *self.controls == Controls::Guess && self.system.layout.u > 0
    }

    /// Whether controls change with time in a regime.
    pub fn is_curved(&self, regime: &Regime) -> bool {
        self.system.layout.u > 0 && (self.is_guessed() || self.rows(regime).len() > 1)
    }

    /// Whether the times of segments move with the interval.
    pub fn is_stretched(&self) -> bool {
        self.controls.is_stretched()
    }

    /// Normalised time.
    pub fn tau(&self, t: f64) -> f64 {
        let [first, last] = self.system.interval;
        if last > first { (t - first) / (last - first) } else { 0.0 }
    }

    /// How a time that is a fixed part of the interval moves with each parameter.
    pub fn clock(&self, t: f64) -> RowDVector<f64> {
        let tau = self.tau(t);
        self.ends_by.row(0) * (1.0 - tau) + self.ends_by.row(1) * tau
    }

    /// `du/d[t | p]`.
    fn control_slopes(&self, regime: &Regime, t: f64) -> DMatrix<f64> {
        let layout = self.system.layout;
        let mut by = DMatrix::zeros(layout.u, 1 + layout.p);
        let by_time = if self.is_guessed() {
            let guess = Jacobian::of(&*self.system.guess, &self.at_tau(t), &self.parameters).by;
            by.copy_from(&guess.rows(layout.x, layout.u));
            let [first, last] = self.system.interval;
            by.column(0) / if last > first { last - first } else { f64::INFINITY }
        } else {
            DVector::from_vec(self.controls.derivatives(regime.segment, t, 1))
        };
        by.column_mut(0).copy_from(&by_time);
        if self.is_guessed() || self.is_stretched() {
            let mut by_parameters = by.columns_mut(1, layout.p);
            by_parameters -= by_time * self.clock(t);
        }
        by
    }

    fn at_tau(&self, t: f64) -> Columns {
        Columns::of_point(&[self.tau(t)])
    }

    /// Derivatives by `[t | x | U | p | ...]` from those by `[t | x | u | p | ...]`.
    pub fn spread(&self, mut by: DMatrix<f64>, regime: &Regime, t: f64) -> DMatrix<f64> {
        if !self.is_curved(regime) || by.is_empty() {
            return by;
        }
        let layout = self.system.layout;
        let by_controls = by.columns_range(layout.controls()).into_owned();
        let through = &by_controls * self.control_slopes(regime, t);
        let mut by_time = by.column_mut(0);
        by_time += through.column(0);
        let mut by_parameters = by.columns_range_mut(layout.parameters());
        by_parameters += through.columns(1, layout.p);
        let weights = self.controls.weights(regime.segment, t, 0);
        if weights.is_empty() {
            return by;
        }
        let first = layout.controls().start;
        let mut spread = by.insert_columns(first, (weights.len() - 1) * layout.u, 0.0);
        for (k, weight) in weights.iter().enumerate() {
            let mut own = spread.columns_mut(first + k * layout.u, layout.u);
            own.copy_from(&(&by_controls * *weight));
        }
        spread
    }

    /// A direction `[t | x | u | p | s]` from one `[t | x | U | p]`; selectors do not move.
    pub fn whole(&self, direction: &DVector<f64>, regime: &Regime, t: f64) -> DVector<f64> {
        let (own, raw) = (self.layout(regime), self.system.layout);
        let mut whole = DVector::zeros(raw.inputs());
        let parameters = direction.rows_range(own.parameters());
        whole.rows_mut(0, 1 + raw.x).copy_from(&direction.rows(0, 1 + raw.x));
        whole.rows_range_mut(raw.parameters()).copy_from(&parameters);
        let mut moved = self.of_numbers(direction, regime, t, 0);
        if self.is_curved(regime) {
            let slopes = self.control_slopes(regime, t);
            moved += slopes.column(0) * direction[0] + slopes.columns(1, raw.p) * parameters;
        }
        whole.rows_range_mut(raw.controls()).copy_from(&moved);
        whole
    }

    /// How the controls, or a derivative of theirs by time, move with the numbers of a direction.
    pub fn of_numbers(
        &self,
        direction: &DVector<f64>,
        regime: &Regime,
        t: f64,
        order: usize,
    ) -> DVector<f64> {
        let (first, count) = (self.system.layout.controls().start, self.system.layout.u);
        let weights = self.controls.weights(regime.segment, t, order).into_iter().enumerate();
        let own = |(k, weight)| direction.rows(first + k * count, count) * weight;
        weights.map(own).fold(DVector::zeros(count), |sum, own| sum + own)
    }
}
