//! Controls far from their own make the Hamiltonian less: a solve goes there, and what it leaves is
//! contradicted as an optimum (`runtime/src/solution/elsewhere.rs`).

use fdcc::optimality::Condition;
use fdcc::{Model, Options, Solution};

fn solved(text: &str) -> Solution {
    let model = Model::from_text("elsewhere", text).expect("a model");
    let solution = model.solve(&Options::default()).expect("an answer");
    assert!(solution.status().is_solved(), "{text}");
    solution
}

fn is_contradicted(solution: &Solution) -> bool {
    let checks = solution.optimality(None);
    checks.iter().any(|it| it.condition == Condition::Minimum && it.contradicts())
}

/// The guess is where the slope of `tanh` is 0, to all digits, and J is 0.0834. The infimum is that
/// of `x' = 1` as long as `x` is below 0.5: 0.0392 by CasADi and IPOPT, from u = 1.
#[test]
fn a_plateau_is_left() {
    for (guess, upper) in [("500", "1e3"), ("3000", "1e4"), ("5000", "1e4")] {
        let solution = solved(&format!(
            "time t in [0, 1] state x start 0 control u in [0, {upper}] guess {guess}\n\
             dynamics {{ x' = tanh(u) }}\nminimize integral((x - 0.5)^2)\nmethod {{ N = 50 }}"
        ));
        let above = solution.objective() - 0.0392;
        assert!((-1e-8..1e-4).contains(&above), "{guess}: {above}");
        assert!(!is_contradicted(&solution), "{guess}");
    }
}

/// 0 is a local minimum of the Hamiltonian and its bounds are better; by calculus.
#[test]
fn a_small_valley_is_left() {
    let cost = |place: &str| {
        format!(
            "time t in [0, 1] state x start 0 control p in [-1, 1] {place}\ndynamics {{ x' = p }}\n\
             minimize integral(1e-3*p^2 - p^4) method {{ N = 20 }}"
        )
    };
    assert!((solved(&cost("guess 0")).objective() + 0.999).abs() < 1e-6);
}

/// What a path condition forbids is not better: `p = 1` is by 0.99, `p = 0.005` is allowed.
#[test]
fn a_value_that_is_not_allowed_is_not_better() {
    let text = |limit: &str| {
        format!(
            "time t in [0, 1] state x start 0 control p in [-1, 1] guess 0
dynamics {{ x' = p }}\n\
             path 2*p <= {limit}  path -2*p <= {limit}\n\
             minimize integral(0.01*(p - 0.005)^2 - p^4 + 1) method {{ N = 20 }}"
        )
    };
    let solution = solved(&text("0.02"));
    assert!(!is_contradicted(&solution));
    assert!((solution.objective() - 1.0).abs() < 1e-6, "{}", solution.objective());
    assert!(solved(&text("2")).objective() < 0.1);
}

/// A value between two others that are better cannot be left where the way there costs: the ends
/// are fixed, and so is the mean of `p`. It is told.
#[test]
fn what_is_no_minimum_of_the_hamiltonian_is_contradicted() {
    let text = "time t in [0, 1] state x start 0 control p in [-1, 1]\ndynamics { x' = p }\n\
                end x == 0\nminimize integral(1e-3*p^2 - p^4) method { N = 1 }";
    assert!(is_contradicted(&solved(text)));
}
