//! Classical optimal control problems with published values: each is solved as well as IPOPT solves
//! the same program, and meets its own `expect` block.
//!
//! IPOPT's answers are those of `tests/peers/classics.py`, with the same scheme, grid and guess.

use fdcc_compiler::model::Comparison;
use fdcc_compiler::{Model, expectations};
use fdcc_runtime::linalg::is_fused;
use fdcc_runtime::nlp::Status;
use fdcc_runtime::problem::Columns;
use fdcc_runtime::solution::integrals;
use fdcc_tests::models::{meaning, problem, solve};
use fdcc_tests::{Solved, documents, repository};

/// Problems that are not solved as well as by IPOPT, and what is known about it. A row that has
/// become untrue is a failure.
const WORSE: &[(&str, &str)] = &[(
    "fed_batch",
    "7e-5 below IPOPT's: along a singular arc there are many optima, and which one is found is \
     chance",
)];

/// Problems that take too long for every change.
const SLOW: &[&str] = &["alp_rider"];

/// A row of the table of the peer.
struct Peer {
    name: String,
    is_solved: bool,
    objective: f64,
}

fn peers() -> Vec<Peer> {
    let path = repository().join("tests/peers/classics.csv");
    let table = std::fs::read_to_string(path).expect("the table is there");
    table.lines().skip(1).map(|line| peer(line).expect(line)).collect()
}

fn peer(line: &str) -> Option<Peer> {
    let [name, status, objective, _] = line.split(',').collect::<Vec<_>>().try_into().ok()?;
    let is_solved = status == "Solve_Succeeded";
    Some(Peer { name: name.into(), is_solved, objective: objective.parse().ok()? })
}

/// A problem of `tests/classics/`, as it was solved.
fn solved(model: &Model) -> Solved {
    let problem = fdcc_compiler::compile(model).expect("it can be solved");
    let outcome = solve(&problem);
    Solved { problem, outcome }
}

/// Solved, and with an objective that is as good as the peer's or better.
fn is_as_good(solved: &Solved, peer: &Peer) -> bool {
    let worse_by = solved.problem.sense * (solved.objective() - peer.objective);
    solved.outcome.solution.status == Status::Solved
        && (!peer.is_solved || worse_by <= 1e-6 * peer.objective.abs().max(1.0))
}

/// The expectations of a model that its solution does not meet: both sides and the tolerance.
fn unmet(model: &Model, solved: &Solved) -> Vec<[f64; 3]> {
    let expectations = expectations(model);
    let trajectory = &solved.outcome.trajectory;
    let mut parameters = trajectory.parameters.clone();
    parameters.extend(integrals(
        &solved.problem,
        &solved.outcome.solution,
        &trajectory.parameters,
        &*expectations.integrands,
    ));
    let starts = trajectory.states.iter().map(|state| state[0]);
    let ends = trajectory.states.iter().map(|state| state[state.len() - 1]);
    let mut points = Columns::new(2 * trajectory.states.len(), 1);
    starts.chain(ends).enumerate().for_each(|(i, value)| points.column_mut(i)[0] = value);
    let mut values = Columns::new(expectations.function.outputs(), 1);
    expectations.function.value(&points, &parameters, &mut values);
    let sides = |at: usize| [0, 1, 2].map(|side| values.column(3 * at + side)[0]);
    assert!(!expectations.list.is_empty(), "{} expects nothing", model.name);
    assert!(expectations.list.iter().all(|it| it.comparison == Comparison::Equal));
    let all = (0..expectations.list.len()).map(sides);
    let is_met = |[left, right, tolerance]: &[f64; 3]| (left - right).abs() <= *tolerance;
    all.filter(|sides| !is_met(sides)).collect()
}

#[test]
fn classical_problems_are_solved_as_well_as_by_ipopt() {
    let mut failed = Vec::new();
    for peer in peers().iter().filter(|peer| !SLOW.contains(&peer.name.as_str())) {
        let model = meaning(&text(&peer.name));
        let solved = solved(&model);
        let (status, objective) = (&solved.outcome.solution.status, solved.objective());
        let known = WORSE.iter().find(|row| row.0 == peer.name);
        match (is_as_good(&solved, peer), known) {
            // With other rounding another optimum may be found.
            (true, Some(_)) if !is_fused() => {}
            (true, Some(_)) => {
                failed.push(format!("{} is solved now: take it off the list", peer.name))
            }
            (true, None) => {
                failed.extend(
                    unmet(&model, &solved).iter().map(|it| format!("{}: {it:?}", peer.name)),
                );
            }
            (false, None) => failed
                .push(format!("{}: {status:?} {objective}, IPOPT {}", peer.name, peer.objective)),
            (false, Some(_)) => {}
        }
    }
    assert!(failed.is_empty(), "{}", failed.join("\n"));
}

/// Where the guess heads in one direction, the two coordinates of the end depend on each other to
/// first order. IPOPT takes 23 to 67 iterations.
#[test]
fn an_end_whose_rows_depend_on_each_other_at_the_guess_is_reached_by_every_scheme() {
    for scheme in ["midpoint", "trapezoid", "radau2", "radau3", "gauss2"] {
        let outcome = solve(&problem(&text("obstacle_avoidance"), &[], &[("scheme", scheme)]));
        let solution = &outcome.solution;
        assert_eq!(solution.status, Status::Solved, "{scheme}");
        assert!((solution.objective - 2.138f64.powi(2)).abs() < 1e-6, "{scheme}");
        assert!(
            solution.counts.iterations <= 200,
            "{scheme}: {} iterations",
            solution.counts.iterations
        );
    }
}

fn text(name: &str) -> String {
    let path = repository().join("tests/classics").join(name).with_extension("fdc");
    std::fs::read_to_string(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

#[test]
fn every_classical_problem_says_where_it_is_from_and_has_a_peer() {
    let peers = peers();
    let models = documents("tests/classics", "fdc");
    assert!(models.len() >= 40 && models.len() == peers.len());
    for ((name, text), peer) in models.iter().zip(&peers) {
        assert_eq!(&meaning(text).name, name);
        assert_eq!(&peer.name, name);
        assert!(
            text.lines().take_while(|line| line.starts_with("#! ")).count() >= 2,
            "{name}: a source"
        );
    }
}

/// Each has its objective in `tests/peers/phases.csv` or `tests/peers/fits.csv`, which closed forms
/// and programs that share nothing with fdcc have written.
#[test]
fn every_problem_with_phases_or_measurements_has_an_answer_from_elsewhere() {
    for folder in ["phases", "fits"] {
        let path = repository().join("tests/peers").join(folder).with_extension("csv");
        let table = std::fs::read_to_string(path).expect("the table is there");
        let models = documents(&format!("tests/classics/{folder}"), "fdc");
        assert!(models.len() >= 12);
        for (name, text) in &models {
            assert!(text.contains(&format!("\nmodel {name}\n")), "{name}: its name");
            assert!(text.contains("\nexpect {"), "{name}: what it expects");
            let row = format!("{name},objective,");
            assert!(table.lines().any(|line| line.starts_with(&row)), "{name}: an answer");
            assert!(text.lines().take_while(|line| line.starts_with("#! ")).count() >= 2);
        }
    }
}
