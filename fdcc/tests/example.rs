//! The example program says what it should.

use std::process::Command;

/// `cargo test` builds the examples of a package beside its tests.
#[test]
fn the_example_solves_verifies_and_prints() {
    let test = std::env::current_exe().expect("a test has a path");
    let profile = test.ancestors().nth(2).expect("tests lie in `deps` of the profile");
    let example = profile.join("examples/solve").with_extension(std::env::consts::EXE_EXTENSION);
    let output = Command::new(example).output().expect("the example runs");
    let text = String::from_utf8(output.stdout).expect("it prints text");
    assert!(text.starts_with("block: solved, objective "), "{text}");
    assert!(text.ends_with("confirmed on the true system to 2 %: true\n"), "{text}");
}
