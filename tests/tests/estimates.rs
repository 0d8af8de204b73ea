//! What estimates are worth: standard errors beside closed forms, and what data do not determine.

use fdcc::{DataFiles, Estimate, Estimates, Options};

/// The estimates of a model with one data file, `a.csv`.
fn estimates(text: &str, data: &str) -> Estimates {
    let data = data.to_owned();
    let files = DataFiles::from(move |_| Ok(data.clone()));
    let checked = fdcc::check_with("a test", text.into(), Some(files));
    let model = checked.model.unwrap_or_else(|| panic!("{text}\n{:#?}", checked.diagnostics));
    let solution = model.solve(&Options::default()).expect("it can be solved");
    assert!(solution.is_solved(), "{text}");
    solution.estimates().unwrap_or_else(|| panic!("no estimates of\n{text}"))
}

fn estimate<'e>(estimates: &'e Estimates, name: &str) -> &'e Estimate {
    estimates.unknowns.iter().find(|it| it.name == name).expect("it is unknown")
}

fn error(estimates: &Estimates, name: &str) -> f64 {
    let found = estimate(estimates, name).standard_error;
    found.unwrap_or_else(|| panic!("`{name}` has no standard error: {estimates:#?}"))
}

const LINE: &str = "data obs = csv(\"a.csv\") columns t, x, s\nfree a in [-9, 9] guess 1\n\
                    free b in [-9, 9] guess 1\ntime t in [0, 4]\nstate x start a\n\
                    dynamics { x' = b }\n";
const POINTS: [(f64, f64, f64); 5] =
    [(0.0, 1.1, 0.1), (1.0, 2.7, 0.2), (2.0, 5.3, 0.1), (3.0, 6.9, 0.3), (4.0, 9.2, 0.1)];

fn points() -> String {
    let line = |(t, x, s): &(f64, f64, f64)| format!("{t},{x},{s}\n");
    format!("t,x,s\n{}", POINTS.iter().map(line).collect::<String>())
}

/// Offset and slope of a line through points with these weights, their variances and covariance
/// for errors of 1 over the root of the weight, and the weighted sum of squares that remains.
fn line(weight: fn(f64) -> f64) -> ([f64; 2], [f64; 3], f64) {
    let sum = |term: &dyn Fn(f64, f64) -> f64| -> f64 {
        POINTS.iter().map(|(t, x, s)| weight(*s) * term(*t, *x)).sum()
    };
    let [s0, s1, s2] = [sum(&|_, _| 1.0), sum(&|t, _| t), sum(&|t, _| t * t)];
    let [y0, y1] = [sum(&|_, x| x), sum(&|t, x| t * x)];
    let determinant = s0 * s2 - s1 * s1;
    let [a, b] = [(s2 * y0 - s1 * y1) / determinant, (s0 * y1 - s1 * y0) / determinant];
    let rest = sum(&|t, x| (a + b * t - x).powi(2));
    ([a, b], [s2 / determinant, s0 / determinant, -s1 / determinant], rest)
}

fn is_near(a: f64, b: f64) -> bool {
    (a - b).abs() <= 1e-7 * b.abs()
}

/// Linear regression has a closed form, with known deviations and with unknown ones.
#[test]
fn errors_of_a_line_are_those_of_linear_regression() {
    let ([a, b], [aa, bb, ab], rest) = line(|s| 1.0 / (s * s));
    let known = estimates(&format!("{LINE}fit obs: x sd obs.s"), &points());
    assert!(is_near(estimate(&known, "a").value, a) && is_near(estimate(&known, "b").value, b));
    assert!(is_near(error(&known, "a"), aa.sqrt()) && is_near(error(&known, "b"), bb.sqrt()));
    assert!(is_near(known.correlations[0][1], ab / (aa * bb).sqrt()));
    assert!(is_near(known.correlations[1][0], ab / (aa * bb).sqrt()));
    assert_eq!((known.rows, known.degrees_of_freedom, known.is_known), (5, Some(3), true));
    assert!(is_near(known.sum_of_squares, rest));
    assert!(is_near(known.deviation.expect("3 degrees of freedom"), (rest / 3.0).sqrt()));

    for text in [
        "minimize sum(k in obs, ((x(k.t) - k.x)/k.s)^2)",
        "minimize 0.5*sum(k in obs, (x(k.t) - k.x)^2/k.s^2)",
        "minimize sum(k in obs, 3*(k.x - x(k.t))^2/(k.s*k.s))",
    ] {
        let free = estimates(&format!("{LINE}{text}"), &points());
        assert!(!free.is_known && free.degrees_of_freedom == Some(3), "{text}");
        let scale = (rest / 3.0).sqrt();
        assert!(is_near(error(&free, "a"), scale * aa.sqrt()), "{text}");
        assert!(is_near(error(&free, "b"), scale * bb.sqrt()), "{text}");
    }
}

/// A row of weight 0 was not measured, whatever stands in it.
#[test]
fn rows_without_weight_do_not_count() {
    let text = format!("{LINE}minimize sum(k in obs, k.s*(x(k.t) - k.x)^2)");
    let found = estimates(&text, &format!("{}4,777,0\n", points()));
    let (_, [aa, ..], rest) = line(|s| s);
    assert_eq!((found.rows, found.degrees_of_freedom), (5, Some(3)));
    assert!(is_near(error(&found, "a"), (aa * rest / 3.0).sqrt()));
    let of = &found.residuals[0];
    assert_eq!(
        (of.name.as_str(), of.is_measured.as_slice()),
        ("x", &[true, true, true, true, true, false][..])
    );
}

/// What was known before counts like a measurement.
#[test]
fn what_was_known_before_makes_errors_smaller() {
    let text = format!("{LINE}fit obs: x sd 1\nminimize ((b - 2)/0.1)^2");
    let found = estimates(&text, &points());
    // The information of the rows, and 1/0.1^2 more on b.
    let [s0, s1, s2] = [5.0_f64, 10.0, 30.0 + 100.0];
    assert!(is_near(error(&found, "b"), (s0 / (s0 * s2 - s1 * s1)).sqrt()));
}

const DECAY: &str = "data obs = csv(\"a.csv\") columns t, x\ntime t in [0, 2]\nstate x start 1\n";

fn decay() -> String {
    let row = |k: i32| {
        let t = 0.2 * f64::from(k);
        format!("{t},{}\n", (-0.7 * t).exp() + if k % 2 == 0 { 0.01 } else { -0.01 })
    };
    format!("t,x\n{}", (0..11).map(row).collect::<String>())
}

/// Of a product only the product is known; an unknown that nothing reads is not known at all.
#[test]
fn unknowns_that_data_do_not_determine_are_named() {
    let text = format!(
        "{DECAY}free p in [0.1, 9] guess 1\nfree q in [0.1, 9] guess 1\nfree r in [0, 1] guess \
         0.5\nfree y in [0, 9] guess 1\ndynamics {{ x' = -p*q*x*(1 + 0*y) }}\nfit obs: x sd 0.01\n\
         end r*x >= -1"
    );
    let found = estimates(&text, &decay());
    assert!(found.is_minimum, "{found:#?}");
    assert_eq!(found.undetermined, [vec!["p", "q"], vec!["r"], vec!["y"]]);
    assert!(found.unknowns.iter().all(|it| it.standard_error.is_none()));
    assert_eq!(found.degrees_of_freedom, Some(10));
}

/// The exact second derivative, errors of the model included: `J'' = 2 sum (t^2 y^2 + (y - x) t^2
/// y)/sd^2` of `y = exp(-p t)`.
#[test]
fn the_hessian_is_exact() {
    let text = format!(
        "{DECAY}free p in [0.1, 9] guess 1\ndynamics {{ x' = -p*x }}\nfit obs: x sd 0.01\n\
         method {{ grid N = 40 scheme radau3 }}"
    );
    let found = estimates(&text, &decay());
    let p = estimate(&found, "p").value;
    let data = decay();
    let rows = data.lines().skip(1).map(|line| line.split_once(',').expect("two columns"));
    let rows = rows.map(|(t, x)| [t, x].map(|it| it.parse::<f64>().expect("a number")));
    let second = |[t, x]: [f64; 2]| {
        let y = (-p * t).exp();
        2.0 * (t * t * y * y + (y - x) * t * t * y) / 1e-4
    };
    let second: f64 = rows.map(second).sum();
    let expected = (2.0 / second).sqrt();
    assert!((error(&found, "p") - expected).abs() < 1e-6 * expected);
}

/// What remains determined beside it keeps its error.
#[test]
fn others_keep_their_errors() {
    let alone =
        format!("{DECAY}free p in [0.1, 9] guess 1\ndynamics {{ x' = -p*x }}\nfit obs: x sd 0.01");
    let alone = estimates(&alone, &decay());
    let both = format!(
        "{DECAY}free p in [0.1, 9] guess 1\nfree r in [0, 1] guess 0.5\ndynamics {{ x' = -p*x \
         }}\nend r*x >= -1\nfit obs: x sd 0.01"
    );
    let both = estimates(&both, &decay());
    assert!(is_near(error(&both, "p"), error(&alone, "p")));
    assert_eq!(both.undetermined, [vec!["r"]]);
}

/// The optimum would be beyond the bound.
#[test]
fn an_unknown_at_its_bound_is_held_there() {
    let text = format!(
        "{DECAY}free p in [0.1, 0.6] guess 0.5\nfree c in [0.5, 2] guess 1\ndynamics {{ x' = -p*x \
         }}\nfit obs: x*c = x sd 0.01\nmethod {{ grid N = 40 scheme radau3 }}"
    );
    let found = estimates(&text, &decay());
    let (p, c) = (estimate(&found, "p"), estimate(&found, "c"));
    assert!(p.is_at_bound && p.standard_error.is_none(), "{p:?}");
    // Linear in c: sd / sqrt(sum x^2) along exp(-0.6 t).
    let squares: f64 = (0..11).map(|k| (-1.2 * 0.2 * f64::from(k)).exp()).sum();
    let expected = 0.01 / squares.sqrt();
    let got = c.standard_error.expect("c is free");
    assert!((got - expected).abs() < 1e-4 * expected, "{got} {expected}");
    assert_eq!(found.degrees_of_freedom, Some(10));
}

/// Three measurements of `b`, beside an unknown `k` that an objective pulls to its lower bound: `b`
/// is their mean, with the error `s/sqrt(3)` and `s^2 = sum of (x - b)^2 / 2`.
fn beside_a_bound(k: &str, pull: &str) -> Estimates {
    let text = format!(
        "data obs = csv(\"a.csv\") columns t, x\nfree k in {k} guess 2\nfree b in [-1, 1] guess \
         0\ntime t in [0, 1]\nstate x start 0\ndynamics {{ x' = 0 }}\nminimize sum(r in obs, \
         (x(r.t) + b - r.x)^2) + {pull}\nmethod {{ solver = interior_point scheme = gauss3 grid \
         N = 5 }}"
    );
    estimates(&text, "t,x\n0.2,0.1\n0.5,0.12\n0.8,0.09\n")
}

fn expect_mean(found: &Estimates, of: &str) {
    assert!(found.is_minimum && found.degrees_of_freedom == Some(2), "{of}: {found:#?}");
    let k = estimate(found, "k");
    assert!(k.is_at_bound && k.standard_error.is_none(), "{of}: {k:?}");
    let mean = 0.31 / 3.0;
    let rest: f64 = [0.1, 0.12, 0.09].iter().map(|x| (x - mean) * (x - mean)).sum();
    let expected = (rest / 2.0 / 3.0).sqrt();
    assert!((error(found, "b") - expected).abs() < 1e-6 * expected, "{of}: {found:#?}");
}

/// A bound of 0, at which an unknown has no size of its own, is a bound like others.
#[test]
fn an_unknown_at_a_bound_of_zero_is_held_there() {
    for k in ["[1, 5]", "[0, 5]", "[0, 1e9]", "[0, inf]"] {
        expect_mean(&beside_a_bound(k, "10*k + k^2"), k);
    }
}

/// Where the objective is concave along an unknown at its bound, the other directions decide.
#[test]
fn what_a_bound_forbids_needs_no_curvature() {
    for (k, pull) in [("[1, 5]", "10*k - k^2"), ("[0, 5]", "10*k - k^2"), ("[0, 5]", "10*k")] {
        expect_mean(&beside_a_bound(k, pull), k);
    }
}

/// Two experiments, a phase for each, share an unknown.
#[test]
fn phases_share_unknowns() {
    let phase = |name: &str, start: f64| {
        format!(
            "phase {name} {{ time t in [0, 2]\nstate x start {start}\ndynamics {{ x' = -p*x \
             }}\nfit obs: x sd 0.01 }}\n"
        )
    };
    let text = format!(
        "data obs = csv(\"a.csv\") columns t, x\nfree p in [0.1, 9] guess 1\n{}{}",
        phase("one", 1.0),
        phase("two", 1.0)
    );
    let both = estimates(&text, &decay());
    let alone =
        format!("{DECAY}free p in [0.1, 9] guess 1\ndynamics {{ x' = -p*x }}\nfit obs: x sd 0.01");
    let alone = estimates(&alone, &decay());
    assert!(is_near(error(&both, "p") * 2.0_f64.sqrt(), error(&alone, "p")));
    let phases: Vec<Option<&str>> = both.residuals.iter().map(|it| it.phase.as_deref()).collect();
    assert_eq!((phases, both.rows), (vec![Some("one"), Some("two")], 22));
}

/// A fit outside of all phases reads them by their names.
#[test]
fn a_fit_of_several_phases_may_stand_outside() {
    let phase = |name: &str| {
        format!("phase {name} {{ time t in [0, 2]\nstate x start 1\ndynamics {{ x' = -p*x }} }}\n")
    };
    let text = |goal: &str| {
        let data = "data obs = csv(\"a.csv\") columns t, x\nfree p in [0.1, 9] guess 1\n";
        format!("{data}{}{}{goal}", phase("one"), phase("two"))
    };
    let fit = estimates(&text("fit obs: one.x sd 0.01, two.x sd 0.01"), &decay());
    let sums = text(
        "minimize sum(k in obs, ((one.x(k.t) - k.x)/0.01)^2) + sum(k in obs, ((two.x(k.t) - \
         k.x)/0.01)^2)",
    );
    let sums = estimates(&sums, &decay());
    assert_eq!((fit.rows, sums.rows), (22, 22));
    assert!(is_near(estimate(&fit, "p").value, estimate(&sums, "p").value));
    let deviation = sums.deviation.expect("there are enough rows");
    assert!(is_near(error(&fit, "p") * deviation, error(&sums, "p")));
}

/// One experiment goes on through two phases whose border is unknown: each row is one of the phase
/// in which it is, wherever that is at the start. The rows lie on two lines exactly.
#[test]
fn rows_of_one_experiment_belong_to_the_phase_that_has_their_time() {
    let value = |t: f64| if t < 1.7 { 2.0 * t } else { 3.4 - (t - 1.7) };
    let rows = (0..=16).map(|row| 0.25 * f64::from(row));
    let rows: String = rows.map(|t| format!("{t},{}\n", value(t))).collect();
    for (border, unknowns) in [("free T in [0.3, 3.7] guess 2.6", 3), ("const T = 1.7", 2)] {
        for goal in ["fit obs: x sd 0.1", "minimize sum(k in obs, (x(k.t) - k.x)^2)"] {
            let text = format!(
                "data obs = csv(\"a.csv\") columns t, x\n{border}\n
                free a in [-9, 9] guess 1\nfree b in [-9, 9] guess 0\nstate x start 0
                phase up {{ time t in [0, T]  dynamics {{ x' = a }} }}
                phase down {{ time t in [T, 4]  dynamics {{ x' = b }} }}
                link up -> down {{}}\n{goal}"
            );
            let found = estimates(&text, &format!("t,x\n{rows}"));
            for (name, value) in [("a", 2.0), ("b", -1.0), ("T", 1.7)].iter().take(unknowns) {
                assert!(is_near(estimate(&found, name).value, *value), "{found:#?}");
            }
            assert_eq!((found.rows, found.unknowns.len()), (17, unknowns), "{text}");
        }
    }
}

/// What is expected of sums over rows of several phases.
#[test]
fn expectations_read_sums_of_phases() {
    let text = "data obs = csv(\"a.csv\") columns t, x\nfree p in [0.1, 9] guess 1\n\
                phase one { time t in [0, 2]\nstate x start 1\ndynamics { x' = -p*x } }\n\
                phase two { time t in [0, 2]\nstate x start 2\ndynamics { x' = -p*x } }\n\
                let a = sum(k in obs, (one.x(k.t) - k.x)^2)\n\
                let b = sum(k in obs, (two.x(k.t) - k.x)^2)\nminimize a + b\nexpect { a >= 0\n\
                a + b >= 1 }";
    let data = decay();
    let files = DataFiles::from(move |_| Ok(data.clone()));
    let model = fdcc::check_with("a test", text.into(), Some(files)).model.expect("a right model");
    let solution = model.solve(&Options::default()).expect("it is solved");
    let left = |it: &fdcc::Expectation| match &it.outcome {
        fdcc::Expected::Compared(sides) => sides.left,
        fdcc::Expected::Untold(why) => panic!("{why:?}"),
    };
    let found: Vec<f64> = solution.expectations().iter().map(left).collect();
    assert!(is_near(found[1], solution.objective()), "{found:?} {}", solution.objective());
    assert!(found[0] > 0.0 && found[0] < found[1], "{found:?}");
}

/// A robust loss is no sum of squares, also where it is written as one, and a sum that is maximised
/// neither: to the square of `(x - y)^2` an error of `y` does not add.
#[test]
fn other_objectives_say_nothing_of_errors() {
    let data = decay();
    let losses = [
        "log(1 + ((x(k.t) - k.x)/0.01)^2)",
        "(x(k.t) - k.x)^4",
        "tanh((x(k.t) - k.x)/0.01)^2",
        "(sqrt(1 + (x(k.t) - k.x)^2) - 1)^2",
        "max(abs(x(k.t) - k.x) - 0.001, 0)^2",
    ];
    let losses = losses.map(|it| format!("minimize sum(k in obs, {it})"));
    for goal in losses.iter().map(String::as_str).chain(["minimize p^2"]) {
        let text = format!("{DECAY}free p in [0.1, 9] guess 1\ndynamics {{ x' = -p*x }}\n{goal}");
        let data = data.clone();
        let files = DataFiles::from(move |_| Ok(data.clone()));
        let model =
            fdcc::check_with("a test", text.into(), Some(files)).model.expect("a right model");
        assert!(model.solve(&Options::default()).expect("it is solved").estimates().is_none());
    }
}

/// Squares in which an error of what was measured adds to the root are least squares in whatever
/// words: the same standard error.
#[test]
fn least_squares_are_known_in_other_words() {
    let fit = |term: &str| {
        let text = format!(
            "{DECAY}free p in [0.1, 9] guess 1\ndynamics {{ x' = -p*x }}\n\
             minimize sum(k in obs, ({term})^2)"
        );
        error(&estimates(&text, &decay()), "p")
    };
    let plain = fit("x(k.t) - k.x");
    for term in ["-(k.x - x(k.t))", "abs(x(k.t) - k.x)", "3*(x(k.t) + 1 - (k.x + 1))"] {
        assert!(is_near(fit(term), plain), "{term}: {} and {plain}", fit(term));
    }
    // Relative errors are others.
    for [one, other] in [
        ["log(x(k.t)) - log(k.x)", "log(x(k.t)/k.x)"],
        ["(x(k.t) - k.x)/x(k.t)", "1 - k.x/x(k.t)"],
        ["x(k.t)/k.x - 1", "(x(k.t) - k.x)/k.x"],
    ] {
        assert!(is_near(fit(one), fit(other)), "{one}: {}, {other}: {}", fit(one), fit(other));
    }
}

/// The measurements of `models/slider_fit.fdc` were made with mu = 0.3 and m = 2, and with the
/// deviations that the model states.
#[test]
fn the_truth_is_within_three_standard_errors() {
    let path = fdcc_tests::repository().join("models/slider_fit.fdc");
    let model = fdcc::Model::from_file(&path.display().to_string()).expect("the model is there");
    let solution = model.solve(&Options::default()).expect("it can be solved");
    let found = solution.estimates().expect("it is a fit");
    for (name, truth) in [("mu", 0.3), ("m", 2.0)] {
        let (it, error) = (estimate(&found, name), error(&found, name));
        assert!((it.value - truth).abs() < 3.0 * error, "{name} {} +- {error}", it.value);
        assert!(error < 0.02 * truth, "{name} {} +- {error}", it.value);
    }
    assert_eq!((found.rows, found.degrees_of_freedom), (42, Some(40)));
    let deviation = found.deviation.expect("there are enough rows");
    assert!((0.7..1.3).contains(&deviation), "{deviation}");
}

/// Every mistake that a fit alone can have, with its code and the beginning of its message.
const MISTAKES: [(&str, &str, &str); 10] = [
    ("fit obs: x sd 1, x sd 1", "FDC0102", "`x` is fitted twice"),
    ("fit obs: x sd -1", "FDC0109", "a standard deviation is above 0"),
    ("fit obs: q sd 1", "FDC0110", "`obs` has no column `q`"),
    ("fit obs: x + 1 sd 1", "FDC0110", "in which column of `obs` is `x + 1`?"),
    ("fit obs: x = z sd 1", "FDC0110", "`obs` has no column `z`"),
    ("fit a: x sd 1", "FDC0103", "`a` is a free unknown, not a data set"),
    ("fit obs: x sd a", "FDC0109", "`a` has no meaning in a standard deviation"),
    ("fit obs: x", "FDC0002", "`sd` with a standard deviation is missing after `x`"),
    ("fit obs: x sd 1\nmaximize a", "FDC0109", "a fit makes squares small, and the objective"),
    (
        "data more = csv(\"a.csv\") columns x\nfit more: x sd 1",
        "FDC0110",
        "`more` has no column `t`",
    ),
];

#[test]
fn mistakes_in_a_fit_are_told() {
    for (line, code, message) in MISTAKES {
        let files = DataFiles::from(|_: &str| Ok("t,x,s\n0,1,1\n".to_owned()));
        let text = format!("{LINE}{line}");
        let checked = fdcc::check_with("a test", text.into(), Some(files));
        let found: Vec<(&str, &str)> =
            checked.diagnostics.iter().map(|it| (it.code.as_str(), it.message.as_str())).collect();
        let is_it = |it: &(&str, &str)| it.0 == code && it.1.starts_with(message);
        assert!(found.iter().any(is_it), "{line}: {found:#?}");
    }
}

/// A simulation has the sum of the squares of what remains with the guess of the unknowns; its
/// gradient is refused, and that is told of the command that refuses it.
#[test]
fn a_fit_is_simulated_and_not_differentiated_yet() {
    let files = DataFiles::from(|_| Ok("t,x\n0,0.5\n1,2\n2,1\n".to_owned()));
    let text = "data obs = csv(\"a.csv\") columns t, x\nfree p in [0, 9] guess 1.5\n\
                time t in [0, 2]\nstate x start 0\ndynamics { x' = p }\nfit obs: x sd 2";
    let model = fdcc::check_with("a test", text.into(), Some(files)).model.expect("it is right");
    let simulation = model.simulate(&fdcc::Controls::Guess, &fdcc::Accuracy::default());
    let objective = simulation.expect("it can be simulated").result.objective;
    let squares = 0.25 * (0.25 + 0.25 + 4.0);
    assert!((objective.expect("it has one") - squares).abs() < 1e-12, "{objective:?}");
    let gradient = fdcc_compiler::compile_sensitivities(model.meaning());
    let Err(refused) = gradient else { panic!("it is refused") };
    assert!(refused[0].message.contains("differentiated"), "{refused:#?}");
    assert!(refused[0].labels[0].text.starts_with("understood by `solve`"), "{refused:#?}");
}

/// An active condition forbids a direction as an equation does.
#[test]
fn an_active_inequality_counts_as_an_equation() {
    let rows = "t,x\n0.2,0.3\n0.5,0.8\n1,1.1\n1.5,1.9\n2,2.3\n";
    let fitted = |end: &str| {
        let text = format!(
            "data obs = csv(\"a.csv\") columns t, x\nfree a in [0, 9] guess 1\n\
             time t in [0, 2]\nstate x start free in [-1, 1]\ndynamics {{ x' = a }}\n\
             end x {end} 2\nfit obs: x sd 0.1"
        );
        let files = DataFiles::from(|_| Ok(rows.to_owned()));
        let model = fdcc::check_with("a test", text.into(), Some(files)).model.expect("right");
        model.solve(&Options::default()).expect("it can be solved").estimates().expect("a fit")
    };
    let (equal, active) = (fitted("=="), fitted("<="));
    assert_eq!(equal.degrees_of_freedom, Some(4));
    assert_eq!(active.degrees_of_freedom, equal.degrees_of_freedom);
    let [a, b] = [&equal, &active].map(|it| it.unknowns[0].standard_error.expect("it has one"));
    assert!((a / b - 1.0).abs() < 1e-4, "{a} {b}");
}

/// Michaelis and Menten: `Vm t = S0 - S + Km log(S0/S)`, without an error. From signals that are
/// guessed apart from each other a grid allows a trajectory with `Km` at its bound; from the motion
/// of the guess the data lead to what they were made with.
#[test]
fn a_fit_without_controls_also_begins_where_the_guess_leads_to() {
    let (rate, half) = (0.8, 0.6);
    let table = move |start: f64, last: f64| {
        let row = |k: i32| {
            let left = start * (last / start).powf(f64::from(k) / 20.0);
            let time = (start - left + half * (start / left).ln()) / rate;
            format!("{time},{left}\n")
        };
        format!("t,S\n{}", (1..=20).map(row).collect::<String>())
    };
    let files = DataFiles::from(move |name: &str| {
        Ok(if name == "low.csv" { table(1.0, 0.01) } else { table(5.0, 0.01) })
    });
    let text = "data low = csv(\"low.csv\") columns t, S
        data high = csv(\"high.csv\") columns t, S
        free Vm in [0.1, 10] guess 1
        free Km in [0.05, 10] guess 1
        phase a { time t in [0, 6]  state S start 1  dynamics { S' = -Vm*S/(Km + S) }
            fit low: S sd 0.02 }
        phase b { time t in [0, 12]  state S start 5  dynamics { S' = -Vm*S/(Km + S) }
            fit high: S sd 0.02 }";
    let checked = fdcc::check_with("a test", text.into(), Some(files));
    let model = checked.model.unwrap_or_else(|| panic!("{:#?}", checked.diagnostics));
    let solution = model.solve(&Options::default()).expect("it can be solved");
    let found: Vec<f64> = solution.unknowns().map(|it| it.1).collect();
    assert!(solution.is_solved() && solution.objective() < 1e-6, "{:?}", solution.objective());
    assert!((found[0] - rate).abs() < 1e-5 && (found[1] - half).abs() < 1e-5, "{found:?}");
}
