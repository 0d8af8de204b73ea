//! Gradients along trajectories whose own steps are long: at rest, or polynomials in time. What a
//! small change does is not at rest.

use fdcc::{Accuracy, Gradient, Model, by_names};
use fdcc_runtime::simulate::Controls;

/// The derivative of an expression by a name.
fn gradient(text: &str, of: &str, by: &str) -> Gradient {
    let model = Model::from_text("rest", text).expect("it is right");
    let asked = model.with_objective(of).into_model().expect("it has a value");
    let (system, controls) = (asked.sensitivity_system().expect("a system"), Controls::Guess);
    let by = by_names(&[by], &system, &controls, &asked).expect("it is a name");
    Gradient::new(&asked, system, controls, by, &Accuracy::default())
}

fn expect(text: &str, of: &str, by: &str, expected: f64, size: f64) {
    let found = gradient(text, of, by);
    let value = found.get(by).expect("it was asked for")[0];
    let off = (value - expected).abs() / size;
    assert!(off < 1e-7, "{text}: {value}, not {expected}: off by {off:e}");
    assert!(found.is_trusted(), "{text}");
}

#[test]
fn an_oscillator_at_rest_is_moved_by_its_start() {
    let text = "param x0 = 0
time t in [0, 10]
state x start x0
state v start 0
dynamics { x' = v  v' = -25*x }";
    expect(text, "x(end)", "x0", 50.0_f64.cos(), 1.0);
}

#[test]
fn an_unstable_rest_grows() {
    let text = "param p = 1
time t in [0, 5]
state x start p
dynamics { x' = x - 1 }";
    expect(text, "x(end)", "p", 5.0_f64.exp(), 5.0_f64.exp());
    let pendulum = "param p = 0
time t in [0, 10]
state x start p
state v start 0
dynamics { x' = v  v' = sin(x) }";
    expect(pendulum, "x(end)", "p", 10.0_f64.cosh(), 10.0_f64.cosh());
}

/// What a parameter that is 0 would do is a pulse, or fast.
#[test]
fn what_a_parameter_would_do_is_not_stepped_over() {
    let pulse = "param p = 0
time t in [0, 10]
state y start 0
dynamics { y' = p*exp(-((t - 5)/0.05)^2) }";
    expect(pulse, "y(end)", "p", 0.05 * std::f64::consts::PI.sqrt(), 0.1);
    let fast = "param p = 0
time t in [0, 10]
state y start 0
dynamics { y' = 1 + p*cos(20*t) }";
    expect(fast, "y(end)", "p", 200.0_f64.sin() / 20.0, 0.05);
    let forced = "param p = 0
time t in [0, 10]
state x start 0
state v start 0
dynamics { x' = v  v' = -9*x + p }";
    expect(forced, "x(end)", "p", (1.0 - 30.0_f64.cos()) / 9.0, 0.1);
}

/// Two of the same beside each other: together, and against each other.
#[test]
fn every_way_to_move_is_looked_at() {
    let text = "param a = 0
time t in [0, 10]
state p(x, y) start (a, -a)
state v(x, y) start (0, 0)
dynamics { p' = v  v' = (-p.x + 400*(p.y - p.x), -p.y + 400*(p.x - p.y)) }";
    expect(text, "p.x(end)", "a", (10.0 * 801.0_f64.sqrt()).cos(), 1.0);
}

/// Fast states that follow a slow one: along explicit steps of the slow one they would grow.
#[test]
fn fast_states_at_rest_stay_there() {
    for (k, last) in [(100.0_f64, 1.0_f64), (300.0, 1.0), (1e5, 100.0)] {
        let text = format!(
            "param a = 0\ntime t in [0, {last}]\nstate z start 0\nstate y start 0\n\
             dynamics {{ z' = a  y' = {k}*(z - y) }}"
        );
        let expected = last - (1.0 - (-k * last).exp()) / k;
        expect(&text, "y(end)", "a", expected, expected);
    }
}

#[test]
fn second_derivatives_are_resolved_too() {
    let text = "param p = 0
time t in [0, 10]
state y start 0
dynamics { y' = 1 + p^2*cos(20*t) }";
    let second = gradient(text, "y(end)", "p").second().expect("it is smooth");
    let expected = 2.0 * 200.0_f64.sin() / 20.0;
    assert!((second[0][0] - expected).abs() < 1e-6, "{second:?}, not {expected}");
}

/// Two blocks at rest, each with all the friction that it needs: their derivatives are from one
/// side only, and shorter steps lead to other ones. That is told after a few halvings, and not
/// after a minute of all that there are, for each side of each quantity.
#[test]
fn what_does_not_settle_is_not_pursued() {
    let text = "param p = 0.308
param q = -0.997
param mu = 0.609
time t in [0, 2 + p]
state x1 start 0
state v1 start 0
state x2 start 0
state v2 start 0
surface g2 = v2
surface r2 = v2 - v1
dynamics {
  x1' = v1
  0.527 * v1' in 0.456*t + 0.324*p - 0.046*x1 + 0.1*mu*Sgn(r2)
  x2' = v2
  v2' in min(1.011*t, 0.91 + q) - 0.323*x2 - 0.985*Sgn(g2) - 0.1*mu*Sgn(r2)
}
minimize integral(x1^2) + p*v2(end)";
    let model = Model::from_text("rest", text).expect("it is right");
    let once = model
        .simulate(&Controls::Guess, &Accuracy::default())
        .expect("it can be")
        .result
        .counts
        .steps;
    let found = gradient(text, "integral(x1^2) + p*v2(end)", "p");
    let steps = found.found.as_ref().expect("it reaches the end").found.simulation.counts.steps;
    assert!(steps <= 80 * once, "{steps} steps, and {once} of the simulation");
}
