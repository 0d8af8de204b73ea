//! How long a check takes: a model that somebody writes, and one of 5,000 lines, right and broken.

use divan::{Bencher, black_box};

fn main() {
    divan::main();
}

const RACECAR: &str = include_str!("../reference/racecar.fdc");

fn understood(text: &str) -> usize {
    let parsed = fdcc_grammar::parse(black_box(text));
    parsed.diagnostics.len() + fdcc_compiler::check(&parsed.tree).diagnostics.len()
}

/// At most 5 ms.
#[divan::bench]
fn race_car() -> usize {
    understood(RACECAR)
}

/// At most 100 ms.
#[divan::bench]
fn five_thousand_lines(bencher: Bencher) {
    let text = fdcc_tests::large::model(5000);
    bencher.bench_local(|| understood(&text));
}

/// One word of an item in ten is misspelt.
#[divan::bench]
fn five_thousand_lines_with_mistakes(bencher: Bencher) {
    let text = fdcc_tests::large::model(5000).replace("surface s", "surfac s");
    bencher.bench_local(|| understood(&text));
}
