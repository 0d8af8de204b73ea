//! The right side in a mode: every selector is given, is a direction, or keeps its surface at 0.
//!
//! On the sliding surfaces `A` the selectors solve `r_A(s) = d_A f(t, x, s) + psi_t = 0` with `d =
//! dpsi/dx`, by Newton's method on `B = -d_A df/ds_A`; one iteration where selectors do not
//! multiply each other.

use super::controls::Controls;
use crate::simulate::tuning::field::{PROJECTED, SOLVED};
pub(crate) mod curve;
pub(crate) mod direction;
mod kink_sides;
mod memory;
pub(crate) mod normals;
pub(crate) mod tolerance;
pub(crate) mod tube;

use super::result::Options;
use super::system::{System, value};
use crate::problem::{Columns, Function};
use crate::simulate::mode::Mode;
use curve::Curve;
use memory::Memory;
use nalgebra::{DMatrix, DVector};
use normals::Normals;
use tolerance::Tolerance;
use tube::Tube;

/// The right side, with the memory that its evaluation needs.
pub(crate) struct Field<'a> {
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
    /// Whether kinks are passed over, because too many are met at one time.
    pub is_blind: bool,
    /// How exact states must be.
    pub tolerance: Tolerance,
    /// What rounding makes of the terms of each surface, then of each kink.
    pub rounding: Vec<f64>,
    pub evaluations: usize,
    /// Lent to whoever looks along a step.
    pub tube: Option<Tube>,
    /// Which segment of the controls is followed.
    pub segment: Option<usize>,
    /// The controls of that segment, where they change in it.
    pub curve: Option<Curve<'a>>,
    controls: &'a Controls,
    /// The values of the controls at the last point.
    control: Vec<f64>,
    parameters: Vec<f64>,
    point: Columns,
    memory: Memory,
}

impl<'a> Field<'a> {
    pub fn new(system: &'a System, controls: &'a Controls, options: &Options) -> Self {
        let surfaces = system.surfaces.len();
        let mut field = Field {
            system,
            modes: vec![Mode::Above; surfaces],
            selectors: vec![0.0; system.layout.s],
            direction: vec![0.0; surfaces],
            departure: vec![f64::NAN; surfaces],
            stable: f64::INFINITY,
            held: Vec::new(),
            is_blind: false,
            tolerance: Tolerance::new(options, &system.start),
            rounding: vec![0.0; surfaces + system.kinks.outputs()],
            evaluations: 0,
            tube: None,
            segment: None,
            curve: None,
            controls,
            control: vec![0.0; system.layout.u],
            parameters: system.parameter_values(),
            point: Columns::new(system.layout.point_inputs(), 1),
            memory: Memory::new(system),
        };
        system.balls.iter().for_each(|ball| field.set_moving(ball));
        field
    }

    /// From now on the controls are those of the segment that begins at a time, or before it.
    pub fn use_controls_of(&mut self, time: f64) {
        self.segment = self.controls.segment(time);
        self.curve = Curve::new(self.controls, self.segment);
        let values = self.controls.values(self.segment, time);
        self.control[..values.len()].copy_from_slice(&values);
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

    /// Whether the controls are the guess.
    pub fn follows_guess(&self) -> bool {
        matches!(self.controls, Controls::Guess) && self.system.layout.u > 0
    }

    /// A time as a part of the whole interval.
    pub fn normalised(&self, t: f64) -> f64 {
        let [first, last] = self.system.interval;
        if last > first { (t - first) / (last - first) } else { 0.0 }
    }

    /// The values of the controls at the last point.
    pub fn control(&self) -> &[f64] {
        &self.control
    }

    /// Those at a time; of the guess at the last point.
    pub fn control_at(&self, t: f64) -> Vec<f64> {
        let mut control = self.control.clone();
        if let Some(curve) = &self.curve {
            curve.value_into(t, &mut control);
        }
        control
    }

    /// The values of all parameters.
    pub fn parameters(&self) -> &[f64] {
        &self.parameters
    }

    /// Guessed controls change all the time, polynomials in time, too.
    fn follow_controls(&mut self, t: f64) {
        if let Some(curve) = &self.curve {
            curve.value_into(t, &mut self.control);
        } else if self.follows_guess() {
            let guessed = self.system.guessed(self.normalised(t));
            self.control.copy_from_slice(&guessed[self.system.layout.x..]);
        }
    }

    /// The next point; with the selectors of the mode if no others are given.
    pub(crate) fn set_point(&mut self, t: f64, x: &[f64], selectors: Option<&[f64]>) {
        self.follow_controls(t);
        let selectors = selectors.unwrap_or(&self.selectors);
        let values = std::iter::once(&t).chain(x).chain(&self.control).chain(selectors);
        let stride = self.point.stride();
        self.point
            .as_mut_slice()
            .chunks_exact_mut(stride)
            .zip(values)
            .for_each(|(column, value)| column[0] = *value);
    }

    /// Values and the derivatives by one kind of inputs, as a dense matrix.
    pub(crate) fn jacobian(
        &self,
        function: &dyn Function,
        inputs: std::ops::Range<usize>,
    ) -> (Vec<f64>, DMatrix<f64>) {
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
        self.set_point(t, x, None);
        let mut values = Columns::new(self.modes.len(), 1);
        self.system.switching.value(&self.point, &self.parameters, &mut values);
        column_values(&values)
    }

    /// The state after a jump.
    pub fn reset(&mut self, jump: usize, t: f64, x: &[f64]) -> Vec<f64> {
        self.set_point(t, x, None);
        let mut values = Columns::new(self.system.resets.outputs(), 1);
        self.system.resets.value(&self.point, &self.parameters, &mut values);
        column_values(&values)[jump * x.len()..][..x.len()].to_vec()
    }

    /// `f` and `df/ds` where all selectors are given.
    pub fn with_selectors(
        &mut self,
        t: f64,
        x: &[f64],
        selectors: &[f64],
    ) -> (Vec<f64>, DMatrix<f64>) {
        self.derivatives(t, x, selectors, self.system.layout.selectors())
    }

    /// `df/dx` in the current mode.
    pub fn by_state(&mut self, t: f64, x: &[f64]) -> DMatrix<f64> {
        let selectors = self.selectors.clone();
        self.derivatives(t, x, &selectors, self.system.layout.states()).1
    }

    /// `f` and `df/dx` where all selectors are given.
    pub fn by_state_with(
        &mut self,
        t: f64,
        x: &[f64],
        selectors: &[f64],
    ) -> (Vec<f64>, DMatrix<f64>) {
        self.derivatives(t, x, selectors, self.system.layout.states())
    }

    /// The derivative of the right side in the current mode, in which the selectors of sliding
    /// surfaces follow the state: `f_x + f_s s_x` with `psi'_s s_x = -psi'_x`.
    pub fn jacobian_of_mode(&mut self, t: f64, x: &[f64]) -> DMatrix<f64> {
        let (states, selectors) = (self.system.layout.states(), self.system.layout.selectors());
        let now = self.selectors_at(t, x);
        let (_, by_inputs) = self.derivatives(t, x, &now, 0..selectors.end);
        let by_state = by_inputs.columns(states.start, states.len()).into_owned();
        let sliding = self.sliding();
        if sliding.is_empty() {
            return by_state;
        }
        let (_, rates) = self.jacobian(&*self.system.rates, 0..selectors.end);
        let rates = rates.select_rows(&sliding);
        let places: Vec<usize> = sliding.iter().map(|&i| selectors.start + i).collect();
        let follows =
            rates.select_columns(&places).lu().solve(&rates.columns(states.start, states.len()));
        match follows {
            Some(follows) => by_state - by_inputs.select_columns(&places) * follows,
            None => by_state,
        }
    }

    fn derivatives(
        &mut self,
        t: f64,
        x: &[f64],
        selectors: &[f64],
        by: std::ops::Range<usize>,
    ) -> (Vec<f64>, DMatrix<f64>) {
        self.evaluations += 1;
        self.set_point(t, x, Some(selectors));
        let (mut rate, mut matrix) = self.jacobian(&*self.system.flow, by);
        for &state in &self.held {
            rate[state] = 0.0;
            matrix.row_mut(state).fill(0.0);
        }
        (rate, matrix)
    }

    /// The right side in the current mode; not a number where sliding selectors cannot be found.
    pub fn rate(&mut self, t: f64, x: &[f64]) -> Vec<f64> {
        let mut rate = vec![0.0; x.len()];
        self.rate_into(t, x, &mut rate);
        rate
    }

    /// The same, into memory that is there.
    pub fn rate_into(&mut self, t: f64, x: &[f64], rate: &mut [f64]) {
        self.follow_directions(t, x);
        if self.modes.contains(&Mode::Sliding) {
            return self.sliding_rate(t, x, rate);
        }
        self.evaluations += 1;
        self.set_point(t, x, None);
        let values = &mut self.memory.flow;
        self.system.flow.value(&self.point, &self.parameters, values);
        read(values, rate);
        if self.system.kinks.outputs() > 0 && rate.iter().any(|value| !value.is_finite()) {
            self.rate_on_its_side(rate);
        }
        self.held.iter().for_each(|&state| rate[state] = 0.0);
    }

    /// The right side of the last point with the sides of that point: beyond a kink the one of
    /// before may have no value.
    fn rate_on_its_side(&mut self, rate: &mut [f64]) {
        let mut point = column_values(&self.point);
        self.system.choose_sides(&mut point, &self.parameters);
        rate.copy_from_slice(&value(&*self.system.flow, &point, &self.parameters));
    }

    /// The selectors of the current mode, each a side, part of a direction, or what keeps its
    /// surface; leaves everything as it is.
    pub fn selectors_at(&mut self, t: f64, x: &[f64]) -> Vec<f64> {
        let before = (self.selectors.clone(), self.evaluations);
        if !self.sliding().is_empty() || !self.moving().is_empty() {
            self.rate(t, x);
        }
        self.evaluations = before.1;
        std::mem::replace(&mut self.selectors, before.0)
    }

    fn sliding_rate(&mut self, t: f64, x: &[f64], rate: &mut [f64]) {
        self.set_point(t, x, None);
        let Field { system, point, parameters, memory, .. } = self;
        memory.slide_on(&self.modes);
        system.switching.jacobian(point, parameters, &mut memory.psi, &mut memory.normals);
        let first = system.layout.selectors().start - system.layout.p;
        for _ in 0..30 {
            self.evaluations += 1;
            system.flow.jacobian(point, parameters, &mut memory.flow, &mut memory.by_inputs);
            read(&memory.flow, rate);
            self.held.iter().for_each(|&state| rate[state] = 0.0);
            if !memory.solve(system, rate, &self.held) {
                break;
            }
            let mut is_solved = true;
            for (&surface, change) in memory.sliding.iter().zip(&memory.change) {
                let selector = &mut point.column_mut(first + surface)[0];
                *selector += change;
                is_solved &= change.abs() <= SOLVED * (1.0 + selector.abs());
            }
            if is_solved {
                memory.sliding.iter().for_each(|&i| self.selectors[i] = point.column(first + i)[0]);
                return memory.follow(rate, &self.held);
            }
        }
        rate.fill(f64::NAN);
    }

    /// Newton's steps along `df/ds` back to the sliding surfaces.
    pub fn project(&mut self, t: f64, x: &mut [f64]) {
        let sliding = self.sliding();
        for _ in 0..if sliding.is_empty() { 0 } else { 3 } {
            let normals = self.normals(t, x);
            if sliding.iter().all(|&i| normals.psi[i].abs() <= PROJECTED * normals.noise(i, x)) {
                return;
            }
            let selectors = self.selectors.clone();
            let (_, by_selector) = self.with_selectors(t, x, &selectors);
            let directions = by_selector.select_columns(&sliding);
            let matrix = normals.by_state.select_rows(&sliding) * &directions;
            let psi =
                DVector::from_iterator(sliding.len(), sliding.iter().map(|&i| normals.psi[i]));
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
pub(crate) fn surface_rates(
    normals: &Normals,
    rate: &[f64],
    by_selector: &DMatrix<f64>,
    surfaces: &[usize],
) -> (DVector<f64>, DMatrix<f64>) {
    let r = DVector::from_iterator(surfaces.len(), surfaces.iter().map(|&i| normals.rate(i, rate)));
    let b = -(normals.by_state.select_rows(surfaces) * by_selector.select_columns(surfaces));
    (r, b)
}

fn read(table: &Columns, values: &mut [f64]) {
    let columns = table.as_slice().chunks_exact(table.stride());
    values.iter_mut().zip(columns).for_each(|(value, column)| *value = column[0]);
}

fn column_values(table: &Columns) -> Vec<f64> {
    (0..table.columns()).map(|column| table.column(column)[0]).collect()
}

/// One Newton step along a gradient.
pub(crate) fn correct(x: &mut [f64], gradient: &[f64], value: f64) {
    let square: f64 = gradient.iter().map(|g| g * g).sum();
    if square > 0.0 {
        x.iter_mut().zip(gradient).for_each(|(x, g)| *x -= value * g / square);
    }
}
