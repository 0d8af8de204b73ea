//! The example program says what it should.

use std::process::Command;

#[test]
fn the_example_solves_verifies_and_prints() {
    let mut run = Command::new(env!("CARGO"));
    run.args(["run", "--quiet", "--offline", "--package", "fdcc", "--example", "solve"]);
    let output = run.output().expect("cargo runs");
    let text = String::from_utf8(output.stdout).expect("it prints text");
    assert!(text.starts_with("block: solved, objective "), "{text}");
    assert!(text.ends_with("confirmed on the true system to 1 %: true\n"), "{text}");
}
