//! A model of twice the size takes twice the work to understand: counted, not timed.

use fdcc_tests::large;
use fdcc_tests::models::{problem, solve};

/// Expressions that a check makes.
fn expressions(lines: usize) -> usize {
    let parsed = fdcc_grammar::parse(&large::model(lines));
    assert!(parsed.diagnostics.is_empty(), "{:#?}", parsed.diagnostics);
    let checked = fdcc_compiler::check(&parsed.tree);
    checked.model.unwrap_or_else(|| panic!("{:#?}", checked.diagnostics)).graph.len()
}

#[test]
fn twice_the_lines_are_twice_the_expressions() {
    let [small, large] = [1000, 2000].map(expressions);
    assert!(large as f64 <= 2.1 * small as f64, "{small} and {large}");
}

#[test]
fn the_model_of_5000_lines_is_one() {
    let lines = large::model(5000).lines().count();
    assert!((4900..5100).contains(&lines), "{lines}");
}

/// All second derivatives of a step of a Runge-Kutta method, of states that all act on all: what
/// machine code keeps of that on the stack is more than a thread has, so there is none. This thread
/// has 2 MB.
#[test]
fn coupled_states_do_not_overflow_the_stack() {
    let count = 26;
    let states: String = (0..count).map(|i| format!("state x{i} start 1\n")).collect();
    let rate = |i: usize| {
        let others = (0..count).filter(|j| *j != i);
        let terms: Vec<String> = others.map(|j| format!("sin(x{j} - x{i})")).collect();
        format!("x{i}' = u + {}\n", terms.join(" + "))
    };
    let rates: String = (0..count).map(rate).collect();
    let text = format!(
        "time t in [0, 1]\ncontrol u in [-1, 1]\n{states}dynamics {{\n{rates}}}\n\
         minimize integral(u^2)\nmethod {{ scheme = rk4 N = 2 }}"
    );
    assert!(solve(&problem(&text, &[], &[])).solution.status.is_solved());
}
