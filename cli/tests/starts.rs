//! Several starting points: the best solution is kept, and what was found is told.

use crate::common::{expect_exit, fdcc, folder, json, stdout};

/// `(p^2 - 1)^2 + p/10` has a minimum near 1, where the guess leads, and a lower one near -1. They
/// are the outer roots of `4 p^3 - 4 p + 1/10`, by the trigonometric formula for three real roots.
const TWO_MINIMA: &[u8] =
    b"model two_minima\nfree p in [-3, 3] guess 0.2\ntime t in [0, 1]\nstate \
                            x start 0\ncontrol u in [-1, 1]\ndynamics { x' = u }\n\
                          minimize (p^2 - 1)^2 + p/10 + integral(u^2)\nmethod { grid N = 20 }\n";

fn minima() -> [f64; 2] {
    let angle = (-3.0 / 80.0 * 3.0_f64.sqrt()).acos() / 3.0;
    [0.0, 2.0].map(|k| {
        let p = 2.0 / 3.0_f64.sqrt() * (angle - k * std::f64::consts::TAU / 3.0).cos();
        (p * p - 1.0).powi(2) + p / 10.0
    })
}

#[test]
fn the_lower_of_two_minima_is_kept_and_both_are_told() {
    let folder = folder("several_starts", &[("two_minima.fdc", TWO_MINIMA)]);
    let alone = json(&fdcc(&folder, &["solve", "two_minima.fdc", "--json", "--log", "none"], ""));
    let [high, low] = minima();
    assert!(
        (alone["objective"].as_f64().expect("a number") - high).abs() < 1e-7,
        "{}",
        alone["objective"]
    );
    assert!(alone.get("starts").is_none());
    let many = ["solve", "two_minima.fdc", "--starts", "12", "--log", "none"];
    let output = fdcc(&folder, &[&many[..], &["--json"]].concat(), "");
    expect_exit(&output, 0, "several starts");
    let document = json(&output);
    assert!((document["objective"].as_f64().expect("a number") - low).abs() < 1e-7);
    let ended = document["starts"].as_array().expect("a list");
    assert_eq!(ended.len(), 12);
    let near = |value: f64| {
        ended
            .iter()
            .filter(move |it| (it["objective"].as_f64().unwrap_or(f64::NAN) - value).abs() < 1e-7)
    };
    let (found_low, found_high) = (near(low).count(), near(high).count());
    assert!(found_low > 0 && found_high > 0, "{ended:?}");
    let said = stdout(&fdcc(&folder, &many, ""));
    assert!(said.contains(&format!("       {found_low} of 12 starts: objective -0.1")), "{said}");
    assert!(said.contains(&format!("       {found_high} of 12 starts: objective 0.09")), "{said}");
}

/// Threads take turns as they like; what comes out does not depend on it.
#[test]
fn the_same_twice() {
    let folder = folder("several_starts_twice", &[("two_minima.fdc", TWO_MINIMA)]);
    let run = || {
        json(&fdcc(
            &folder,
            &["solve", "two_minima.fdc", "--starts", "6", "--json", "--log", "none"],
            "",
        ))["starts"]
            .clone()
    };
    assert_eq!(run(), run());
}
