//! How optima move with parameters: by closed forms, and as two optima beside each other differ.

use fdcc::{Model, Options, ParametricSensitivity, Solution};
use fdcc_tests::repository;

fn model(text: &str) -> Model {
    Model::from_text("moved", text).expect("it has no mistakes")
}

fn solved(model: &Model) -> Solution {
    let found = model.solve(&Options::default()).expect("it can be solved");
    assert!(found.is_solved(), "{:?} {:?}", found.status(), found.certificate);
    found
}

fn by(solution: &Solution, name: &str) -> ParametricSensitivity {
    solution.parametric_sensitivity(name).unwrap_or_else(|it| panic!("{name}: {it:?}"))
}

fn column<'c>(columns: &'c [(String, Vec<f64>)], name: &str) -> &'c [f64] {
    let found = columns.iter().find(|it| it.0 == name);
    &found.unwrap_or_else(|| panic!("there is no `{name}`")).1
}

/// `T = 2 sqrt(d U/(U^2 - mu^2))` from rest to rest, and the force turns at `(U + mu)/(2 U) T`.
#[test]
fn the_time_and_the_switch_of_a_block_move() {
    let (d, u, mu) = (1.0, 2.0, 0.5_f64);
    let gap: f64 = u * u - mu * mu;
    let time = 2.0 * (d * u / gap).sqrt();
    let part = (u + mu) / (2.0 * u);
    let path = repository().join("models/coulomb_rest.fdc");
    let solution = solved(&Model::from_file(&path.display().to_string()).expect("it is there"));
    let of_time = [
        ("d", time / (2.0 * d), 0.0),
        ("U", -time * (u * u + mu * mu) / (2.0 * u * gap), -mu / (2.0 * u * u)),
        ("mu", time * mu / gap, 1.0 / (2.0 * u)),
    ];
    for (name, slope, of_part) in of_time {
        let found = by(&solution, name);
        let own = found.unknowns.iter().find(|it| it.0 == "T").expect("it is unknown").1;
        assert!((own - slope).abs() < 1e-7, "{name}: {own} {slope}");
        let (at, moved) = found.junctions[0];
        assert!((at - part * time).abs() < 1e-7, "{at}");
        let expected = part * slope + of_part * time;
        assert!((moved - expected).abs() < 1e-7, "{name}: {moved} {expected}");
    }
}

/// `x'' = u` to `x(1) = a`, at rest: `u = 6 a (1 - 2 t)` and `x = a (3 t^2 - 2 t^3)`.
#[test]
fn signals_move_at_times_that_stay() {
    let text = "param a = 2 param T = 1 time t in [0, T] state x start 0 state v start 0 control u
        dynamics { x' = v  v' = u } end x == a end v == 0 minimize integral(u^2)";
    let solution = solved(&model(text));
    let by_a = by(&solution, "a");
    let own = &by_a.phases[0];
    for (t, by) in own.time.iter().zip(column(&own.states, "x")) {
        assert!((by - t * t * (3.0 - 2.0 * t)).abs() < 1e-8, "{t}: {by}");
    }
    // x = a (3 s^2 - 2 s^3) with s = t/T, and u = 6 a (1 - 2 s)/T^2.
    let by_time = by(&solution, "T");
    let own = &by_time.phases[0];
    for (t, by) in own.time.iter().zip(column(&own.states, "x")) {
        let slope = -2.0 * (6.0 * t * t - 6.0 * t.powi(3));
        assert!((by - slope).abs() < 1e-6, "{t}: {by} {slope}");
    }
    for (pair, by) in own.time.windows(2).zip(column(&own.controls, "u")) {
        let t = 0.5 * (pair[0] + pair[1]);
        let slope = 12.0 * (-2.0 * (1.0 - 2.0 * t) + 2.0 * t);
        assert!((by - slope).abs() < 1e-5, "{t}: {by} {slope}");
    }
}

/// `x = a t` and `u = a` whatever the unit and the range of `a` are; in SI.
#[test]
fn units_and_ranges_of_parameters_do_not_matter() {
    let cases = [("a = 50 [cm]", "[m]"), ("a = 2 [km] in [2, 3]", "[km]"), ("a = 0 in [0, 1]", "")];
    for (a, unit) in cases {
        let text = format!(
            "param {a} time t in [0, 1] state x {unit} start 0 control u {unit}
             dynamics {{ x' = u }} end x == a minimize integral(u^2)"
        );
        let by_a = by(&solved(&model(&text)), "a");
        let own = &by_a.phases[0];
        for (t, by) in own.time.iter().zip(column(&own.states, "x")) {
            assert!((by - t).abs() < 1e-6, "{text} {t}: {by}");
        }
    }
}

/// What `value` reads of optima beside each other, and its slope.
fn difference(
    of: &Model,
    name: &str,
    value: f64,
    read: &dyn Fn(&Solution) -> Vec<f64>,
) -> Vec<f64> {
    let step = 1e-4 * value.abs();
    let at = |value: f64| read(&solved(&of.with(name, value).expect("it is a parameter")));
    let [far_below, below] = [at(value - 2.0 * step), at(value - step)];
    let [above, far_above] = [at(value + step), at(value + 2.0 * step)];
    let near = above.iter().zip(&below).map(|(a, b)| (a - b) / (2.0 * step));
    let far = far_above.iter().zip(&far_below).map(|(a, b)| (a - b) / (4.0 * step));
    near.zip(far).map(|(near, far)| near + (near - far) / 3.0).collect()
}

/// The last states.
fn read(solution: &Solution) -> Vec<f64> {
    let states = solution.outcome.trajectory.states.iter().zip(&solution.problem.states);
    states.filter(|it| !it.1.hidden).map(|it| it.0[it.0.len() - 1]).collect()
}

/// `T = d/top + top/a` at the limit of the speed, which is reached at `top/a`. Whatever else an
/// answer divides its time at leaves the optimum open.
#[test]
fn arcs_move_with_their_limits() {
    let text = "param top = 0.6 param a = 1 free T in [0.5, 9] guess 3 time t in [0, T]
        state x start 0 state v in [-1, top] start 0 control u in [-a, a]
        dynamics { x' = v  v' = u } end x == 1 end v == 0 minimize T";
    let solution = solved(&model(text));
    let (top, a) = (0.6, 1.0);
    let time = 1.0 / top + top / a;
    let cases =
        [("top", -1.0 / (top * top) + 1.0 / a, 1.0 / a), ("a", -top / (a * a), -top / (a * a))];
    for (name, of_time, reached) in cases {
        let found = by(&solution, name);
        assert!((found.unknowns[0].1 - of_time).abs() < 1e-7, "{name}: {found:?}");
        let moves = |at: f64| {
            let junction = found.junctions.iter().find(|it| (it.0 - at).abs() < 1e-6);
            junction.unwrap_or_else(|| panic!("none at {at}: {:?}", found.junctions)).1
        };
        assert!((moves(top / a) - reached).abs() < 1e-7, "{name}");
        assert!((moves(time - top / a) - (of_time - reached)).abs() < 1e-7, "{name}");
    }
}

/// Friction that is held and left, a bounce, and a discretised problem.
#[test]
fn it_is_what_optima_beside_each_other_say() {
    let stick = "param mu = 0.4 param d = 1 time t in [0, 2] state x start 0 state v start -0.5
        control F in [-2, 2] surface slip = v
        dynamics { x' = v  v' in F - mu*Sgn(slip) }
        minimize integral(F^2) + (x(end) - d)^2";
    let bounce = "param e = 0.7 time t in [0, 1.5] state h start 1 state v start 0
        control u in [-3, 3] surface floor = h dynamics { h' = v  v' = u - 9.81 }
        jump bounce on floor falling at most 1 { v := -e*v }
        minimize integral(u^2) + 20*(h(end) - 0.8)^2";
    let smooth = "param a = 2 time t in [0, 1] state x start 1 control u in [-1, 1]
        dynamics { x' = -a*x^3 + u } minimize integral(x^2 + u^2) + x(end)^2 method { N = 20 }";
    for (text, name, value) in
        [(stick, "mu", 0.4), (stick, "d", 1.0), (bounce, "e", 0.7), (smooth, "a", 2.0)]
    {
        let model = model(text);
        let found = by(&solved(&model), name);
        let last = found.phases[0].states.iter().map(|it| it.1[it.1.len() - 1]);
        let last: Vec<f64> = last.collect();
        let expected = difference(&model, name, value, &read);
        assert_eq!(last.len(), expected.len(), "{text}");
        let size = expected.iter().fold(0.0, |a: f64, it| a.max(it.abs()));
        for (own, other) in last.iter().zip(&expected) {
            assert!((own - other).abs() < 2e-5 * size, "{text} {name}: {last:?} {expected:?}");
        }
    }
}

/// What has no derivative says why. A block that is pushed over a distance and rests may be so at
/// any time: `F = k (c - t)` for the time that it takes, and nothing says when it begins.
#[test]
fn what_has_no_derivative_says_why() {
    let any_time = "param mu = 0.4 time t in [0, 6] state x start 0 state v start 0
        control F in [-2, 2] surface slip = v
        dynamics { x' = v  v' in F - mu*Sgn(slip) } end x == 1 minimize integral(F^2)";
    let refused = solved(&model(any_time)).parametric_sensitivity("mu").expect_err("there is none");
    assert!(format!("{refused}").contains("no strict minimum"), "{refused}");

    let kinked = "param a = 0 time t in [0, 1] state x start 0 control u end x == 1
        dynamics { x' = u + abs(a) } minimize integral(u^2)";
    let solution = solved(&model(kinked));
    for (name, why) in [("a", "has a kink"), ("b", "there is no parameter")] {
        let refused = solution.parametric_sensitivity(name).expect_err("there is none");
        assert!(format!("{refused}").contains(why), "{refused}");
    }
}
