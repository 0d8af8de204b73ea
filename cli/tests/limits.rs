//! What is too large, takes too long or is not whole is refused at once, with the number.

use crate::common::*;
use serde_json::{Value, json};
use std::time::{Duration, Instant};

/// Generous: the tests share the machine.
const AT_ONCE: Duration = Duration::from_secs(5);

/// A sum that takes longer to compile than anybody waits for.
fn long() -> String {
    let terms: Vec<String> = (1..=4000).map(|i| format!("sin({i}*x + {i})")).collect();
    format!(
        "time t in [0, 1]\nstate x start 0\ncontrol u in [-1, 1]\ndynamics {{ x' = u + {} \
         }}\nminimize integral(u^2)\n\
         method {{ N = 10 scheme = rk4 }}\nexpect {{ x(start) == 0 }}\n",
        terms.join(" + ")
    )
}

#[test]
fn the_time_limit_reaches_checking_and_compiling() {
    let many: String = (0..100_000).map(|i| format!("param p{i} = {i}\n")).collect();
    let texts = [("long.fdc", long()), ("many.fdc", many)];
    let files: Vec<(&str, &[u8])> =
        texts.iter().map(|(name, text)| (*name, text.as_bytes())).collect();
    let place = folder("limits_time", &files);
    let commands: [&[&str]; 6] = [
        &["solve", "long.fdc"],
        &["sweep", "long.fdc", "N=10,11"],
        &["test", "long.fdc"],
        &["simulate", "long.fdc"],
        &["grad", "long.fdc", "--of", "x(end)", "--wrt", "x(start)"],
        &["check", "many.fdc"],
    ];
    for command in commands {
        let begin = Instant::now();
        let output = fdcc(&place, &[command, &["--time-limit", "0.01"]].concat(), "");
        assert!(begin.elapsed() < AT_ONCE, "{command:?} takes {:?}", begin.elapsed());
        expect_exit(&output, 2, &format!("{command:?}"));
        let said = stderr(&output);
        assert!(
            said.contains("the time limit was reached while it was read and compiled"),
            "{said}"
        );
        // `test` counts what was as expected.
        let printed = if command[0] == "test" { "0 ok, 0 failed\n" } else { "" };
        assert_eq!(stdout(&output), printed, "{command:?}");
    }
}

#[cfg(unix)]
#[test]
fn ctrl_c_reaches_compiling() {
    let place = folder("limits_interrupt", &[("long.fdc", long().as_bytes())]);
    let child = start(&place, &["solve", "long.fdc"]);
    std::thread::sleep(Duration::from_millis(300));
    let begin = Instant::now();
    let kill = std::process::Command::new("kill").args(["-INT", &child.id().to_string()]).status();
    assert!(kill.expect("kill runs").success());
    let output = child.wait_with_output().expect("it ends");
    assert!(begin.elapsed() < AT_ONCE, "{:?}", begin.elapsed());
    expect_exit(&output, 2, "interrupted");
    assert!(
        stderr(&output).contains("interrupted while it was read and compiled"),
        "{}",
        stderr(&output)
    );
}

/// Each would ask for far more memory than there is.
#[test]
fn sizes_are_refused_with_the_number_before_memory_is_asked_for() {
    let methods =
        ["N = 1000000000", "N = 4 steps = 1000000", "N = 4 steps = 1000000000", "N = 1e300"];
    let numbers = ["1000000000", "4000000", "4000000000", "18446744073709551615"];
    for (method, number) in methods.into_iter().zip(numbers) {
        let text = RAMP.replace("N = 4", method);
        let place = folder(
            "limits_sizes",
            &[("large.fdc", text.as_bytes()), ("ramp.fdc", RAMP.as_bytes())],
        );
        for command in ["check", "solve", "simulate", "grad", "test", "show"] {
            let output = fdcc(&place, &[command, "large.fdc"], "");
            expect_exit(&output, 1, &format!("{command} {method}"));
            let said = stdout(&output) + &stderr(&output);
            assert!(said.contains(number), "{command} {method}: {said}");
        }
        for command in ["solve", "sweep", "grad", "simulate", "show"] {
            let changes: Vec<String> =
                method.replace(" = ", "=").split(' ').map(str::to_owned).collect();
            let changes = changes.iter().flat_map(|change| ["--method", change]);
            let values = if command == "sweep" { vec!["goal=1,2"] } else { Vec::new() };
            let arguments = [command, "ramp.fdc"].into_iter().chain(values).chain(changes);
            let output = fdcc(&place, &arguments.collect::<Vec<_>>(), "");
            expect_exit(&output, 3, &format!("{command} --method {method}"));
            assert!(stderr(&output).contains(number), "{command} {method}: {}", stderr(&output));
        }
    }
}

fn solved(place: &std::path::Path) -> Value {
    expect_exit(
        &fdcc(place, &["solve", "ramp.fdc", "--out", ".", "--log", "none"], ""),
        0,
        "solve",
    );
    let text = std::fs::read_to_string(place.join("ramp.sol.json")).expect("it was written");
    serde_json::from_str(&text).expect("JSON")
}

#[test]
fn a_solution_that_says_so_is_refused_like_an_option() {
    let place = folder("limits_solution", &[("ramp.fdc", RAMP.as_bytes())]);
    for n in [json!(1_000_000_000), json!(u64::MAX)] {
        let mut solution = solved(&place);
        solution["method"]["N"] = n.clone();
        std::fs::write(place.join("large.sol.json"), solution.to_string())
            .expect("it can be written");
        for command in ["grad", "simulate"] {
            let output = fdcc(&place, &[command, "ramp.fdc", "--control", "large.sol.json"], "");
            expect_exit(&output, 3, command);
            assert!(stderr(&output).contains(&n.to_string()), "{command}: {}", stderr(&output));
        }
    }
}

#[test]
fn a_start_that_is_not_whole_is_refused() {
    let place = folder("limits_warm", &[("ramp.fdc", RAMP.as_bytes())]);
    let whole = solved(&place);
    let reversed: Vec<Value> =
        whole["time"].as_array().expect("times").iter().rev().cloned().collect();
    let nodes = |time: Value, u: Value| json!({"time": time, "values": {"u": u}});
    let spoilt: [(&str, &str, Value, &str); 13] = [
        (
            "control_nodes",
            "",
            nodes(json!([0.1, 1.9]), json!([1, 1])),
            "`control_nodes` have 1.9, outside of its times",
        ),
        (
            "control_nodes",
            "",
            nodes(json!([0.9, 0.1]), json!([1, 1])),
            "`control_nodes` must ascend, but 0.1 follows 0.9",
        ),
        (
            "control_nodes",
            "",
            nodes(json!([0.1, 0.9]), json!([1])),
            "`control_nodes.values.u` has 1 values where there should be 2",
        ),
        (
            "control_nodes",
            "",
            nodes(json!([0.1, 0.9]), json!([1, null])),
            "value 2 of `control_nodes.values.u` is no number",
        ),
        (
            "control_nodes",
            "",
            json!({"time": [0.1, 0.9], "values": {}}),
            "`control_nodes` has no values of `u`",
        ),
        ("states", "x", json!([0.0, null, 0.5, 0.75, 1.0]), "value 2 of `states.x` is no number"),
        ("states", "x", json!([0.0, 0.25, 0.5]), "`states.x` has 3 values where there should be 5"),
        (
            "controls",
            "u",
            json!([1.0, 1.0, 1.0, 1.0, 1.0]),
            "`controls.u` has 5 values where there should be 4",
        ),
        ("controls", "u", json!([null, 1.0, 1.0, 1.0]), "value 1 of `controls.u` is no number"),
        ("time", "", json!(reversed), "times must ascend, but 0.75 follows 1"),
        ("params", "goal", json!(null), "`params.goal` is no number"),
        (
            "time",
            "",
            json!([0.0, 0.25, 0.25, 0.75, 1.0]),
            "times must ascend, but 0.25 follows 0.25",
        ),
        ("time", "", json!([0.0, 0.25, null, 0.75, 1.0]), "value 3 of `time` is no number"),
    ];
    for (field, name, value, words) in spoilt {
        let mut solution = whole.clone();
        match name {
            "" => solution[field] = value,
            _ => solution[field][name] = value,
        }
        std::fs::write(place.join("spoilt.sol.json"), solution.to_string())
            .expect("it can be written");
        for command in [&["solve", "ramp.fdc"][..], &["sweep", "ramp.fdc", "goal=1,2"]] {
            let output = fdcc(&place, &[command, &["--warm", "spoilt.sol.json"]].concat(), "");
            expect_exit(&output, 4, words);
            assert!(stderr(&output).contains(words), "{words}: {}", stderr(&output));
        }
    }
}

/// What a replay takes over must be there: the parameters of another problem would be those of the
/// text, in silence.
#[test]
fn a_solution_without_its_numbers_is_neither_verified_nor_replayed() {
    let place = folder("limits_replayed", &[("ramp.fdc", RAMP.as_bytes())]);
    let whole = solved(&place);
    let spoilt = [
        ("params", "goal", json!(null), "`params.goal` is no number"),
        ("states", "x", json!([0.0, null, 0.5, 0.75, 1.0]), "value 2 of `states.x` is no number"),
        ("controls", "u", json!([1.0, 1.0, 1.0, null]), "value 4 of `controls.u` is no number"),
        ("states", "x", json!([0.0, 0.25]), "`states.x` has 2 values where there should be 5"),
        (
            "states",
            "x",
            json!([0, 1, 2, 3, 4, 5, 6, 7]),
            "`states.x` has 8 values where there should be 5",
        ),
        ("controls", "u", json!([1.0]), "`controls.u` has 1 values where there should be 4"),
    ];
    let commands: [&[&str]; 4] = [
        &["verify", "spoilt.sol.json", "ramp.fdc"],
        &["simulate", "ramp.fdc", "--control", "spoilt.sol.json"],
        &["simulate", "ramp.fdc", "--warm", "spoilt.sol.json"],
        &["grad", "ramp.fdc", "--control", "spoilt.sol.json"],
    ];
    for (field, name, value, words) in spoilt {
        let mut solution = whole.clone();
        solution[field][name] = value;
        std::fs::write(place.join("spoilt.sol.json"), solution.to_string())
            .expect("it can be written");
        for command in commands {
            let output = fdcc(&place, command, "");
            expect_exit(&output, 4, words);
            assert!(stderr(&output).contains(words), "{command:?}: {}", stderr(&output));
        }
    }
}

/// A picture of half a solution would be a wrong one.
#[test]
fn a_solution_that_is_not_whole_is_not_drawn() {
    let place = folder("limits_drawn", &[("ramp.fdc", RAMP.as_bytes())]);
    let whole = solved(&place);
    let spoilt = [
        ("/states/x", json!([0.0, null, 0.5, 0.75, 1.0]), "value 2 of `states.x` is no number"),
        ("/states/x", json!([0.0, 0.25]), "`states.x` has 2 values where there should be 5"),
        (
            "/controls/u",
            json!([1.0, 1.0, 1.0, 1.0, 1.0]),
            "`controls.u` has 5 values where there should be 4",
        ),
        ("/costates/x", json!([0.0]), "`costates.x` has 1 values where there should be 5"),
        (
            "/time",
            json!([1.0, 0.75, 0.5, 0.25, 0.0]),
            "`time`: times must ascend, but 0.75 follows 1",
        ),
        ("/time", json!([0.0, 0.25, null, 0.75, 1.0]), "value 3 of `time` is no number"),
    ];
    for (field, value, words) in spoilt {
        let mut solution = whole.clone();
        *solution.pointer_mut(field).expect("the field is there") = value;
        std::fs::write(place.join("spoilt.sol.json"), solution.to_string())
            .expect("it can be written");
        for command in [&["report"][..], &["plot", "--out", "x.svg"]] {
            let output = fdcc(&place, &[command, &["spoilt.sol.json"]].concat(), "");
            expect_exit(&output, 4, words);
            assert!(stderr(&output).contains(words), "{words}: {}", stderr(&output));
        }
    }
}

/// Files without end: as much of them is read as is allowed, and no more.
#[cfg(unix)]
#[test]
fn a_file_without_end_is_refused() {
    let place = folder("limits_endless", &[("ramp.fdc", RAMP.as_bytes())]);
    let commands: [(&[&str], i32, &str); 6] = [
        (&["solve", "ramp.fdc", "--warm", "/dev/zero"], 4, "more than 256 MiB"),
        (&["simulate", "ramp.fdc", "--control", "/dev/zero"], 4, "more than 256 MiB"),
        (&["simulate", "ramp.fdc", "--warm", "/dev/zero"], 4, "more than 256 MiB"),
        (&["verify", "/dev/zero", "ramp.fdc"], 4, "more than 256 MiB"),
        (&["check", "/dev/zero"], 1, "FDC0009"),
        (&["solve", "/dev/zero"], 1, "FDC0009"),
    ];
    for (command, code, words) in commands {
        let output = fdcc(&place, command, "");
        expect_exit(&output, code, words);
        let said = stdout(&output) + &stderr(&output);
        assert!(said.contains(words), "{command:?}: {said}");
    }
}

#[test]
fn a_gap_is_a_finite_number() {
    let place = folder("limits_gap", &[("ramp.fdc", RAMP.as_bytes())]);
    solved(&place);
    for gap in ["inf", "1e400", "nan", "-1", "infinity"] {
        for command in [&["solve", "ramp.fdc"][..], &["verify", "ramp.sol.json", "ramp.fdc"]] {
            let output = fdcc(&place, &[command, &["--gap", gap]].concat(), "");
            expect_exit(&output, 3, gap);
            assert!(stderr(&output).contains("it needs a finite number"), "{}", stderr(&output));
        }
    }
}

/// `check` sees the value of the model, `solve` that of the command line.
#[test]
fn a_start_without_a_value_is_refused() {
    let text = "param a = 2  time t in [0, 1]  state x start log(a)  control u in [-1, 1]\n\
                dynamics { x' = u }  minimize integral(u^2)  method { N = 10 }\n";
    let folder = folder("start_nan", &[("start.fdc", text.as_bytes())]);
    let solve = |a: &str| fdcc(&folder, &["solve", "start.fdc", "--log", "none", "--set", a], "");
    expect_exit(&solve("a=3"), 0, "a start with a value");
    let refused = solve("a=-1");
    expect_exit(&refused, 1, "a start without a value");
    assert!(stderr(&refused).contains("FDC0401"), "{}", stderr(&refused));
}

/// Parameters that nothing reads cost what it takes to read them.
#[test]
fn unused_parameters_take_time_in_proportion_to_their_number() {
    let many: String = (0..40_000).map(|i| format!("param p{i} = {i}\n")).collect();
    let place = folder("limits_parameters", &[("many.fdc", (RAMP.to_owned() + &many).as_bytes())]);
    let begin = Instant::now();
    let output = fdcc(&place, &["solve", "many.fdc"], "");
    assert!(begin.elapsed() < 2 * AT_ONCE, "{:?}", begin.elapsed());
    expect_exit(&output, 0, "40000 parameters");
}

/// They divide the time once, and are not carried through every interval of both parts.
#[test]
fn many_conditions_at_one_time_are_solved_at_once() {
    let many: String = (1..=1000).map(|i| format!("at 0.5: x <= {i}\n")).collect();
    let place = folder("limits_at_one_time", &[("many.fdc", (RAMP.to_owned() + &many).as_bytes())]);
    let begin = Instant::now();
    let output = fdcc(&place, &["solve", "many.fdc", "--log", "none"], "");
    assert!(begin.elapsed() < AT_ONCE, "{:?}", begin.elapsed());
    expect_exit(&output, 0, "1000 conditions");
}

fn expect_too_many(name: &str, text: &str, number: &str) {
    let place = folder(&format!("limits_{name}"), &[("large.fdc", text.as_bytes())]);
    let begin = Instant::now();
    let output = fdcc(&place, &["solve", "large.fdc"], "");
    assert!(begin.elapsed() < 2 * AT_ONCE, "{name}: {:?}", begin.elapsed());
    expect_exit(&output, 3, name);
    let said = stderr(&output);
    assert!(said.contains(number) && said.contains("too many"), "{name}: {said}");
}

/// Phases are solved at once: what each may have alone is too much for all together.
#[test]
fn sizes_are_counted_over_all_phases() {
    let phase = |i: usize| {
        format!(
            "phase a{i} {{\ntime t in [{i}, {}]\nstate v{}\ncontrol u in [-1, 1]\n\
             dynamics {{ v' = u }}\n}}\n",
            i + 1,
            if i == 0 { " start 1" } else { "" }
        )
    };
    let phases: String = (0..10).map(phase).collect();
    let links: String = (1..10).map(|i| format!("link a{} -> a{i} {{ same }}\n", i - 1)).collect();
    let whole = |method: &str| {
        format!("{phases}{links}minimize a9.v(end)^2\nmethod {{ {method} scheme = euler }}\n")
    };
    expect_too_many(
        "phase_steps",
        &whole("N = 100 steps = 2000"),
        "2000000 steps in all phases together are too many; at most 200000",
    );
    expect_too_many("phase_intervals", &whole("N = 500000"), "5000000 steps");
}

#[test]
fn conditions_and_surfaces_count() {
    let many = |line: &dyn Fn(usize) -> String| -> String { (1..=20_000).map(line).collect() };
    let ramp = RAMP.replace("N = 4", "N = 200");
    let paths = ramp.clone() + &many(&|i| format!("path x <= {i}\n"));
    expect_too_many("paths", &paths, "4000000 conditions");
    let surfaces = many(&|i| format!("surface s{i} = x - {i}\n"));
    expect_too_many("surfaces", &(ramp.clone() + &surfaces), "4000000 conditions");
    let jumps = many(&|i| format!("jump j{i} on s{i} rising {{ x := 0 }}\n"));
    expect_too_many("jumps", &(ramp + &surfaces + &jumps), "4000000 conditions");
}

/// What simplifies to a number is none where one of its parts is infinite, or 0/0.
#[test]
fn what_is_no_number_before_it_is_simplified_is_refused() {
    let bounds = ["0*inf", "inf/inf", "inf^0", "1/inf", "(1 - 1)*inf"];
    let bounds = bounds.map(|it| RAMP.replace("[-4, 4]", &format!("[0, {it}]")));
    let ratios = ["p/p", "3 + 2*(p/p)", "(p/p)^2", "2*p/p", "p^2/p", "p*(1/p)", "0/p", "1/(1/p)"];
    let ratios = ratios.map(|it| format!("{RAMP}param p = 0\nparam z = {it}\n"));
    for text in bounds.iter().chain(&ratios) {
        let place = folder("limits_no_number", &[("m.fdc", text.as_bytes())]);
        let output = fdcc(&place, &["check", "m.fdc"], "");
        expect_exit(&output, 1, text);
        assert!((stdout(&output) + &stderr(&output)).contains("FDC0411"), "{text}");
    }
    let chosen = "param p = 0\nlet z = piecewise { p > 0 => 2*p/p  otherwise => 1 }\n";
    for more in ["param p = 2\nparam z = 2*p/p\n", chosen] {
        let right = RAMP.replace("[-4, 4]", "[-4, inf]") + more;
        let place = folder("limits_number", &[("m.fdc", right.as_bytes())]);
        expect_exit(&fdcc(&place, &["check", "m.fdc"], ""), 0, &right);
    }
}
