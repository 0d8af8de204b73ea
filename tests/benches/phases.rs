//! What it costs to cut a time into phases: seconds for each iteration with K phases of N/K
//! intervals, beside one phase of N.
//!
//! `cargo bench -p fdcc-tests --bench phases` prints the table of `docs/performance.md`.

use fdcc_compiler::compile_chain;
use fdcc_runtime::problem::{Chain, often_called};
use fdcc_runtime::solve::solve_chain;
use fdcc_tests::models::meaning;
use fdcc_tests::repository;
use std::ops::ControlFlow;
use std::time::Instant;

/// Into how many phases.
const PHASES: [usize; 5] = [1, 2, 5, 16, 50];
/// Intervals of all phases together.
const INTERVALS: usize = 800;
/// Of so many runs the fastest is shown.
const REPEATS: usize = 5;

fn main() {
    println!("| model | phases | iterations | ms each | beside one phase |\n|---|---|---|---|---|");
    for (name, text, last) in [("racecar", racecar(), "T"), ("ten states", ten_states(), "4")] {
        let mut first = None;
        for count in PHASES {
            let (iterations, seconds) = each_iteration(&cut(&text, last, count));
            let beside = seconds / *first.get_or_insert(seconds);
            let each = 1e3 * seconds;
            println!("| {name} | {count} | {iterations} | {each:.3} | {beside:.2} |");
        }
    }
}

/// A model with a place for its time, cut into phases of the same length.
fn cut(text: &str, last: &str, count: usize) -> String {
    let each = INTERVALS / count;
    // A guess speaks of the time of its phase.
    let (text, guess) = text.split_once("guess {").unwrap_or((text, "}\n"));
    let (guess, rest) = guess.split_once("}\n").expect("a block is closed");
    let guess = if guess.is_empty() { String::new() } else { format!("guess {{{guess}}}\n") };
    let phase = |j: usize| {
        let (begin, end) = (j as f64 / count as f64, (j + 1) as f64 / count as f64);
        format!(
            "phase p{j} {{ time t in [{begin}*{last}, {end}*{last}]\nmethod {{ grid N = {each} \
             }}\n{guess}}}\n"
        )
    };
    let link = |j: usize| format!("link p{j} -> p{} {{ }}\n", j + 1);
    let phases: String = (0..count).map(phase).collect();
    let links: String = (0..count - 1).map(link).collect();
    format!("{text}{rest}\n{phases}{links}")
}

/// The race car without its time.
fn racecar() -> String {
    let path = repository().join("tests/reference/racecar.fdc");
    let text = std::fs::read_to_string(path).expect("the model is there");
    let (text, _) = text.split_once("report {").expect("the report is the last item");
    text.replace("time t in [0, T]\n", "")
}

/// Five masses between springs that grow stiffer.
fn ten_states() -> String {
    let states = |name: &str, start: f64| -> String {
        let of = |i: i32| format!("state {name}{i} start {}\n", start * f64::from(i));
        (1..=5).map(of).collect()
    };
    let place = |i: i32| if (1..=5).contains(&i) { format!("q{i}") } else { "0".into() };
    let mass = |i: i32| {
        let (before, own, after) = (place(i - 1), place(i), place(i + 1));
        let force = if i == 1 { " + u" } else { "" };
        format!("q{i}' = v{i}\nv{i}' = {before} - 2*{own} + {after} - {own}^3{force}\n")
    };
    let equations: String = (1..=5).map(mass).collect();
    format!(
        "{}{}control u in [-5, 5]\ndynamics {{\n{equations}}}\n\
         minimize integral(q1^2 + q2^2 + q3^2 + q4^2 + q5^2 + u^2)\nmethod {{ scheme = radau2 }}\n",
        states("q", 0.2),
        states("v", 0.0)
    )
}

/// Iterations of a solve, and the seconds that each takes.
fn each_iteration(text: &str) -> (usize, f64) {
    let chain = compile_chain(&meaning(text)).expect("it can be solved");
    for phase in &chain.phases {
        often_called(phase).iter().for_each(|(function, order)| function.prepare(*order));
    }
    let runs = (0..REPEATS).map(|_| run(&chain));
    runs.min_by(|a, b| a.1.total_cmp(&b.1)).expect("there is a run")
}

fn run(chain: &Chain) -> (usize, f64) {
    let begin = Instant::now();
    let outcome = solve_chain(chain, None, &mut |_, _| ControlFlow::Continue(()));
    let counts = outcome.expect("no solver is asked for").solution.counts;
    (counts.iterations, begin.elapsed().as_secs_f64() / counts.iterations as f64)
}
