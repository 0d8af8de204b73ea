//! Located optima against closed forms and a program of its own (`tests/peers/true_optimum.py`):
//! what is certified is right to many digits, and nothing else is certified.

use fdcc::{Model, Options, Solution};
use std::path::{Path, PathBuf};

/// Certified is never further from the reference than this, for its size.
const RIGHT: f64 = 1e-8;

/// What is certified today; a row that goes is a loss.
const CERTIFIED: &[&str] = &[
    "models/block",
    "models/coulomb_energy",
    "models/coulomb_rest",
    "models/coulomb_reverse",
    "models/puck",
    "right/pension",
    "right/pushed_table",
    "switched/belt",
    "switched/drag_regimes",
    "switched/free_time",
    "switched/overdrive",
    "switched/puck_aside",
    "switched/relay",
    "switched/shoreline",
    "switched/toll",
    "switched/turn_round",
    "switched/twins",
    "switched/two_contacts",
    "switched/two_relays",
    "switched/uphill_soon",
    "switched/window",
];

/// Solved in other tests, or too slow for every run.
const LEFT_OUT: &[&str] =
    &["models/stacked", "models/racecar", "right/gripper", "right/sled_on_ice"];

/// A row of the table of references.
struct Reference {
    name: String,
    objective: f64,
    /// When surfaces change their modes.
    switches: Vec<f64>,
}

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

fn references() -> Vec<Reference> {
    let table = std::fs::read_to_string(root().join("tests/peers/true_optimum.csv"));
    let table = table.expect("the table is there");
    let row = |line: &str| {
        let mut cells = line.split(',');
        let name = cells.next()?.to_owned();
        let objective = cells.next()?.parse().ok()?;
        let switches = cells.next()?.split(';').filter_map(|it| it.parse().ok()).collect();
        Some(Reference { name, objective, switches })
    };
    table.lines().skip(1).filter_map(row).collect()
}

fn place(name: &str) -> Option<PathBuf> {
    let (kind, model) = name.split_once('/')?;
    let folder = match kind {
        "models" => "models",
        "right" => "tests/right",
        "switched" => "tests/classics/switched",
        _ => return None,
    };
    Some(root().join(folder).join(format!("{model}.fdc")))
}

fn solved(name: &str) -> Solution {
    let path = place(name).expect("a kind of models");
    let model = Model::from_file(path.to_str().expect("a path")).expect("it has no mistakes");
    model.solve(&Options::default()).expect("it can be solved")
}

fn relative(found: f64, reference: f64) -> f64 {
    (found - reference).abs() / reference.abs().max(1.0)
}

#[test]
fn what_is_certified_is_the_true_optimum() {
    for it in references() {
        if place(&it.name).is_none() || LEFT_OUT.contains(&it.name.as_str()) {
            continue;
        }
        let solution = solved(&it.name);
        let is_certified = solution.is_certified();
        if CERTIFIED.contains(&it.name.as_str()) {
            assert!(is_certified, "{}: {:?}", it.name, solution.certificate);
        }
        if is_certified {
            let off = relative(solution.objective(), it.objective);
            assert!(off < RIGHT, "{} {} {}", it.name, solution.objective(), it.objective);
        }
    }
}

/// One switch, as the closed form or the other program has it.
#[test]
fn a_switch_is_located_where_it_is() {
    for it in references().iter().filter(|it| CERTIFIED.contains(&it.name.as_str())) {
        let unique = ["switched/belt", "switched/toll", "switched/turn_round"];
        if !unique.contains(&it.name.as_str()) {
            continue;
        }
        let certificate = solved(&it.name).certificate.expect("it was looked for");
        let found: Vec<f64> = certificate.switches.iter().map(|switch| switch.time).collect();
        let same = found.iter().zip(&it.switches).all(|(a, b)| (a - b).abs() < 1e-8);
        assert!(same && found.len() == it.switches.len(), "{} {found:?}", it.name);
    }
}

/// `T = 2 sqrt(d U/(U^2 - mu^2))`, differentiated by hand: bounds on arcs count.
#[test]
fn a_located_optimum_has_exact_sensitivities() {
    let (d, u, mu) = (1.0, 2.0, 0.5_f64);
    let gap: f64 = u * u - mu * mu;
    let time = 2.0 * (d * u / gap).sqrt();
    let by = [
        ("d", time / (2.0 * d)),
        ("U", -time * (u * u + mu * mu) / (2.0 * u * gap)),
        ("mu", time * mu / gap),
    ];
    let solution = solved("models/coulomb_rest");
    let found = solution.sensitivities();
    for (name, expected) in by {
        let own = found.iter().find(|it| it.0 == name).expect("a parameter").1;
        assert!((own - expected).abs() < 1e-7, "{name}: {own} {expected}");
    }
}

/// An infimum at a surface that repels, and an arc of a state: neither is called an optimum.
#[test]
fn what_is_no_optimum_or_not_located_is_not_certified() {
    for name in ["switched/ridge", "models/turbo"] {
        let solution = solved(name);
        let certificate = solution.certificate.as_ref().expect("it was looked for");
        assert!(!certificate.is_certified() && certificate.checks.iter().any(|it| !it.passes()));
        assert!(solution.outcome.sigma.iter().all(|sigma| *sigma > 0.0), "the smoothed answer");
    }
}

/// A width that is named asks for the smoothed problem.
#[test]
fn a_named_width_is_taken() {
    let path = place("models/block").expect("a model");
    let model = Model::from_file(path.to_str().expect("a path")).expect("it has no mistakes");
    let model = model.with_method("sigma", 0.3).expect("a width");
    let solution = model.solve(&Options::default()).expect("it can be solved");
    assert!(solution.certificate.is_none());
    assert!((solution.objective() - 59.835987805166).abs() < 1e-3);
}
