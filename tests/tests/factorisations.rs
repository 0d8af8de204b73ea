//! Both factorisations of the interior point method lead along the same path: the same status,
//! objective and number of iterations. `tests/peers/factorisations.py` compares them on all models.

use fdcc_runtime::nlp::Solution;
use fdcc_tests::documents;
use fdcc_tests::models::{problem, refusal, solve};

/// Longer paths multiply rounding until they part; they still have to end at the same place.
const LONG_PATH: usize = 100;

fn solution(text: &str, linear: &str) -> Solution {
    // With a width of our own choice two searches for one would be compared.
    let method = [("linear", linear), ("solver", "interior_point"), ("sigma", "0.05")];
    solve(&problem(text, &[], &method)).solution
}

/// What differs, if anything does.
fn difference(name: &str, text: &str) -> Option<String> {
    let (one, other) = (solution(text, "riccati"), solution(text, "sparse_ldl"));
    let counts = [one.counts.iterations, other.counts.iterations];
    let most = (counts[0] / 10).max(3);
    let gap = (one.objective - other.objective).abs();
    let is_same = one.status == other.status
        && gap <= 1e-8 * one.objective.abs().max(1.0)
        && (counts[0] > LONG_PATH || counts[0].abs_diff(counts[1]) <= most);
    let words = || {
        format!(
            "{name}: {:?} and {:?}, objectives off by {gap:e}, iterations {counts:?}",
            one.status, other.status
        )
    };
    (!is_same).then(words)
}

fn assert_same(models: impl Iterator<Item = (String, String)>) {
    let different: Vec<_> = models.filter_map(|(name, text)| difference(&name, &text)).collect();
    assert!(different.is_empty(), "{}", different.join("\n"));
}

/// Masses on springs and dampers, each with friction; a force on the last brings it to 0.5, and all
/// of them to rest.
fn chain(masses: usize) -> String {
    let (mut names, mut rates, mut rest) = (String::new(), String::new(), String::new());
    for i in 1..=masses {
        let coupling = |j: usize| format!("+ 20*(x{j} - x{i}) + 0.5*(v{j} - v{i})");
        let left = if i > 1 { coupling(i - 1) } else { String::new() };
        let right = if i < masses { coupling(i + 1) } else { "+ F".into() };
        names += &format!("state x{i} start 0\nstate v{i} start 0\nsurface slip{i} = v{i}\n");
        rates += &format!("x{i}' = v{i}\nv{i}' in -0.4*Sgn(slip{i}) {left} {right}\n");
        rest += &format!("end v{i} == 0\n");
    }
    format!(
        "time t in [0, 4]\ncontrol F in [-50, 50]\n{names}dynamics {{\n{rates}}}\n{rest}\
         end x{masses} == 0.5\nminimize integral(F^2)\nmethod {{ N = 100  sigma = 0.05 }}\n"
    )
}

/// Without pivots the longer ones failed after thousands of iterations.
#[test]
fn chains_of_masses_with_friction_need_pivots() {
    let named = |masses| (format!("{} states", 2 * masses), chain(masses));
    assert_same([6, 7, 9].into_iter().map(named));
}

#[test]
fn models_are_solved_alike() {
    assert_same(documents("models", "fdc").into_iter().filter(|(_, text)| refusal(text).is_none()));
}
