//! What rests after `then hold`: until a jump takes it off, and while the surface stays where it
//! is; and what states come to where jumps pile up. All in closed form.

use fdcc_compiler::{compile_sensitivities, compile_simulation};
use fdcc_runtime::sensitivity::{KinkMet, Quantity, Sensitivity, gradient};
use fdcc_runtime::simulate::{Controls, EventKind, Options, Simulation, Status, System, simulate};
use fdcc_tests::models::meaning;
use fdcc_tests::random::Random;

const G: f64 = 9.81;

fn run(text: &str) -> (System, Simulation) {
    let system = compile_simulation(&meaning(text)).expect("it can be simulated");
    let found = simulate(&system, &Controls::Guess, &Options::default());
    (system, found)
}

#[track_caller]
fn expect_end(text: &str, expected: &[(&str, f64)]) -> Simulation {
    let (system, found) = run(text);
    assert!(matches!(found.status, Status::Completed), "{text}: {:?}", found.status);
    for (name, value) in expected {
        let at = system.states.iter().position(|it| it.name == *name).expect(name);
        assert!((found.end[at] - value).abs() < 1e-11, "{text}: {name} = {}", found.end[at]);
    }
    found
}

/// A ball that lies on the ground at 2, where something else happens to it.
fn struck(last: f64, limit: &str, strike: &str) -> String {
    format!(
        "param k = 3  time t in [0, {last}]  state h start 1  state v start 0
        surface ground = h  surface clock = t - 2
        dynamics {{ h' = v  v' = -9.81 }}
        jump bounce on ground falling {limit} then hold ground {{ v := -0.5*v }}
        jump strike on clock rising at most 1 {{ {strike} }}  minimize h(end)"
    )
}

fn by_k(text: &str) -> Sensitivity {
    let system = compile_sensitivities(&meaning(text)).expect("it can be simulated");
    let at = system.parameters.iter().position(|it| it.name == "k").expect("there is one");
    let by = [Quantity::Parameter(at)];
    gradient(&system, &Controls::Guess, &Options::default(), &by).expect("it reaches the end")
}

/// `h = k s - g s^2/2`, `s` after the strike.
#[test]
fn a_jump_off_a_held_surface_ends_the_hold() {
    for limit in ["", "at most 3"] {
        let text = struck(2.5, limit, "v := k");
        expect_end(&text, &[("h", 1.5 - 0.125 * G), ("v", 3.0 - 0.5 * G)]);
        let found = by_k(&text);
        assert!(found.kink.is_none() && (found.adjoint[0] - 0.5).abs() < 1e-9, "{found:?}");
    }
    expect_end(&struck(2.1, "", "h := 0.5"), &[("h", 0.5 - 0.005 * G), ("v", -0.1 * G)]);
}

/// Thrown up from 0 until it rests: the sum of what is below all throws, each `2 v^3/(3 g^2)`.
#[test]
fn what_has_been_until_a_rest_has_its_derivative() {
    let text = "param k = 3  time t in [0, 2]  state h start 0  state v start k  state x start 0
        surface ground = h  dynamics { h' = v  v' = -9.81  x' = h }
        jump bounce on ground falling then hold ground { v := -0.5*v }  minimize x(end)";
    let by = 3.0 * 9.0 * 2.0 / (3.0 * G * G) / (1.0 - 0.125);
    let found = by_k(text);
    assert!(found.kink.is_none(), "{:?}", found.kink);
    assert!((found.adjoint[0] - by).abs() < 1e-9, "{} instead of {by}", found.adjoint[0]);
}

/// Struck down it bounces at once, with half of the speed.
#[test]
fn a_jump_into_a_held_surface_is_an_impact() {
    let text = struck(2.05, "", "v := -k");
    expect_end(&text, &[("h", 0.075 - 0.00125 * G), ("v", 1.5 - 0.05 * G)]);
    let found = by_k(&text);
    assert!((found.adjoint[0] - 0.025).abs() < 1e-9, "{:?}", found.adjoint);
    // Where it may bounce no more it rests again.
    let text = struck(2.05, "at most 2", "v := -k");
    expect_end(&text, &[("h", 0.0), ("v", 0.0)]);
    assert!(by_k(&text).adjoint[0].abs() < 1e-12);
}

/// It comes back after `2k/g`, and comes to rest after as long again; where it has bounced as often
/// as it may, at once.
#[test]
fn what_comes_back_rests_again() {
    for (limit, after) in [("", 2.0), ("at most 3", 1.0)] {
        let found = expect_end(&struck(4.0, limit, "v := k"), &[("h", 0.0), ("v", 0.0)]);
        let last = found.events.last().expect("it comes to rest");
        let expected = 2.0 + after * 6.0 / G;
        assert!(last.kind == EventKind::EntersSliding, "{last:?}");
        assert!((last.time - expected).abs() < 1e-9, "{} instead of {expected}", last.time);
    }
}

/// A jump that leaves it where it is ends no hold, nor does one of a state beside it.
#[test]
fn a_jump_that_takes_nothing_off_ends_no_hold() {
    for strike in ["v := 0", "v := -0.5*v", "h := 2*h"] {
        expect_end(&struck(3.0, "", strike), &[("h", 0.0), ("v", 0.0)]);
    }
}

/// `a` lies on the ground, `b` falls on it with the speed `s`: `(a', b') = (3, 1) b/4`, then the
/// ground gives `a` two fifths of what it has, and once more: -0.3 s, 0.12 s ... until they part.
#[test]
fn an_impact_goes_through_what_rests_on_the_ground() {
    let text = "time t in [0, 0.47]  state a start 0  state va start 0
        state b start 1  state vb start 0  surface g = a  surface c = b - a
        dynamics { a' = va  va' = -9.81  b' = vb  vb' = -9.81 }
        jump ground on g falling then hold g { va := -0.4*va }
        jump hit on c falling then hold c { va := 0.75*vb + 0.25*va  vb := 0.75*va + 0.25*vb }";
    let (fall, speed) = ((2.0 / G).sqrt(), (2.0 * G).sqrt());
    let (mut a, mut b) = (0.0, -speed);
    while b < a || a < 0.0 {
        (a, b) = if b < a { (0.75 * b + 0.25 * a, 0.75 * a + 0.25 * b) } else { (-0.4 * a, b) };
    }
    let rest = 0.47 - fall;
    let fallen = 0.5 * G * rest * rest;
    expect_end(text, &[("a", a * rest - fallen), ("b", b * rest - fallen)]);
}

/// A table that moves, a slope under a state that moves, and a table that is drawn away at 2.
#[test]
fn a_surface_that_moves_away_from_what_rests_on_it_is_told() {
    let on = |surface: &str, speed: &str| {
        format!(
            "time t in [0, 4]  state x start 0  state h start 0.5  state v start 0
            surface g = h - {surface}  dynamics {{ x' = 1  h' = v  v' = -9.81 }}
            jump b on g falling then hold g {{ v := {speed} - 0.3*(v - {speed}) }}"
        )
    };
    for (surface, speed, time) in [
        ("0.3*sin(2*t)", "0.6*cos(2*t)", None),
        ("0.2*sin(x)", "0.2*cos(x)", None),
        ("(0 - 2*max(0, t - 2))", "0", Some(2.0)),
    ] {
        let (_, found) = run(&on(surface, speed));
        assert!(matches!(found.status, Status::NotHeld { surface: 0 }), "{:?}", found.status);
        let rests = found.events.last().expect("it comes to rest").time;
        let expected: f64 = time.unwrap_or(rests);
        assert!((found.end_time - expected).abs() < 1e-3, "{surface}: {}", found.end_time);
    }
    // On what moves on with the speed that it has at rest it stays.
    expect_end(&on("0.1*t", "0.1"), &[("h", 0.4), ("v", 0.1)]);
}

/// `c` is the sum of all speeds, `s/(1 - e)`; of `u` each bounce leaves 0.95, so that nothing is
/// left, and `x = t1 + (2 s/g) sum (0.95 e)^k`.
#[test]
fn states_come_to_their_limit_where_jumps_pile_up() {
    let text = |reset: &str| {
        format!(
            "param k = 0.05  time t in [0, 4]  state x start 0  state h start 1  state v start 0
            state u start 1  state c start 0  surface ground = h
            dynamics {{ x' = u  h' = v  v' = -9.81  u' = 0  c' = 0 }}
            jump bounce on ground falling then hold ground {{ v := -0.5*v  {reset} }}
            minimize x(end)"
        )
    };
    let speed = (2.0 * G).sqrt();
    let way = (2.0 / G).sqrt() + 2.0 * speed / G * 0.475 / 0.525;
    expect_end(&text("c := c - v"), &[("c", 2.0 * speed)]);
    let taken = text("u := (1 - k)*u");
    expect_end(&taken, &[("u", 0.0), ("x", way)]);
    let kink = by_k(&taken).kink.expect("what the limit depends on is not known");
    assert!(matches!(kink.met, KinkMet::ByPile(_)), "{kink:?}");
    for endless in ["c := c + 1", "u := -u", "c := sqrt(1 + c^2)"] {
        let (_, found) = run(&text(endless));
        let is_told = matches!(found.status, Status::Zeno { unsettled: Some(3 | 4), .. });
        assert!(is_told, "{endless}: {:?}", found.status);
    }
}

/// A ball without rebound comes to rest with its first jump, whatever that does to others.
#[test]
fn without_rebound_there_is_one_jump() {
    let text = "time t in [0, 4]  state h start 1  state v start 0  state n start 0
        surface ground = h  dynamics { h' = v  v' = -9.81  n' = 0 }
        jump bounce on ground falling then hold ground { v := 0  n := n + 1 }";
    expect_end(text, &[("h", 0.0), ("v", 0.0), ("n", 1.0)]);
}

/// A ball with restitution 1/2 that gets a speed at some times, bounce by bounce in closed form;
/// what bounces with less than 1e-9 of a speed rests.
struct Ball {
    h: f64,
    v: f64,
}

impl Ball {
    fn fly(&mut self, mut time: f64) {
        loop {
            if self.h <= 0.0 && self.v.abs() < 1e-9 {
                return (self.h, self.v) = (0.0, 0.0);
            }
            let speed = (self.v * self.v + 2.0 * G * self.h.max(0.0)).sqrt();
            let falls = (self.v + speed) / G;
            if falls > time {
                self.h += self.v * time - 0.5 * G * time * time;
                return self.v -= G * time;
            }
            time -= falls;
            (self.h, self.v) = (0.0, 0.5 * speed);
        }
    }
}

#[test]
fn random_kicks_are_followed_as_they_are_in_closed_form() {
    let mut random = Random::new(7);
    for _ in 0..40 {
        let kicks: Vec<(f64, f64)> = (0..3)
            .map(|k| {
                (1.7 + 0.9 * f64::from(k) + random.between(0.0, 0.5), random.between(-3.0, 3.0))
            })
            .collect();
        let last = 4.0 + random.between(0.0, 1.0);
        let (mut clocks, mut ball, mut now) = (String::new(), Ball { h: 1.0, v: 0.0 }, 0.0);
        for (k, (time, v)) in kicks.iter().enumerate() {
            clocks += &format!(
                "surface c{k} = t - {time}  jump k{k} on c{k} rising at most 1 {{ v := {v} }}\n"
            );
            ball.fly(time - now);
            (ball.v, now) = (*v, *time);
        }
        ball.fly(last - now);
        let text = format!(
            "time t in [0, {last}]  state h start 1  state v start 0  surface ground = h
            dynamics {{ h' = v  v' = -9.81 }}
            jump bounce on ground falling then hold ground {{ v := -0.5*v }}\n{clocks}"
        );
        let (_, found) = run(&text);
        assert!(matches!(found.status, Status::Completed), "{text}: {:?}", found.status);
        let off = (found.end[0] - ball.h).abs().max((found.end[1] - ball.v).abs());
        assert!(off < 1e-7, "{text}: {:?}, not {} {}", found.end, ball.h, ball.v);
    }
}
