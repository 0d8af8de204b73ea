//! A solve that begins at the solution of a similar problem, one that is stopped, and one that is
//! impossible.

use std::ops::ControlFlow;

use fdcc::Model;
use fdcc_runtime::nlp::{Options, Start, Status, Stop, interior_point};
use fdcc_runtime::problem::{Chain, Linear, Problem, Solver};
use fdcc_runtime::solve::warm_start::again;
use fdcc_runtime::solve::{self, Outcome};
use fdcc_runtime::transcribe::TranscribedNlp;
use fdcc_tests::models::{Changes, load, problem, solve};
use fdcc_tests::optimality::residuals;
use fdcc_tests::repository;

const INTERIOR: (&str, &str) = ("solver", "interior_point");

fn assert_optimal(what: &str, problem: &Problem, outcome: &Outcome) {
    assert_eq!(outcome.solution.status, Status::Solved, "{what}");
    let found = residuals(problem, outcome);
    assert!(found.error(outcome.solution.objective) <= 1e-6, "{what}: {found:?}");
}

#[test]
fn a_small_change_of_a_parameter_takes_fewer_iterations_than_the_guess() {
    let cases: [(&str, Changes, (&str, &str)); 3] = [
        ("racecar", &[("N", "250")], ("muN", "1.01")),
        ("block", &[], ("mu", "0.303")),
        ("coulomb_rest", &[("sigma", "0.01")], ("mu", "0.505")),
    ];
    for (name, settings, parameter) in cases {
        let before = solve(&load(name, &[], settings));
        let mut problem = load(name, &[parameter], settings);
        problem.method.solver = Solver::InteriorPoint;
        let [cold, warm] =
            [None, Some(again(&Chain::single(problem.clone()), &before.solution, &[]))].map(
                |start| {
                    let outcome =
                        solve::solve(&problem, start, &mut |_, _| ControlFlow::Continue(()));
                    let outcome = outcome.expect(name);
                    assert_optimal(name, &problem, &outcome);
                    outcome.solution
                },
            );
        let objectives = [cold.objective, warm.objective];
        let is_near = (cold.objective - warm.objective).abs() <= 1e-4 * cold.objective.abs();
        assert!(is_near, "{name}: {objectives:?}");
        let most = cold.counts.iterations / 2;
        assert!(warm.counts.iterations <= most, "{name}: {:?} {:?}", warm.counts, cold.counts);
    }
}

/// What was solved to a tighter tolerance takes no step at all, although its gradients may be
/// scaled in another way.
#[test]
fn a_solution_is_recognised() {
    let path = repository().join("tests/classics/brachistochrone.fdc");
    let text = std::fs::read_to_string(path).expect("the classic is there");
    let problem = problem(&text, &[], &[INTERIOR]);
    let mut nlp = TranscribedNlp::new(&problem);
    let options = |tol| Options { tol, max_iter: 100, linear: Linear::Automatic, is_final: true };
    let mut watch = |_: &_| ControlFlow::Continue(());
    let guess = Start { v: nlp.guess(), warm: None };
    let first = interior_point::solve(&mut nlp, &guess, &options(1e-8), &mut watch);
    let again = Start::after(&first);
    let second = interior_point::solve(&mut nlp, &again, &options(1e-7), &mut watch);
    assert_eq!((first.status, second.status), (Status::Solved, Status::Solved));
    assert!(second.counts.iterations <= 1, "{:?}", second.counts);
}

#[test]
fn it_stops_when_asked_to() {
    let problem = load("puck", &[], &[INTERIOR]);
    for (stop, status) in
        [(Stop::Interrupted, Status::Interrupted), (Stop::TimeLimit, Status::TimeLimit)]
    {
        let outcome = solve::solve(&problem, None, &mut |progress, _| {
            if progress.iteration == 3 {
                ControlFlow::Break(stop)
            } else {
                ControlFlow::Continue(())
            }
        });
        let solution = outcome.expect("nothing is refused").solution;
        assert_eq!((solution.status, solution.counts.iterations), (status, 3));
    }
}

/// Within one second a mass cannot go 2 m with a force of 1 N: at most 0.25 m.
#[test]
fn what_is_impossible_is_infeasible() {
    let text = "time t in [0, 1] state x start 0 state v start 0 control u in [-1, 1] dynamics { \
                x' = v v' = u*(1 + 0.1*x) } end x == 2 end v == 0
        minimize integral(u^2) method { grid N = 20 }";
    let outcome = solve(&problem(text, &[], &[INTERIOR]));
    assert_eq!(outcome.solution.status, Status::Infeasible);
    assert!(outcome.limiting.is_some() && outcome.solution.counts.restorations >= 1);
}

/// A solver that is there no longer is refused, with what to write instead.
#[test]
fn a_removed_solver_says_what_to_write() {
    let mut model = fdcc_tests::models::meaning(&fdcc_tests::models::text_of("puck"));
    let refused = model.set_method("solver", "sqp").expect_err("it was removed");
    assert!(refused.contains("write `interior_point`"), "{refused}");
}

/// From a certified optimum the next one is found with its structure: nothing is smoothed, and no
/// sequence is looked for. What comes out is the optimum that is found from the guess; where the
/// structure changes (without friction nothing sticks), the guess is as good as before.
#[test]
fn an_optimum_is_followed_with_its_structure() {
    let model = Model::from_file("../models/block.fdc").expect("it is there");
    let solve = |mu: f64, start| {
        let model = model.with("mu", mu).expect("it is a parameter");
        let options = fdcc::Options { start, ..fdcc::Options::default() };
        model.solve(&options).expect("it can be solved")
    };
    let first = solve(0.3, fdcc::Start::Guess);
    for mu in [0.31, 0.2, 0.45] {
        let alone = solve(mu, fdcc::Start::Guess);
        let next = solve(mu, fdcc::Start::Solution(&first));
        assert!(alone.is_certified() && next.is_certified(), "{mu}");
        let [own, its] = [&next, &alone].map(fdcc::Solution::objective);
        assert!((own - its).abs() < 1e-7 * its, "{mu}: {own}, from the guess {its}");
        let counts = [&next, &alone].map(|it| it.outcome.solution.counts.iterations);
        assert!(counts[0] < counts[1], "{mu}: {counts:?}");
    }
}
