//! What remains between a model and its measurements, as functions to be evaluated at a solution.

use super::machine_code;
use crate::lower::squares;
use crate::model::Model;
use crate::model::numbers::numbers;
use fdcc_runtime::problem::Measurements;

/// The roots of the squares of a sum over rows that is minimised.
pub struct Residuals {
    /// The signal or column that it is about, or the text of the sum.
    pub name: String,
    /// The data set.
    pub data: String,
    /// Whether the model says how far measurements lie from what they measure: then residuals are
    /// in standard deviations.
    pub is_fit: bool,
    /// One for each row: the residual is this times the term. It is 0 where nothing was measured.
    pub weights: Vec<f64>,
    /// What was measured in each row, where the term is its difference to a signal, times a factor.
    pub readings: Option<Readings>,
    /// The terms, values only.
    pub rows: Measurements,
}

/// Measurements, one for each row.
#[derive(Clone, Debug)]
pub struct Readings {
    /// What was measured.
    pub measured: Vec<f64>,
    /// The term is this times the signal less the measurement.
    pub factors: Vec<f64>,
}

/// The residuals of a model, whose squares are minimised; none if what is minimised over rows of
/// data is no sum of squares.
pub fn residuals(model: &Model) -> Vec<Residuals> {
    let Ok(numbers) = numbers(model) else { return Vec::new() };
    let (graph, squares) = squares(model);
    let functions = squares.iter().map(|it| it.root.term.clone()).collect();
    let weights: Option<Vec<Vec<f64>>> =
        squares.iter().map(|it| it.weights(model, &graph, &numbers)).collect();
    let Some(weights) = weights else { return Vec::new() };
    let readings: Vec<_> = squares.iter().map(|it| it.readings(model, &graph, &numbers)).collect();
    let functions = machine_code(graph, functions);
    let all = squares.iter().zip(weights).zip(readings).zip(&functions);
    let residuals = all.map(|(((square, weights), readings), function)| {
        let sum = &model.sums[square.root.sum];
        Residuals {
            name: square.name.clone(),
            data: model.tables[sum.table].called().to_owned(),
            is_fit: sum.is_fit,
            weights,
            readings: readings.map(|[measured, factors]| Readings { measured, factors }),
            rows: square.root.with_rows(model, &numbers, function),
        }
    });
    residuals.collect()
}
