//! Where everything is during a part of a step: an interval for each input of the functions of a
//! system.
//!
//! A state is a polynomial of degree 4 along a step, and stays between the least and the greatest
//! of its Bernstein coefficients over a
//! part; so does its rate. R. T. Farouki: The Bernstein polynomial basis: a centennial
//! retrospective, CAGD 29 (2012) 379-419.

use super::interval::{ALL, around, plus, times};
use crate::simulate::field::Field;
use crate::simulate::field::tube::Tube;
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
        let moves = self.go_to(field, step, part, of);
        self.evaluate(of);
        let slopes = self.ranges[1..].iter().zip(&of.by);
        let terms = slopes.map(|(slope, input)| times(*slope, self.speeds[*input]));
        [self.ranges[0], if moves { ALL } else { terms.fold([0.0; 2], plus) }]
    }

    /// Intervals of what an enclosure reads; whether a control among it changes, nobody knows how
    /// fast.
    pub fn go_to(
        &mut self,
        field: &Field,
        step: &Step,
        [from, to]: [f64; 2],
        of: &Enclosure,
    ) -> bool {
        let layout = field.system.layout;
        let mut moves = false;
        for &input in &of.reads {
            if input < layout.t {
                self.inputs[input] = [step.t + from * step.h, step.t + to * step.h];
                self.speeds[input] = [step.h; 2];
            } else if layout.states().contains(&input) {
                let (value, speed) = component(step, input - layout.t, [from, to]);
                (self.inputs[input], self.speeds[input]) = (value, speed);
            } else if layout.controls().contains(&input) && field.follows_guess() {
                let now = [step.t + from * step.h, step.t + to * step.h];
                self.inputs[input] = guessed(field, input - layout.controls().start, now);
                moves |= self.inputs[input][0] != self.inputs[input][1];
            }
        }
        moves
    }
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
    let mut speed: [f64; 4] = std::array::from_fn(|k| 4.0 * (value[k + 1] - value[k]));
    restrict(&mut value, part);
    restrict(&mut speed, part);
    (around(&value), around(&speed))
}

/// Bernstein coefficients over a part of [0, 1], by de Casteljau's algorithm.
fn restrict(coefficients: &mut [f64], [from, to]: [f64; 2]) {
    let degree = coefficients.len() - 1;
    for turn in (1..=degree).filter(|_| to < 1.0) {
        for k in (turn..=degree).rev() {
            coefficients[k] = (1.0 - to) * coefficients[k - 1] + to * coefficients[k];
        }
    }
    let from = from / to;
    for turn in (1..=degree).filter(|_| from > 0.0) {
        for k in 0..=degree - turn {
            coefficients[k] = (1.0 - from) * coefficients[k] + from * coefficients[k + 1];
        }
    }
}

#[cfg(test)]
mod tests {
    use super::restrict;

    /// `x^3 = (0, 0, 0, 1)`; over [1/2, 1] its coefficients are the products of three of the ends.
    #[test]
    fn a_part_of_a_polynomial_has_the_blossoms_of_its_ends() {
        let mut cube = [0.0, 0.0, 0.0, 1.0];
        restrict(&mut cube, [0.5, 1.0]);
        assert_eq!(cube, [0.125, 0.25, 0.5, 1.0]);
        restrict(&mut cube, [0.0, 0.5]);
        assert_eq!(cube, [0.125, 0.1875, 0.28125, 0.421875]);
    }
}
