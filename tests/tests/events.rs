//! What an event does to a state, and what a simulation says where events cannot be told apart.

use fdcc_compiler::compile_simulation;
use fdcc_runtime::simulate::{Controls, EventKind, Options, Order, Simulation, Status, simulate};
use fdcc_tests::models::meaning;
use fdcc_tests::random::Random;

fn run_with(text: &str, options: &Options) -> Simulation {
    let system = compile_simulation(&meaning(text)).expect("the model can be simulated");
    simulate(&system, &Controls::Guess, options)
}

fn run(text: &str) -> Simulation {
    run_with(text, &Options::default())
}

/// A clock, `q = cos(3t)`, and a surface that time moves more than the states do.
fn clocked(psi: &str) -> String {
    format!(
        "time t in [0, 10]
state q start 1
state w start 0
state y start 0
surface s = {psi}
dynamics {{
  q' = -3*w
  w' = 3*q
  y' in Sgn(s)
}}
"
    )
}

fn check_clock(psi: &str) {
    let simulation = run(&clocked(psi));
    assert!(matches!(simulation.status, Status::Completed), "{:?}\n{psi}", simulation.status);
    assert!(!simulation.events.is_empty(), "{psi}");
    let ends = simulation.events.iter().map(|it| (it.time, &it.after));
    for (time, state) in ends.chain([(simulation.end_time, &simulation.end)]) {
        let gap = (state[0] - (3.0 * time).cos()).abs();
        assert!(gap < 1e-6, "{gap:e} at {time}\n{psi}");
    }
}

#[test]
fn an_event_leaves_a_state_where_it_is_if_time_moves_the_surface() {
    for psi in
        ["sin(3.7*t) + 0.3*tanh(20*q)", "sin(t) + 1e-20*q", "cos(3.7*t) + 0.5/(1 + exp(-40*q))"]
    {
        check_clock(psi);
    }
}

#[test]
fn events_of_random_surfaces_over_time_leave_the_clock_alone() {
    let mut random = Random::new(17);
    for _ in 0..20 {
        let time = random.of(&["sin(A*t + B)", "cos(A*t) + 0.2*sin(B*t)", "sin(A*t)*cos(B*t)"]);
        let state = random.of(&["0.3*tanh(C*q)", "0.4/(1 + exp(-C*w))", "1e-15*C*q", "0.1*q*w"]);
        let psi = format!("{time} + {state}")
            .replace('A', &format!("{:.3}", random.between(1.0, 5.0)))
            .replace('B', &format!("{:.3}", random.between(0.5, 3.0)))
            .replace('C', &format!("{:.3}", random.between(5.0, 60.0)));
        check_clock(&psi);
    }
}

fn stone(right: &str, jump: &str) -> String {
    format!(
        "time t in [0, 2]
state h start 1
state v start 0
state on start 1
state z start 0
surface ground = h
dynamics {{
  h' = v
  v' {right}
  on' = 0
  z' in Sgn(ground)
}}
jump hit on ground falling {{ {jump} }}
"
    )
}

/// `z` may go any way while the stone lies, on whichever side rounding sees it.
#[test]
fn a_stone_that_lies_is_on_the_ground_but_for_rounding() {
    for height in ["", "h := 0", "h := 1e-49", "h := 0 - 1e-49"] {
        let text = stone("= -9.81*on", &format!("v := 0  on := 0  {height}"));
        let simulation = run(&text);
        let Status::NotUnique { candidates, .. } = simulation.status else {
            panic!("{height}: {:?}", simulation.status)
        };
        let mut sides: Vec<i8> = candidates.iter().map(|it| it.sides[0].1).collect();
        sides.sort_unstable();
        assert_eq!(sides, [-1, 0, 1], "{height}");
    }
}

/// Without `z` it has one future: it lies.
#[test]
fn a_stone_that_weighs_nothing_on_the_ground_stays_there() {
    let text = "time t in [0, 2]
state h start 1
state v start 0
surface ground = h
dynamics {
  h' = v
  v' in match ground { below => 0, above => -9.81 }
}
jump hit on ground falling { v := 0 }
";
    let simulation = run(text);
    assert!(matches!(simulation.status, Status::Completed), "{:?}", simulation.status);
    let jumps = simulation.events.iter().filter(|it| matches!(it.kind, EventKind::Jump(_)));
    assert_eq!((jumps.count(), simulation.events.len()), (1, 1));
    let fallen = (2.0_f64 / 9.81).sqrt();
    assert!((simulation.events[0].time - fallen).abs() < 1e-9);
    assert!(simulation.end.iter().all(|it| it.abs() < 1e-9), "{:?}", simulation.end);
}

fn waves(argument: &str, last: &str) -> String {
    format!(
        "time t in [0, {last}]
state x start 0
state y start 0
surface s = sin({argument})
dynamics {{
  x' = 1
  y' in Sgn(s)
}}
"
    )
}

/// Crossings that no times tell apart are not passed over in silence, nor do they pile up.
#[test]
fn what_cannot_be_resolved_is_not_completed() {
    let options = Options { max_steps: 2000, ..Options::default() };
    let fast =
        [14, 15, 16, 17, 18, 19, 20, 22, 30].map(|power| waves(&format!("1e{power}*x"), "10"));
    let long = [30, 60, 100].map(|power| waves("x", &format!("1e{power}")));
    let late = [waves("1e14*x", "20").replace("[0,", "[10,").replace("x start 0", "x start 10")];
    for text in fast.iter().chain(&long).chain(&late) {
        let status = run_with(text, &options).status;
        assert!(matches!(status, Status::StepLimit), "{status:?}\n{text}");
    }
}

#[test]
fn many_crossings_that_times_tell_apart_are_found() {
    let simulation = run(&waves("1e3*x", "1"));
    assert!(matches!(simulation.status, Status::Completed));
    assert_eq!(simulation.events.len(), 318);
}

/// What was large before a jump says nothing of how exact the motion behind it has to be.
#[test]
fn a_jump_to_a_small_scale_begins_anew() {
    let text = "time t in [0, 40]
state x start 1
state v start 0
surface k = t - 10
dynamics {
  x' = v
  v' = -x
}
jump kick on k rising {
  v := 1e-12
  x := 0.0 - 1e-13
}
";
    let simulation = run(text);
    assert!(matches!(simulation.status, Status::Completed));
    let (sin, cos) = 30.0_f64.sin_cos();
    let expected = [-1e-13 * cos + 1e-12 * sin, 1e-13 * sin + 1e-12 * cos];
    for (found, expected) in simulation.end.iter().zip(expected) {
        assert!((found - expected).abs() < 1e-19, "{found:e} {expected:e}");
    }
}

/// A reset that does not move its surface happens once where the state starts there, whichever way
/// it leaves: `n` counts the times at which `100 t` is a multiple of `2 pi`.
#[test]
fn a_jump_at_the_start_happens_once() {
    for (psi, counted) in [("sin(100*t)", 16.0), ("x", 1.0), ("-x", 0.0), ("t", 1.0)] {
        let simulation = run(&format!(
            "time t in [0, 1]\nstate x start 0\nstate n start 0\nsurface s = {psi}\n\
             dynamics {{\n x' = 1\n n' = 0\n}}\njump count on s rising {{ n := n + 1 }}\n"
        ));
        assert!(matches!(simulation.status, Status::Completed), "{psi}: {:?}", simulation.status);
        assert_eq!(simulation.end[1], counted, "{psi}");
    }
}

/// A ball that starts on the ground bounces at once: `h = 0.8 t - t^2/2`, until 1.6.
#[test]
fn a_ball_that_starts_on_the_ground_bounces_once() {
    let simulation = run(
        "time t in [0, 1]\nstate h start 0\nstate v start -1\nsurface ground = h\ndynamics {\n \
         h' = v\n v' = -1\n}\njump bounce on ground falling { v := -0.8*v }\n",
    );
    assert!(matches!(simulation.status, Status::Completed), "{:?}", simulation.status);
    assert_eq!(simulation.events.len(), 1, "{:?}", simulation.events);
    assert!((simulation.end[0] - 0.3).abs() < 1e-12, "{:?}", simulation.end);
}

/// Whether `z` is 4 or 3 is a matter of order; two sums are not.
#[test]
fn jumps_at_one_time_are_told_where_their_order_matters() {
    for (second, expected) in [("2*z", 1), ("z + 3", 0)] {
        let text = format!(
            "time t in [0, 1]  state x start 0  state y start 0  state z start 1
            surface p = x - 0.5  surface q = y - 0.5  dynamics {{ x' = 1  y' = 1  z' = 0 }}
            jump a on p rising at most 1 {{ z := z + 1 }}
            jump b on q rising at most 1 {{ z := {second} }}"
        );
        let found = run(&text);
        assert_eq!((found.orders.len(), found.events.len()), (expected, 2), "{:?}", found.orders);
        let is_right = |it: &Order| it.jumps == [0, 1] && (it.time - 0.5).abs() < 1e-12;
        assert!(found.orders.iter().all(is_right), "{:?}", found.orders);
    }
}
