//! In a closed loop the plan before is one interval old when the next one begins.

use fdcc::{Model, Options};
use fdcc_tests::closed_loop::{CASES, run};

#[test]
fn what_is_left_of_a_plan_is_the_better_start() {
    for case in &CASES[..3] {
        let [as_it_is, later] = [false, true].map(|is_later| run(case, is_later));
        assert_eq!((as_it_is.failures, later.failures), (0, 0), "{}", case.name);
        let [a, b] = [as_it_is.iterations, later.iterations];
        assert!(5 * b < 4 * a, "{}: {a} iterations, {b} one interval later", case.name);
        for (a, b) in as_it_is.state.iter().zip(later.state) {
            assert!((a - b).abs() < 1e-5, "{}: {a} and {b}", case.name);
        }
    }
}

#[test]
fn a_controller_begins_there_where_the_state_has_moved_on() {
    let case = &CASES[0];
    let mut controller = case.model().controller(case.intervals).expect("it has a width");
    let (mut now, mut state, mut iterations) = (0.0, [0.0, 0.0], 0);
    for step in 0..=case.steps {
        controller.set("now", now).expect("it is declared");
        let found = controller.step(&state, &Options::default()).expect("two numbers");
        assert!(found.is_solved());
        iterations += if step > 0 { found.outcome.solution.counts.iterations } else { 0 };
        now += found.time()[1];
        state = ["x", "v"].map(|name| found.state(name).expect("it is declared")[1]);
    }
    assert_eq!(iterations, run(case, true).iterations);
}

/// Where the state has not moved the whole plan is still right.
#[test]
fn a_controller_that_is_asked_twice_keeps_its_plan() {
    let case = &CASES[0];
    let mut controller = case.model().controller(case.intervals).expect("it has a width");
    let mut iterations = || {
        let found = controller.step(&[0.1, 0.2], &Options::default()).expect("two numbers");
        found.outcome.solution.counts.iterations
    };
    let (first, again) = (iterations(), iterations());
    assert!(again <= 3 && again < first, "{first} iterations, then {again}");
}

/// At rest a solve leaves numbers of 1e-20 and less. They are no sizes of quantities: another goal
/// takes about as many iterations as from the guess, and no step is solved in units of its own.
#[test]
fn what_a_rest_leaves_is_no_size() {
    let text = include_str!("../peers/acados/cart.fdc");
    let model = Model::from_text("cart", text).expect("the model is right");
    let mut controller = model.controller(40).expect("it has a width");
    let mut iterations = |goal: f64| {
        controller.set("goal", goal).expect("it is declared");
        let found = controller.step(&[0.0; 4], &Options::default()).expect("four numbers");
        assert!(found.is_solved() && found.problem.states.iter().all(|it| it.unit == 1.0));
        found.outcome.solution.counts.iterations
    };
    let from_the_guess = iterations(0.5);
    (0..5).for_each(|_| assert!(iterations(0.0) < from_the_guess));
    let again = iterations(0.5);
    assert!(again <= 2 * from_the_guess, "{from_the_guess} iterations, after a rest {again}");
}
