//! Kinks of `abs`, `min` and `max` in models with phases, against closed forms.

use fdcc::{Model, Options, Solution};

/// Certified, and with this objective.
#[track_caller]
fn solved(text: &str, objective: f64) -> Solution {
    let model = Model::from_text("phases", text).expect("it is right");
    let solution = model.solve(&Options::default()).expect("it can be solved");
    let off = solution.objective() - objective;
    assert!(solution.is_certified() && off.abs() < 1e-8, "{:?} {off:e}", solution.status());
    solution
}

/// A root, where a function that grows has one between two numbers.
fn root(function: impl Fn(f64) -> f64, [mut low, mut high]: [f64; 2]) -> f64 {
    for _ in 0..100 {
        let middle = 0.5 * (low + high);
        *if function(middle) < 0.0 { &mut low } else { &mut high } = middle;
    }
    low
}

/// A push of duration `a` in drag, `v' = u - v/5`, so `v(2) = a - x(2)/5`; then a brake of duration
/// `v(2)` without drag.
#[test]
fn a_burn_in_each_phase() {
    let speed = |a: f64| 5.0 * (1.0 - (-0.2 * a).exp()) * (-0.2 * (2.0 - a)).exp();
    let place = |a: f64| 5.0 * (a - speed(a)) + 2.0 * speed(a) - 0.5 * speed(a).powi(2);
    let push = root(|a| place(a) - 1.0, [0.0, 1.0]);
    let solution = solved(
        "phase go { time t in [0, 2]  state x start 0  state v start 0  control u in [-1, 1]
            dynamics { x' = v  v' = u - 0.2*v }  minimize integral(abs(u)) }
         phase stop { time t in [2, 4]  state x  state v  control u in [-1, 1]
            dynamics { x' = v  v' = u }  end x == 1  end v == 0  minimize integral(abs(u)) }
         link go -> stop { same }",
        push + speed(push),
    );
    assert!(solution.outcome.solution.global);
    let names = |part: &Solution| part.problem.controls.iter().map(|it| it.name.clone()).collect();
    let all: Vec<Vec<String>> = solution.phases().iter().map(names).collect();
    assert_eq!(all, [["u"], ["u"]]);
}

/// The end is on the kink: `2*0.8 < 3`.
#[test]
fn a_kink_at_the_end_of_the_last_phase() {
    let solution = solved(
        "phase one { time t in [0, 0.4]  state x start 1  control u in [-1, 1]
            dynamics { x' = u } }
         phase two { time t in [0.4, 1]  state x  control u in [-1, 1]  dynamics { x' = u } }
         link one -> two { same }
         minimize integral(one.u^2) + integral(two.u^2) + 3*abs(two.x(end) - 0.2)",
        0.64,
    );
    assert!(solution.unknowns().count() == 0 && solution.outcome.solution.global);
}

/// `u = -c e^t` until `x = 0`, constant from then on, where `sinh(t) = 2 - t`; the leak ends in the
/// first phase.
#[test]
fn a_kink_of_a_state_in_the_right_side() {
    let t = root(|t| t.sinh() + t - 2.0, [0.0, 2.0]);
    let grown = (2.0 * t).exp();
    let c = 2.0 / (grown - 1.0);
    let energy = c * c * (0.5 * (grown - 1.0) + grown * (2.0 - t));
    solved(
        "state x start 1  control u
         phase one { time t in [0, 1.5]  dynamics { x' = u - max(x, 0) } }
         phase two { time t in [1.5, 2]  dynamics { x' = u - max(x, 0) } }
         link one -> two {}
         end x == -1  minimize integral(u^2)",
        energy,
    );
}

/// Speed is only taken away, so that the distance of `u` from 0 is at its limit in all of the time.
#[test]
fn a_brake_before_and_after_a_coast() {
    let left = |b: f64| 0.5 - b;
    let place = |b: f64| {
        let coast = left(b) * (2.0 - b - left(b));
        0.4 + 0.5 * b - 0.5 * b * b + coast + 0.5 * left(b).powi(2)
    };
    let b = root(|b| 1.0 - place(b), [0.0, 0.5]);
    let squares = (0.125 - left(b).powi(3)) / 3.0
        + left(b).powi(2) * (2.0 - b - left(b))
        + left(b).powi(3) / 3.0;
    solved(
        "time t in [0, 2]  state x start 0.4  state v start 0.5  control u in [-1, 1]
         dynamics { x' = v  v' = u }  end x == 1  end v == 0
         minimize integral(abs(u)) + 0.01*integral(v^2)",
        0.5 + 0.01 * squares,
    );
}

/// Legs that have nothing to do with each other: the sum of what each of them costs alone. While
/// the one is mended, the other still has phases that shrank to nothing.
#[test]
fn two_legs_with_regenerative_brakes() {
    let leg = |[from, to]: [f64; 2], distance: f64| {
        format!(
            "time t in [{from}, {to}]  state x start 0  state v start 0  control u in [-1, 1]
             dynamics {{ x' = v  v' = u - 0.05 - 0.02*v^2 }}  end x == {distance}  end v == 0
             minimize integral(max(u*v, 0.6*u*v))"
        )
    };
    let [first, second] = [leg([0.0, 5.0], 4.5), leg([5.0, 9.0], 2.5)];
    let alone = |text: &str| solved_as_it_is(text).objective();
    let together = format!("phase one {{ {first} }}\nphase two {{ {second} }}");
    solved(&together, alone(&first) + alone(&second));
}

/// Certified.
#[track_caller]
fn solved_as_it_is(text: &str) -> Solution {
    let model = Model::from_text("one", text).expect("it is right");
    let solution = model.solve(&Options::default()).expect("it can be solved");
    assert!(solution.is_certified(), "{:?}", solution.status());
    solution
}
