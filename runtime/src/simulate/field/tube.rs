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
        let (inputs, speeds) =
            (vec![[0.0; 2]; layout.inputs()], vec![[0.0; 2]; layout.controls().end]);
        let mut tube = Tube { inputs, speeds, ranges: Vec::new() };
        tube.put(layout.parameters().start, field.parameters());
        tube.begin(field);
        tube
    }

    /// Puts selectors and controls where they are at the last point.
    fn begin(&mut self, field: &Field) {
        let layout = field.system.layout;
        self.put(layout.controls().start, field.control());
        self.put(layout.selectors().start, &field.selectors);
        self.speeds[layout.controls()].fill([0.0; 2]);
    }

    fn put(&mut self, first: usize, values: &[f64]) {
        let inputs = self.inputs[first..].iter_mut().zip(values);
        inputs.for_each(|(input, value)| *input = [*value; 2]);
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

impl Field<'_> {
    /// A tube in memory that was used before; whoever is done with it puts it back.
    pub fn lend_tube(&mut self) -> Tube {
        match self.tube.take() {
            Some(mut tube) => {
                tube.begin(self);
                tube
            }
            None => Tube::new(self),
        }
    }
}
