//! Where everything is during a part of a step: an interval for each input of the functions of a
//! system.
//!
//! A state is a polynomial of degree 4 along a step, and stays between the least and the greatest
//! of its Bernstein coefficients over a part; so does its rate, and so do controls that are
//! polynomials in time.

use crate::simulate::bernstein::restrict;
use crate::simulate::field::Field;
use crate::simulate::field::tube::Tube;
use crate::simulate::interval::{ALL, around, plus, scaled, times};
use crate::simulate::steps::Step;
use crate::simulate::system::{Enclosure, Interval};

impl Tube {
    /// Value and rate of what an enclosure encloses, during a part of a step.
    pub fn bounds(
        &mut self,
        field: &Field,
        step: &Step,
        part: [f64; 2],
        of: &Enclosure,
    ) -> [Interval; 2] {
        self.go_to(field, step, part, of);
        self.evaluate(of);
        let slopes = self.ranges[1..].iter().zip(&of.by);
        let terms = slopes.map(|(slope, input)| times(*slope, self.speeds[*input]));
        [self.ranges[0], terms.fold([0.0; 2], plus)]
    }

    /// Intervals of what an enclosure reads, and how fast it changes.
    pub fn go_to(&mut self, field: &Field, step: &Step, [from, to]: [f64; 2], of: &Enclosure) {
        let layout = field.system.layout;
        let now = [step.t + from * step.h, step.t + to * step.h];
        for &input in &of.reads {
            if input < layout.t {
                (self.inputs[input], self.speeds[input]) = (now, [step.h; 2]);
            } else if layout.states().contains(&input) {
                let (value, speed) = component(step, input - layout.t, [from, to]);
                (self.inputs[input], self.speeds[input]) = (value, speed);
            } else if layout.controls().contains(&input) {
                let moved = control(field, input - layout.controls().start, now);
                let Some([value, rate]) = moved else { continue };
                (self.inputs[input], self.speeds[input]) = (value, scaled(step.h, rate));
            }
        }
    }
}

/// A control during some time, and its rate; nothing if it does not change at all.
fn control(field: &Field, control: usize, time: Interval) -> Option<[Interval; 2]> {
    if let Some(curve) = &field.curve {
        return Some(curve.over(control, time));
    }
    field.follows_guess().then(|| {
        let value = guessed(field, control, time);
        // Nobody knows how fast a guess changes, which may jump.
        [value, if value[0] == value[1] { [0.0; 2] } else { ALL }]
    })
}

/// A guessed control during some time.
fn guessed(field: &Field, control: usize, time: Interval) -> Interval {
    let of = &field.system.enclosures.controls[control];
    let mut domain = vec![time.map(|time| field.normalised(time))];
    domain.extend(field.parameters().iter().map(|value| [*value; 2]));
    let mut ranges = vec![[0.0; 2]; 1 + of.by.len()];
    (of.over)(&domain, &mut ranges);
    ranges[0]
}

/// A state and its rate, per step, during a part of it.
fn component(step: &Step, state: usize, part: [f64; 2]) -> (Interval, Interval) {
    let mut value = step.extension.coefficients(state);
    let mut speed = step.extension.slopes(state);
    restrict(&mut value, part);
    restrict(&mut speed, part);
    (around(&value), around(&speed))
}
