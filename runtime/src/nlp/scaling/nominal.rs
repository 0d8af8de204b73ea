//! Nominal magnitudes: how large the quantities of an NLP are, as far as can be told before it is
//! solved.
//!
//! The size of a quantity is the largest value of its guess; where that is 0, the length of its
//! range; where that is infinite, how far a condition on it alone takes it; where there is none,
//! what the others make of it,
//!
//! ```text
//!     of a state     S_i = sum of |steps of x_i|, with all of known size moved by a part of it;
//!     of a control   S_j = min over i of S_i / sum of |slopes of x_i's steps|, there too
//! ```
//!
//! A small guess may be meant as none, and a solve that begins at an earlier solution finds
//! quantities at rest: it is the size only as far as range, conditions and equations do not say
//! more. Beyond 1 they do not raise it.

use crate::nlp::tuning::nominal::{
    GOLDEN, LARGEST_ASKED_FOR, LARGEST_ESTIMATE, LEAST_ANSWER, LEAST_PART, LONGEST_RANGE, NO_SIZE,
    SMALL,
};
use crate::nlp::{Derivatives, Nlp, Quantities};
use crate::problem::Bounds;
use std::collections::BTreeMap;

/// The size of each quantity; 0 where nothing is known.
pub(in crate::nlp) fn magnitudes(
    nlp: &mut dyn Nlp,
    quantities: &Quantities,
    v: &[f64],
) -> Vec<f64> {
    let guesses = largest(&quantities.variables, v.iter().map(|value| value.abs()));
    told(nlp, quantities, v, &guesses, LARGEST_ESTIMATE)
}

/// The same where a guess counts only beside a range that says something: else it may be ours.
pub(in crate::nlp) fn magnitudes_of_equations(
    nlp: &mut dyn Nlp,
    quantities: &Quantities,
    v: &[f64],
) -> Vec<f64> {
    let mut guesses = largest(&quantities.variables, v.iter().map(|value| value.abs()));
    let ranges = ranges(nlp, quantities);
    guesses.iter_mut().zip(ranges).filter(|it| it.1 == 0.0).for_each(|(guess, _)| *guess = 0.0);
    told(nlp, quantities, v, &guesses, LARGEST_ASKED_FOR)
}

/// The lengths of the ranges; 0 where that is no statement about a size.
fn ranges(nlp: &dyn Nlp, quantities: &Quantities) -> Vec<f64> {
    let mut ranges = largest(&quantities.variables, nlp.variable_bounds().iter().map(range));
    let wide = |(range, unit): &(&mut f64, &f64)| **range > LONGEST_RANGE * **unit;
    ranges.iter_mut().zip(&quantities.units).filter(wide).for_each(|(range, _)| *range = 0.0);
    ranges
}

/// Estimates are at most `most` units. What a solve before left of quantities at rest says nothing
/// of their sizes.
fn told(
    nlp: &mut dyn Nlp,
    quantities: &Quantities,
    v: &[f64],
    guesses: &[f64],
    most: f64,
) -> Vec<f64> {
    let ranges = ranges(nlp, quantities);
    let mut magnitudes: Vec<f64> =
        guesses.iter().zip(ranges).map(|(guess, range)| stated(*guess, range)).collect();
    if !magnitudes.contains(&0.0) {
        return magnitudes;
    }
    let of_unknown = |mut sizes: Vec<f64>, known: &[f64]| {
        let all = sizes.iter_mut().zip(known).zip(&quantities.units);
        let rounding =
            all.filter(|((size, known), unit)| **known == 0.0 && **size < NO_SIZE * *unit);
        rounding.for_each(|((size, _), _)| *size = 0.0);
        sizes
    };
    let guesses = of_unknown(guesses.to_vec(), &magnitudes);
    let demands = demands(nlp, quantities, v);
    fill(&mut magnitudes, |i| if demands[i] > 0.0 { demands[i].max(guesses[i]) } else { 0.0 });
    while magnitudes.contains(&0.0) {
        let known = magnitudes.clone();
        let found = of_unknown(estimates(nlp, quantities, v, &known), &known);
        if found == known {
            // A signal begins somewhere; an unknown that nothing is known of is left as it is.
            fill(&mut magnitudes, |i| if i < quantities.stepped { guesses[i] } else { 0.0 });
        } else {
            fill(&mut magnitudes, |i| {
                let unit = quantities.units[i];
                let range = [unit / most, unit * most];
                if found[i] > 0.0 { believed(found[i], guesses[i], range) } else { 0.0 }
            });
        }
        if magnitudes == known {
            break;
        }
    }
    magnitudes
}

/// The size of each quantity at an answer; 0 where it is nothing. What guess and bounds said has no
/// part in it.
pub(in crate::nlp) fn magnitudes_of_answer(quantities: &Quantities, v: &[f64]) -> Vec<f64> {
    let largest = largest(&quantities.variables, v.iter().map(|value| value.abs()));
    let is_there =
        |(size, unit): (&f64, &f64)| if *size >= LEAST_ANSWER * unit { *size } else { 0.0 };
    largest.iter().zip(&quantities.units).map(is_there).collect()
}

/// Gives those whose size is unknown what has been found.
fn fill(magnitudes: &mut [f64], found: impl Fn(usize) -> f64) {
    magnitudes
        .iter_mut()
        .enumerate()
        .filter(|(_, size)| **size == 0.0)
        .for_each(|(i, size)| *size = found(i));
}

/// The magnitudes with those of states that the equations tell, else of controls.
fn estimates(nlp: &mut dyn Nlp, quantities: &Quantities, v: &[f64], known: &[f64]) -> Vec<f64> {
    let mut magnitudes = known.to_vec();
    let near = near(nlp, quantities, v, known);
    find_states(nlp, quantities, &near, &mut magnitudes);
    if magnitudes == known {
        find_controls(nlp, quantities, &near, &mut magnitudes);
    }
    magnitudes
}

/// What guess and range say; 0 where that is nothing.
fn stated(guess: f64, range: f64) -> f64 {
    if guess >= SMALL {
        guess
    } else if guess > 0.0 && range > 0.0 {
        guess.max((LEAST_PART * range).min(1.0))
    } else {
        range
    }
}

/// What an estimate says beside a small guess, or without one.
fn believed(estimate: f64, guess: f64, [least, most]: [f64; 2]) -> f64 {
    if guess > 0.0 { estimate.min(1.0).max(guess) } else { estimate.clamp(least, most) }
}

/// How far each quantity has to move for conditions on it alone.
fn demands(nlp: &mut dyn Nlp, quantities: &Quantities, v: &[f64]) -> Vec<f64> {
    let slopes = slopes(nlp, v);
    let mut rows = vec![0.0; quantities.constraints.len()];
    nlp.values(v, &mut rows);
    let mut steepest = vec![(0, 0.0f64, 0); rows.len()];
    nlp.jacobian_structure().with_values(&slopes.jacobian).for_each(|(row, column, slope)| {
        let (quantity, most, entries) = &mut steepest[row];
        if slope != 0.0 {
            (*quantity, *most, *entries) =
                (quantities.variables[column], slope.abs(), *entries + 1);
        }
    });
    let mut demands = vec![0.0f64; quantities.variables.iter().max().map_or(0, |last| last + 1)];
    let conditions =
        nlp.constraint_bounds().iter().zip(&rows).zip(&quantities.constraints).zip(steepest);
    for (((bounds, value), row), (quantity, slope, entries)) in conditions {
        let distance = bounds.violation(*value) / slope;
        if *row >= quantities.stepped && entries == 1 && distance.is_finite() {
            demands[quantity] = demands[quantity].max(distance);
        }
    }
    demands
}

/// Each variable moved by a part of the size of its quantity, within its bounds.
pub(in crate::nlp) fn near(
    nlp: &dyn Nlp,
    quantities: &Quantities,
    v: &[f64],
    magnitudes: &[f64],
) -> Vec<f64> {
    let moved = v.iter().zip(nlp.variable_bounds()).zip(&quantities.variables).enumerate();
    let moved = moved.map(|(i, ((v, bounds), quantity))| {
        let (v, size) = (v.max(bounds.lower).min(bounds.upper), magnitudes[*quantity]);
        let (least, most) = ((v - size).max(bounds.lower), (v + size).min(bounds.upper));
        least + (i as f64 * GOLDEN).fract() * (most - least)
    });
    moved.collect()
}

/// Derivatives of objective and rows.
pub(in crate::nlp) fn slopes(nlp: &mut dyn Nlp, v: &[f64]) -> Derivatives {
    let mut slopes = Derivatives::new(nlp);
    nlp.derivatives(v, 0.0, &vec![0.0; nlp.constraint_bounds().len()], &mut slopes);
    slopes
}

/// The largest value that belongs to each number in `of`.
pub(in crate::nlp) fn largest(of: &[usize], values: impl Iterator<Item = f64>) -> Vec<f64> {
    let mut largest = vec![0.0f64; of.iter().max().map_or(0, |last| last + 1)];
    of.iter().zip(values).for_each(|(i, value)| largest[*i] = largest[*i].max(value));
    largest
}

fn range(bounds: &Bounds) -> f64 {
    if bounds.is_equality() { 0.0 } else { bounds.upper - bounds.lower }
}

/// How far the equations take states of unknown size, which are 0: all that is left of a step is
/// its right side.
fn find_states(nlp: &mut dyn Nlp, quantities: &Quantities, near: &[f64], magnitudes: &mut [f64]) {
    let mut rows = vec![0.0; quantities.constraints.len()];
    nlp.values(near, &mut rows);
    let mut steps: BTreeMap<usize, Vec<f64>> = BTreeMap::new();
    for (i, row) in quantities.constraints.iter().zip(rows) {
        if *i < quantities.stepped && magnitudes[*i] == 0.0 && row.is_finite() {
            steps.entry(*i).or_default().push(row.abs());
        }
    }
    let intervals = intervals(nlp);
    steps.into_iter().for_each(|(i, steps)| magnitudes[i] = intervals * mean(&steps));
}

/// How much of a control of unknown size changes a state by its own size.
fn find_controls(nlp: &mut dyn Nlp, quantities: &Quantities, near: &[f64], magnitudes: &mut [f64]) {
    let slopes = slopes(nlp, near);
    let mut influences: BTreeMap<(usize, usize), Vec<f64>> = BTreeMap::new();
    for ((row, column), slope) in nlp.jacobian_structure().entries().zip(&slopes.jacobian) {
        let (i, j) = (quantities.constraints[row], quantities.variables[column]);
        if i < quantities.stepped
            && magnitudes[i] > 0.0
            && magnitudes[j] == 0.0
            && slope.is_finite()
        {
            influences.entry((i, j)).or_default().push(slope.abs());
        }
    }
    let intervals = intervals(nlp);
    for ((i, j), slopes) in influences {
        let most = magnitudes[i] / (intervals * mean(&slopes));
        magnitudes[j] = if most.is_finite() && (magnitudes[j] == 0.0 || most < magnitudes[j]) {
            most
        } else {
            magnitudes[j]
        };
    }
}

fn intervals(nlp: &dyn Nlp) -> f64 {
    let phases = nlp.phases().iter().map(|phase| phase.stages.intervals).max();
    nlp.stages().map(|stages| stages.intervals).or(phases).map_or(1.0, |count| count as f64)
}

fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}
