//! Surfaces whose functions have kinks, such as a belt that is suddenly braked: what is on one goes
//! on as the slopes behind the kink say, at once and without chattering, and where it leaves there
//! is a derivative. All in closed form.

use fdcc_compiler::{compile_sensitivities, compile_simulation};
use fdcc_runtime::sensitivity::{
    KinkMet, NondifferentiabilityKind, Quantity, Sensitivity, gradient, one_sided,
};
use fdcc_runtime::simulate::{Controls, EventKind, Options, Simulation, Status, simulate};
use fdcc_tests::models::meaning;

fn run(text: &str) -> Simulation {
    let system = compile_simulation(&meaning(text)).expect("it can be simulated");
    simulate(&system, &Controls::Guess, &Options::default())
}

#[track_caller]
fn expect_events(text: &str, events: &[(EventKind, f64)], end: &[f64]) {
    let found = run(text);
    assert!(matches!(found.status, Status::Completed), "{text}: {:?}", found.status);
    let seen: Vec<(EventKind, f64)> = found.events.iter().map(|it| (it.kind, it.time)).collect();
    let is_near =
        |(a, b): (&(EventKind, f64), &(EventKind, f64))| a.0 == b.0 && (a.1 - b.1).abs() < 1e-11;
    let are_near = seen.len() == events.len() && seen.iter().zip(events).all(is_near);
    assert!(are_near, "{text}: {seen:?}");
    for (got, expected) in found.end.iter().zip(end) {
        assert!((got - expected).abs() < 1e-10, "{text}: {:?} instead of {end:?}", found.end);
    }
}

fn by_p(text: &str) -> Sensitivity {
    let system = compile_sensitivities(&meaning(text)).expect("it can be simulated");
    let at = system.parameters.iter().position(|it| it.name == "p").expect("there is one");
    let by = [Quantity::Parameter(at)];
    gradient(&system, &Controls::Guess, &Options::default(), &by).expect("it reaches the end")
}

/// The belt gains 1.25 m/s^2 until 0.7 and is braked with 4, friction has 3: the block is thrown
/// off at 0.7.
#[test]
fn a_block_leaves_a_belt_that_is_suddenly_braked_once() {
    let belts = [
        "min(1.25*t, 0.875 - 4*(t - 0.7))",
        "(0.875 - 1.375*(t - 0.7) - 2.625*abs(t - 0.7))",
        "(0.875 + 1.25*(t - 0.7) - 5.25*max(0, t - 0.7))",
        "belt(t)",
        "min(1.25*y, 0.875 - 4*(y - 0.7))",
    ];
    for belt in belts {
        for friction in [
            format!("surface slip = v - {belt}  dynamics {{ v' in -3*Sgn(slip)  y' = 1 }}"),
            format!("dynamics {{ v' in -3*Dir(v - {belt})  y' = 1 }}"),
        ] {
            let text = format!(
                "time t in [0, 1.2]  state v start 0  state y start 0
                fn belt(s) = piecewise {{ s <= 0.7 => 1.25*s  otherwise => 0.875 - 4*(s - 0.7) }}
                {friction}"
            );
            if text.contains("Dir") {
                let plane = text
                    .replace("state v start 0", "state v(a, b) start (0, 0)")
                    .replace(&format!("Dir(v - {belt})"), &format!("Dir(v - ({belt}, 0))"));
                let events = [(EventKind::StartsSliding, 0.0), (EventKind::LeavesUp, 0.7)];
                expect_events(&plane, &events, &[0.875 - 1.5, 0.0, 1.2]);
                continue;
            }
            let events = [(EventKind::StartsSliding, 0.0), (EventKind::LeavesUp, 0.7)];
            expect_events(&text, &events, &[0.875 - 1.5, 1.2]);
        }
    }
}

/// Held on `x = 0` while `y` rises to the corner at 0, from which the surface falls with slope 2:
/// `psi' = (2 b - 1) s + 2 a` behind it. The last one could go either way along its selector
/// alone.
#[test]
fn at_a_corner_of_a_surface_the_motion_behind_it_decides() {
    for (a, b) in [(1.0, 1.0), (1.0, 0.6), (0.9, 0.2), (0.5, 1.5)] {
        let text = format!(
            "time t in [0, 2]  state x start 0.3  state y start -1  surface s = x + 2*max(0, y)
            dynamics {{ x' in -Sgn(s)  y' in {a} + {b}*Sgn(s) }}"
        );
        let met = -1.0 + 0.3 * (a + b);
        let time = 0.3 - met / a;
        let rest = 2.0 - time;
        let events = [(EventKind::EntersSliding, 0.3), (EventKind::LeavesUp, time)];
        expect_events(&text, &events, &[-rest, rest * (a + b)]);
    }
    // Behind it the surface holds on: x = -2 y.
    let text = "time t in [0, 2]  state x start 0.3  state y start -1
        surface s = x + 2*max(0, y)  dynamics { x' in 0.5 - 2*Sgn(s)  y' = 0.5 }";
    expect_events(text, &[(EventKind::EntersSliding, 0.2)], &[0.0, 0.0]);
}

/// Held on a surface that turns away at `y = 0`, where `t = 1 - p`: `x(end) = 0.5 - 0.3 (1 + p)`;
/// where it holds on, `x = 0.5 - 0.5 |y|`, and the derivative is that of its end.
#[test]
fn an_exit_at_a_kink_moves_with_it() {
    let kinks = ["0.5*abs(y)", "k(y)", "max(0.5*y, -0.5*y)", "0.5*abs(t - 1 + p)"];
    for kink in kinks {
        for (push, expected) in [("1.7", -0.3), ("1.4", -0.5)] {
            let text = format!(
                "param p = 0  time t in [0, 2]  state x start 0.3  state y start p - 1
                fn k(a) = piecewise {{ a <= 0 => -0.5*a  otherwise => 0.5*a }}
                surface s = x + {kink} - 0.5  dynamics {{ x' in {push} - 2*Sgn(s)  y' = 1 }}
                minimize x(end)"
            );
            let found = by_p(&text);
            assert!(found.kink.is_none() && found.nondifferentiabilities.is_empty(), "{found:?}");
            let [forward, adjoint] = [found.forward[0], found.adjoint[0]];
            let is_right = |it: f64| (it - expected).abs() < 1e-9;
            assert!(is_right(forward) && is_right(adjoint), "{text}: {forward} {adjoint}");
        }
    }
}

/// A kink that is only touched, or crossed together with another: there the sides may differ.
#[test]
fn a_kink_of_a_surface_that_is_touched_is_seen() {
    let text = |y: &str| {
        format!(
            "param p = 0  time t in [0, 2]  state x start 0.3  state y start p - 1
            surface s = x + 0.5*abs(y) + 0.5*max(y - p, 0) - 0.5
            dynamics {{ x' in 0.7 - 2*Sgn(s)  y' = {y} }}  minimize x(end)"
        )
    };
    for y in ["1", "3*(1 - t)^2"] {
        let kink = by_p(&text(y)).kink.expect("the sides differ");
        assert!(matches!(kink.met, KinkMet::BySurface(_)), "{kink:?}");
    }
}

/// Nothing but a jump depends on the wall: it chooses nothing, and friction holds the block.
#[test]
fn a_wall_that_only_jumps_multiplies_no_ways() {
    let text = |walls: &str| {
        format!(
            "time t in [0, 4]  state x start 0  state v start 0.5  surface slip = v
            surface wall = x - 0.1  dynamics {{ x' = v  v' in -Sgn(slip) }}  {walls}
            jump hit on wall rising at most 1 {{ v := 0 }}"
        )
    };
    let met = 0.5 - (0.25_f64 - 0.2).sqrt();
    let events = |jump| [(EventKind::Jump(jump), met), (EventKind::EntersSliding, met)];
    expect_events(&text(""), &events(0), &[0.1, 0.0]);
    let two = "surface other = 2*x - 0.2  jump far on other falling at most 1 { x := 9 }";
    expect_events(&text(two), &events(1), &[0.1, 0.0]);
}

/// Held on `min(t, 1)` until `p`, and `v(end) = min(p, 1)`: a little less time takes away what the
/// slope before 1 gives, a little more adds nothing. So a speed that is held on `min(2*t, p)`.
#[test]
fn a_hold_that_ends_on_a_kink_has_derivatives_of_sides() {
    let time = "[0, p]  state v start 0  surface s = v - min(t, 1)";
    let level = "[0, 0.5]  state v start 0  surface s = v - min(2*t, p)";
    let start = "[0, 1]  state v start 0*p  surface s = v - min(t, 1)";
    for (text, kink) in [(time, true), (level, true), (start, false)] {
        for p in [0.9, 1.0, 1.1] {
            let found = by_p(&format!(
                "param p = {p}  time t in {text}  dynamics {{ v' in -3*Sgn(s) }}  minimize v(end)"
            ));
            let end = found.simulation.end_time;
            let at_end = |met: &KinkMet| matches!(met, KinkMet::BySurface(time) if *time == end);
            let is_met = found.kink.as_ref().is_some_and(|it| at_end(&it.met));
            assert_eq!(is_met, kink && p == 1.0, "{text} at {p}: {:?}", found.kink);
        }
    }
}

/// `z := z + a` leaves the state above its surface for `a > 0`, and below, to jump again, for `a <
/// 0`: then `z(1)` comes to -1. What resets leave where it was, or send back, is no matter of `a`.
#[test]
fn a_reset_onto_its_own_surface_is_seen() {
    let on = "state x start 0  state z start -0.5  surface p = x + z  dynamics { x' = 1  z' = 0 }
        jump h on p rising";
    let ball = "state x start 0  state z start 1  surface p = z  dynamics { x' = -1  z' = x }
        jump h on p falling at most 2";
    let cases = [
        (on, "{ z := z + a }", 0.0, true),
        (on, "{ z := z + a }", 0.1, false),
        (on, "at most 1 { z := z + a*x }", 0.0, true),
        (ball, "{ x := -0.5*x + a }", 0.0, false),
        (ball, "{ z := 0  x := -0.5*x + a }", 0.0, false),
    ];
    for (text, reset, a, is_met) in cases {
        let text = format!("param a = {a}  time t in [0, 2]  {text} {reset}  minimize z(end)");
        let system = compile_sensitivities(&meaning(&text)).expect("it can be simulated");
        let (by, options) = ([Quantity::Parameter(0)], Options::default());
        let found = gradient(&system, &Controls::Guess, &options, &by).expect("it ends");
        let seen = &found.nondifferentiabilities;
        let is_seen = seen.iter().any(|it| it.kind == NondifferentiabilityKind::Coincident);
        assert_eq!(is_seen, is_met, "{text}: {seen:?}");
        if a == 0.0 && reset == "{ z := z + a }" {
            let [below, above] = one_sided(&system, &Controls::Guess, &options, &by)[0];
            assert!(below.is_none_or(f64::is_infinite), "{below:?}");
            assert!(above.is_some_and(|it| (it - 1.0).abs() < 1e-6), "{above:?}");
        }
    }
}

/// What begins and ends at once: `x(end)` moves with its speed of 1.
#[test]
fn a_time_of_no_length_grows() {
    let text = "param p = 1  time t in [0, p]  state x start 0  control u in [-2, 2] guess 1
        dynamics { x' = u - 0.5*x }  minimize 3*x(end) + integral(x)";
    let system = compile_sensitivities(&meaning(text)).expect("it can be simulated");
    let short = system.with_parameters(&[0.0]);
    let by = [Quantity::Parameter(0)];
    let found = gradient(&short, &Controls::Guess, &Options::default(), &by).expect("it ends");
    assert_eq!((found.forward[0], found.adjoint[0]), (3.0, 3.0));
}
