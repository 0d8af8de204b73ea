//! The right side in a mode: every selector is given, is a direction, or keeps its surface at 0.
//!
//! On the sliding surfaces `A` the selectors solve `r_A(s) = d_A f(t, x, s) + psi_t = 0` with `d = dpsi/dx`, by Newton's
//! method on `B = -d_A df/ds_A`; one iteration where selectors do not multiply each other.

use super::controls::Controls;
use super::system::System;
use crate::problem::{Columns, Function};
use nalgebra::{DMatrix, DVector};

/// Where the state is with respect to a surface.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Mode {
    /// The selector is -1.
    Below,
    /// The selector is 1.
    Above,
    /// The selector keeps the state on the surface.
    Sliding,
    /// A component of a ball that is not at 0, or leaves it.
    Moving,
    /// Kept on the surface by what a jump says follows it.
    Held,
}

impl Mode {
    /// -1, 1, or 0 on the surface.
    pub(super) fn side(self) -> f64 {
        match self {
            Mode::Below => -1.0,
            Mode::Above => 1.0,
            Mode::Sliding | Mode::Moving | Mode::Held => 0.0,
        }
    }
}

/// The functions of the surfaces with their derivatives.
pub(super) struct Normals {
    pub psi: Vec<f64>,
    pub by_time: Vec<f64>,
    /// One row for each surface.
    pub by_state: DMatrix<f64>,
}

impl Normals {
    /// `psi'` along a rate.
    pub fn rate(&self, surface: usize, rate: &[f64]) -> f64 {
        let along: f64 = self.by_state.row(surface).iter().zip(rate).map(|(d, f)| d * f).sum();
        along + self.by_time[surface]
    }

    /// What rounding may make of `psi = 0`.
    pub fn noise(&self, surface: usize, x: &[f64]) -> f64 {
        let size: f64 = self.by_state.row(surface).iter().zip(x).map(|(d, x)| (d * x).abs()).sum();
        1e-14 * (1.0 + size)
    }
}

/// The right side, with the memory that its evaluation needs.
pub(super) struct Field<'a> {
    pub system: &'a System,
    pub modes: Vec<Mode>,
    /// The last selectors; where the next sliding solve begins.
    pub selectors: Vec<f64>,
    /// Of a ball that leaves 0, the direction in which it does.
    pub direction: Vec<f64>,
    /// When it leaves; NaN for what began off 0.
    pub departure: Vec<f64>,
    /// The longest explicit step that moving balls allow at the beginning of the next one.
    pub stable: f64,
    /// States that stand still.
    pub held: Vec<usize>,
    pub evaluations: usize,
    /// Which row of the controls holds.
    pub row: Option<usize>,
    controls: &'a Controls,
    parameters: Vec<f64>,
    point: Columns,
}

impl<'a> Field<'a> {
    pub fn new(system: &'a System, controls: &'a Controls) -> Self {
        let surfaces = system.surfaces.len();
        let mut field = Field {
            system,
            modes: vec![Mode::Above; surfaces],
            selectors: vec![0.0; surfaces],
            direction: vec![0.0; surfaces],
            departure: vec![f64::NAN; surfaces],
            stable: f64::INFINITY,
            held: Vec::new(),
            evaluations: 0,
            row: None,
            controls,
            parameters: system.parameter_values(),
            point: Columns::new(system.layout.point_inputs(), 1),
        };
        system.balls.iter().for_each(|ball| field.set_moving(ball));
        field
    }

    /// From now on the controls of a time hold.
    pub fn use_controls_of(&mut self, time: f64) {
        self.row = self.controls.index(time);
    }

    pub fn set_mode(&mut self, surface: usize, mode: Mode) {
        self.modes[surface] = mode;
        match mode {
            Mode::Below | Mode::Above => self.selectors[surface] = mode.side(),
            Mode::Sliding | Mode::Moving | Mode::Held => {}
        }
    }

    pub fn sliding(&self) -> Vec<usize> {
        (0..self.modes.len()).filter(|&i| self.modes[i] == Mode::Sliding).collect()
    }

    /// The values of the controls at a time.
    fn control(&self, t: f64) -> Vec<f64> {
        match self.controls {
            Controls::Held { .. } => self.controls.row(self.row).to_vec(),
            Controls::Guess if self.system.layout.u == 0 => Vec::new(),
            Controls::Guess => {
                let [first, last] = self.system.interval;
                let tau = if last > first { (t - first) / (last - first) } else { 0.0 };
                self.system.guessed(tau)[self.system.layout.x..].to_vec()
            }
        }
    }

    fn set_point(&mut self, t: f64, x: &[f64], selectors: &[f64]) {
        let control = self.control(t);
        let values = std::iter::once(&t).chain(x).chain(&control).chain(selectors);
        for (column, value) in values.enumerate() {
            self.point.column_mut(column)[0] = *value;
        }
    }

    /// Values and the derivatives by one kind of inputs, as a dense matrix.
    fn jacobian(&self, function: &dyn Function, inputs: std::ops::Range<usize>) -> (Vec<f64>, DMatrix<f64>) {
        let pattern = function.jacobian_pattern();
        let mut values = Columns::new(function.outputs(), 1);
        let mut entries = Columns::new(pattern.entries.len(), 1);
        function.jacobian(&self.point, &self.parameters, &mut values, &mut entries);
        let mut matrix = DMatrix::zeros(function.outputs(), inputs.len());
        for (at, &(row, column)) in pattern.entries.iter().enumerate() {
            if inputs.contains(&(column as usize)) {
                matrix[(row as usize, column as usize - inputs.start)] = entries.column(at)[0];
            }
        }
        (column_values(&values), matrix)
    }

    /// The functions of the surfaces.
    pub fn psi(&mut self, t: f64, x: &[f64]) -> Vec<f64> {
        let selectors = self.selectors.clone();
        self.set_point(t, x, &selectors);
        let mut values = Columns::new(self.modes.len(), 1);
        self.system.guards.value(&self.point, &self.parameters, &mut values);
        column_values(&values)
    }

    /// The functions of the surfaces with their derivatives.
    pub fn normals(&mut self, t: f64, x: &[f64]) -> Normals {
        let selectors = self.selectors.clone();
        self.set_point(t, x, &selectors);
        let (psi, matrix) = self.jacobian(&*self.system.guards, 0..1 + x.len());
        let by_time = matrix.column(0).iter().copied().collect();
        Normals { psi, by_time, by_state: matrix.columns(1, x.len()).into_owned() }
    }

    /// The state after a jump.
    pub fn reset(&mut self, jump: usize, t: f64, x: &[f64]) -> Vec<f64> {
        let selectors = self.selectors.clone();
        self.set_point(t, x, &selectors);
        let mut values = Columns::new(self.system.resets.outputs(), 1);
        self.system.resets.value(&self.point, &self.parameters, &mut values);
        column_values(&values)[jump * x.len()..][..x.len()].to_vec()
    }

    /// `f` and `df/ds` where all selectors are given.
    pub fn with_selectors(&mut self, t: f64, x: &[f64], selectors: &[f64]) -> (Vec<f64>, DMatrix<f64>) {
        self.derivatives(t, x, selectors, self.system.layout.selectors())
    }

    /// `df/dx` in the current mode.
    pub fn by_state(&mut self, t: f64, x: &[f64]) -> DMatrix<f64> {
        let selectors = self.selectors.clone();
        self.derivatives(t, x, &selectors, self.system.layout.states()).1
    }

    /// `f` and `df/dx` where all selectors are given.
    pub fn by_state_with(&mut self, t: f64, x: &[f64], selectors: &[f64]) -> (Vec<f64>, DMatrix<f64>) {
        self.derivatives(t, x, selectors, self.system.layout.states())
    }

    fn derivatives(
        &mut self,
        t: f64,
        x: &[f64],
        selectors: &[f64],
        by: std::ops::Range<usize>,
    ) -> (Vec<f64>, DMatrix<f64>) {
        self.evaluations += 1;
        self.set_point(t, x, selectors);
        let (mut rate, mut matrix) = self.jacobian(&*self.system.flow, by);
        for &state in &self.held {
            rate[state] = 0.0;
            matrix.row_mut(state).fill(0.0);
        }
        (rate, matrix)
    }

    /// The right side in the current mode; not a number where sliding selectors cannot be found.
    pub fn rate(&mut self, t: f64, x: &[f64]) -> Vec<f64> {
        self.follow_directions(t, x);
        let sliding = self.sliding();
        if !sliding.is_empty() {
            return self.sliding_rate(t, x, &sliding);
        }
        self.evaluations += 1;
        let selectors = self.selectors.clone();
        self.set_point(t, x, &selectors);
        let mut values = Columns::new(x.len(), 1);
        self.system.flow.value(&self.point, &self.parameters, &mut values);
        let mut rate = column_values(&values);
        self.held.iter().for_each(|&state| rate[state] = 0.0);
        rate
    }

    /// The selectors of the current mode, each a side, part of a direction, or what keeps its surface; leaves everything as it is.
    pub fn selectors_at(&mut self, t: f64, x: &[f64]) -> Vec<f64> {
        let before = (self.selectors.clone(), self.evaluations);
        if !self.sliding().is_empty() || !self.moving().is_empty() {
            self.rate(t, x);
        }
        self.evaluations = before.1;
        std::mem::replace(&mut self.selectors, before.0)
    }

    fn sliding_rate(&mut self, t: f64, x: &[f64], sliding: &[usize]) -> Vec<f64> {
        let normals = self.normals(t, x);
        let mut selectors = self.selectors.clone();
        for _ in 0..30 {
            let (rate, by_selector) = self.with_selectors(t, x, &selectors);
            let (r, b) = surface_rates(&normals, &rate, &by_selector, sliding);
            let Some(change) = b.lu().solve(&r) else { break };
            sliding.iter().zip(change.iter()).for_each(|(&i, change)| selectors[i] += change);
            if change.amax() <= 1e-13 * (1.0 + DVector::from_column_slice(&selectors).amax()) {
                let moved = by_selector.select_columns(sliding) * change;
                self.selectors = selectors;
                return rate.iter().zip(moved.iter()).map(|(rate, moved)| rate + moved).collect();
            }
        }
        vec![f64::NAN; x.len()]
    }

    /// Newton's steps along `df/ds` back to the sliding surfaces.
    pub fn project(&mut self, t: f64, x: &mut [f64]) {
        let sliding = self.sliding();
        for _ in 0..if sliding.is_empty() { 0 } else { 3 } {
            let normals = self.normals(t, x);
            let selectors = self.selectors.clone();
            let (_, by_selector) = self.with_selectors(t, x, &selectors);
            let directions = by_selector.select_columns(&sliding);
            let matrix = normals.by_state.select_rows(&sliding) * &directions;
            let psi = DVector::from_iterator(sliding.len(), sliding.iter().map(|&i| normals.psi[i]));
            let Some(along) = matrix.lu().solve(&psi) else { return };
            let change = directions * along;
            if !change.iter().all(|value| value.is_finite()) {
                return;
            }
            x.iter_mut().zip(change.iter()).for_each(|(x, change)| *x -= change);
        }
    }
}

/// `r = d f + psi_t` and `B = -d df/ds` of some surfaces.
pub(super) fn surface_rates(
    normals: &Normals,
    rate: &[f64],
    by_selector: &DMatrix<f64>,
    surfaces: &[usize],
) -> (DVector<f64>, DMatrix<f64>) {
    let r = DVector::from_iterator(surfaces.len(), surfaces.iter().map(|&i| normals.rate(i, rate)));
    let b = -(normals.by_state.select_rows(surfaces) * by_selector.select_columns(surfaces));
    (r, b)
}

fn column_values(table: &Columns) -> Vec<f64> {
    (0..table.columns()).map(|column| table.column(column)[0]).collect()
}
