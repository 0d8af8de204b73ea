//! Where the iteration begins: inside all bounds, with multipliers from the caller or from least
//! squares.

use super::algorithm::Algorithm;
use super::filter::Filter;
use super::formulation::Formulation;
use super::iterate::Iterate;
use super::tuning::initialisation::{BOUND_PUSH, FIRST_MU, WARM_START_BOUND_PUSH};
use crate::nlp::{Multipliers, Nlp, Options, Start};

/// The algorithm at its first iterate.
pub(super) fn prepare(nlp: &mut dyn Nlp, start: &Start, options: Options) -> Algorithm {
    let formulation = Formulation::new(nlp);
    let (mu, push) = match &start.warm {
        Some(warm) => {
            // A method without a barrier has no parameter of it.
            let mu = warm.mu.filter(|mu| *mu > 0.0).unwrap_or(options.tol);
            (mu, WARM_START_BOUND_PUSH)
        }
        None => (FIRST_MU, BOUND_PUSH),
    };
    let y = first_point(nlp, &formulation, &start.v, push);
    let (length, rows) = (formulation.len(), formulation.target.len());
    let mut at =
        Iterate { y, lambda: vec![0.0; rows], lower: vec![0.0; length], upper: vec![0.0; length] };
    match &start.warm {
        Some(warm) => warm_multipliers(&formulation, &warm.multipliers, mu, &mut at),
        None => at.set_bound_multipliers(&formulation, |_| 1.0),
    }
    let mut algorithm = Algorithm::new(nlp, formulation, at, mu, options);
    if algorithm.values.evaluate(
        nlp,
        &algorithm.formulation,
        &algorithm.at.y,
        &mut algorithm.counts,
    ) {
        algorithm.filter = Filter::new(algorithm.values.violation);
        if start.warm.is_none() {
            algorithm.estimate_multipliers(nlp);
        }
    }
    algorithm
}

fn first_point(nlp: &mut dyn Nlp, formulation: &Formulation, start: &[f64], push: f64) -> Vec<f64> {
    let mut y = start.to_vec();
    for (value, bounds) in y.iter_mut().zip(nlp.variable_bounds()) {
        if bounds.is_equality() {
            *value = bounds.lower;
        }
    }
    if !formulation.slacks.is_empty() {
        let mut pushed = y.clone();
        formulation.push_inside(&mut pushed, push);
        let mut rows = vec![0.0; formulation.target.len()];
        nlp.values(&pushed, &mut rows);
        let finite = |row: f64| if row.is_finite() { row } else { 0.0 };
        y.extend(formulation.slacks.iter().map(|it| finite(rows[it.row])));
    }
    formulation.push_inside(&mut y, push);
    y
}

fn warm_multipliers(formulation: &Formulation, known: &Multipliers, mu: f64, at: &mut Iterate) {
    at.lambda.copy_from_slice(&known.constraints);
    let Iterate { y, lambda, lower, upper } = at;
    formulation.for_each_bound(y, |i, distance, direction| {
        let (z, known) = if direction > 0.0 {
            (&mut lower[i], &known.lower)
        } else {
            (&mut upper[i], &known.upper)
        };
        let value = match i.checked_sub(formulation.variables) {
            None => known[i],
            // A slack's multipliers follow from those of its row: -lambda - z_lower + z_upper = 0.
            Some(j) => -direction * lambda[formulation.slacks[j].row],
        };
        *z = value.max(mu / distance.max(1.0));
    });
}
