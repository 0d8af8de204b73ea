//! On which side of a surface a state is, and whether it can go to the other one: surfaces whose
//! functions have kinks that are surfaces themselves, surfaces that are touched, and kinks that are
//! left from rest. All in closed form.

use fdcc_compiler::{compile_sensitivities, compile_simulation};
use fdcc_runtime::sensitivity::{Quantity, gradient};
use fdcc_runtime::simulate::{Controls, EventKind, Options, Simulation, Status, simulate};
use fdcc_tests::models::meaning;

fn run(text: &str) -> Simulation {
    let system = compile_simulation(&meaning(text)).expect("it can be simulated");
    simulate(&system, &Controls::Guess, &Options::default())
}

#[track_caller]
fn expect(text: &str, events: &[(EventKind, f64)], end: &[f64]) {
    let found = run(text);
    assert!(matches!(found.status, Status::Completed), "{text}: {:?}", found.status);
    let seen: Vec<(EventKind, f64)> = found.events.iter().map(|it| (it.kind, it.time)).collect();
    assert_eq!(seen, events, "{text}");
    for (got, expected) in found.end.iter().zip(end) {
        assert!((got - expected).abs() < 1e-9, "{text}: {:?} instead of {end:?}", found.end);
    }
}

/// `x` moves from 1 to 2 above all of them, as `y` says.
#[test]
fn what_starts_beside_a_kink_that_is_a_surface_meets_nothing() {
    for of in ["abs(x) - 0.5", "max(x, -x) - 0.5", "x + abs(x)", "abs(abs(x) - 0.5) - 0.2"] {
        let text = format!(
            "time t in [0, 1]  state x start 1  state y start 0
            surface p = {of}  surface r = abs(x) - 0.5  surface q = x
            dynamics {{ x' = 1  y' in Sgn(q)*Sgn(r) }}
            jump h on p rising {{ y := y + 10 }}"
        );
        expect(&text, &[], &[2.0, 1.0]);
    }
    let falls = "time t in [0, 1]  state x start 2  state y start 0
        surface p = abs(x) - 0.5  surface q = x  dynamics { x' = -1  y' in Sgn(p) + Sgn(q) }";
    expect(falls, &[], &[1.0, 2.0]);
}

/// `abs(x) - y` rises where `x` leaves 0 either way, whatever reads the surfaces.
#[test]
fn surfaces_that_bend_at_each_other_are_left_on_the_right_side() {
    for speed in [1.0, -1.0] {
        for (reads, slope) in [("Sgn(q)*Sgn(p)", speed), ("Sgn(p)", 1.0), ("Sgn(q)", speed)] {
            let text = format!(
                "time t in [0, 1]  state x start 0  state y start 0  state z start 0
                surface p = abs(x) - y  surface q = x
                dynamics {{ x' = {speed}  y' = 0.5  z' in {reads} }}
                jump h on p falling {{ z := 10 }}"
            );
            expect(&text, &[], &[speed, 0.5, slope]);
        }
    }
}

/// Behind the jump `x` is 1, and `abs(x)` is 1 as well.
#[test]
fn what_jumps_beside_a_kink_that_is_a_surface_meets_nothing() {
    let text = "time t in [0, 2]  state x start -2  state y start 0
        surface c = t - 1  surface p = abs(x) - 0.5  surface q = x
        dynamics { x' = 0.1  y' in Sgn(q) }
        jump k on c rising at most 1 { x := 1 }  jump h on p rising { y := y + 10 }";
    expect(text, &[(EventKind::Jump(0), 1.0)], &[1.1, 0.0]);
}

/// `y(1)` is 1 wherever `x` starts beyond 0.5.
#[test]
fn a_surface_that_is_not_met_has_no_part_in_a_gradient() {
    let text = "param a = 1  time t in [0, 1]  state x start a  state y start 0
        surface p = abs(x) - 0.5  surface q = x  dynamics { x' = 1  y' in Sgn(p) }
        minimize y(end)";
    let system = compile_sensitivities(&meaning(text)).expect("it can be simulated");
    let by = [Quantity::Parameter(0)];
    let found = gradient(&system, &Controls::Guess, &Options::default(), &by).expect("it ends");
    assert!((found.value - 1.0).abs() < 1e-12, "{}", found.value);
    assert_eq!((found.forward[0], found.adjoint[0]), (0.0, 0.0));
    assert!(found.nondifferentiabilities.is_empty(), "{:?}", found.nondifferentiabilities);
}

/// Thrown up so that it just comes to `p`, where the field behind takes it farther, at once or by
/// and by; and mirrored.
#[test]
fn a_surface_that_is_touched_may_be_left_to_both_sides_where_the_field_behind_leads_away() {
    let late = "state x start -1  state v start 1  surface p = x + 0.5
        dynamics { x' = v  v' in match p { below => -1, above => 1 } }";
    let mirrored = "state x start 1  state v start -1  surface p = x - 0.5
        dynamics { x' = v  v' in match p { below => -1, above => 1 } }";
    let early = "state x start -1  surface p = x
        dynamics { x' in match p { below => 2*(1 - t), above => 1 } }";
    for (text, end) in [(late, vec![-0.5, 0.0]), (mirrored, vec![0.5, 0.0]), (early, vec![0.0])] {
        let found = run(&format!("time t in [0, 2.5]  {text}"));
        let Status::NotUnique { surface: 0, candidates } = &found.status else {
            panic!("{text}: {:?}", found.status)
        };
        let sides: Vec<i8> = candidates.iter().map(|it| it.sides[0].1).collect();
        assert_eq!(sides, [1, -1], "{text}");
        assert!((found.end_time - 1.0).abs() < 1e-7, "{text}: {}", found.end_time);
        for (got, expected) in found.end.iter().zip(&end) {
            assert!((got - expected).abs() < 1e-7, "{text}: {:?}", found.end);
        }
    }
}

#[test]
fn a_surface_that_is_touched_is_no_event_where_the_field_behind_leads_back() {
    let late = "time t in [0, 2]  state x start -1  state v start 1  surface p = x + 0.5
        dynamics { x' = v  v' in match p { below => -1, above => -3 } }";
    expect(late, &[], &[-1.0, -1.0]);
    let early = "time t in [0, 2]  state x start -1  surface p = x
        dynamics { x' in match p { below => 2*(1 - t), above => -1 } }";
    expect(early, &[], &[-1.0]);
    let idle = "time t in [0, 2]  state x start -1  state v start 1  surface p = x + 0.5
        dynamics { x' = v  v' = -1 }  jump h on p rising { v := 1 }";
    expect(idle, &[], &[-1.0, -1.0]);
}

/// `x'' = 1 + 2 x` from rest at 0: friction lets go at once, and `x` is above its kink from then
/// on.
#[test]
fn what_rises_from_rest_on_a_kink_is_above_it() {
    let expected = (0.9 * 2.0_f64.sqrt()).cosh();
    let end = [0.5 * (expected - 1.0), (0.9 * 2.0_f64.sqrt()).sinh() / 2.0_f64.sqrt()];
    for force in ["2*x", "2*max(x, 0)", "(x + abs(x))", "(2*x + min(x, 0))"] {
        let text = format!(
            "time t in [0, 0.9]  state x start 0  state v start 0  surface p = v - t
            dynamics {{ x' = v  v' in 2 - Sgn(p) + {force} }}"
        );
        expect(&text, &[(EventKind::StartsSliding, 0.0), (EventKind::LeavesUp, 0.0)], &end);
    }
}
