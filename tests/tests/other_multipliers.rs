//! What a parameter is worth where conditions depend on each other: nothing is told that depends on
//! which of several sets of multipliers was found.

use fdcc::{Model, Options};

/// The derivatives of the least objective by all parameters.
fn slopes(text: &str) -> Vec<f64> {
    let model = Model::from_text("other_multipliers", text).expect("a model");
    let solution = model.solve(&Options::default()).expect("an answer");
    assert!(solution.status().is_solved(), "{text}: {}", solution.status_name());
    solution.sensitivities().into_iter().map(|it| it.1).collect()
}

const MOVE: &str = "time t in [0, 1] state x start 0 control u in [-5, 5] dynamics { x' = u }
    minimize integral(u^2)";

/// With `a` alone there is no solution, with both it is `a^2`; `k` has nothing to do with them.
#[test]
fn a_condition_that_is_written_twice() {
    let text = format!(
        "param a = 1 param b = 1 param k = 2 state y start 0 end x == a end x == b
         {}",
        MOVE.replace("x' = u", "x' = u y' = k*u").replace("(u^2)", "(u^2) + y(end)")
    );
    let slopes = slopes(&text);
    assert!(slopes[0].is_nan() && slopes[1].is_nan(), "{slopes:?}");
    assert!((slopes[2] - 1.0).abs() < 1e-6, "{slopes:?}");
}

/// The same parameter in both: `2 a`.
#[test]
fn a_parameter_of_both_conditions_has_a_derivative() {
    let slopes = slopes(&format!("param a = 1.5 end x == a end 2*x == 2*a {MOVE}"));
    assert!((slopes[0] - 3.0).abs() < 1e-6, "{slopes:?}");
}

/// The whole way is at the bound: with less of it there is no solution, more changes nothing.
#[test]
fn a_bound_that_leaves_one_way_only() {
    let text = format!("param most = 1 end x == 1 {}", MOVE.replace("[-5, 5]", "[-5, most]"));
    assert!(slopes(&text)[0].is_nan());
    // It is one of two, or holds for a while only.
    let text = format!("param most = 0.5 {}", MOVE.replace("[-5, 5]", "[-5, most]"))
        .replace("integral(u^2)", "integral((u - 1)^2)");
    assert!((slopes(&text)[0] + 1.0).abs() < 1e-6);
}

/// Defects of an unstable plant are nearly dependent: with `x' = k x + u` the least
/// `integral(u^2)` to the end `a` is `2 k a^2/(e^(2k) - 1)`, 4e-8 for `k = 10`.
#[test]
fn an_unstable_plant_has_its_derivatives() {
    let slopes = slopes(
        "param k = 10 param a = 1 time t in [0, 1] state x start 0 control u
         dynamics { x' = k*x + u } end x == a minimize integral(u^2)",
    );
    let (k, growth) = (10.0_f64, 20.0_f64.exp());
    let by_a = 4.0 * k / (growth - 1.0);
    let by_k = 2.0 / (growth - 1.0) - 4.0 * k * growth / (growth - 1.0).powi(2);
    for (slope, exact) in slopes.iter().zip([by_k, by_a]) {
        assert!((slope - exact).abs() < 1e-4 * exact.abs(), "{slope} not {exact}");
    }
}
