//! What one attempt loses another one wins; and where no feasible point exists, that is said in
//! reasonable time.

use fdcc_runtime::nlp::{Status, Stop};
use fdcc_runtime::problem::Chain;
use fdcc_runtime::solve::multistart;
use fdcc_runtime::solve::{self, Outcome};
use fdcc_tests::models::{problem, refine, solve};
use fdcc_tests::repository;
use std::f64::consts::PI;
use std::ops::ControlFlow;

fn text(file: &str) -> String {
    std::fs::read_to_string(repository().join(file))
        .unwrap_or_else(|error| panic!("{file}: {error}"))
}

fn solved(text: &str, scheme: &str, intervals: &str) -> Outcome {
    solve(&problem(text, &[], &[("scheme", scheme), ("N", intervals)]))
}

/// From the guess the objective draws the final time below what any feasible trajectory needs,
/// where the violation is smallest near by.
#[test]
fn a_final_time_that_became_too_short_is_found_from_a_feasible_point() {
    for (file, scheme, intervals, exact, tolerance) in [
        ("models/coulomb_reverse.fdc", "rk4", "200", 2.0, 1e-3),
        ("models/coulomb_reverse.fdc", "rk4", "800", 2.0, 1e-4),
        ("tests/classics/oscillator.fdc", "rk4", "50", 2.0 * PI, 1e-4),
    ] {
        let own = text(file).replace("  grid N", "  smooth sigma = 0.01 [m/s]\n  grid N");
        let solution = solved(&own, scheme, intervals).solution;
        assert_eq!(solution.status, Status::Solved, "{file} {scheme} {intervals}");
        assert!((solution.objective - exact).abs() < tolerance, "{file}: {}", solution.objective);
    }
}

/// Full steps lead to values beyond 1e16, from where nothing could be restored.
#[test]
fn a_step_on_trust_into_nowhere_is_taken_back() {
    for intervals in ["50", "100", "200"] {
        let problem =
            problem(&text("tests/right/lotka.fdc"), &[], &[("scheme", "rk4"), ("N", intervals)]);
        let mut farthest = 0.0_f64;
        let outcome = solve::solve(&problem, None, &mut |progress, _| {
            farthest = farthest.max(if progress.restoration { progress.objective } else { 0.0 });
            ControlFlow::Continue(())
        });
        assert_eq!(
            outcome.expect("it is not refused").solution.status,
            Status::Solved,
            "{intervals}"
        );
        assert!(farthest < 1e10, "{intervals}: restored from {farthest:e}");
    }
}

/// The guess holds the surface: it says nothing of the size of its function, and eight times the
/// width is too thin to begin with.
#[test]
fn a_thin_layer_is_approached_from_far_away() {
    let text = text("cli/templates/racecar.fdc");
    for (scheme, intervals) in [("radau2", "50"), ("radau2", "100"), ("radau3", "50")] {
        let method = [("scheme", scheme), ("N", intervals), ("sigma", "0.0005")];
        let solution = solve(&problem(&text, &[], &method)).solution;
        assert_eq!(solution.status, Status::Solved, "{scheme} {intervals}");
        assert!(solution.counts.iterations < 1000, "{scheme}: {}", solution.counts.iterations);
    }
}

/// Where the optimum is flat no digit is gained for thousands of iterations: IPOPT, too, calls it
/// acceptable.
#[test]
fn steps_on_trust_do_not_hide_that_nothing_more_is_gained() {
    for (scheme, intervals) in [("midpoint", "200"), ("radau3", "50")] {
        let solution = solved(&text("tests/right/neuron.fdc"), scheme, intervals).solution;
        assert!(solution.status.is_solved(), "{scheme} {intervals}");
        assert!(solution.counts.iterations < 1000, "{scheme}: {}", solution.counts.iterations);
    }
}

/// The least time from rest to rest is 2: bang-bang, and every scheme integrates constant controls
/// exactly.
#[test]
fn what_is_out_of_reach_by_a_hair_is_infeasible() {
    let text = |time: f64| {
        format!(
            "time t in [0, {time}] state x start 0 state v start 0 control u in [-1, 1] \
             dynamics {{ x' = v v' = u }} end x == 1 end v == 0 method {{ solver = interior_point \
             }}"
        )
    };
    for scheme in ["midpoint", "radau2", "radau3", "gauss2"] {
        let ends = |time| solved(&text(time), scheme, "50").solution;
        assert_eq!(ends(2.0 * (1.0 + 1e-4)).status, Status::Solved, "{scheme}");
        let beyond = ends(2.0 * (1.0 - 1e-4));
        assert_eq!(beyond.status, Status::Infeasible, "{scheme}");
        assert!(beyond.counts.iterations < 1000, "{scheme}: {}", beyond.counts.iterations);
    }
}

/// The guess leads between the discs, where the grid is too coarse by two parts in ten thousand;
/// from elsewhere there is another way.
#[test]
fn what_no_attempt_from_the_guess_finds_is_found_from_other_starts() {
    let text = text("tests/classics/obstacle_avoidance.fdc");
    for scheme in ["radau2", "radau3", "gauss2"] {
        let problem = problem(&text, &[], &[("scheme", scheme), ("N", "50")]);
        let is_solved = |index: u32| {
            let start = multistart::perturbed(&Chain::single(problem.clone()), None, index);
            let outcome =
                solve::solve(&problem, Some(start), &mut |_, _| ControlFlow::Continue(()));
            outcome.expect("it is not refused").solution.status == Status::Solved
        };
        assert!((1..8).any(is_solved), "{scheme}");
    }
}

/// `time` stops the second attempt before it has looked at anything: the answer is that it was
/// stopped, not that there is none.
#[test]
fn who_stops_a_later_attempt_is_not_told_that_there_is_no_solution() {
    let text = "time t in [0, 1.9] state x start 0 state v start 0 control u in [-1, 1] \
                dynamics { x' = v v' = u } end x == 1 end v == 0 minimize integral(exp(u)) method \
                { grid N = 40 scheme midpoint }";
    let problem = problem(text, &[], &[("solver", "interior_point")]);
    let count = |limit: usize| {
        let mut seen = 0;
        let outcome = solve::solve(&problem, None, &mut |_, _| {
            seen += 1;
            if seen > limit {
                ControlFlow::Break(Stop::Interrupted)
            } else {
                ControlFlow::Continue(())
            }
        });
        (outcome.expect("it is not refused").solution.status, seen)
    };
    let (status, all) = count(usize::MAX);
    assert_eq!(status, Status::Infeasible);
    for limit in [all / 3, all / 2, 2 * all / 3, all - 1] {
        assert_eq!(count(limit).0, Status::Interrupted, "after {limit} of {all}");
    }
}

/// Fifty intervals are too few for implicit Euler to swing it up; on a hundred it comes up, by
/// `radau3` on fifty.
#[test]
fn a_grid_of_our_own_choice_that_is_too_coarse_is_no_verdict() {
    for (mu, most, sigma) in [("0.1", "0.6", None), ("0.1", "0.6", Some("0.01"))] {
        let text = format!(
            "time t in [0, 12] state th start 0 state w start 0 control u in [-{most}, {most}] \
             surface slip = w \
             dynamics {{ th' = w w' in -sin(th) - {mu}*Sgn(slip) + u }} end th == pi end w == 0 \
             minimize integral(u^2)"
        );
        let found = |intervals: &str| {
            let sigma = sigma.map(|sigma| ("sigma", sigma));
            let method: Vec<(&str, &str)> =
                [("N", intervals), ("tolerance", "1")].into_iter().chain(sigma).collect();
            refine(&problem(&text, &[], &method), &mut |_, _| ControlFlow::Continue(()))
        };
        let named = found("50").outcome;
        assert_eq!(
            (named.solution.status, named.is_impossible),
            (Status::Infeasible, false),
            "{mu}"
        );
        let chosen = found("auto");
        assert_eq!(chosen.outcome.solution.status, Status::Solved, "{mu}");
        assert!(chosen.problem.method.intervals() >= 100, "{mu}");
    }
}

/// From 0 to 97 % of the speed 1 of a belt that pulls with 0.3, in 3.3 instead of at least 3.23. In
/// a wide layer it pulls too little.
#[test]
fn a_layer_that_is_too_wide_is_no_verdict() {
    let text = |method: &str| {
        format!(
            "time t in [0, 3.3] state v start 0 control u in [-0.001, 0.001] surface slip = 1 - v \
             dynamics {{ v' in 0.3*Sgn(slip) + u }} end v >= 0.97 minimize integral(u^2) method {{ \
             {method} }}"
        )
    };
    for method in [
        "N = 200",
        "sigma = 0.03 max_iter = 300",
        "smooth sigma = 0.01 continue sigma = 1",
        "sigma = 0.06",
    ] {
        let found = solve(&problem(&text(method), &[], &[]));
        assert_eq!(found.solution.status, Status::Solved, "{method}");
    }
    let wide = solve(&problem(&text("sigma = 1"), &[], &[]));
    assert_eq!((wide.solution.status, wide.is_impossible), (Status::Infeasible, false));
    let widths: Vec<f64> = wide.attempts.iter().map(|attempt| attempt.sigma[0]).collect();
    assert!(widths.contains(&8.0) && widths.last() == Some(&1.0), "{widths:?}");
}

/// What is infeasible by linear conditions is proved to be so, whichever solver was asked; what
/// bends is not.
#[test]
fn only_what_is_proved_is_impossible() {
    let text = |rate: &str| {
        format!(
            "time t in [0, 1] state x start 0 control u in [-1, 1] dynamics {{ x' = {rate} }} end \
             x == 2 minimize integral(u^2)"
        )
    };
    for solver in ["auto", "interior_point", "convex"] {
        let found = solve(&problem(&text("u"), &[], &[("solver", solver), ("N", "20")]));
        assert_eq!(
            (found.solution.status, found.is_impossible),
            (Status::Infeasible, true),
            "{solver}"
        );
    }
    let bends = solve(&problem(&text("sin(u)"), &[], &[("N", "20")]));
    assert_eq!((bends.solution.status, bends.is_impossible), (Status::Infeasible, false));
}

/// One interval is no chain: the recursion has nothing to do there.
#[test]
fn one_interval_is_solved() {
    let text = "time t in [0, 2] state x start 0 state v start 0 control u in [-5, 5] \
                dynamics { x' = v v' = u - 0.2*v } end x == 1 minimize integral(u^2)";
    for (scheme, linear) in [("midpoint", "auto"), ("radau3", "riccati"), ("gauss2", "auto")] {
        let changes =
            [("scheme", scheme), ("linear", linear), ("N", "1"), ("solver", "interior_point")];
        assert_eq!(
            solve(&problem(text, &[], &changes)).solution.status,
            Status::Solved,
            "{scheme}"
        );
    }
}

/// The guess `u = 0` is stationary for what stands in the way; `sin` is the least way to 0.2.
#[test]
fn what_the_guess_does_not_find_is_looked_for_elsewhere() {
    let text = "time t in [0, 1]  state x start 0  state y start 0  control u in [-10, 10]
        dynamics { x' = u  y' = x^2 }  end x == 0  end y >= 0.2
        minimize integral(u^2)";
    let model = fdcc::Model::from_text("elsewhere", text).expect("it is right");
    let solution = model.solve(&fdcc::Options::default()).expect("it can be solved");
    let least = 0.2 * std::f64::consts::PI.powi(2);
    assert!(solution.is_certified() && (solution.objective() - least).abs() < 1e-6);
    // On one grid as well, where no other start is tried: the saddle itself is left.
    let named = model.with_method("N", 100).expect("a setting");
    let solution = named.solve(&fdcc::Options::default()).expect("it can be solved");
    assert!(solution.is_solved() && (solution.objective() / least - 1.0).abs() < 1e-3);
}

/// `sqrt` of the integral has no derivative at the guess; the mean of the force is its size.
#[test]
fn a_guess_without_a_value_is_left() {
    let text = "time t in [0, 2]  state x start 0  control u in [-3, 3]
        dynamics { x' = u }  end x == 1  minimize sqrt(integral(u^2))";
    let model = fdcc::Model::from_text("rms", text).expect("it is right");
    let solution = model.solve(&fdcc::Options::default()).expect("it can be solved");
    let least = 0.5_f64.sqrt();
    assert!(solution.is_certified() && (solution.objective() - least).abs() < 1e-8);
}
