//! From the text of the race car to the first line of the iteration table, stage by stage: at most
//! 5 ms.
//!
//! The first run is that of a fresh process, whose memory is cold; of the others the median is
//! told.

use fdcc_runtime::nlp::Stop;
use fdcc_runtime::problem::{Problem, often_called};
use fdcc_runtime::solve::solve;
use std::hint::black_box;
use std::ops::ControlFlow;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::Instant;

const RACECAR: &str = include_str!("../reference/racecar.fdc");
const STAGES: [&str; 4] = ["read", "checked", "compiled", "first iteration"];
const RUNS: usize = 300;

/// Milliseconds from the text to the end of each stage.
fn run() -> [f64; 4] {
    let begin = Instant::now();
    let milliseconds = || begin.elapsed().as_secs_f64() * 1e3;
    let tree = fdcc_grammar::parse(black_box(RACECAR)).tree;
    let read = milliseconds();
    let model = fdcc_compiler::check(&tree).model.expect("the race car has no errors");
    let checked = milliseconds();
    let problem = fdcc_compiler::compile(&model).expect("the race car can be solved");
    make_machine_code(&problem);
    let compiled = milliseconds();
    let mut first = None;
    let _ = solve(&problem, None, &mut |_, _| {
        first.get_or_insert_with(milliseconds);
        ControlFlow::Break(Stop::TimeLimit)
    });
    [read, checked, compiled, first.expect("there is an iteration")]
}

/// On two threads, as `fdcc solve` does it where there are two processors.
fn make_machine_code(problem: &Problem) {
    let (functions, next) = (often_called(problem), AtomicUsize::new(0));
    let work = || {
        while let Some((function, order)) = functions.get(next.fetch_add(1, Ordering::Relaxed)) {
            function.prepare(*order);
        }
    };
    std::thread::scope(|scope| {
        scope.spawn(work);
        work();
    });
}

fn main() {
    let cold = run();
    let warm: Vec<[f64; 4]> = (0..RUNS).map(|_| run()).collect();
    for (stage, name) in STAGES.iter().enumerate() {
        let mut times: Vec<f64> = warm.iter().map(|run| run[stage]).collect();
        times.sort_by(f64::total_cmp);
        println!("{name:<16} {:.2} ms at first, then {:.2} ms", cold[stage], times[RUNS / 2]);
    }
}
