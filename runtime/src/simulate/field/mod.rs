//! The right side in a mode: every selector is given, is a direction, or keeps its surface at 0.
//!
//! On the sliding surfaces `A` the selectors solve `r_A(s) = d_A f(t, x, s) + psi_t = 0` with `d =
//! dpsi/dx`, by Newton's method on `B = -d_A df/ds_A`; one iteration where selectors do not
//! multiply each other.

pub(crate) mod curve;
mod derivatives;
pub(crate) mod direction;
mod kink_sides;
mod memory;
pub(crate) mod normals;
mod sliding;
pub(crate) mod tolerance;
pub(crate) mod tube;

pub(crate) use sliding::{correct, surface_rates};

use super::controls::Controls;
use super::result::Options;
use super::system::{System, value};
use crate::problem::Columns;
use crate::simulate::mode::Mode;
use curve::Curve;
use memory::Memory;
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
    /// Whether the right side reads the selector of each surface.
    pub acts: Vec<bool>,
    /// States that stand still.
    pub held: Vec<usize>,
    /// How far from 0 the function of a surface may be on which the state rests.
    pub slack: Vec<f64>,
    /// Whether kinks are passed over, because too many are met at one time.
    pub is_blind: bool,
    /// The kink that is being crossed.
    pub crossed: Option<usize>,
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
            acts: acting(system),
            held: Vec::new(),
            slack: vec![0.0; surfaces],
            is_blind: false,
            crossed: None,
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
    pub fn follow_controls(&mut self, t: f64) {
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

    /// The functions of the surfaces.
    pub fn psi(&mut self, t: f64, x: &[f64]) -> Vec<f64> {
        self.set_point(t, x, None);
        let mut values = Columns::new(self.modes.len(), 1);
        self.system.switching.value(&self.point, &self.parameters, &mut values);
        column_values(&values)
    }

    /// The same with the sides of all surfaces and kinks that the point itself is on.
    pub fn psi_on_its_sides(&mut self, t: f64, x: &[f64]) -> Vec<f64> {
        self.set_point(t, x, None);
        self.system.switching_at(&mut column_values(&self.point), &self.parameters)
    }

    /// The state after a jump.
    pub fn reset(&mut self, jump: usize, t: f64, x: &[f64]) -> Vec<f64> {
        self.set_point(t, x, None);
        let mut values = Columns::new(self.system.resets.outputs(), 1);
        self.system.resets.value(&self.point, &self.parameters, &mut values);
        column_values(&values)[jump * x.len()..][..x.len()].to_vec()
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
}

/// Whether the right side reads the selector of each surface.
fn acting(system: &System) -> Vec<bool> {
    let selectors = system.surface_selectors();
    let mut acts = vec![false; system.surfaces.len()];
    for &(_, input) in &system.flow.jacobian_pattern().entries {
        if let Some(surface) = selectors.clone().position(|it| it == input as usize) {
            acts[surface] = true;
        }
    }
    acts
}

fn read(table: &Columns, values: &mut [f64]) {
    let columns = table.as_slice().chunks_exact(table.stride());
    values.iter_mut().zip(columns).for_each(|(value, column)| *value = column[0]);
}

fn column_values(table: &Columns) -> Vec<f64> {
    (0..table.columns()).map(|column| table.column(column)[0]).collect()
}
