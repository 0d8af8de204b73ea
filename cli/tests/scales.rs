//! The verdict does not depend on the units in which a model is written, nor on how large its
//! numbers are.

use crate::common::{expect_exit, fdcc, folder, json, number, stdout};
use serde_json::Value;

/// A block of mass 1 that friction of 3 m/s^2 holds, pulled over half a micrometre within 2 ms.
fn block(length: &str, time: &str) -> String {
    format!(
        "model block\nparam friction = 3 [m/s^2]\nparam goal = 0.5 [um]\ntime t in [0[s], 2[ms]]\n\
         state x [{length}] start 0\nstate v [{length}/{time}] start 0\ncontrol a [m/s^2]\nsurface \
         slip = v\n\
         dynamics {{ x' = v\n v' in a - friction*Sgn(slip) }}\nend x == goal\nend v == 0\nminimize \
         integral(a^2)\n"
    )
}

const UNITS: [(&str, &str); 6] =
    [("m", "s"), ("mm", "s"), ("um", "ms"), ("km", "s"), ("m", "ms"), ("km", "ms")];

/// The solution says that it moves; without any force it rests, and misses by all of its way.
const RESTS: &str = r#"{"model": "block", "free": {}, "params": {"friction": 3, "goal": 5e-7},
    "time": [0, 1e-3, 2e-3], "states": {"x": [0, 2.5e-7, 5e-7], "v": [0, 5e-4, 0]},
    "controls": {"a": [0, 0]}}"#;

fn near(value: &Value, expected: f64, within: f64) {
    assert!((number(value) - expected).abs() <= within, "{value}, not {expected}");
}

#[test]
fn a_block_that_misses_by_all_of_its_way_is_not_confirmed_in_any_unit() {
    for (length, time) in UNITS {
        let files = [("block.fdc", block(length, time)), ("block.sol.json", RESTS.to_owned())];
        let files = files.each_ref().map(|(name, text)| (*name, text.as_bytes()));
        let folder = folder(&format!("scales_rests_{length}_{time}"), &files);
        let output = fdcc(&folder, &["verify", "block.sol.json", "--json"], "");
        expect_exit(&output, 2, length);
        let verification = &json(&output)["verification"];
        near(&verification["state_gap"], 1.0, 1e-12);
        near(&verification["relative_violation"], 1.0, 1e-12);
        near(&verification["constraint_violation"], 5e-7, 1e-18);
        assert_eq!(verification["worst"]["condition"], "end x == goal");
        let said = stdout(&fdcc(&folder, &["verify", "block.sol.json"], ""));
        assert!(
            length != "um" || said.contains("violates `end x == goal` by 0.5 um, 1 of its terms"),
            "{said}"
        );
    }
}

/// Pulled with `a = friction + 6d/tau^2 (1 - 2t/tau)` for the last `tau = sqrt(6 d/friction)` of
/// the time, which here is 1 ms: `J = friction^2 tau + 12 d^2/tau^3 = 0.012`.
#[test]
fn a_block_is_pulled_over_half_a_micrometre_the_same_in_every_unit() {
    let solved = UNITS.map(|(length, time)| {
        let text = block(length, time);
        let folder = folder(&format!("scales_{length}_{time}"), &[("block.fdc", text.as_bytes())]);
        json(&fdcc(&folder, &["solve", "block.fdc", "--json", "--log", "none"], ""))
    });
    for document in &solved {
        // In units in which all numbers are tiny nothing may be certified.
        let status = document["status"].as_str().expect("a word");
        assert!(["solved", "uncertified"].contains(&status), "{status}");
        near(&document["objective"], 0.012, 0.03 * 0.012);
        // The block ends where it should, to a few hundredths of its way.
        assert!(
            number(&document["verification"]["relative_violation"]) < 0.05,
            "{}",
            document["verification"]
        );
    }
    let parts = UNITS.map(|(length, time)| width_for_speed(&block(length, time)));
    for part in parts {
        // The guess rests, so the first width is a part of the unit, and the last is what it comes
        // to: up to twice a hundredth of the speed.
        assert!((0.5..2.0).contains(&(part / parts[0])), "{part} {}", parts[0]);
    }
}

/// Where a located optimum is certified, it is the closed form. In units in which all numbers are
/// tiny the search may find none.
#[test]
fn what_is_certified_is_so_in_its_own_unit() {
    for (length, time, has_to_be) in [("m", "s", false), ("mm", "s", true), ("um", "ms", true)] {
        let text = block(length, time);
        let folder = folder(&format!("true_{length}_{time}"), &[("block.fdc", text.as_bytes())]);
        let document = json(&fdcc(&folder, &["solve", "block.fdc", "--json", "--log", "none"], ""));
        let is_certified = document["certificate"]["certified"] == true;
        assert!(is_certified || !has_to_be, "{length}/{time}");
        if is_certified {
            near(&document["objective"], 0.012, 1e-9 * 0.012);
        }
    }
}

/// The width that the smoothed problem comes to, as a part of the largest speed.
fn width_for_speed(text: &str) -> f64 {
    let model = fdcc::Model::from_text("block", text).expect("it has no mistakes");
    let chain = model.chain().expect("it can be compiled");
    let mut go_on = |_: &_, _: fdcc_runtime::solve::Level| std::ops::ControlFlow::Continue(());
    let found = fdcc_runtime::solve::solve_chain(&chain, None, &mut go_on);
    let outcome = found.expect("nothing is refused").into_single();
    let speeds = &outcome.trajectory.states[1];
    outcome.sigma[0] / speeds.iter().fold(0.0, |most: f64, speed| most.max(speed.abs()))
}

/// The same over other ways and times: what pulls it, and what holds it, is `k = way/time^2` times
/// as much, so `J` is `k^2 time` times as large. The width is a hundredth of the speed in all.
#[test]
fn the_width_fits_the_speed_at_every_scale() {
    for (length, way, in_metres, time, lasts, in_seconds) in [
        ("um", 0.5, 1e-6, "ms", 2.0, 1e-3),
        ("km", 500.0, 1e3, "s", 2000.0, 1.0),
        ("um", 1e-4, 1e-6, "ns", 40.0, 1e-9),
        ("nm", 3.0, 1e-9, "us", 7.0, 1e-6),
        ("km", 100.0, 1e3, "h", 4.0, 3600.0),
    ] {
        let duration: f64 = lasts * in_seconds / 2e-3;
        let k = way * in_metres / 0.5e-6 / duration.powi(2);
        let text = block(length, time)
            .replace("= 3 [m/s^2]", &format!("= {:e} [m/s^2]", 3.0 * k))
            .replace("0.5 [um]", &format!("{way:e} [{length}]"))
            .replace("2[ms]", &format!("{lasts}[{time}]"));
        let folder = folder(&format!("widths_{length}_{time}"), &[("block.fdc", text.as_bytes())]);
        let document = json(&fdcc(&folder, &["solve", "block.fdc", "--json", "--log", "none"], ""));
        let least = 0.012 * k.powi(2) * duration;
        near(&document["objective"], least, 0.03 * least);
        let part = width_for_speed(&text);
        assert!((0.005..0.02).contains(&part), "{length}/{time}: sigma is {part} of the speed");
    }
}

/// A vessel at 100 bar, filled to 110: 1 Pa is a millionth of the way, 10 kPa a hundredth.
#[test]
fn a_vessel_at_100_bar_can_be_confirmed() {
    let model = |pressure: &str, from: &str, to: &str, rate: &str| {
        format!(
            "model vessel\ntime t in [0, 1] [s]\nstate p {pressure} start {from}\ncontrol u \
             {rate}\n\
             dynamics {{ p' = u }}\nend p == {to}\nminimize integral(u^2)\n"
        )
    };
    let models = [
        model("[Pa]", "1e7", "1.1e7[Pa]", "[Pa/s]"),
        model("[bar]", "100", "110[bar]", "[bar/s]"),
        model("", "1e7", "1.1e7", "").replace("[s]", ""),
    ];
    for (at, text) in models.iter().enumerate() {
        for (rate, code) in [(1e6, 0), (1_000_001.0, 0), (1.01e6, 2)] {
            let solution = format!(
                r#"{{"model": "vessel", "free": {{}}, "params": {{}}, "time": [0, 0.5, 1],
                  "states": {{"p": [1e7, 1.05e7, 1.1e7]}}, "controls": {{"u": [{rate}, {rate}]}}}}"#
            );
            let files = [("vessel.fdc", text.as_bytes()), ("vessel.sol.json", solution.as_bytes())];
            let folder = folder(&format!("scales_vessel_{at}"), &files);
            let output = fdcc(&folder, &["verify", "vessel.sol.json", "--json"], "");
            expect_exit(&output, code, text);
            let missed = rate - 1e6;
            near(&json(&output)["verification"]["state_gap"], missed / (1e6 + missed), 1e-8);
        }
    }
}

/// A state that rests, at 0 or far from it, does not differ by rounding.
#[test]
fn what_does_not_move_does_not_differ() {
    let text = "model rests\ntime t in [0, 1]\nstate x start 0\nstate y start 0\nstate z start \
                300\ncontrol u\n\
                dynamics { x' = u\n y' = 0*u\n z' = 0*u }\nend y == 0\nend z == 300\nminimize \
                integral(u^2)\n";
    let solution = r#"{"model": "rests", "free": {}, "params": {}, "time": [0, 1],
        "states": {"x": [0, 1], "y": [0, 1e-16], "z": [300, 300.00000000001]},
        "controls": {"u": [1]}}"#;
    let folder = folder(
        "scales_rests",
        &[("rests.fdc", text.as_bytes()), ("rests.sol.json", solution.as_bytes())],
    );
    expect_exit(&fdcc(&folder, &["verify", "rests.sol.json"], ""), 0, "rounding");
}
