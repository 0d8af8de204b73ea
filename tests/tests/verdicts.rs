//! Every word of a verdict of `solve` is true: what is called solved or global is so, whatever
//! bounds, guess and units say of sizes.
//!
//! The programs have closed forms, or were solved by CasADi 3.7 with IPOPT 3.14 (`tol = 1e-10`) as
//! the same discrete problem. Some 1,000 random ones more:
//! `tests/peers/random_problems/`.

use fdcc_runtime::nlp::Status;
use fdcc_tests::models::{assert_solved, problem, solve, solved};

/// A control that follows 1, and a state that it takes to `x(1)`; with `x' = u` the best control is
/// constant, `(u - 1) + (u - 2) = 0`.
fn follows(bounds: &str, rate: &str, method: &str) -> String {
    format!(
        "time t in [0, 1] state x start 0 control u {bounds} dynamics {{ x' = {rate} }}\n\
         minimize integral((u - 1)^2) + (x(end) - 2)^2 method {{ {method} }}"
    )
}

#[test]
fn wide_bounds_say_nothing_of_sizes() {
    for bounds in [
        "in [0, 1e5]",
        "in [0, 1e6]",
        "in [0, 1e8]",
        "in [-1e7, 1e9]",
        "in [-1e9, 1e5]",
        "in [0, 3]",
        "",
    ] {
        let convex = solved(&follows(bounds, "u", "N = 5"));
        assert_solved(bounds, &convex, 0.5);
        assert!(convex.global, "{bounds}");
        assert_solved(bounds, &solved(&follows(bounds, "u", "N = 5 solver = interior_point")), 0.5);
        // CasADi and IPOPT, implicit Euler with 200 intervals.
        assert_solved(bounds, &solved(&follows(bounds, "u + 0.1*sin(x)", "N = 200")), 0.439428757);
    }
}

/// A guess that is far off is no statement about sizes, either.
#[test]
fn a_guess_says_nothing_of_sizes() {
    for guess in ["-1e6", "1e-9", "1e3", "1e7"] {
        let bounds = format!("in [-1e8, 1e8] guess {guess}");
        assert_solved(guess, &solved(&follows(&bounds, "u", "N = 5 solver = interior_point")), 0.5);
        assert_solved(guess, &solved(&follows(&bounds, "u + 0.1*sin(x)", "N = 200")), 0.439428757);
    }
}

/// `p^2 - w^2` is least at `p = 0` and at the bound of `w` that is further out; the other bound is
/// a local minimum, too, on each interval by itself.
#[test]
fn an_indefinite_form_is_not_called_convex_and_its_saddle_is_left() {
    for (range, weight) in [("1e7", "1"), ("1e6", "1"), ("2", "1"), ("1e7", "1e-6"), ("1e3", "1e6")]
    {
        let text = format!(
            "time t in [0, 1] state x start 0 control p in [-{range}, {range}] control w in [-1, \
             1.01]\n\
             dynamics {{ x' = p + w }} minimize integral(p^2 - {weight}*w^2) method {{ N = 20 }}"
        );
        let solution = solved(&text);
        assert!(!solution.global && solution.status == Status::Solved, "{text}: {solution:?}");
        let minima = -1.0201 - 1e-6..=-1.0 + 1e-6;
        let weight: f64 = weight.parse().expect("a number");
        assert!(minima.contains(&(solution.objective / weight)), "{text}: {}", solution.objective);
    }
}

/// Nothing is least: what is left of it falls with the barrier, and has no size of its own.
#[test]
fn an_objective_that_is_zero_in_the_end_is_solved() {
    for objective in ["integral(u)", "integral(u) + x(end)", "x(end)", "integral(x)"] {
        let text = format!(
            "time t in [0, 2] state x start 0 control u in [0, 1] dynamics {{ x' = u - x }}
             minimize {objective}"
        );
        let found = fdcc::Model::from_text("rest", &text).expect("it has no mistakes");
        let found = found.solve(&fdcc::Options::default()).expect("it can be solved");
        let value = found.objective();
        assert!(found.is_certified() && value.abs() < 1e-12, "{text}: {value}");
    }
}

/// Rosenbrock's function in the unit circle, and the cheapest fence: unknowns alone, without time.
#[test]
fn a_model_without_time_is_solved() {
    let circle = "free x in [-2, 2] guess -1.2 free y in [-2, 2] guess 1
        end x^2 + y^2 <= 1 minimize (1 - x)^2 + 100*(y - x^2)^2";
    let fence = "param V = 2 free a in [0.1, 5] guess 1 free b in [0.1, 5] guess 1
        end a*b >= V minimize a + 2*b";
    for (text, least, slopes) in [(circle, 0.045_674_8, vec![]), (fence, 4.0, vec![1.0])] {
        let model = fdcc::Model::from_text("unknowns", text).expect("it has no mistakes");
        let found = model.solve(&fdcc::Options::default()).expect("it can be solved");
        assert!(found.is_certified(), "{text}: {:?}", found.certificate);
        assert!((found.objective() - least).abs() < 1e-7, "{text}: {}", found.objective());
        let own = found.sensitivities().into_iter().map(|it| it.1);
        own.zip(slopes).for_each(|(own, slope): (f64, f64)| assert!((own - slope).abs() < 1e-6));
    }
}

/// A form that is convex is called so, at any size of its terms, also where it is singular.
#[test]
fn convex_forms_are_recognised() {
    for cost in ["p^2 + w^2", "(p - w)^2", "p^2 + p*w + w^2", "1e-9*p^2 + 1e9*w^2", "p^2"] {
        let text = format!(
            "time t in [0, 1] state x start 0 control p in [-1, 1] control w in [-1, 1]\n\
             dynamics {{ x' = p + w }} minimize integral({cost}) + (x(end) - 1)^2 method {{ N = 8 \
             }}"
        );
        assert!(solved(&text).global, "{cost}");
    }
}

/// The heat equation in a rod, heated at one end: directions in which the objective hardly curves.
#[test]
fn flat_directions_are_followed_to_the_end() {
    let count = 50;
    let states: String = (1..=count).map(|i| format!("state x{i} start 0\n")).collect();
    let left = |i: usize| if i == 1 { "u".to_string() } else { format!("x{}", i - 1) };
    let right = |i: usize| format!("x{}", (i + 1).min(count));
    let rates: String = (1..=count)
        .map(|i| format!("x{i}' = 0.05*51^2*({} - 2*x{i} + {}) - 0.1*x{i}^3\n", left(i), right(i)))
        .collect();
    let misses: Vec<String> = (1..=count).map(|i| format!("(x{i}(end) - 0.5)^2")).collect();
    let text = format!(
        "time t in [0, 1]\n{states}control u in [0, 3]\ndynamics {{\n{rates}}}\n\
         minimize 2*({}) + integral(u^2)/100\nmethod {{ N = 50 }}",
        misses.join(" + ")
    );
    assert_solved("heat", &solved(&text), 9.331967363);
}

/// The last of many masses, out of reach of the force on the first: `E' <= F |v_1| <= F sqrt(2 E)`,
/// so `|v_n| <= F t` and `|x_n| <= F T^2 / 2`.
#[test]
fn what_is_out_of_reach_is_not_called_solved() {
    for (count, target) in [(3, 1.0), (6, 0.6), (8, 5.0)] {
        let states: String =
            (1..=count).map(|i| format!("state x{i} start 0 state v{i} start 0\n")).collect();
        let pull = |i: usize, j: usize| format!("10*(x{j} - x{i}) + 0.5*(v{j} - v{i})");
        let force = |i: usize| {
            let left = if i == 1 { "F".to_string() } else { pull(i, i - 1) };
            let right = if i == count { String::new() } else { format!(" + {}", pull(i, i + 1)) };
            format!("x{i}' = v{i}  v{i}' = {left}{right}\n")
        };
        let forces: String = (1..=count).map(force).collect();
        for method in ["", "solver = interior_point", "linear = sparse_ldl"] {
            let text = format!(
                "time t in [0, 1]\n{states}control F in [-1, 1]\ndynamics {{\n{forces}}}\n\
                 end x{count} == {target}\nminimize integral(F^2)\nmethod {{ N = 50 {method} }}"
            );
            let solution = solved(&text);
            assert_eq!(
                solution.status,
                Status::Infeasible,
                "{count} masses, {method}: {solution:?}"
            );
        }
    }
}

/// The last of many masses is pulled, the first is to be far away. A restoration phase whose own
/// iteration runs away says nothing of the objective, which is never below 0 here.
#[test]
fn what_is_out_of_reach_is_not_called_unbounded() {
    let count = 15;
    let states: String =
        (1..=count).map(|i| format!("state x{i} start 0 state v{i} start 0\n")).collect();
    let pull = |i: usize, j: usize| format!("10*(x{j} - x{i}) + 0.1*(v{j} - v{i})");
    let force = |i: usize| {
        let left = if i > 1 { pull(i, i - 1) } else { "0".to_string() };
        let right = if i < count { pull(i, i + 1) } else { "u".to_string() };
        format!("x{i}' = v{i}  v{i}' = {left} + {right}\n")
    };
    let forces: String = (1..=count).map(force).collect();
    for target in ["1e6", "1e7"] {
        let text = format!(
            "time t in [0, 5]\n{states}control u in [-1, 1]\ndynamics {{\n{forces}}}\n\
             end x1 == {target}\nminimize integral(u^2)\n\
             method {{ N = 100 linear = sparse_ldl }}"
        );
        let status = solved(&text).status;
        assert!(!status.is_solved() && status != Status::Unbounded, "{target}: {status:?}");
    }
}

/// A minimum to the fourth order, where the objective is 0: nothing is left of its terms to compare
/// with.
#[test]
fn a_flat_minimum_is_reached() {
    let text = "time t in [0, 1] state x start 0 control u in [-2, 3] guess 1 dynamics { x' = u }\n\
                minimize integral(u^4) method { N = 10 }";
    let solution = solved(text);
    assert!(solution.status == Status::Solved && solution.objective < 1e-12, "{solution:?}");
}

/// Slope and curvature are 0 at the guess, which is no minimum: each least value by calculus, the
/// same in each interval.
#[test]
fn a_flat_point_that_is_no_minimum_is_left() {
    for (cost, least) in [
        ("u^3", -1.0),
        ("-u^4", -1.0),
        ("u^4 - u^3", -27.0 / 256.0),
        ("3*u^4 - 4*u^3", -1.0),
        ("u^6 - u^4", -4.0 / 27.0),
    ] {
        for intervals in [5, 20] {
            let solution = solved(&format!(
                "time t in [0, 1] state x start 0 control u in [-1, 1] dynamics {{ x' = u }}\n\
                 minimize integral({cost}) method {{ N = {intervals} scheme midpoint }}"
            ));
            assert_solved(cost, &solution, least);
        }
    }
}

/// The last interval can make up for what all others do, up to its bound: without end only as far
/// as nobody looks at bounds far away. `J = 0.001 h sum u_k`, less the price of `x(3) = 1`, by
/// CasADi and IPOPT.
#[test]
fn far_bounds_are_bounds() {
    for (bound, least) in [("1e6", -6485.74954136), ("1e9", -6485759.98918)] {
        let text = format!(
            "time t in [0, 3] state x start 0 control u in [-inf, {bound}] dynamics {{ x' = u - x \
             }}\nminimize (x(end) - 1)^2 + 0.001*integral(u) method {{ N = 5 }}"
        );
        assert_solved(bound, &solved(&text), least);
    }
}

/// Twins that have to differ at the end: by so little that each step may hide its share.
#[test]
fn a_contradiction_that_is_spread_over_the_grid_is_one() {
    for (gap, intervals) in [("1e-3", 100), ("1e-4", 100), ("1e-4", 1000)] {
        let solution = solved(&format!(
            "time t in [0, 2] state x start 0 state v start 0 control u\n\
             dynamics {{ x' = u  v' = u }} end x == 1 end v >= 1 + {gap} minimize integral(u^2)\n\
             method {{ N = {intervals} scheme midpoint }}"
        ));
        assert_eq!(solution.status, Status::Infeasible, "{gap} over {intervals}");
    }
}

/// What an objective is worth depends on its unit: `c` is the best constant control, by calculus.
#[test]
fn a_small_objective_is_an_objective() {
    // c + (exp(c) - 2) exp(c) = 0
    let (mut low, mut high) = (0.0f64, 1.0f64);
    while high - low > 1e-15 {
        let c = 0.5 * (low + high);
        if c + (c.exp() - 2.0) * c.exp() < 0.0 { low = c } else { high = c }
    }
    let curved = low.powi(2) + (low.exp() - 2.0).powi(2);
    for factor in [1.0, 1e-12, 1e-19, 1e-25, 1e-40] {
        for (goal, least) in [("(x(end) - 0.5)^2", 0.125), ("(exp(x(end)) - 2)^2", curved)] {
            let text = format!(
                "time t in [0, 1] state x start 0 control u in [-3, 3] dynamics {{ x' = u }}\n\
                 minimize {factor:e}*({goal} + integral(u^2)) method {{ N = 20 }}"
            );
            assert_solved(&text, &solved(&text), factor * least);
        }
    }
}

#[test]
fn an_objective_without_a_value_is_no_optimum() {
    let text = "param a = 2 time t in [0, 1] state x start 0 control u in [-1, 1]\n\
                dynamics { x' = u } minimize integral(u^2) + (x(end) - 1)^2 + log(a)";
    let solution = solve(&problem(text, &[("a", "-1")], &[])).solution;
    assert!(matches!(solution.status, Status::NotFinite(_)), "{solution:?}");
}

/// What takes a control of 2e6, or 1e13, is feasible: no proof may rest on how far away that is.
#[test]
fn what_is_far_away_is_not_proved_to_be_infeasible() {
    let far = "time t in [0, 1]\nstate x start 0\nstate y start 0\ncontrol u in [0, 1e7]
control w\ndynamics { x' = 1e-6*u\n y' = x + w }\nend x == 2\nend y == 0
minimize integral(u^2 + w^2)\nmethod { grid N = 10 }";
    let solved = solve(&problem(far, &[], &[]));
    assert!(solved.solution.status.is_solved(), "{:?}", solved.solution.status);
    assert!((solved.solution.objective / 4e12 - 1.0).abs() < 1e-6);
    let heavy = "time t in [0, 1]\nstate v start 0\ncontrol F
dynamics { v' = F/1e13 }\nend v == 1\nminimize integral(F^2)\nmethod { grid N = 10 }";
    let solved = solve(&problem(heavy, &[], &[]));
    assert!((solved.solution.objective / 1e26 - 1.0).abs() < 1e-6);
}

/// A variable of 1e12 at an optimum has not left the problem.
#[test]
fn what_is_far_away_is_not_unbounded() {
    let far = "time t in [0, 1]\nstate x start 0\ncontrol u\ndynamics { x' = u }
minimize (x(end)/1e12 - 1)^2 + integral((u/1e12)^2)\nmethod { grid N = 20 }";
    // `1e-6 u^2 - u` is least at 5e5.
    let steep = "time t in [0, 1]\nstate x start 0\nstate y start 0\ncontrol u
dynamics { x' = u\n y' = u^2 }\nminimize 1e-6*y(end) - x(end)\nmethod { grid N = 10 }";
    for (text, optimum) in [(far, 0.5), (steep, -250_000.0)] {
        let solved = solve(&problem(text, &[], &[]));
        assert!(solved.solution.status.is_solved(), "{:?}", solved.solution.status);
        assert!((solved.solution.objective / optimum - 1.0).abs() < 1e-6);
    }
}
