//! ScalingFactors that make the numbers of an NLP moderate, whatever the units of the model.
//!
//! A quantity whose size ([`nominal`](super::nominal)) is between 1/16 and 16 is left alone, others
//! are brought to the nearer of these. The steps of a state are divided by what it is divided by.
//! The objective is scaled so that its gradient, summed over the times of a quantity, is between 1
//! and
//! 100. As in Ipopt (Waechter & Biegler 2006, section 3.8) rows with gradients above 100 at the
//!      start are scaled down to that; path constraints and boundary conditions whose gradients are
//!      all below 1/100, at the start and near it, are scaled up to 1. All but the factors of steep
//!      rows are powers of two, which round nothing.

use super::nominal::{
    largest, magnitudes, magnitudes_of_answer, magnitudes_of_equations, near, slopes,
};
use crate::nlp::tuning::factors::{
    LARGEST_FACTOR, LARGEST_OBJECTIVE, LEAST_FACTOR, LEAST_OBJECTIVE, MODERATE, MODERATE_GRADIENT,
    SMALLEST,
};
use crate::nlp::{Derivatives, Nlp, Quantities};

/// What the numbers of an NLP are multiplied by.
#[derive(Clone)]
pub(in crate::nlp) struct ScalingFactors {
    pub(in crate::nlp) objective: f64,
    /// `v` of the NLP is so many times the variables of the scaled one.
    pub(in crate::nlp) variables: Vec<f64>,
    pub(in crate::nlp) rows: Vec<f64>,
}

impl ScalingFactors {
    /// Those for a solve that begins at `v`, of which little is known.
    pub(in crate::nlp) fn new(nlp: &mut dyn Nlp, v: &[f64]) -> Self {
        let (quantities, v) = (nlp.quantities(), inside(nlp, v));
        let magnitudes = magnitudes(nlp, &quantities, &v);
        ScalingFactors::of_sizes(nlp, &quantities, &v, &magnitudes)
    }

    /// Those for another solve that begins at `v`, where what is known of that led nowhere: how
    /// large variables are is asked of conditions and equations.
    pub(in crate::nlp) fn of_equations(nlp: &mut dyn Nlp, v: &[f64]) -> Self {
        let (quantities, v) = (nlp.quantities(), inside(nlp, v));
        let magnitudes = magnitudes_of_equations(nlp, &quantities, &v);
        ScalingFactors::of_sizes(nlp, &quantities, &v, &magnitudes)
    }

    /// Those for a solve that begins at the answer of another.
    pub(in crate::nlp) fn of_answer(nlp: &mut dyn Nlp, v: &[f64]) -> Self {
        let (quantities, v) = (nlp.quantities(), inside(nlp, v));
        let magnitudes = magnitudes_of_answer(&quantities, &v);
        ScalingFactors::of_sizes(nlp, &quantities, &v, &magnitudes)
    }

    /// The largest ratio of the factors of a variable or of the objective.
    pub(in crate::nlp) fn distance(&self, other: &ScalingFactors) -> f64 {
        let own = self.variables.iter().chain([&self.objective]);
        let ratios = own.zip(other.variables.iter().chain([&other.objective])).map(|(a, b)| a / b);
        ratios.fold(1.0, |most, ratio| most.max(ratio).max(1.0 / ratio))
    }

    fn of_sizes(nlp: &mut dyn Nlp, quantities: &Quantities, v: &[f64], magnitudes: &[f64]) -> Self {
        let at_start = slopes(nlp, v);
        let units: Vec<f64> = magnitudes.iter().map(|size| unit(*size)).collect();
        let variables: Vec<f64> = quantities.variables.iter().map(|i| units[*i]).collect();
        let mut steepness = Steepness::new(nlp, quantities, &variables, &at_start);
        // What is flat at the start may be so by chance.
        if steepness.is_flat(quantities) {
            let near = near(nlp, quantities, v, magnitudes);
            let at_near = slopes(nlp, &near);
            steepness = steepness.or(Steepness::new(nlp, quantities, &variables, &at_near));
        }
        let mut objective = objective(steepness.objective);
        if objective > LARGEST_FACTOR {
            objective = objective.min(power_of_two(LARGEST_FACTOR / nlp.objective_unit()));
        }
        ScalingFactors { objective, rows: rows(quantities, &units, steepness), variables }
    }
}

/// One unit of the objective of an NLP that has none: how much it changes at a guess with the sizes
/// of the variables, where that is less than 1.
pub(crate) fn objective_unit(nlp: &mut dyn Nlp, guess: &[f64]) -> f64 {
    let (quantities, v) = (nlp.quantities(), inside(nlp, guess));
    let magnitudes = magnitudes(nlp, &quantities, &v);
    let units: Vec<f64> = magnitudes.iter().map(|size| unit(*size)).collect();
    let variables: Vec<f64> = quantities.variables.iter().map(|i| units[*i]).collect();
    let slope =
        |nlp: &mut dyn Nlp, v: &[f64]| objective_slope(&quantities, &variables, &slopes(nlp, v));
    let here = slope(nlp, &v);
    if here >= 1.0 && here.is_finite() {
        return 1.0;
    }
    let near = near(nlp, &quantities, &v, &magnitudes);
    let near = slope(nlp, &near);
    let largest = [here, near].into_iter().filter(|slope| slope.is_finite()).fold(0.0, f64::max);
    if largest > 0.0 { largest.min(1.0) } else { 1.0 }
}

/// The point of the bounds that is nearest to `v`.
fn inside(nlp: &dyn Nlp, v: &[f64]) -> Vec<f64> {
    v.iter().zip(nlp.variable_bounds()).map(|(v, it)| v.max(it.lower).min(it.upper)).collect()
}

/// The gradients of objective and rows in scaled variables.
struct Steepness {
    /// Summed over the times of each quantity; the largest sum.
    objective: f64,
    rows: Vec<f64>,
    /// The largest of the rows that are one quantity.
    conditions: Vec<f64>,
}

impl Steepness {
    fn new(nlp: &dyn Nlp, quantities: &Quantities, variables: &[f64], at: &Derivatives) -> Self {
        let mut rows = vec![0.0f64; quantities.constraints.len()];
        nlp.jacobian_structure().with_values(&at.jacobian).for_each(|(row, column, slope)| {
            rows[row] = rows[row].max((variables[column] * slope).abs());
        });
        let conditions = largest(&quantities.constraints, rows.iter().copied());
        Steepness { objective: objective_slope(quantities, variables, at), rows, conditions }
    }

    /// Whether something would be scaled up.
    fn is_flat(&self, quantities: &Quantities) -> bool {
        let conditions = self.conditions.iter().skip(quantities.stepped);
        self.objective < LEAST_OBJECTIVE
            || conditions.into_iter().any(|slope| *slope < 1.0 / MODERATE_GRADIENT)
    }

    /// The same with what is steeper elsewhere.
    fn or(mut self, other: Steepness) -> Self {
        let steeper = |a: f64, b: f64| if b.is_finite() { a.max(b) } else { a };
        self.objective = steeper(self.objective, other.objective);
        let conditions = self.conditions.iter_mut().zip(other.conditions);
        conditions.for_each(|(slope, other)| *slope = steeper(*slope, other));
        self
    }
}

/// What a quantity of this size is divided by; 1 where it is moderate or nothing is known.
fn unit(size: f64) -> f64 {
    if size == 0.0 || !size.is_finite() {
        return 1.0;
    }
    let size = power_of_two(size.clamp(SMALLEST, 1.0 / SMALLEST));
    size / size.clamp(1.0 / MODERATE, MODERATE)
}

fn power_of_two(value: f64) -> f64 {
    value.log2().round().exp2()
}

/// The gradient of the objective, summed over the times of each quantity; the largest sum.
fn objective_slope(quantities: &Quantities, variables: &[f64], at: &Derivatives) -> f64 {
    let mut sums = vec![0.0; variables.len()];
    for ((i, unit), slope) in quantities.variables.iter().zip(variables).zip(&at.gradient) {
        sums[*i] += (unit * slope).abs();
    }
    sums.into_iter().fold(0.0, f64::max)
}

fn objective(slope: f64) -> f64 {
    if slope == 0.0 || !slope.is_finite() {
        return 1.0;
    }
    let factor = slope.clamp(LEAST_OBJECTIVE, LARGEST_OBJECTIVE) / slope;
    power_of_two(factor.max(1.0 / LARGEST_FACTOR))
}

fn rows(quantities: &Quantities, units: &[f64], steepness: Steepness) -> Vec<f64> {
    let upwards: Vec<f64> = steepness.conditions.into_iter().map(upwards).collect();
    let factor = |(i, slope): (&usize, f64)| {
        let factor = if *i < quantities.stepped { 1.0 / units[*i] } else { upwards[*i] };
        factor * downwards(factor * slope)
    };
    quantities.constraints.iter().zip(steepness.rows).map(factor).collect()
}

fn upwards(slope: f64) -> f64 {
    let is_small = slope > 0.0 && slope < 1.0 / MODERATE_GRADIENT;
    if is_small { power_of_two(1.0 / slope.max(SMALLEST)) } else { 1.0 }
}

fn downwards(slope: f64) -> f64 {
    if slope > MODERATE_GRADIENT { (MODERATE_GRADIENT / slope).max(LEAST_FACTOR) } else { 1.0 }
}
