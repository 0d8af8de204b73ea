//! The example in C is built by the C compiler and does what it says; skipped with a word where
//! there is no compiler.

use std::path::{Path, PathBuf};
use std::process::Command;

fn compiler() -> Option<&'static str> {
    let runs = |name: &&str| Command::new(name).arg("--version").output().is_ok();
    ["cc", "gcc", "clang"].into_iter().find(runs)
}

/// Where cargo puts the library beside this test.
fn libraries() -> PathBuf {
    let test = std::env::current_exe().expect("this test is a file");
    test.parent().expect("it is in a folder").to_owned()
}

fn built(source: &Path, name: &str) -> Option<PathBuf> {
    let Some(compiler) = compiler() else {
        eprintln!("skipped: there is no C compiler");
        return None;
    };
    let own = Path::new(env!("CARGO_MANIFEST_DIR"));
    let program = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join(name);
    let mut command = Command::new(compiler);
    command.args(["-std=c99", "-Wall", "-Wextra", "-Werror", "-pedantic", "-D_GNU_SOURCE", "-I"]);
    command.arg(own.join("include")).arg(source).arg("-o").arg(&program);
    command.arg("-L").arg(libraries()).args(["-lfdcc_c", "-lm"]);
    let output = command.output().expect("the compiler runs");
    let words = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{words}");
    Some(program)
}

fn run(program: &Path) -> String {
    let output = Command::new(program).env("LD_LIBRARY_PATH", libraries()).output();
    let output = output.expect("the program runs");
    let words = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{words}");
    String::from_utf8_lossy(&output.stdout).into_owned()
}

#[test]
#[cfg(target_os = "linux")]
fn the_example_brings_the_block_to_its_goal() {
    let source = Path::new(env!("CARGO_MANIFEST_DIR")).join("examples/closed_loop.c");
    let Some(program) = built(&source, "closed_loop") else { return };
    let printed = run(&program);
    let expected = [
        "violation below 1e-6: 1",
        "there is no parameter `gaol`; did you mean `goal`?",
        "after another goal",
    ];
    assert!(expected.iter().all(|it| printed.contains(it)), "{printed}");
    let value = |line: usize| -> f64 {
        let line = printed.lines().nth(line).expect("three lines");
        line.split_whitespace().nth(2).expect("x = VALUE").parse().expect("a number")
    };
    assert!((value(0) - 1.0).abs() < 0.1 && (value(2) - 0.5).abs() < 0.1, "{printed}");
}

/// What a program does wrong is a status, and ends nothing.
#[test]
#[cfg(target_os = "linux")]
fn wrong_calls_are_told() {
    let source = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/wrong_calls.c");
    let Some(program) = built(&source, "wrong_calls") else { return };
    assert_eq!(run(&program), "all told\n");
}
