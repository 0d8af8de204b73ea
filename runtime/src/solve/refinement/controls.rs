//! Where few long intervals say too little of a control: it jumps or has a kink inside.
//!
//! The errors of the steps do not show that: they are those of the control as it is. But a
//! polynomial of degree `n` on an interval that cannot do without its leading coefficient `a`,
//! however high the degree, is no piece of a smooth function: it is at least `|a| 2^(1 - 2n)` away
//! from all of lower degree, on [0, 1]. Such intervals are divided until they are as short as where
//! the order is given; decay of coefficients as a sign of smoothness: Liu, Hager and Rao, IEEE
//! Trans. Control Syst. Technol. 26 (2018) 1475-1483.

use crate::problem::{ControlShape, FIRST_GRID, Problem};
use crate::solve::Outcome;
use crate::solve::tuning::controls::{FLAT, ROUGH};
use crate::transcribe::TranscribedNlp;
use crate::transcribe::interval::Signal;

/// Into how many parts each interval is divided.
pub(super) fn parts(problem: &Problem, outcome: &Outcome) -> Vec<usize> {
    let nlp = TranscribedNlp::new(problem);
    let intervals = nlp.chain().intervals;
    let mut parts = vec![1; intervals];
    if problem.method.controls != ControlShape::Polynomial {
        return parts;
    }
    for control in 0..problem.layout.u {
        let rough = rough(&nlp, &outcome.solution.v, control);
        for (k, parts) in parts.iter_mut().enumerate().filter(|(k, _)| rough[*k]) {
            let length = nlp.mesh().relative(k) / intervals as f64;
            *parts = (length * FIRST_GRID as f64).round().max(1.0) as usize;
        }
    }
    parts
}

/// The intervals on which a control is not smooth.
fn rough(nlp: &TranscribedNlp, v: &[f64], control: usize) -> Vec<bool> {
    let slots = nlp.interval().slots.iter().enumerate();
    let own = slots.filter(|(_, slot)| slot.signal == Signal::Control(control));
    let (places, times): (Vec<usize>, Vec<f64>) =
        own.map(|(place, slot)| (place, slot.time)).unzip();
    let values: Vec<Vec<f64>> = (0..nlp.chain().intervals)
        .map(|k| places.iter().map(|place| v[nlp.chain().state(k).start + place]).collect())
        .collect();
    let (least, most) = values
        .iter()
        .flatten()
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(least, most), u| (least.min(*u), most.max(*u)));
    let range = (most - least).max(FLAT * least.abs().max(most.abs()).max(1.0));
    values.iter().map(|values| distance(&times, values) > ROUGH * range).collect()
}

/// Of the polynomial through these values from all of lower degree.
fn distance(times: &[f64], values: &[f64]) -> f64 {
    let term = |(j, value): (usize, &f64)| {
        let others = times.iter().enumerate().filter(|(l, _)| *l != j);
        others.fold(*value, |term, (_, other)| term / (times[j] - other))
    };
    let leading: f64 = values.iter().enumerate().map(term).sum();
    leading.abs() * 2f64.powi(3 - 2 * times.len() as i32)
}

#[cfg(test)]
mod tests {
    use super::distance;

    /// `t^2 - t + 1/8` has the least size of all quadratic polynomials that begin so, 1/8.
    #[test]
    fn what_is_of_lower_degree_is_at_no_distance() {
        let times = [0.1, 0.5, 0.9];
        let at = |u: fn(f64) -> f64| distance(&times, &times.map(u));
        assert!(at(|t| 3.0 * t - 1.0) < 1e-14);
        assert!((at(|t| t * t) - 0.125).abs() < 1e-14);
    }
}
