//! The true optimum of models with phases: every switch and arc located in each of them, all solved
//! at once.

use fdcc::{Executor, Expectation, Expected, Model, Options, Solution};
use fdcc_tests::repository;

fn solved(text: &str) -> Solution {
    let model = Model::from_text("model", text).expect("it is right");
    model.solve(&Options::default()).expect("it is solved")
}

fn holds(expectation: &Expectation) -> bool {
    matches!(&expectation.outcome, Expected::Compared(sides) if sides.holds)
}

/// The models of a folder of `tests/classics`.
fn models(folder: &str) -> Vec<(String, String)> {
    let folder = repository().join("tests/classics").join(folder);
    let files = std::fs::read_dir(folder).expect("the folder is there");
    let paths = files.map(|it| it.expect("it can be read").path());
    let mut paths: Vec<_> =
        paths.filter(|it| it.extension().is_some_and(|it| it == "fdc")).collect();
    paths.sort();
    let read = |path: std::path::PathBuf| {
        let name = path.file_stem().expect("it has a name").to_string_lossy().into_owned();
        (name, std::fs::read_to_string(path).expect("it can be read"))
    };
    paths.into_iter().map(read).collect()
}

/// Where a phase is divided, those behind it stand elsewhere, with other numbers of states. The
/// middle phase is passed at `v = y`: `T = (3 - y + y^2)/(2 y)`, and `y = 1` is the bound.
#[test]
fn phases_of_several_sizes_are_divided() {
    let driven = "control u in [-1, 1] dynamics { x' = v  v' = u  w' = u }";
    let text = format!(
        "model sizes
         free T in [0.5, 5] guess 2
         phase a {{ time t in [0, T] state x start 0 state v in [0, 1] start 0 state w start 0
           {driven} }}
         phase b {{ time t in [T, T + 1] state x state v dynamics {{ x' = v  v' = 0 }} }}
         phase c {{ time t in [T + 1, 2*T + 1] state x state v in [0, 1] state w start 0 {driven} }}
         link a -> b {{ same }}
         link b -> c {{ same }}
         end c.x == 3
         end c.v == 0
         minimize T + 0.1*c.w(end)^2"
    );
    let solution = solved(&text);
    let objective = solution.objective();
    assert!(solution.is_certified() && (objective - 1.6).abs() < 1e-8, "{objective}");
}

/// Closed forms, and `tests/peers/phases_friction.py`, are in what each model expects.
#[test]
fn switches_are_located_in_every_phase() {
    let all = models("switched_phases");
    assert!(all.len() >= 4);
    for (name, text) in all {
        let solution = solved(&text);
        let certificate = solution.certificate.as_ref().expect("something switches");
        assert!(certificate.is_certified(), "{name}: {certificate:?}");
        let expected = solution.expectations();
        assert!(!expected.is_empty() && expected.iter().all(holds), "{name}");
        let is_of_phase = |name: &str| {
            solution.phases().iter().any(|it| name.starts_with(&format!("{}.", it.problem.name)))
        };
        assert!(certificate.switches.iter().all(|it| is_of_phase(&it.surface)));
    }
}

/// Without a number of intervals the objectives are those of `tests/peers/phases.csv`.
#[test]
fn smooth_phases_end_in_continuous_time() {
    let table = std::fs::read_to_string(repository().join("tests/peers/phases.csv"));
    let table = table.expect("the table is there");
    let all = models("phases");
    let wrong = |(name, text): &(String, String)| {
        let solution = solved(&without_method(text));
        let row = table.lines().find_map(|it| it.strip_prefix(&format!("{name},objective,")));
        let known = row.and_then(|it| it.split(',').next()).and_then(|it| it.parse::<f64>().ok());
        let known = known.expect("each has a row");
        let difference = (solution.objective() - known).abs() / known.abs().max(1.0);
        let is_right = solution.is_certified() && difference <= 1e-6;
        (!is_right).then(|| format!("{name}: {} {known}", solution.objective()))
    };
    let wrong = Executor::default().in_order(all.len(), |it| wrong(&all[it]), |_| false);
    let wrong: Vec<_> = wrong.into_iter().flatten().collect();
    assert!(wrong.is_empty(), "{wrong:#?}");
}

/// Conditions at times divide time as phases do; the closed forms are in what each model expects.
#[test]
fn conditions_at_times_are_met_in_continuous_time() {
    for (name, text) in models("at_times") {
        let solution = solved(&without_method(&text));
        assert!(solution.is_certified(), "{name}: {:?}", solution.certificate);
        assert!(solution.phases().is_empty(), "{name}: one trajectory");
        assert!(solution.expectations().iter().all(holds), "{name}");
        let rows: usize = solution.model().meaning().at_times.iter().map(|it| it.rows.len()).sum();
        assert_eq!(solution.at_multipliers().len(), rows);
        let certificate = solution.certificate.as_ref().expect("it is certified");
        assert!(certificate.arcs.iter().all(|(control, _)| !control.contains(&name)));
    }
}

/// Leaves out all blocks `method { ... }`, which have no braces inside.
fn without_method(text: &str) -> String {
    let mut rest = text;
    let mut all = String::new();
    while let Some(begin) = rest.find("method {") {
        all += &rest[..begin];
        let block = &rest[begin..];
        rest = &block[block.find('}').expect("a block ends") + 1..];
    }
    all + rest
}

/// A tank that is empty stays so: the last node of a phase lies before its end, and a limit holds
/// behind it, too. The rocket has a closed form: full thrust for `(m0 - m1) c/F = 50` s, then none.
#[test]
fn a_limit_holds_to_the_end() {
    let rocket = |fuel: &str| {
        format!(
            "param c = 2500\ntime t in [0, 120]\nstate h start 0\nstate v start 0
            state m start 1500\ncontrol thrust in [0, 40000]
            dynamics {{ h' = v\n v' = thrust/m - 9.81\n m' = -thrust/c }}
            {fuel}\nmaximize h(end) + 80*v(end)"
        )
    };
    let (c, r, g) = (2500.0_f64, 1500.0_f64 / 700.0, 9.81);
    let height = c * 50.0 * (1.0 - r.ln() / (r - 1.0)) - g * 50.0 * 50.0 / 2.0;
    let speed = c * r.ln() - g * 50.0;
    let last = speed - g * 70.0;
    let known = height + speed * 70.0 - g * 70.0 * 70.0 / 2.0 + 80.0 * last;
    for fuel in ["path fuel: m >= 700", "end m >= 700"] {
        let solution = solved(&rocket(fuel));
        assert!(solution.is_certified(), "{fuel}: {:?}", solution.certificate);
        let difference = (solution.objective() / known - 1.0).abs();
        assert!(difference < 1e-7, "{fuel}: {} {known}", solution.objective());
    }
}

/// The slope of the optimum of a model with phases is that of two optima.
#[test]
fn sensitivities_of_phases_are_exact() {
    let text = std::fs::read_to_string(repository().join("models/twostage.fdc"));
    let text = without_method(&text.expect("it is there"));
    let model = Model::from_text("twostage", &text).expect("it is right");
    let at = |c: f64| {
        let model = model.with("c", c).expect("it is a parameter");
        let solution = model.solve(&Options::default()).expect("it is solved");
        assert!(solution.is_certified(), "{:?}", solution.certificate);
        solution
    };
    let slopes = at(2500.0);
    let slope = slopes.sensitivities().into_iter().find(|it| it.0 == "c").expect("it is there").1;
    let between = (at(2501.0).objective() - at(2499.0).objective()) / 2.0;
    assert!((slope / between - 1.0).abs() < 1e-5, "{slope} {between}");
}

/// A phase that begins held where the one before it ended, on a belt whose speed is a parameter, is
/// worth what the same motion in one piece is; and that what two optima say.
#[test]
fn a_hold_goes_on_through_a_link() {
    let motion = "surface slip = v - c control u in [-1, 1]
        dynamics { x' = v  v' in u - 2*Sgn(slip) }";
    let phases = format!(
        "param c = 0.5 phase one {{ time t in [0, 1] state x start 0 state v start 1 {motion} }}
         phase two like one {{ time t in [1, 2] }} link one -> two {{ same }}
         minimize integral(one.u^2) + integral(two.u^2) + two.x(end)^2"
    );
    let whole = format!(
        "param c = 0.5 time t in [0, 2] state x start 0 state v start 1 {motion}
         minimize integral(u^2) + x(end)^2"
    );
    let at = |text: &str, c: f64| {
        let model = Model::from_text("belt", text).expect("it is right");
        let model = model.with("c", c).expect("it is a parameter");
        let solution = model.solve(&Options::default()).expect("it is solved");
        assert!(solution.is_certified(), "{:?}", solution.certificate);
        (solution.objective(), solution.sensitivities()[0].1)
    };
    let [below, above] = [0.499, 0.501].map(|c| at(&phases, c).0);
    let between = (above - below) / 0.002;
    for text in [&phases, &whole] {
        let slope = at(text, 0.5).1;
        assert!((slope / between - 1.0).abs() < 1e-5, "{text}: {slope} {between}");
    }
}

/// A ball that is set rolling at once: `2*(R w)^2/5 + v^2 = 7/5 36` whatever its radius is.
#[test]
fn a_chosen_start_follows_the_surface() {
    let text = "param R = 0.108 free v0 in [0, 12] guess 7 free w0 in [-50, 80] guess 10
        time t in [0, 3] state x start 0 state v start v0 state w start w0
        surface slip = v - R*w
        dynamics { x' = v  v' in -1.2*Sgn(slip)
          R*w' in 3*Sgn(slip) }
        end x == 18 minimize v0^2 + 0.4*(R*w0)^2";
    let solution = solved(text);
    assert!(solution.is_certified() && (solution.objective() - 50.4).abs() < 1e-7);
    let slope = solution.sensitivities()[0].1;
    assert!(slope.abs() < 1e-6, "{slope}");
}

/// The switch of `tests/classics/switched/ridge.fdc` is best at 2/3 and may come at any time: where
/// it happens just where a phase ends nothing in the phases moves it, and that is no optimum.
#[test]
fn a_switch_at_a_link_is_no_reason_to_stay_there() {
    let solution = solved(
        "state x start -0.5\ncontrol u in [-3, 3]\nend x == 1\nminimize integral(u^2)
        phase one { time t in [0, 0.74] surface top = x dynamics { x' in u + 0.5*Sgn(top) } }
        phase two like one { time t in [0.74, 2] }
        link one -> two { }",
    );
    assert!(!solution.is_certified(), "{} {:?}", solution.objective(), solution.certificate);
}

/// The limit is on the second derivative of the state that a control moves, and holds until the
/// first phase ends, where it is active: the least force through `(1, 0.5)` and `(2, 2)`, whose
/// Gram matrix is `(1/3, 5/6; 5/6, 8/3)`.
#[test]
fn a_limit_holds_at_the_last_time_of_a_phase() {
    let solution = solved(
        "state h start 0\nstate w start 0\ncontrol b in [-9, 9]
        phase first { time t in [0, 1] path h <= 0.5 }
        phase second { time t in [1, 2] }
        link first -> second { }
        dynamics { h' = w  w' = b }\nend h == 2\nminimize integral(b^2)",
    );
    assert!(solution.is_certified(), "{:?}", solution.certificate);
    assert!((solution.objective() - 12.0 / 7.0).abs() < 1e-8, "{}", solution.objective());
}
