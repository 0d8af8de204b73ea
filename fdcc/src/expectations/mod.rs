//! What a model expects of its solution, compared with the solution.
//!
//! Values of states are those at the ends of the trajectory; integrals are taken by the scheme's
//! own quadrature. What only a simulation can tell is that of the replay on the true system.

mod of_phases;
mod replayed;

use crate::solve::{Phases, Solution};
use fdcc_compiler::model::Comparison;
use fdcc_compiler::{Model, expectations};
use fdcc_runtime::problem::{Columns, Function, Origin, Problem};
use fdcc_runtime::solution::{integrals, sums_over_rows};
use fdcc_runtime::solve::Outcome;
use replayed::Replayed;

/// One line of the `expect` block and what became of it.
///
/// ```
/// use fdcc::{Expected, Model, Options};
///
/// # let text = "time t in [0, 1]\nstate x start 0\ncontrol u in [-1, 1]
/// # dynamics { x' = u }\nend x == 0.5\nminimize integral(u^2)";
/// let text = format!("{text}\nexpect {{ x(end) == 0.5 within 1e-6 }}");
/// let model = Model::from_text("hop", &text)?;
/// let found = model.solve(&Options::default())?.expectations();
/// assert!(matches!(&found[0].outcome, Expected::Compared(sides) if sides.holds));
/// # Ok::<(), fdcc::Error>(())
/// ```
pub struct Expectation {
    /// The text and its place.
    pub origin: Origin,
    /// The comparison.
    pub outcome: Expected,
}

/// What became of an expectation.
///
/// ```
/// use fdcc::{Expected, Model, Options};
///
/// let text = "time t in [0, 1]\nstate x start 0\ndynamics { x' = 1 }
/// free T in [0, 1] guess 0.5\nend x == 2*T\nexpect { x(end) >= 2 within 1e-6 }";
/// let found = Model::from_text("line", text)?.solve(&Options::default())?.expectations();
/// let Expected::Compared(sides) = &found[0].outcome else { panic!("both sides have values") };
/// assert!(!sides.holds);
/// # Ok::<(), fdcc::Error>(())
/// ```
pub enum Expected {
    /// Both sides have values.
    Compared(Sides),
    /// The true system does not tell, and why.
    Untold(String),
}

/// The numbers of a comparison.
///
/// ```
/// use fdcc::{Expected, Model, Options, Sides};
///
/// # let text = "time t in [0, 1]\nstate x start 0\ncontrol u in [-1, 1]
/// # dynamics { x' = u }\nend x == 0.5\nminimize integral(u^2)";
/// let text = format!("{text}\nexpect {{ x(end) <= 1 within 1e-6 }}");
/// let found = Model::from_text("hop", &text)?.solve(&Options::default())?.expectations();
/// let Expected::Compared(Sides { left, right, .. }) = found[0].outcome else { panic!() };
/// assert!((left - 0.5).abs() < 1e-8 && right == 1.0);
/// # Ok::<(), fdcc::Error>(())
/// ```
pub struct Sides {
    /// Left side.
    pub left: f64,
    /// Right side.
    pub right: f64,
    /// By how much it may fail.
    pub tolerance: f64,
    /// Whether it holds; never if a side is not a number.
    pub holds: bool,
}

impl Solution {
    /// What the model expects of its solution, compared with this one.
    pub fn expectations(&self) -> Vec<Expectation> {
        if self.phases().is_empty() { evaluate(self) } else { of_phases::evaluate(self) }
    }
}

/// Evaluates all expectations of its model at a solution.
fn evaluate(solution: &Solution) -> Vec<Expectation> {
    let between = solution.between_jumps.as_ref();
    let expectations = expectations(between.map_or(solution.model().meaning(), |it| &it.model));
    let trajectory = &solution.outcome.trajectory;
    let ends = |column: fn(&[f64]) -> f64| trajectory.states.iter().map(move |state| column(state));
    let inputs: Vec<f64> =
        ends(|state| state[0]).chain(ends(|state| state[state.len() - 1])).collect();
    let mut parameters = match between {
        Some(it) => it.outcome.phases[0].trajectory.parameters.clone(),
        None => trajectory.parameters.clone(),
    };
    parameters.extend(match between {
        Some(phases) => over_phases(phases),
        None => over_time(&solution.problem, &solution.outcome, &expectations),
    });
    let replayed = Replayed::new(solution, &expectations.simulated);
    parameters.extend(replayed.values());
    let mut values = Columns::new(expectations.function.outputs(), 1);
    expectations.function.value(&Columns::of_point(&inputs), &parameters, &mut values);
    let list = expectations.list.iter().enumerate();
    list.map(|(at, expected)| checked(expected, at, &values, &replayed)).collect()
}

/// The integrals that expectations read, over the time of one phase.
pub(super) fn of_phase(
    problem: &Problem,
    outcome: &Outcome,
    integrands: &dyn Function,
) -> Vec<f64> {
    integrals(problem, &outcome.solution, &outcome.trajectory.parameters, integrands)
}

/// The integrals, then the sums over rows.
fn over_time(
    problem: &Problem,
    outcome: &Outcome,
    expectations: &fdcc_compiler::Expectations,
) -> Vec<f64> {
    let (known, sums) = (&outcome.trajectory.parameters, &expectations.sums);
    let mut all = of_phase(problem, outcome, &*expectations.integrands);
    all.extend(sums_over_rows(problem, &outcome.solution, known, sums));
    all
}

/// The same over all phases between jumps.
fn over_phases(phases: &Phases) -> Vec<f64> {
    let Phases { model, chain, outcome } = phases;
    let models: Vec<&Model> = match &model.phases[..] {
        [] => vec![model],
        own => own.iter().map(|phase| &phase.model).collect(),
    };
    let own = models.into_iter().zip(&chain.phases).zip(&outcome.phases);
    let own =
        own.map(|((model, problem), outcome)| over_time(problem, outcome, &expectations(model)));
    let add = |sum: Vec<f64>, more: Vec<f64>| sum.iter().zip(more).map(|(a, b)| a + b).collect();
    own.reduce(add).unwrap_or_default()
}

fn checked(
    expected: &fdcc_compiler::Expected,
    at: usize,
    values: &Columns,
    replayed: &Replayed,
) -> Expectation {
    let outcome = match expected.simulated.iter().find_map(|&asked| replayed.why_not(asked)) {
        Some(why) => Expected::Untold(why),
        None => Expected::Compared(sides(expected, at, values)),
    };
    Expectation { origin: expected.origin.clone(), outcome }
}

fn sides(expected: &fdcc_compiler::Expected, at: usize, values: &Columns) -> Sides {
    let [left, right, tolerance] = [0, 1, 2].map(|side| values.column(3 * at + side)[0]);
    let holds = holds(expected.comparison, left, right, tolerance);
    Sides { left, right, tolerance, holds }
}

fn holds(comparison: Comparison, left: f64, right: f64, tolerance: f64) -> bool {
    match comparison {
        Comparison::Equal => (left - right).abs() <= tolerance,
        Comparison::LessEqual => left <= right + tolerance,
        Comparison::GreaterEqual => left >= right - tolerance,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_comparison_may_fail_by_its_tolerance_and_never_holds_for_nan() {
        let cases = [
            (Comparison::Equal, 1.0, 1.25, 0.25, true),
            (Comparison::Equal, 1.0, 1.25, 0.125, false),
            (Comparison::LessEqual, 1.25, 1.0, 0.25, true),
            (Comparison::LessEqual, 1.25, 1.0, 0.125, false),
            (Comparison::LessEqual, 0.0, 1.0, 0.0, true),
            (Comparison::GreaterEqual, 0.75, 1.0, 0.25, true),
            (Comparison::GreaterEqual, 0.75, 1.0, 0.125, false),
            (Comparison::GreaterEqual, f64::NAN, 1.0, 0.25, false),
            (Comparison::Equal, 1.0, f64::NAN, 0.25, false),
        ];
        for (comparison, left, right, tolerance, expected) in cases {
            assert_eq!(
                holds(comparison, left, right, tolerance),
                expected,
                "{left} {comparison:?} {right}"
            );
        }
    }
}
