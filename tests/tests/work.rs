//! The work that every model costs, as a table under version control: a worse algorithm shows in
//! its diff.
//!
//! `UPDATE=1 cargo test --release --workspace` rewrites the table. It is no reference for
//! anything but itself.

use std::fmt::Write;

use fdcc_compiler::Model;
use fdcc_runtime::linalg::is_fused;
use fdcc_runtime::nlp::Nlp;
use fdcc_runtime::problem::Chain;
use fdcc_runtime::transcribe::chain::ChainNlp;
use fdcc_tests::models::{in_phases, meaning, problem, refusal, solve_chain, text_of};
use fdcc_tests::{documents, repository};

const HEADINGS: [&str; 12] = [
    "model",
    "status",
    "iterations",
    "factored",
    "regularised",
    "values",
    "derivatives",
    "restored",
    "variables",
    "rows",
    "jacobian",
    "hessian",
];

/// The last of them: they depend on no rounding.
const SIZES: usize = 4;

/// Each model as it stands, with each sequence of jumps that may happen, and the rows of Table 7.1
/// that are hardest for their size.
fn cases() -> Vec<(String, Chain)> {
    let models = documents("models", "fdc").into_iter().filter(|(_, text)| refusal(text).is_none());
    let mut cases: Vec<(String, Chain)> =
        models.flat_map(|(name, _)| with_jumps(&name, &meaning(&text_of(&name)))).collect();
    let race = text_of("racecar");
    for (name, method) in [
        ("racecar 0.05 500", [("sigma", "0.05"), ("N", "500")]),
        ("racecar 0.025 1000", [("sigma", "0.025"), ("N", "1000")]),
    ] {
        cases.push((name.into(), Chain::single(problem(&race, &[], &method))));
    }
    cases
}

fn with_jumps(name: &str, model: &Model) -> Vec<(String, Chain)> {
    let all = in_phases(model).into_iter();
    all.map(|it| match model.jumps.len() {
        0 => (name.to_owned(), it.chain),
        _ => (format!("{name}, {} jumps", it.jumps), it.chain),
    })
    .collect()
}

fn row(name: &str, chain: &Chain) -> Vec<String> {
    let solution = solve_chain(chain).solution;
    let nlp = ChainNlp::new(chain);
    let counts = solution.counts;
    let numbers = [
        counts.iterations,
        counts.factorizations,
        counts.regularizations,
        counts.values,
        counts.derivatives,
        counts.restorations,
        nlp.variable_bounds().len(),
        nlp.constraint_bounds().len(),
        nlp.jacobian_structure().len(),
        nlp.hessian_structure().len(),
    ];
    let words = [name.to_owned(), format!("{:?}", solution.status)];
    words.into_iter().chain(numbers.iter().map(usize::to_string)).collect()
}

/// Right-aligned columns, but for the first two.
fn table(rows: &[Vec<String>]) -> String {
    let width = |column: usize| rows.iter().map(|row| row[column].len()).max().unwrap_or(0);
    let mut text = String::new();
    for row in rows {
        let cells = row.iter().enumerate().map(|(column, cell)| match column {
            0 | 1 => format!("{cell:<width$}", width = width(column)),
            _ => format!("{cell:>width$}", width = width(column)),
        });
        writeln!(text, "{}", cells.collect::<Vec<_>>().join("  "))
            .expect("a string takes everything");
    }
    text
}

/// Whether two tables have the same rows, sizes and statuses, and counts within a factor of two; of
/// small ones up to ten more.
fn is_near(before: &str, found: &str) -> bool {
    let is_size = |column: usize| HEADINGS[column..].len() <= SIZES;
    let cells = |line: &str| -> Vec<String> {
        line.split("  ").map(|it| it.trim().into()).filter(|it: &String| !it.is_empty()).collect()
    };
    let is_near = |(column, (a, b)): (usize, (&String, &String))| match (
        a.parse::<usize>(),
        b.parse::<usize>(),
    ) {
        (Ok(a), Ok(b)) if !is_size(column) => a <= 2 * b + 10 && b <= 2 * a + 10,
        _ => a == b,
    };
    let rows = before.lines().zip(found.lines());
    before.lines().count() == found.lines().count()
        && rows
            .map(|(a, b)| (cells(a), cells(b)))
            .all(|(a, b)| a.len() == b.len() && a.iter().zip(&b).enumerate().all(is_near))
}

#[test]
fn counts_are_near_within_a_factor_and_all_else_is_the_same() {
    let row = "block  Solved  100  183  122  289  118  0  602  402  1202  400";
    assert!(is_near(row, &row.replace(" 100 ", " 190 ")));
    assert!(!is_near(row, &row.replace(" 100 ", " 290 ")));
    assert!(!is_near(row, &row.replace(" 602 ", " 603 ")));
    assert!(!is_near(row, &row.replace("Solved", "Acceptable")));
    assert!(!is_near(row, ""));
}

#[test]
fn the_work_is_what_it_was() {
    let mut rows = vec![HEADINGS.map(String::from).to_vec()];
    rows.extend(cases().iter().map(|(name, problem)| row(name, problem)));
    let (found, path) = (table(&rows), repository().join("tests/snapshots/work.txt"));
    if std::env::var_os("UPDATE").is_some() {
        std::fs::write(&path, &found).expect("the snapshot can be written");
    }
    let before = std::fs::read_to_string(&path).expect("`UPDATE=1 cargo test` makes the snapshot");
    // The table is that of a machine with AVX2 and FMA; others round otherwise.
    let is_same = if is_fused() { before == found } else { is_near(&before, &found) };
    assert!(
        is_same,
        "the work has changed; if for good reasons, run with UPDATE=1\n{before}\n{found}"
    );
}
