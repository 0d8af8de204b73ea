//! Right sides and guards of one system at single points, with all their derivatives.

use crate::problem::{Columns, Function};
use crate::simulate::{Controls, System, value};
use nalgebra::{DMatrix, DVector};

/// Values of a function and their derivatives by all its inputs.
pub(super) struct Jacobian {
    pub values: DVector<f64>,
    /// One column for each input.
    pub by: DMatrix<f64>,
}

impl Jacobian {
    /// At a point `[t | x | u | s]`.
    pub fn of(function: &dyn Function, point: &[f64], parameters: &[f64]) -> Self {
        let mut points = Columns::new(point.len(), 1);
        point.iter().enumerate().for_each(|(column, value)| points.column_mut(column)[0] = *value);
        let pattern = function.jacobian_pattern();
        let mut values = Columns::new(function.outputs(), 1);
        let mut entries = Columns::new(pattern.entries.len(), 1);
        function.jacobian(&points, parameters, &mut values, &mut entries);
        let mut by = DMatrix::zeros(function.outputs(), function.layout().inputs());
        for (entry, &(row, column)) in pattern.entries.iter().enumerate() {
            by[(row as usize, column as usize)] = entries.column(entry)[0];
        }
        Jacobian {
            values: DVector::from_fn(function.outputs(), |row, _| values.column(row)[0]),
            by,
        }
    }
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

    /// The row of the controls at a normalised time; none for those of the guess.
    pub fn row(&self, tau: f64) -> Option<usize> {
        self.controls.index(self.time(tau))
    }

    /// The controls at a normalised time.
    pub fn control(&self, tau: f64) -> Vec<f64> {
        match self.row(tau) {
            _ if self.system.layout.u == 0 => Vec::new(),
            None => self.system.guessed(tau)[self.system.layout.x..].to_vec(),
            row => self.controls.row(row).to_vec(),
        }
    }

    pub fn rate(&self, point: &Point) -> DVector<f64> {
        DVector::from_vec(value(&*self.system.flow, &self.inputs(point), &self.parameters))
    }

    pub fn flow(&self, point: &Point) -> Jacobian {
        Jacobian::of(&*self.system.flow, &self.inputs(point), &self.parameters)
    }

    pub fn psi(&self, point: &Point) -> DVector<f64> {
        DVector::from_vec(value(&*self.system.guards, &self.inputs(point), &self.parameters))
    }

    pub fn guards(&self, point: &Point) -> Jacobian {
        Jacobian::of(&*self.system.guards, &self.inputs(point), &self.parameters)
    }
}
