//! An interval for each input of the functions of a system, and what the functions are there.

use super::Field;
use crate::simulate::system::{Enclosure, Interval};

/// The inputs `[t | x | u | p | s]` during a part of a step.
pub(crate) struct Tube {
    /// An interval for each input.
    pub inputs: Vec<Interval>,
    /// How fast time, states and controls change with the part of the step that is past.
    pub speeds: Vec<Interval>,
    /// Value and derivatives of what was evaluated last.
    pub ranges: Vec<Interval>,
}

impl Tube {
    /// Selectors and parameters, and controls that are held, do not change along a step.
    pub fn new(field: &Field) -> Self {
        let layout = field.system.layout;
        let mut inputs = vec![[0.0; 2]; layout.inputs()];
        let mut put = |first: usize, values: &[f64]| {
            inputs[first..].iter_mut().zip(values).for_each(|(input, value)| *input = [*value; 2]);
        };
        put(layout.controls().start, field.control());
        put(layout.parameters().start, field.parameters());
        put(layout.selectors().start, &field.selectors);
        Tube { inputs, speeds: vec![[0.0; 2]; layout.controls().end], ranges: Vec::new() }
    }

    /// At one point.
    pub fn at(field: &Field, t: f64, x: &[f64]) -> Self {
        let mut tube = Tube::new(field);
        let control = field.control_at(t);
        let point = std::iter::once(&t).chain(x).chain(&control);
        tube.inputs.iter_mut().zip(point).for_each(|(input, value)| *input = [*value; 2]);
        tube
    }

    /// Finds value and derivatives over the present part.
    pub fn evaluate(&mut self, of: &Enclosure) {
        self.ranges.clear();
        self.ranges.resize(1 + of.by.len(), [0.0; 2]);
        (of.over)(&self.inputs, &mut self.ranges);
    }
}
