//! `fdcc grad` from outside: closed forms, what may be asked, and where there is no gradient.

use crate::common::{column, expect_exit, fdcc, folder, json, model, number, stderr, stdout};
use serde_json::Value;

/// Example (2.3): `x(end) = a(2 + x0/(2 + a))`, `J' = 2(x0 + 1)/9 - x0^2/3 + (x0 + 6)^2/27` for `a
/// = 1`.
const CROSSING: &str = "\
model crossing
param a = 1
free x0 in [-1.5, -0.5] guess -1
time t in [0, 2]
state x start x0
surface zero = x
dynamics { x' in (1 + a) - Sgn(zero) }
minimize (x(end) - 5/3)^2 + integral(x^2)
method {
  smooth sigma = 0.1 kernel tanh
  grid N = 200 scheme implicit_euler
}
report {
  height = a*x
  rate = (1 + a) - selected(Sgn(zero))
}
";

/// Grazing, example (g1): `y(end) = p - 1` for `p < 0`, and -1 for `p > 0`.
const GRAZING: &str = "\
model grazing
param p = 0
time t in [0, 2]
state x start -1
state y start -1 + p
surface edge = y
dynamics {
  x' = 1
  y' in match edge { below => -2*x, above => -2*x - 1 }
}
";

/// `x(end) = x(0) + c*sum(h*u)`, `y(end)` is that of the other.
const DRIVEN: &str = "\
model driven
param c = 2
time t in [0, 1]
state pos(x, y) start free in [-1, 1]
control u in [-1, 1]
dynamics { pos' = (c*u, 1) }
maximize pos.x(end)^2
";

/// `N` is computed: where it stands, its formula does.
const WEIGHED: &str = "\
model weighed
param m = 2
param N = 3*m
time t in [0, 1]
state x start 0
dynamics { x' = N + m }
minimize x(end)
";

/// A model that is understood and cannot be simulated yet; its objective is there.
const PHASES: &str = "\
phase first {
  time t in [0, 1]
  state x start 0
  dynamics { x' = 1 }
}
maximize first.x(end)
";

fn near(value: &Value, expected: f64) {
    assert!(
        (number(value) - expected).abs() <= 1e-9 * expected.abs().max(1.0),
        "{value}, not {expected}"
    );
}

fn found(test: &str, text: &str, arguments: &[&str], code: i32) -> Value {
    let folder =
        folder(test, &[("model.fdc", text.as_bytes()), ("u.csv", b"t,u\n0,1\n0.25,0.5\n")]);
    let output = fdcc(&folder, &[&["grad", "model.fdc", "--json"], arguments].concat(), "");
    expect_exit(&output, code, &format!("{arguments:?}"));
    json(&output)
}

/// The smoothed number is that of an independent program (tanh, sigma = .1, h = .01, implicit
/// Euler), whose integral is the trapezoidal sum; that of the language takes the right ends.
#[test]
fn the_document_is_the_one_that_is_promised() {
    let found = found("grad_document", CROSSING, &[], 0);
    assert_eq!((&found["of"], &found["status"]), (&"objective".into(), &"completed".into()));
    near(&found["value"], 134.0 / 81.0);
    for way in ["gradient", "adjoint"] {
        near(&found[way]["x0"], 16.0 / 27.0);
    }
    assert!(number(&found["agreement"]) <= 1e-10, "{found}");
    let (end, slope, h) = (1.6978505288978205, 0.3333333339424377, 0.01);
    near(&found["compare"]["smoothed"]["x0"], 0.6483102710522225 + h * (end * slope + 1.0));
    assert_eq!(
        (&found["compare"]["smoothed"]["sigma"], &found["compare"]["smoothed"]["N"]),
        (&0.1.into(), &200.into())
    );
    assert_eq!(found["compare"]["discretised"]["scheme"], "implicit_euler");
    assert_eq!((&found["differentiable"], &found["trusted"]), (&true.into(), &true.into()));
    assert_eq!(found["events"][0]["surface"], "zero");
    near(&found["events"][0]["time"], 1.0 / 3.0);
    near(&found["events"][0]["margin"], 1.0);
    assert!(found.get("one_sided").is_none() && found.get("second").is_none(), "{found}");
}

/// Off the lattice the theta scheme has a closed form: -.33541 with the trapezoidal sum where the
/// truth is .58881215.
#[test]
fn the_gradient_of_the_discretised_problem_is_the_trap_of_section_two() {
    let text = CROSSING.replace("guess -1", "guess -1.003");
    let found = found("grad_trap", &text, &["--wrt", "x0"], 0);
    near(
        &found["gradient"]["x0"],
        2.0 * -0.003 / 9.0 - 1.003f64.powi(2) / 3.0 + 4.997f64.powi(2) / 27.0,
    );
    near(&found["compare"]["discretised"]["x0"], -0.33541 + 0.01 * 1.003);
    let warnings = found["warnings"].to_string();
    assert!(warnings.contains("the discretised gradient is off by 155 %"), "{warnings}");
}

#[test]
fn anything_with_a_value_at_the_end_can_be_differentiated() {
    let (x0, a) = (-1.0, 1.0);
    let end = a * (2.0 + x0 / (2.0 + a));
    let cases = [
        ("x(end)", end, 1.0 / 3.0, 16.0 / 9.0),
        ("-x(end)", -end, -1.0 / 3.0, -16.0 / 9.0),
        ("height(end)", a * end, 1.0 / 3.0, 16.0 / 9.0 + end),
        ("a^2*x0", x0, 1.0, 2.0 * x0),
        ("x(start)*x(end)", x0 * end, end + x0 / 3.0, x0 * 16.0 / 9.0),
        ("integral(1) + 0*x0", 2.0, 0.0, 0.0),
    ];
    for (of, value, by_x0, by_a) in cases {
        let found = found("grad_of", CROSSING, &["--of", of], 0);
        assert_eq!(found["of"], of);
        near(&found["value"], value);
        near(&found["gradient"]["x0"], by_x0);
        near(&found["gradient"]["a"], by_a);
    }
}

/// `d2/dx0 da = 2/(2 + a)^2`, `d2/da2 = -4 x0/(2 + a)^3`.
#[test]
fn second_derivatives_are_those_of_the_closed_form() {
    let found = found("grad_second", CROSSING, &["--of", "x(end)", "--second"], 0);
    near(&found["second"]["a"]["x0"], 2.0 / 9.0);
    near(&found["second"]["x0"]["a"], 2.0 / 9.0);
    near(&found["second"]["a"]["a"], 4.0 / 27.0);
    near(&found["second"]["x0"]["x0"], 0.0);
}

/// `v(1/2) = (u_1 + u_2)/4` squared: every second derivative is 1/8.
#[test]
fn rows_of_controls_have_second_derivatives() {
    let text =
        "time t in [0, 0.5]  state v start 0  control u\ndynamics { v' = u }\nminimize v(end)^2\n";
    let found =
        found("grad_second_rows", text, &["--control", "u.csv", "--wrt", "u", "--second"], 0);
    near(&found["second"]["u[1]"]["u[1]"], 0.125);
    near(&found["second"]["u[1]"]["u[2]"], 0.125);
    near(&found["second"]["u[2]"]["u[2]"], 0.125);
}

#[test]
fn at_a_grazing_there_are_two_derivatives() {
    let found = found("grad_grazing", GRAZING, &["--of", "y(end)"], 2);
    assert_eq!((&found["differentiable"], &found["trusted"]), (&false.into(), &false.into()));
    assert!((number(&found["one_sided"]["p"]["below"]) - 1.0).abs() < 1e-6, "{found}");
    assert!(number(&found["one_sided"]["p"]["above"]).abs() < 1e-6, "{found}");
    assert_eq!(
        (&found["cause"]["kind"], &found["cause"]["surface"]),
        (&"grazing".into(), &"edge".into())
    );
    near(&found["cause"]["time"], 1.0);
    let folder = folder("grad_grazing_words", &[("model.fdc", GRAZING.as_bytes())]);
    let said = stdout(&fdcc(&folder, &["grad", "model.fdc", "--of", "y(end)"], ""));
    assert!(said.contains("NOT DIFFERENTIABLE: `edge` is grazed at t = 1"), "{said}");
    assert!(said.contains("below") && said.contains("above"), "{said}");
    let beside = fdcc(&folder, &["grad", "model.fdc", "--of", "y(end)", "--set", "p=0.01"], "");
    expect_exit(&beside, 0, "off the grazing");
}

/// `y = p - (x - 1)^2 (x - 2)^2` touches 0 twice in one long step: for `p < 0` all of `p` is left,
/// for `p > 0` nothing, as of a grazing.
const TWICE: &str = "\
param p = 0
time t in [0, 3]
state x start 0
state y start -4 + p
surface edge = y
dynamics {
  x' = 1
  y' in match edge {
    below => -2*(x - 1)*(x - 2)*(2*x - 3),
    above => -2*(x - 1)*(x - 2)*(2*x - 3) - 1
  }
}
";

/// A block that comes to rest is pulled as hard as friction holds it, for an instant.
const PULLED: &str = "\
param p = 0
time t in [0, 3]
state x start 0
state v start 0
surface slip = v
dynamics { x' = v  v' in (1 + p - (t - 1)^2*(t - 2)^2) - Sgn(slip) }
";

#[test]
fn what_is_touched_inside_a_long_step_is_seen() {
    found("grad_twice_beside", TWICE, &["--of", "y(end)", "--set", "p=-1e-3"], 0);
    let found = found("grad_twice", TWICE, &["--of", "y(end)"], 2);
    assert_eq!((&found["trusted"], &found["cause"]["kind"]), (&false.into(), &"grazing".into()));
    near(&found["cause"]["time"], 1.0);
    near(&found["one_sided"]["p"]["below"], 1.0);
    near(&found["one_sided"]["p"]["above"], 0.0);
}

#[test]
fn a_limit_that_is_reached_for_an_instant_is_told() {
    let folder = folder("grad_pulled", &[("pulled.fdc", PULLED.as_bytes())]);
    let said = |p: &str| {
        let arguments = ["grad", "pulled.fdc", "--of", "x(end)", "--set", p];
        stdout(&fdcc(&folder, &arguments, ""))
    };
    // A little more force moves the block by the power 3/2 of it: both derivatives are the same.
    assert!(said("p=0").contains("(and 2 more); the derivatives from both sides agree"));
    assert!(!said("p=-1e-3").contains("more"));
}

/// Whether two derivatives are one does not depend on the unit of what is differentiated.
#[test]
fn small_derivatives_are_two_as_well_as_large_ones() {
    for of in ["1e-12*y(end)", "1e-6*y(end)", "1e6*y(end)"] {
        let found = found("grad_scaled", GRAZING, &["--of", of], 2);
        assert_eq!(
            (&found["differentiable"], &found["trusted"]),
            (&false.into(), &false.into()),
            "{of}"
        );
    }
}

/// `x(end) = N + m` with `N = 3m`; nothing depends on `N` until it has a value of its own.
#[test]
fn a_parameter_that_is_computed_is_none_to_differentiate_by() {
    let all = found("grad_computed", WEIGHED, &[], 0);
    assert_eq!(all["gradient"].as_object().expect("an object").len(), 1);
    near(&all["gradient"]["m"], 4.0);
    let given = found("grad_computed", WEIGHED, &["--set", "N=6"], 0);
    near(&given["gradient"]["m"], 1.0);
    near(&given["gradient"]["N"], 1.0);
}

/// With `x(0) = 0` from the guess, `J = x(end)^2` and `x(end) = c(.25*1 + .75*.5)`: the rows count
/// by their durations.
#[test]
fn starts_controls_and_maximize_are_as_written() {
    let end = 2.0 * 0.625;
    let all = found("grad_default", DRIVEN, &["--control", "u.csv"], 0);
    let names: Vec<&String> = all["gradient"].as_object().expect("an object").keys().collect();
    assert_eq!(names, ["c", "pos.x(start)", "pos.y(start)"]);
    near(&all["value"], end * end);
    near(&all["gradient"]["c"], 2.0 * end * 0.625);
    let some = found("grad_some", DRIVEN, &["--control", "u.csv", "--wrt", "pos(start), u,u"], 0);
    near(&some["gradient"]["pos.x(start)"], 2.0 * end);
    near(&some["gradient"]["pos.y(start)"], 0.0);
    let by_rows = column(&some["gradient"]["u"]);
    assert_eq!(by_rows.len(), 2);
    near(&some["gradient"]["u"][0], 2.0 * end * 2.0 * 0.25);
    near(&some["gradient"]["u"][1], 2.0 * end * 2.0 * 0.75);
}

/// More than forward sensitivities are made for: the adjoint alone, checked along sums.
#[test]
fn many_control_values_are_done_by_the_adjoint() {
    let rows: String = (0..200).map(|k| format!("{},0.5\n", k as f64 / 200.0)).collect();
    let files = [("model.fdc", DRIVEN.as_bytes()), ("u.csv", b"")];
    let folder = folder("grad_many", &files);
    std::fs::write(folder.join("u.csv"), format!("t,u\n{rows}")).expect("a file can be written");
    let output = fdcc(
        &folder,
        &["grad", "model.fdc", "--control", "u.csv", "--of", "pos.x(end)", "--wrt", "u", "--json"],
        "",
    );
    expect_exit(&output, 0, "many");
    let found = json(&output);
    column(&found["gradient"]["u"])
        .iter()
        .for_each(|value| assert!((value - 0.01).abs() < 1e-12, "{value}"));
    assert_eq!(column(&found["gradient"]["u"]).len(), 200);
    assert_eq!(found["trusted"], true);
    let said =
        stdout(&fdcc(&folder, &["grad", "model.fdc", "--control", "u.csv", "--wrt", "u"], ""));
    assert!(said.contains("of 200)"), "{said}");
}

/// The point of a solve: parameters, unknowns and method are those of its file unless the command
/// line has others.
#[test]
fn a_solution_brings_its_parameters_and_its_method() {
    let folder = folder("grad_solution", &[("model.fdc", CROSSING.as_bytes())]);
    let solve = ["solve", "model.fdc", "--set", "a=2", "--method", "N=50", "--out", "."];
    expect_exit(&fdcc(&folder, &solve, ""), 0, "solve");
    let grad = ["grad", "model.fdc", "--control", "crossing.sol.json", "--of", "x(end)", "--json"];
    let found = json(&fdcc(&folder, &grad, ""));
    near(&found["gradient"]["x0"], 0.5);
    assert_eq!(found["compare"]["smoothed"]["N"], 50);
    let other =
        json(&fdcc(&folder, &[&grad[..], &["--set", "a=1", "--method", "N=60"]].concat(), ""));
    near(&other["gradient"]["x0"], 1.0 / 3.0);
    assert_eq!(other["compare"]["smoothed"]["N"], 60);
}

#[test]
fn without_a_trajectory_there_is_no_gradient() {
    let edge = "param a = 1\ntime t in [0, 1]\nstate x start 0\nsurface top = x\ndynamics { x' in \
                a*x + 2*Sgn(top) }\n";
    let stuck = found("grad_edge", edge, &["--of", "x(end)"], 2);
    assert_eq!((&stuck["status"], &stuck["differentiable"]), (&"not_unique".into(), &false.into()));
    assert_eq!(stuck["value"], Value::Null);
    assert_eq!(stuck["not_unique"]["candidates"], serde_json::json!(["up", "down", "slide"]));
    let folder = folder("grad_edge_words", &[("edge.fdc", edge.as_bytes())]);
    let said = stdout(&fdcc(&folder, &["grad", "edge.fdc", "--of", "x(end)"], ""));
    assert!(said.starts_with(" NO GRADIENT of x(end)") && said.contains("several ways"), "{said}");
}

#[test]
fn what_cannot_be_asked_is_explained() {
    let files = [
        ("crossing.fdc", CROSSING.as_bytes()),
        ("grazing.fdc", GRAZING.as_bytes()),
        ("driven.fdc", DRIVEN.as_bytes()),
        ("weighed.fdc", WEIGHED.as_bytes()),
        ("phases.fdc", PHASES.as_bytes()),
        (
            "bare.fdc",
            b"time t in [0, 1]\nstate x start 0\ndynamics { x' = 1 }\nminimize x(end)\n" as &[u8],
        ),
        ("u.csv", b"t,u\n0,1\n"),
    ];
    let folder = folder("grad_usage", &files);
    let cases: &[(&[&str], i32, &str)] = &[
        (&["crossing.fdc", "--of", "x"], 3, "write `x(end)`, `x(start)` or `integral(x)`"),
        (&["crossing.fdc", "--of", "heigth(end)"], 3, "change `heigth` to `height`"),
        (&["crossing.fdc", "--of", "rate(end)"], 3, "depends on the side of a surface"),
        (&["crossing.fdc", "--of", "x(end"], 3, "`(` is never closed"),
        (&["crossing.fdc", "--of", "x(end) x0"], 3, "missing operator"),
        (&["crossing.fdc", "--of", "x(end) minimize x0"], 3, "one expression is enough"),
        (&["crossing.fdc", "--of", ""], 3, "`--of` needs an expression"),
        (&["crossing.fdc", "--of", "sliding(zero)"], 3, "only a simulation can tell"),
        (&["crossing.fdc", "--wrt", "x"], 3, "`x` is a state; write `x(start)`"),
        (&["crossing.fdc", "--wrt", "x1"], 3, "there is a, x0"),
        (&["crossing.fdc", "--wrt", "y(start)"], 3, "there is no state `y`; there is x"),
        (
            &["driven.fdc", "--wrt", "poss(start)"],
            3,
            "there is no state `poss`; there is pos.x, pos.y",
        ),
        (&["driven.fdc", "--wrt", "u"], 3, "`u` follows its guess"),
        (&["weighed.fdc", "--wrt", "N"], 3, "`--set N=6` makes it one of its own"),
        (&["phases.fdc"], 1, "FDC0603"),
        (&["crossing.fdc", "--rtol", "-1"], 3, "a number from 1e-14 to 1 is needed"),
        (&["grazing.fdc"], 3, "the model has no objective"),
        (&["bare.fdc"], 3, "nothing to differentiate by"),
        (&["crossing.fdc", "--set", "b=1"], 3, "there is no parameter `b`"),
        (&["absent.fdc"], 4, "absent.fdc cannot be read"),
        (&["crossing.fdc", "--control", "absent.csv"], 4, "absent.csv cannot be read"),
        (&[], 3, ""),
    ];
    for (arguments, code, message) in cases {
        let output = fdcc(&folder, &[&["grad"], *arguments].concat(), "");
        expect_exit(&output, *code, &format!("{arguments:?}"));
        assert!(stderr(&output).contains(message), "{arguments:?}: {}", stderr(&output));
        assert_eq!(stdout(&output), "", "{arguments:?}");
    }
}

#[test]
fn what_is_wrong_with_the_expression_is_shown_under_its_own_name() {
    let folder = folder("grad_place", &[("crossing.fdc", CROSSING.as_bytes())]);
    let said = stderr(&fdcc(&folder, &["grad", "crossing.fdc", "--of", "2*x(end) + q"], ""));
    assert!(said.contains("[--of:1:12]") && said.contains("2*x(end) + q"), "{said}");
}

#[test]
fn the_file_is_the_document() {
    let folder = folder("grad_file", &[]);
    let output = fdcc(&folder, &["grad", &model("crossing"), "--json", "--out", "out"], "");
    expect_exit(&output, 0, "crossing");
    let written =
        std::fs::read_to_string(folder.join("out/crossing.grad.json")).expect("the file is there");
    assert_eq!(written, stdout(&output));
}

/// `x(end) = a`; only the kinks are at `a = 2`.
#[test]
fn an_objective_at_a_kink_has_no_derivative_to_trust() {
    for (objective, is_kink) in [
        ("max(x(end), 2)", true),
        ("abs(x(end) - 2)", true),
        ("sqrt((x(end) - 2)^2)", true),
        ("min(a, b)*x(end)", true),
        ("max(x(end), 1)", false),
        ("abs(x(end) - 2)^3", false),
        ("1e6*(x(end) - 2)^2 + exp(x(end))", false),
        ("(x(end) + 1e9) - 1e9", false),
    ] {
        let text = format!(
            "param a = 2  param b = 2  time t in [0, 1]  state x start 0\ndynamics {{ x' = a }}\n\
             minimize {objective}\n"
        );
        let found = found("grad_objective_kink", &text, &[], if is_kink { 2 } else { 0 });
        assert_eq!(found["trusted"], !is_kink, "{objective}: {found}");
    }
}

#[test]
fn a_gradient_along_a_kink_is_not_trusted() {
    let text = "param p = 1  time t in [0, 2]  state x start 0\ndynamics { x' = p*abs(x) \
                }\nminimize x(end)\n";
    let along = found("grad_kink", text, &[], 2);
    assert_eq!((&along["trusted"], &along["differentiable"]), (&false.into(), &true.into()));
    let warnings = along["warnings"].to_string();
    assert!(warnings.contains("stays on a kink of `x'` (line 2"), "{warnings}");
    let across = found(
        "grad_across_kink",
        &text.replace("p*abs", "1 + p*abs").replace("start 0", "start -1"),
        &[],
        0,
    );
    assert_eq!(across["trusted"], true);
}

/// `y` is 1 where the jump finds it, as `p` is.
#[test]
fn a_jump_on_a_kink_has_no_derivative_to_trust() {
    for (assigned, is_kink) in [
        ("max(y, 1)", true),
        ("max(p, 1)", true),
        ("2 + abs(y - p/2 - 0.5)", true),
        ("max(y, 0.5)", false),
        ("max(q, 1)", false),
        ("y^2 + p", false),
    ] {
        let text = format!(
            "param p = 1  param q = 1  time t in [0, 2]  state x start 0  state y start p\nsurface \
             s = x - 1\ndynamics {{ x' = 1\n y' = 0 }}\njump hit on s rising {{ y := {assigned} \
             }}\nminimize y(end)\n"
        );
        let found = found("grad_reset_kink", &text, &["--wrt", "p"], if is_kink { 2 } else { 0 });
        assert_eq!(found["trusted"], !is_kink, "{assigned}: {found}");
        let said = found["warnings"].to_string().contains("the jump at t = 1 is on a kink");
        assert_eq!(said, is_kink, "{assigned}: {found}");
    }
}

/// `(q - p/4)^2` at q = 0.8, p = 2, of no state at all.
#[test]
fn a_model_without_states_has_a_gradient() {
    let text = "param p = 2\nfree q in [0, 1] guess 0.8\ntime t in [0, 1]\nminimize (q - p/4)^2\n";
    let folder = folder("grad_no_state", &[("still.fdc", text.as_bytes())]);
    let output = fdcc(&folder, &["grad", "still.fdc", "--json"], "");
    expect_exit(&output, 0, "it has derivatives");
    let by = &json(&output)["gradient"];
    let of = |name: &str| by[name].as_f64().expect("a number");
    assert!((of("p") + 0.15).abs() < 1e-12 && (of("q") - 0.6).abs() < 1e-12, "{by}");
}
