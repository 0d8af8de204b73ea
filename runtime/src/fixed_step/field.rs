//! Right sides and switching functions of one system at single points, with all their derivatives.

use crate::problem::{Columns, Function};
use crate::sensitivity::Jacobian;
use crate::simulate::{Controls, System, value};
use nalgebra::DVector;

/// Values of a function and their derivatives by all its inputs, at a point `[t | x | u | s]`.
pub(super) fn jacobian(function: &dyn Function, point: &[f64], parameters: &[f64]) -> Jacobian {
    Jacobian::of(function, &Columns::of_point(point), parameters)
}

/// A system with numbers for its parameters and controls.
pub(super) struct Field<'a> {
    pub system: &'a System,
    pub parameters: Vec<f64>,
    pub first_time: f64,
    pub duration: f64,
    controls: &'a Controls,
}

/// Where a right side is evaluated.
#[derive(Clone)]
pub(super) struct Point {
    pub t: f64,
    pub x: DVector<f64>,
    pub u: Vec<f64>,
    pub s: DVector<f64>,
}

impl<'a> Field<'a> {
    pub fn new(system: &'a System, controls: &'a Controls) -> Self {
        let parameters = system.parameter_values();
        let ends = value(&*system.interval_of, &[], &parameters);
        Field { system, first_time: ends[0], duration: ends[1] - ends[0], parameters, controls }
    }

    /// `[t | x | u | s]`, on the sides of kinks where the point is.
    fn inputs(&self, point: &Point) -> Vec<f64> {
        let states = std::iter::once(&point.t).chain(point.x.iter());
        let mut inputs: Vec<f64> = states.chain(&point.u).chain(point.s.iter()).copied().collect();
        inputs.resize(self.system.layout.point_inputs(), -1.0);
        self.system.choose_sides(&mut inputs, &self.parameters);
        inputs
    }

    pub fn start(&self) -> DVector<f64> {
        DVector::from_vec(value(&*self.system.start_of, &[], &self.parameters))
    }

    pub fn time(&self, tau: f64) -> f64 {
        self.first_time + tau * self.duration
    }

    /// The controls at a normalised time.
    pub fn control(&self, tau: f64) -> Vec<f64> {
        let time = self.time(tau);
        match self.controls.segment(time) {
            _ if self.system.layout.u == 0 => Vec::new(),
            None => self.system.guessed(tau)[self.system.layout.x..].to_vec(),
            segment => self.controls.values(segment, time),
        }
    }

    /// The rows that make the controls at a normalised time, each with its weight; none for those
    /// of the guess.
    pub fn rows(&self, tau: f64) -> impl Iterator<Item = (usize, f64)> {
        let time = self.time(tau);
        let segment = self.controls.segment(time);
        self.controls.range(segment).zip(self.controls.weights(segment, time, 0))
    }

    /// Whether the controls are the guess.
    pub fn follows_guess(&self) -> bool {
        *self.controls == Controls::Guess && self.system.layout.u > 0
    }

    pub fn rate(&self, point: &Point) -> DVector<f64> {
        DVector::from_vec(value(&*self.system.flow, &self.inputs(point), &self.parameters))
    }

    pub fn flow(&self, point: &Point) -> Jacobian {
        jacobian(&*self.system.flow, &self.inputs(point), &self.parameters)
    }

    pub fn psi(&self, point: &Point) -> DVector<f64> {
        DVector::from_vec(value(&*self.system.switching, &self.inputs(point), &self.parameters))
    }

    pub fn switching(&self, point: &Point) -> Jacobian {
        jacobian(&*self.system.switching, &self.inputs(point), &self.parameters)
    }
}
