//! A model of twice the size takes twice the work to understand: counted, not timed.

use fdcc_tests::large;

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
