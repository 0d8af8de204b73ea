//! From the text of the race car to a problem whose functions can be called; machine code is made
//! when they are.

use divan::{Bencher, black_box};

fn main() {
    divan::main();
}

const RACECAR: &str = include_str!("../reference/racecar.fdc");

#[divan::bench]
fn parse() -> fdcc_grammar::Parse {
    fdcc_grammar::parse(black_box(RACECAR))
}

#[divan::bench]
fn check(bencher: Bencher) {
    let tree = fdcc_grammar::parse(RACECAR).tree;
    bencher.bench_local(|| fdcc_compiler::check(black_box(&tree)));
}

#[divan::bench]
fn text_to_problem(bencher: Bencher) {
    bencher.bench_local(|| {
        let tree = fdcc_grammar::parse(black_box(RACECAR)).tree;
        let model = fdcc_compiler::check(&tree).model.expect("the race car has no errors");
        fdcc_compiler::compile(&model)
            .unwrap_or_else(|_| unreachable!("the race car can be solved"))
    });
}
