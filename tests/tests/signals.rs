//! Quantities that are given from outside: what the text says, and values at the points of a grid.

use fdcc::{Accuracy, ClosedLoop, Error, Model, Options, Solution};

const FOLLOW: &str = "model follow
param a = 1
time t in [T0, T0 + 1]
signal r = a*sin(3*t)
state x start 0
control u in [-10, 10]
dynamics { x' = u }
minimize integral((x - r)^2 + 0.01*u^2)
method { N = 40 }
";

fn follow(first: f64) -> Model {
    let text = FOLLOW.replace("T0", &first.to_string());
    Model::from_text("follow", &text).expect("it is right")
}

fn states(solution: &Solution) -> Vec<f64> {
    solution.state("x").expect("it is declared").to_vec()
}

fn agree(found: &[f64], expected: &[f64], within: f64) {
    let off = found.iter().zip(expected).map(|(a, b)| (a - b).abs());
    let off = off.fold(0.0, f64::max);
    assert!(off < within, "off by {off:e}");
}

/// Straight lines between the points of the grid differ from a sine by the square of a step.
#[test]
fn a_controller_plans_with_what_the_text_says() {
    let model = follow(0.0);
    let solved = states(&model.solve(&Options::default()).expect("it is solved"));
    let mut controller = model.controller(40).expect("it can be one");
    let stepped = controller.step(&[0.0], &Options::default()).expect("it is solved");
    agree(&states(stepped), &solved, 1e-3);
}

/// Where time goes on, the plan is that of the model that begins later.
#[test]
fn the_time_of_signals_goes_on() {
    let mut controller = follow(0.0).controller(40).expect("it can be one");
    controller.set_time(0.7).expect("it is finite");
    let stepped = states(controller.step(&[0.0], &Options::default()).expect("it is solved"));
    let mut later = follow(0.7).controller(40).expect("it can be one");
    let expected = states(later.step(&[0.0], &Options::default()).expect("it is solved"));
    agree(&stepped, &expected, 1e-9);
}

/// The same values as a table, whose curve is what the manual says of `interpolate`.
#[test]
fn given_values_are_straight_lines_between_the_points() {
    let values: Vec<f64> = (0..=40).map(|k| f64::from(k % 7) * 0.1).collect();
    let mut controller = follow(0.0).controller(40).expect("it can be one");
    controller.set_signal("r", &values).expect("there are 41");
    let given = states(controller.step(&[0.0], &Options::default()).expect("it is solved"));
    let rows = values.iter().enumerate().map(|(k, r)| format!("{},{r}\n", k as f64 / 40.0));
    let table = format!("t,r\n{}", rows.collect::<String>());
    let text = FOLLOW.replace("T0", "0").replace("a*sin(3*t)", "interpolate(plan.t, plan.r, t)");
    let text = text.replace("param a = 1\n", "data plan = csv(\"plan.csv\") columns t, r\n");
    let files = fdcc::DataFiles::from(move |_| Ok(table.clone()));
    let model = fdcc::check_with("follow", text.into(), Some(files)).model.expect("it is right");
    let expected = model.solve(&Options::default()).expect("it is solved");
    agree(&given, &states(&expected), 1e-8);
}

/// Values of parameters stay when a controller is made, and may change after that.
#[test]
fn signals_follow_parameters() {
    let mut twice =
        follow(0.0).with("a", 2).expect("it is right").controller(40).expect("it is right");
    let mut set = follow(0.0).controller(40).expect("it is right");
    set.set("a", 2).expect("it is a parameter");
    let expected = states(twice.step(&[0.0], &Options::default()).expect("it is right"));
    agree(&states(set.step(&[0.0], &Options::default()).expect("it is right")), &expected, 1e-9);
    assert!(expected[20] > 1.2, "twice as far");
}

/// Far from both ends `u' = (x - r)/w` with the weight `w` of `u^2`, so that `x'' = (x - r)/w`: for
/// `r = sin(3 t)` that is `x = r/(1 + 9 w)`, without a lag, since the plan knows what lies ahead.
#[test]
fn a_closed_loop_follows_what_lies_ahead() {
    let model = follow(0.0);
    let mut closed = ClosedLoop::new(
        model.controller(40).expect("it is right"),
        model.plant().expect("it is right"),
    )
    .expect("it is right");
    for _ in 0..120 {
        closed.solve(&Options::default()).expect("it is solved");
        assert!(closed.apply(&Accuracy::default()).expect("the plant knows all controls"));
    }
    assert!((closed.time() - 3.0).abs() < 1e-9);
    let expected = 9.0_f64.sin() / 1.09;
    assert!((closed.state()[0] - expected).abs() < 1e-3, "{:?}, not {expected}", closed.state());
}

#[test]
fn wrong_signals_are_told() {
    let mut controller = follow(0.0).controller(40).expect("it is right");
    let message = |found: Result<(), Error>| found.expect_err("it is wrong").to_string();
    assert_eq!(message(controller.set_signal("q", &[1.0])), "`q` is no signal; signals are r");
    let number = message(controller.set_signal("r", &[1.0; 40]));
    assert_eq!(number, "`r` takes 1 or 41 finite values, one for each point");
    assert!(
        controller.set_signal("r", &[f64::NAN]).is_err() && controller.set_time(f64::NAN).is_err()
    );
    let text = FOLLOW
        .replace("T0", "0")
        .replace("time t in [0, 0 + 1]", "free T in [1, 2]\ntime t in [0, T]");
    let open = Model::from_text("open", &text).expect("it is right").controller(10);
    assert!(open.err().expect("its times are open").to_string().contains("fix its times"));
}

/// The parts of a vector have names of their own.
#[test]
fn a_vector_is_given_part_by_part() {
    let text = "time t in [0, 1]
signal r = (1, -1)
state p(x, y) start (0, 0)
control u(x, y) in [-100, 100]
dynamics { p' = u }
minimize integral(normsq(p - r) + 0.01*normsq(u))";
    let mut controller =
        Model::from_text("two", text).expect("it is right").controller(20).expect("it is right");
    assert_eq!(controller.signals().collect::<Vec<_>>(), ["r[1]", "r[2]"]);
    controller.set_signal("r[2]", &[2.0]).expect("it is a signal");
    let found = controller.step(&[0.0, 0.0], &Options::default()).expect("it is right");
    let end = |name| *found.state(name).expect("it is right").last().expect("it is right");
    assert!((end("p.y") / end("p.x") - 2.0).abs() < 1e-6);
}
