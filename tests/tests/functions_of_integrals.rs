//! Objectives and conditions in which integrals are not simply added up: what one unit of them
//! counts is known at the solution alone, and the Hamiltonian needs it.

use fdcc::{Model, Options, Solution};

fn solved(text: &str) -> Solution {
    let model = Model::from_text("integrals", text).expect("it is right");
    model.solve(&Options::default()).expect("it can be solved")
}

/// To and fro with `|u| = 1` costs nothing; to stand still is stationary.
#[test]
fn a_stationary_point_of_a_function_of_an_integral_is_no_optimum() {
    let text = "time t in [0, 1]  state x start 0  control u in [-2, 2]
        dynamics { x' = u }  minimize abs(integral(abs(u)) - 1) + x(end)^2";
    let solution = solved(text);
    assert!(!solution.is_certified() || solution.objective() < 1e-6, "{}", solution.objective());
}

/// `x(end) = integral((2 - t) u) - 1`, at most `sqrt(8/3) - 1` by Cauchy and Schwarz.
#[test]
fn what_an_integral_in_a_condition_costs_is_part_of_the_hamiltonian() {
    let text = "time t in [0, 2]  state x start 0  state v start 0  control u in [-3, 3]
        surface slip = v  dynamics { x' = v  v' in u - 0.5*Sgn(slip) }
        end integral(u^2) <= 1  maximize x(end)";
    let solution = solved(text);
    let off = solution.objective() - ((8.0_f64 / 3.0).sqrt() - 1.0);
    assert!(solution.is_certified() && off.abs() < 1e-8, "{off}");
    let minimum = solution.certificate.iter().flat_map(|it| &it.checks);
    let minimum = minimum.filter(|it| it.name == "minimum").map(|it| it.figure);
    assert!(minimum.fold(0.0, f64::max) < 1e-8);
}
