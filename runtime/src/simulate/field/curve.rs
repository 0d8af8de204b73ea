//! The controls of one segment as polynomials in time, in Bernstein form.

use crate::simulate::bernstein::{restrict, slopes, through, value};
use crate::simulate::controls::{Controls, Polynomials};
use crate::simulate::interval::around;
use crate::simulate::system::Interval;
use nalgebra::DVector;

/// Controls that change during a segment.
pub(crate) struct Curve<'a> {
    of: &'a Polynomials,
    segment: usize,
    /// Of each control its values, then its derivative by time.
    controls: Vec<[Vec<f64>; 2]>,
}

impl<'a> Curve<'a> {
    /// Nothing where controls are the guess, or do not change.
    pub fn new(controls: &'a Controls, segment: Option<usize>) -> Option<Self> {
        let (Controls::Polynomial(of), Some(segment)) = (controls, segment) else { return None };
        let mut curve = Curve { of, segment, controls: Vec::new() };
        let range = of.ranges[segment].clone();
        let nodes: Vec<f64> = of.nodes[range.clone()].iter().map(|it| curve.part(*it)).collect();
        let length = curve.length();
        let count = of.rows.first().map_or(0, Vec::len);
        let control = |at: usize| {
            let column: Vec<f64> = of.rows[range.clone()].iter().map(|row| row[at]).collect();
            let values = through(&nodes, &column);
            let rates = slopes(&values).into_iter().map(|slope| slope / length).collect();
            [values, rates]
        };
        curve.controls = (0..count).map(control).collect();
        (range.len() > 1).then_some(curve)
    }

    /// The degree of the polynomials, at most.
    pub fn degree(&self) -> usize {
        self.of.ranges[self.segment].len() - 1
    }

    fn length(&self) -> f64 {
        self.of.times[self.segment + 1] - self.of.times[self.segment]
    }

    /// A time as a part of the segment.
    fn part(&self, t: f64) -> f64 {
        (t - self.of.times[self.segment]) / self.length()
    }

    /// All controls at a time.
    pub fn value_into(&self, t: f64, into: &mut [f64]) {
        let part = self.part(self.of.inside(self.segment, t).0);
        into.iter_mut().zip(&self.controls).for_each(|(into, of)| *into = value(&of[0], part));
    }

    /// How fast they change.
    pub fn rates(&self, t: f64) -> DVector<f64> {
        let (inside, is_inside) = self.of.inside(self.segment, t);
        let (part, factor) = (self.part(inside), f64::from(u8::from(is_inside)));
        let rate = |at: usize, _| factor * value(&self.controls[at][1], part);
        DVector::from_fn(self.controls.len(), rate)
    }

    /// Where a control and its rate are during some time.
    pub fn over(&self, control: usize, time: Interval) -> [Interval; 2] {
        let ends = time.map(|t| self.of.inside(self.segment, t));
        let part = ends.map(|end| self.part(end.0));
        let [values, mut rates] = self.controls[control].clone().map(|mut coefficients| {
            restrict(&mut coefficients, part);
            coefficients
        });
        // Outside of the segment nothing changes.
        if ends.iter().any(|end| !end.1) {
            rates.push(0.0);
        }
        [around(&values), around(&rates)]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// `t^2` on [1, 3] through three nodes; over [1.5, 2] it rises from 2.25 to 4.
    #[test]
    fn a_curve_is_enclosed_with_its_rate() {
        let of = Polynomials {
            times: vec![1.0, 3.0],
            ranges: std::iter::once(0..3).collect(),
            nodes: vec![1.5, 2.0, 3.0],
            rows: vec![vec![2.25], vec![4.0], vec![9.0]],
            is_stretched: true,
        };
        let controls = Controls::Polynomial(of);
        let curve = Curve::new(&controls, Some(0)).expect("it changes");
        let [value, rate] = curve.over(0, [1.5, 2.0]);
        assert!((value[0] - 2.25).abs() < 1e-14 && (value[1] - 4.0).abs() < 1e-14, "{value:?}");
        assert!((rate[0] - 3.0).abs() < 1e-14 && (rate[1] - 4.0).abs() < 1e-14, "{rate:?}");
        assert!((curve.rates(1.25)[0] - 2.5).abs() < 1e-14);
        let [value, rate] = curve.over(0, [2.5, 4.0]);
        assert!((value[1] - 9.0).abs() < 1e-14 && rate[0] == 0.0, "it stays at its end");
    }
}
