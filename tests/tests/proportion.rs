//! What a model costs before it is solved is in proportion to its text: counted as nodes of the
//! graph where that can be done.

use std::time::{Duration, Instant};

use fdcc_compiler::differentiate::differentiate;
use fdcc_compiler::lower::lower;
use fdcc_compiler::{analyze, compile};
use fdcc_grammar::{Code, Severity};
use fdcc_tests::models::meaning;

fn motion(right: &str, more: &str, method: &str) -> String {
    format!(
        "time t in [0, 1]\nstate x start 0.5\ncontrol u in [-1, 1]\n{more}dynamics {{ x' = u + \
         {right} }}\n\
         minimize integral(u^2)\nmethod {{ N = 10 {method} }}\n"
    )
}

fn nested(depth: usize, wrap: fn(&str) -> String) -> String {
    (0..depth).fold("x".to_owned(), |inner, _| wrap(&inner))
}

/// Expressions with a `blend` in each level.
const BLENDS: [fn(&str) -> String; 4] = [
    |inner| format!("blend(abs({inner} - 0.1), 0.1)"),
    |inner| format!("blend(abs, 0.1)({inner})"),
    |inner| format!("blend(max({inner}, 0.2) + min(x, 0.3), 0.1)"),
    |inner| format!("blend(piecewise {{ {inner} <= 0.3 => x otherwise => 1 }}, 0.1)"),
];

#[test]
fn nested_blends_grow_by_as_much_from_level_to_level() {
    for wrap in BLENDS {
        let nodes = |depth| meaning(&motion(&nested(depth, wrap), "", "")).graph.len();
        let [few, some, many] = [4, 8, 16].map(nodes);
        assert!(many - some <= 2 * (some - few) + 20, "{}: {few}, {some}, {many}", wrap("e"));
    }
}

/// `let` hides how deep it is.
#[test]
fn blends_of_definitions_grow_by_as_much_too() {
    let nodes = |depth: usize| {
        let step =
            |i: usize| format!("let l{i} = blend(abs(l{} - 0.1) + l{}, 0.1)\n", i - 1, i - 1);
        let lets: String = (1..=depth).map(step).collect();
        meaning(&motion(&format!("l{depth}"), &format!("let l0 = x\n{lets}"), "")).graph.len()
    };
    let [few, some, many] = [10, 20, 40].map(nodes);
    assert!(many - some <= 2 * (some - few) + 20, "{few}, {some}, {many}");
}

/// What is rounded already has nothing to round, and says so.
#[test]
fn a_second_blend_of_the_same_changes_nothing() {
    let once = motion("blend(abs(x), 0.1)", "", "");
    let twice = motion("blend(blend(abs(x), 0.1), 0.2)", "", "");
    let found = analyze(&twice).diagnostics;
    let is_told =
        |code, severity| found.iter().any(|it| it.code == code && it.severity == severity);
    assert!(is_told(Code::NotAllowedHere, Severity::Warning), "{found:?}");
    // The width of the second is a number more.
    let [once, twice] = [once, twice].map(|text| meaning(&text).graph.len());
    assert!(twice <= once + 3, "{once} {twice}");
}

/// Somebody may write the very comparison that a `blend` makes: that is a knot all the same.
#[test]
fn a_knot_at_the_end_of_a_zone_is_rounded() {
    let own = "piecewise { x <= -1 => -1 otherwise => x }";
    let count = |right: &str| meaning(&motion(right, "", "")).graph.len();
    let apart = count(&format!("blend(abs(x), 2) + blend({own}, 0.5)"));
    let plain = count(&format!("blend(abs(x), 2) + {own}"));
    assert!(apart > plain + 5, "{apart} {plain}");
}

fn sum(terms: usize) -> String {
    (1..=terms).map(|i| format!("sin({i}*x + {i})")).collect::<Vec<_>>().join(" + ")
}

fn product(factors: usize) -> String {
    (1..=factors).map(|i| format!("(2 + sin({i}*x + {i}))")).collect::<Vec<_>>().join(" * ")
}

/// The expressions of a step and of its derivatives, up to the second.
fn expressions(right: &str, more: &str) -> usize {
    let program = lower(&meaning(&motion(right, more, "scheme = rk4")));
    let functions: Vec<_> = program.functions().into_iter().cloned().collect();
    let mut graph = program.graph;
    functions.into_iter().for_each(|function| drop(differentiate(&mut graph, function)));
    graph.len()
}

#[test]
fn derivatives_of_long_sums_and_products_are_in_proportion() {
    for text in [sum, product] {
        let [short, long] = [50, 200].map(|terms| expressions(&text(terms), ""));
        assert!(long as f64 <= 4.2 * short as f64, "{short}, {long}");
    }
}

/// Each function calls the one before it twice: with the same argument, and with two that come
/// together again, so that depth 40 has at most 40 arguments at each of 40 levels.
#[test]
fn functions_that_call_each_other_twice_share_what_they_compute() {
    let nodes = |call: &str, depth: usize| {
        let step =
            |i: usize| format!("fn f{i}(z) = {}\n", call.replace('F', &format!("f{}", i - 1)));
        let all: String = (1..=depth).map(step).collect();
        expressions(&format!("f{depth}(x)"), &format!("fn f0(z) = sin(z)\n{all}"))
    };
    for (call, growth) in
        [("F(z) + F(z)", 2.2), ("F(z)*sin(F(z))", 2.2), ("F(z + 1) + F(z + 2)", 4.4)]
    {
        let [few, many] = [20, 40].map(|depth| nodes(call, depth));
        assert!(many as f64 <= growth * few as f64, "{call}: {few}, {many}");
    }
}

/// The fastest of two.
fn seconds_to_compile(terms: usize) -> f64 {
    let model = meaning(&motion(&sum(terms), "", "scheme = rk4"));
    let once = || {
        let begin = Instant::now();
        let problem = compile(&model).expect("it can be solved");
        problem.dynamics.prepare(2);
        begin.elapsed().as_secs_f64()
    };
    once().min(once())
}

/// Making machine code is another program's work, which cannot be counted. Four times as long a sum
/// took forty times as long.
#[test]
fn machine_code_of_a_long_sum_takes_time_in_proportion() {
    let [short, long] = [60, 240].map(seconds_to_compile);
    assert!(long < 12.0 * short, "{short} s, {long} s");
}

#[test]
fn many_names_that_nothing_mentions_are_told_at_once() {
    let text: String = (0..100_000).map(|i| format!("param p{i} = {i}\n")).collect();
    let begin = Instant::now();
    let found = analyze(&text).diagnostics;
    assert_eq!(found.iter().filter(|it| it.code == Code::Unused).count(), 100_000);
    assert!(begin.elapsed() < Duration::from_secs(10), "{:?}", begin.elapsed());
}

/// Each took minutes, with the square of the number.
#[test]
fn many_of_one_construct_are_checked_at_once() {
    let repeated = |count: usize, line: fn(usize) -> String| (0..count).map(line).collect();
    let lines: String = repeated(16_000, |i| format!("at {}: x <= 1\n", (i + 1) as f64 / 16_002.0));
    let arms: String = repeated(4_000, |i| format!("t <= {i}/4000 => {i} "));
    let phases: String = repeated(4_000, |i| {
        format!("phase a{i} {{ time t in [0, 1] state x{i} start 0 dynamics {{ x{i}' = 1 }} }}\n")
    });
    let texts = [
        motion("0", &lines, ""),
        motion("0", &format!("report {{ q = piecewise {{ {arms}otherwise => 0 }} }}\n"), ""),
        phases,
    ];
    for text in texts {
        let begin = Instant::now();
        let found = analyze(&text).diagnostics;
        assert!(found.iter().all(|it| it.severity < Severity::Error), "{found:#?}");
        assert!(begin.elapsed() < Duration::from_secs(10), "{:?}", begin.elapsed());
    }
}
