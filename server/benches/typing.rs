//! From a keystroke to its diagnostics, on a model of 1,000 lines: median below 5 ms, 99th
//! percentile below 15 ms.
//!
//! Several hundred keystrokes one after the other give the percentiles, outside of all blocks and
//! in the longest one; `keystroke_in_a_comment` is the mean of divan.

#[path = "../tests/client/mod.rs"]
mod client;

use client::{Client, URI};
use divan::Bencher;
use serde_json::json;
use std::time::{Duration, Instant};

/// What is typed, character by character, on a line of its own before the equations of motion.
const ITEMS: &str =
    "let power = u7*v7 + 0.5*d7^2   # what the motor gives\npath limit: -20 <= power <= 20\n";

/// What is typed in the middle of the equations of motion.
const EQUATIONS: &str =
    "  x7' = v7 + 0.5*sin(d7)\n  v7' = u7 - (d7 + v7)^2   # what holds it back\n";

fn main() {
    percentiles("before the dynamics", "dynamics", ITEMS);
    percentiles("in the dynamics", "  x55' ", EQUATIONS);
    divan::main();
}

/// A client that has a large model open, and the empty line before the first one that begins so.
fn opened(before: &str) -> (Client, usize) {
    let text = fdcc_tests::large::model(1000);
    let line =
        text.lines().position(|line| line.starts_with(before)).expect("there is such a line");
    let text = text.replacen(&format!("\n{before}"), &format!("\n\n{before}"), 1);
    let mut client = Client::start(
        json!({ "textDocument": { "publishDiagnostics": { "relatedInformation": true } } }),
    );
    client.open(URI, &text);
    client.diagnostics();
    (client, line)
}

/// Types one character and waits for what is said about it.
fn keystroke(client: &mut Client, version: i32, at: (usize, usize), character: char) -> Duration {
    let place = json!({ "line": at.0, "character": at.1 });
    let before = Instant::now();
    client.change(
        URI,
        version,
        json!([{ "range": { "start": place, "end": place }, "text": character.to_string() }]),
    );
    let published = client.diagnostics();
    assert_eq!(published["version"], version, "what is said is about the text as it is");
    before.elapsed()
}

fn percentiles(place: &str, before: &str, typed: &str) {
    let (mut client, line) = opened(before);
    let mut times = Vec::new();
    let (mut at, mut version) = ((line, 0), 1);
    for character in typed.repeat(5).chars() {
        version += 1;
        times.push(keystroke(&mut client, version, at, character));
        at = if character == '\n' { (at.0 + 1, 0) } else { (at.0, at.1 + 1) };
    }
    times.sort();
    let milliseconds = |share: usize| times[times.len() * share / 100].as_secs_f64() * 1e3;
    println!(
        "{} keystrokes {place}: median {:.2} ms, 90th percentile {:.2} ms, 99th percentile {:.2} \
         ms, longest {:.2} ms",
        times.len(),
        milliseconds(50),
        milliseconds(90),
        milliseconds(99),
        times[times.len() - 1].as_secs_f64() * 1e3
    );
}

#[divan::bench(sample_count = 200)]
fn keystroke_in_a_comment(bencher: Bencher) {
    let (mut client, line) = opened("dynamics");
    let at = json!({ "line": line, "character": 0 });
    client.change(URI, 2, json!([{ "range": { "start": at, "end": at }, "text": "# \n" }]));
    client.diagnostics();
    let mut version = 2;
    bencher.bench_local(|| {
        version += 1;
        keystroke(&mut client, version, (line, 2), 'x')
    });
}
