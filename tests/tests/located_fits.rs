//! Fits of systems with friction and impacts: every switch is located, and rows go from one part of
//! time to the next with it.

use fdcc::{DataFiles, Model, Options, Solution};
use std::f64::consts::FRAC_PI_2;
use std::fmt::Write;

fn model(path: &str) -> Model {
    let path = fdcc_tests::repository().join(path);
    Model::from_file(&path.display().to_string()).expect("it has no mistake")
}

fn certified(model: &Model) -> Solution {
    let solution = model.solve(&Options::default()).expect("it can be solved");
    assert!(solution.is_certified(), "{:?}", solution.certificate);
    solution
}

fn assert_near(solution: &Solution, expected: &[(&str, f64)], tolerance: f64) {
    for (name, value) in expected {
        let found = match *name {
            "objective" => solution.objective(),
            name => solution.unknowns().find(|it| it.0 == name).expect("it is unknown").1,
        };
        let off = (found - value).abs() / value.abs();
        assert!(off < tolerance, "{name}: {found} instead of {value}");
    }
}

/// By `scipy.optimize.least_squares` over the closed form of the motion: `v = a t - b t^2` until it
/// is 0.
#[test]
fn friction_and_mass_are_those_of_the_true_motion() {
    let solution = certified(&model("models/slider_fit.fdc"));
    let expected = [("objective", 42.020_119_385_05), ("mu", 0.302_211_36), ("m", 1.988_294_47)];
    assert_near(&solution, &expected, 1e-8);
    let estimates = solution.estimates().expect("it is a fit");
    let [x, v] = &estimates.residuals[..] else { panic!("two signals were measured") };
    assert_eq!([x.values.len(), v.values.len()], [21, 21]);
    assert!(x.time.is_sorted() && x.time.len() == 21);
    assert!((estimates.sum_of_squares - solution.objective()).abs() < 1e-9);
    let replayed = solution.verify().expect("it can be replayed").simulation.objective;
    assert!((replayed.expect("it has one") - solution.objective()).abs() < 1e-7);
}

/// The same of a block that is pushed to and fro, of which `tests/classics/fits` has the values.
#[test]
fn a_force_through_measured_points_bends_where_intervals_meet() {
    let read = |name: &str| {
        let path = fdcc_tests::repository().join("tests/classics/fits").join(name);
        std::fs::read_to_string(path).expect("it is there")
    };
    let (text, data) = (read("slider_friction.fdc"), read("slider_friction.csv"));
    let method = text.lines().find(|it| it.starts_with("method")).expect("it names a width");
    let solution = certified(&with_data(&text.replace(method, ""), move |_| data.clone()));
    let expected = [("objective", 1.538_611_63e-4), ("mu", 0.250_201_184), ("v0", 1.201_914_60)];
    assert_near(&solution, &expected, 2e-8);
}

#[test]
fn bounces_are_located_where_heights_are_measured() {
    let solution = certified(&model("tests/classics/fits/bouncing_ball.fdc"));
    let expected =
        [("objective", 6.401_697_936_25e-4), ("e", 0.748_916_410_79), ("v0", 0.303_184_110_579)];
    assert_near(&solution, &expected, 1e-8);
    assert_eq!(solution.jumps.len(), 2);
    assert_eq!(solution.estimates().expect("it is a fit").rows, 35);
}

/// Two runs of `x'' = -4 x - 0.5 Sgn(x')`: half cycles of a cosine about +-1/8, each 1/4 smaller.
#[test]
fn runs_with_dry_friction_share_their_unknowns() {
    let phase = |name: &str, start: f64| {
        format!(
            "phase {name} {{ time t in [0, 3]  state x start {start}  state v start 0
                surface slip = v
                dynamics {{ x' = v  v' in -k*x - f*Sgn(slip) }} }}
             fit {name}_rows: {name}.x sd 0.01\n"
        )
    };
    let text = format!(
        "data one_rows = csv(\"one.csv\") columns t, x
         data two_rows = csv(\"two.csv\") columns t, x
         free k in [1, 10] guess 3.7\nfree f in [0, 2] guess 0.45\n{}{}",
        phase("one", 1.4),
        phase("two", -1.1)
    );
    let rows = |path: &str| measured(if path == "one.csv" { 1.4 } else { -1.1 });
    let solution = certified(&with_data(&text, rows));
    assert_near(&solution, &[("k", 4.0), ("f", 0.5)], 1e-8);
    assert_eq!(solution.estimates().expect("it is a fit").rows, 42);
}

fn with_data(text: &str, rows: impl Fn(&str) -> String + Send + Sync + 'static) -> Model {
    let files = DataFiles::from(move |path: &str| Ok(rows(path)));
    fdcc::check_with("fit", text.into(), Some(files)).model.expect("it has no mistake")
}

fn measured(start: f64) -> String {
    let mut rows = String::from("t,x\n");
    for row in 0..=20 {
        let t = 0.15 * f64::from(row);
        let half = (t / FRAC_PI_2).floor();
        let size = start.abs() - 0.25 * half;
        let side = if half % 2.0 == 0.0 { start.signum() } else { -start.signum() };
        let x = side * (0.125 + (size - 0.125) * (2.0 * (t - half * FRAC_PI_2)).cos());
        writeln!(rows, "{t:e},{x:e}").expect("a string has room");
    }
    rows
}

/// A mass on a spring and a belt: it slides until it is as fast as the belt, is held until the
/// spring pulls as much as friction, and slides from then on. At the first answer from the guess
/// the belt is always faster, and its speed means nothing; what the guess does is what happens.
#[test]
fn what_the_guess_does_is_fitted_too() {
    let (k, mu, belt) = (8.0_f64, 1.0, 0.3);
    let w = k.sqrt();
    let held = (belt * w / mu).asin() / w;
    let x_held = mu / k * (1.0 - (w * held).cos());
    let left = held + (mu / k - x_held) / belt;
    let position = |t: f64| match t {
        t if t < held => mu / k * (1.0 - (w * t).cos()),
        t if t < left => x_held + belt * (t - held),
        _ => mu / k + belt / w * (w * (t - left)).sin(),
    };
    let times = (0..31).map(|row| 0.08 * (f64::from(row) + 0.5));
    let rows: String = times.map(|t| format!("{t},{}\n", position(t))).collect();
    let text = "data obs = csv(\"a.csv\") columns t, x
        free mu in [0.1, 3] guess 0.8\nfree k in [1, 20] guess 7\nfree vb in [0.05, 1] guess 0.25
        time t in [0, 2.5] state x start 0 state v start 0 surface slip = v - vb
        dynamics { x' = v  v' in -k*x - mu*Sgn(slip) }
        fit obs: x sd 0.005";
    let solution = certified(&with_data(text, move |_| format!("t,x\n{rows}")));
    assert_near(&solution, &[("mu", mu), ("k", k), ("vb", belt)], 1e-7);
    let estimates = solution.estimates().expect("it is a fit");
    assert!(estimates.undetermined.is_empty(), "{:?}", estimates.undetermined);
    // That its selector is 1 where it is left follows from the equations, and forbids nothing.
    assert_eq!(estimates.degrees_of_freedom, Some(31 - 3));
}

/// A block that is pushed with 2 until `T = 1` and slides on, with friction 0.5 that brings it to
/// rest at 4. One experiment goes through both phases; rows at exact positions.
#[test]
fn one_experiment_goes_through_phases_with_friction() {
    let position = |t: f64| match t {
        t if t < 1.0 => 0.75 * t * t,
        t if t < 4.0 => 0.75 + 1.5 * (t - 1.0) - 0.25 * (t - 1.0).powi(2),
        _ => 3.0,
    };
    let rows = (0..=20).map(|row| 0.25 * f64::from(row) + 0.1);
    let rows: String = rows.map(|t| format!("{t},{}\n", position(t))).collect();
    let files = DataFiles::from(move |_| Ok(format!("t,x\n{rows}")));
    let text = "data obs = csv(\"a.csv\") columns t, x
        free mu in [0.1, 1.5] guess 0.8  free T in [0.4, 2] guess 1.3
        state x start 0  state v start 0
        phase push { time t in [0, T]  surface slip = v
            dynamics { x' = v  v' in 2 - mu*Sgn(slip) } }
        phase coast { time t in [T, 6]  surface slip = v
            dynamics { x' = v  v' in -mu*Sgn(slip) } }
        link push -> coast {}  fit obs: x sd 0.1";
    let model = fdcc::check_with("fit", text.into(), Some(files)).model.expect("it is right");
    let solution = certified(&model);
    assert_near(&solution, &[("mu", 0.5), ("T", 1.0)], 1e-5);
    assert!(solution.estimates().is_some_and(|it| it.rows == 21));
    let simulated = model.simulate_phases(Some(&solution.record()), &fdcc::Accuracy::default());
    let objective = simulated.expect("it can be simulated").objective.expect("it has one");
    assert!(objective < 1e-8 && solution.objective() < 1e-8, "{objective}");
}

/// Temperatures of a room between the levels 19 and 21 of its thermostat, every 0.1.
const ROOM: [f64; 40] = [
    18.5642, 18.8466, 19.183, 19.5108, 19.7928, 20.2446, 20.676, 20.8768, 20.6266, 20.1647,
    19.7489, 19.1431, 19.0853, 19.3946, 19.9286, 20.1126, 20.5866, 21.0105, 20.7024, 20.2086,
    19.8366, 19.3793, 18.9417, 19.4603, 19.9779, 20.102, 20.4485, 20.6953, 20.8505, 20.2264,
    19.7867, 19.5851, 18.9393, 19.4563, 19.8646, 20.0914, 20.4637, 20.9363, 20.8843, 20.3747,
];

/// As it is guessed seven switches happen, and eight with what the data were made with. By
/// `scipy.optimize.least_squares` over the closed form of the motion.
#[test]
fn switches_of_a_fit_are_those_near_its_guess() {
    let row = |(k, th): (usize, &f64)| format!("{},{th}\n", 0.1 * (k + 1) as f64);
    let rows = format!("t,th\n{}", ROOM.iter().enumerate().map(row).collect::<String>());
    let text = "data log = csv(\"log.csv\") columns t, th
        free p in [2, 20] guess 7\nfree l in [0.05, 2] guess 0.25\ntime t in [0, 4]
        state th start 18\nstate on start 1\nsurface warm = th - 21\nsurface cold = th - 19
        dynamics { th' = p*on - l*(th - 5)  on' = 0 }
        jump off on warm rising at most 6 { on := 0 }
        jump again on cold falling at most 6 { on := 1 }
        fit log: th sd 0.1";
    let solution = certified(&with_data(text, move |_| rows.clone()));
    let expected = [("objective", 28.695_122_490_5), ("p", 8.012_388_625), ("l", 0.299_427_378)];
    assert_near(&solution, &expected, 1e-7);
    assert_eq!(solution.jumps.len(), 7);
}

/// Two levels of a thermostat for three hours: the start at the motion of the guess has the
/// switches of the best answer. By Nelder and Mead (scipy) over the closed form of the motion.
#[test]
fn levels_of_a_thermostat_are_found_from_the_motion_of_their_guess() {
    let model = Model::from_text(
        "two_levels",
        "free hi in [20.2, 23] guess 21\nfree lo in [17, 19.8] guess 19\ntime t in [0, 3]
         state th start 18\nstate on start 1\nstate en start 0
         surface warm = th - hi\nsurface cold = th - lo
         dynamics { th' = 8*on - 0.3*(th - 5)  on' = 0  en' = 8*on }
         jump off on warm rising at most 2 { on := 0 }
         jump again on cold falling at most 2 { on := 1 }
         minimize integral((th - 20)^2) + 0.2*en(end)",
    );
    let solution = certified(&model.expect("it has no mistake"));
    let expected = [("objective", 4.859_435_777_32), ("hi", 21.079_187_7), ("lo", 18.860_812_3)];
    assert_near(&solution, &expected, 5e-8);
}

/// A block that slides throughout: its surface is there, and nothing switches. `x = 2 t - t^2/4` is
/// measured, to 0.01 above and below in turn.
#[test]
fn a_fit_without_any_switch_has_estimates() {
    let rows = (0..=20).map(|row| {
        let (t, side) = (0.05 * f64::from(row), if row % 2 == 0 { 0.01 } else { -0.01 });
        format!("{t},{}\n", 2.0 * t - 0.25 * t * t + side)
    });
    let rows: String = rows.collect();
    let text = "data obs = csv(\"a.csv\") columns t, x
        free a in [0, 2] guess 0.3  free v0 in [0, 5] guess 1
        time t in [0, 1]  state x start 0  state v start v0  surface slip = v
        dynamics { x' = v  v' in -a*Sgn(slip) }  fit obs: x sd 0.01";
    let solution = certified(&with_data(text, move |_| format!("t,x\n{rows}")));
    let estimates = solution.estimates().expect("it is a fit");
    assert_eq!((estimates.rows, estimates.residuals[0].values.len()), (21, 21));
    let off = |name: &str, value: f64| {
        let it = estimates.unknowns.iter().find(|it| it.name == name).expect("it is unknown");
        (it.value - value).abs() / it.standard_error.expect("it is determined")
    };
    assert!(off("a", 0.5) < 1.0 && off("v0", 2.0) < 1.0, "{:?}", estimates.unknowns);
}
