//! Motions that begin, end, turn or stay on a surface: there a neighbour is on the other side, and
//! derivatives are those of one side.

use fdcc::{Accuracy, Controls, Model, Options, Solution};

fn solved(text: &str) -> Solution {
    let model = Model::from_text("an edge", text).expect("it is right");
    model.solve(&Options::default()).expect("it can be solved")
}

fn expect(text: &str, objective: f64) {
    let solution = solved(text);
    assert!(solution.is_certified(), "{:?}\n{text}", solution.certificate);
    let off = (solution.objective() - objective).abs() / objective.abs().max(1e-3);
    assert!(off < 1e-7, "{} instead of {objective}\n{text}", solution.objective());
}

/// To arrive at 1 and wait costs 0.5. Beyond it time is paid for: whoever is there a moment earlier
/// and comes back in the last moment pays less, so that nothing is the least.
#[test]
fn an_end_on_an_edge_is_no_optimum_where_the_other_side_is_better() {
    let text = "time t in [0, 2]  state x start 0  state c start 0  control u in [-5, 5]
        surface bonus = x - 1
        dynamics { x' = u  c' in u^2 + match bonus { below => 0, above => -1 } }
        end x == 1  minimize c(end)";
    let solution = solved(text);
    assert!(!solution.is_certified() || solution.objective() < 1e-3, "{}", solution.objective());
}

/// To 1 at a constant rate the objective is -0.5. Behind it a thin layer pushes: J falls by 0.76
/// for each unit of x in it.
#[test]
fn a_free_end_on_an_edge_goes_on_where_that_is_better() {
    let text = "time t in [0, 2]  state x start 0  control u in [-5, 5]
        surface z = x - 1  surface y = x - 1.002
        dynamics { x' in u + match z { below => 0, above => 1 }
            - match y { below => 0, above => 60 } }
        minimize integral(u^2) - x(end)";
    let solution = solved(text);
    assert!(!solution.is_certified() || solution.objective() < -0.5014, "{}", solution.objective());
}

/// A swimmer along a shore on which the current is that of either side: what happens is decided by
/// rounding.
#[test]
fn a_motion_along_a_surface_that_nothing_holds_is_not_certified() {
    let text = "time t in [0, 2]  state x start 0  state y start 0
        control u in [-2, 2]  control w in [-2, 2]  surface shore = y
        dynamics { x' in w + match shore { below => 0, above => 0.5 }  y' = u }
        end x == 1  end y == 0  minimize integral(u^2 + w^2)";
    assert!(!solved(text).is_certified());
}

/// A block that starts at once: 13 is what a start to the right saves, 11 what one to the left
/// costs.
#[test]
fn what_moves_the_start_off_its_surface_has_a_kink() {
    let text = "param v0 = 0  param a = 0.5  time t in [0, 1]
        state x start 0  state v start v0  control u  surface slip = v
        dynamics { x' = v  v' in u - a*Sgn(slip) }
        end x == 1  end v == 0  minimize integral(u^2)";
    let solution = solved(text);
    assert!(solution.is_certified());
    let all = solution.sensitivities();
    let of = |name: &str| all.iter().find(|it| it.0 == name).map(|it| it.1);
    assert!(of("v0").is_none_or(f64::is_nan), "{:?}", of("v0"));
    assert!(of("a").is_some_and(|it| (it - 1.0).abs() < 1e-8));
}

/// A puck from rest to rest: `2 mu |v|` is saved or lost at either end.
#[test]
fn what_moves_the_start_off_rest_has_a_kink_under_a_direction_too() {
    let text = "param vx0 = 0  param ve = 0  param mu = 0.5  param T = 3  time t in [0, T]
        state p(x, y) start (0, 0)  state v(x, y) start (vx0, 0)  control u(x, y) in [-9, 9]
        dynamics { p' = v  v' in u - mu*Dir(v) }
        end p == (0.6, 0.8)  end v == (ve, 0)  minimize integral(normsq(u))";
    let solution = solved(text);
    assert!(solution.is_certified());
    let all = solution.sensitivities();
    let of = |name: &str| all.iter().find(|it| it.0 == name).map_or(f64::NAN, |it| it.1);
    assert!(of("vx0").is_nan() && of("ve").is_nan(), "{all:?}");
    assert!(of("mu").is_finite() && of("T").is_finite(), "{all:?}");
}

/// Both sides of a kink are the same: a start on it that leaves it is as good as any other.
#[test]
fn a_start_on_a_continuous_kink_has_a_slope() {
    let text = "param x0 = 0  time t in [0, 1]  state x start x0  control u
        dynamics { x' = u - 0.5*abs(x) }  end x == 1  minimize integral(u^2)";
    let model = Model::from_text("a kink", text).expect("it is right");
    let at = |x0: f64| {
        let model = model.with("x0", x0).expect("a parameter");
        model.solve(&Options::default()).expect("it can be solved")
    };
    let (before, own, after) = (at(-1e-4), at(0.0), at(1e-4));
    assert!(own.is_certified());
    let slope = (after.objective() - before.objective()) / 2e-4;
    let told = own.sensitivities().iter().find(|it| it.0 == "x0").map_or(f64::NAN, |it| it.1);
    assert!((told - slope).abs() < 1e-3 * slope.abs(), "{told} and {slope}");
}

/// `abs` of the function of a surface is its selector times that function: the same model without.
#[test]
fn a_kink_on_a_declared_surface_is_that_surface() {
    let text = |cost: &str| {
        format!(
            "time t in [0, 2]  state x start 0  state v start 0  control u in [-9, 9]
            surface slip = v  dynamics {{ x' = v  v' in u - 0.5*Sgn(slip) }}
            end x == 1  end v == 0  minimize integral(u^2 + 0.5*{cost})"
        )
    };
    let [with, without] = ["abs(v)", "v"].map(|cost| solved(&text(cost)));
    assert!(with.is_certified() && without.is_certified());
    assert!((with.objective() - without.objective()).abs() < 1e-8);
}

/// A tank that stands at its weir for hours: controls keep it on the kink. The same with the level
/// bounded by the kink, where it has none.
#[test]
fn a_state_that_rests_on_a_kink_is_certified() {
    let text = |bound: &str, weir: &str| {
        format!(
            "time t in [0, 4]  state h in [0, {bound}] start 0.5  control q in [0, 2]
            dynamics {{ h' = q - 0.4 - {weir} }}
            end h == 0.5  minimize integral((2 - t)*q + 0.2*q^2 - 0.5*h)"
        )
    };
    let [with, without] = [text("9", "3*max(0, h - 1.5)"), text("1.5", "0")].map(|it| solved(&it));
    assert!(with.is_certified() && without.is_certified());
    let off = (with.objective() - without.objective()).abs();
    assert!(off < 1e-6, "{} and {}", with.objective(), without.objective());
}

/// What a train takes is worth more than what it gives back: the same with a control for each.
#[test]
fn kinks_over_a_long_time_are_certified_though_means_mix_both_sides() {
    let train = |controls: &str, a: &str, cost: &str| {
        format!(
            "time t in [0, 120]  state s start 0  state v in [0, 22] start 0  {controls}
            dynamics {{ s' = v  v' = {a} - 0.02 - 0.0002*v^2 }}
            end s == 2000  end v == 0  minimize integral({cost})"
        )
    };
    let one = train("control a in [-1, 1]", "a", "max(a*v, 0) - 0.6*max(-a*v, 0)");
    let two = train("control a in [0, 1]  control b in [0, 1]", "a - b", "a*v - 0.6*b*v");
    let [one, two] = [one, two].map(|it| solved(&it));
    assert!(one.is_certified() && two.is_certified());
    let off = (one.objective() - two.objective()).abs() / two.objective();
    assert!(off < 1e-7, "{} and {}", one.objective(), two.objective());
}

/// A puck that is all but at rest starts to move: its direction turns faster than time can tell.
/// It has a constant acceleration, as from rest.
#[test]
fn a_start_beside_rest_is_a_start_from_rest() {
    for (x, y) in [("0", "0"), ("-1.5e-23", "1e-23"), ("-1.5e-17", "1e-17"), ("-1.5e-15", "1e-15")]
    {
        let text = format!(
            "state v(x, y) start ({x}, {y})  control u(x, y) in [-3, 3]  time t in [1.7, 2]
            dynamics {{ v' in u - 0.8*Dir(v) }}  guess {{ u = (-1, 0.5) }}"
        );
        let model = Model::from_text("a puck", &text).expect("it is right");
        let simulation =
            model.simulate(&Controls::Guess, &Accuracy::default()).expect("it can be simulated");
        let last = |name: &str| simulation.state(name).and_then(|it| it.last().copied());
        let speed = last("v.x").expect("it ends").hypot(last("v.y").expect("it ends"));
        assert!((speed - 0.3 * (1.25_f64.sqrt() - 0.8)).abs() < 1e-9, "{x}: {speed}");
    }
}

/// Two phases with a `Dir` each, the second from rest with twice the mass.
#[test]
fn a_factor_before_a_vector_rate_makes_no_difference() {
    let text = |second: &str| {
        format!(
            "free T1 in [0.3, 5] guess 1.5  free T2 in [0.3, 5] guess 1.5
            state p(x, y) start (0, 0)  state v(x, y) start (0, 0)  control u(x, y) in [-3, 3]
            phase empty {{ time t in [0, T1]  dynamics {{ p' = v  v' in u - 0.4*Dir(v) }}
                end p == (1, 0.5)  end v == 0 }}
            phase loaded {{ time t in [T1, T1 + T2]  dynamics {{ p' = v  {second} }} }}
            link empty -> loaded {{}}
            end p == (0, 1)  end v == 0  minimize T1 + T2 + 0.2*integral(normsq(u))"
        )
    };
    let half = solved(&text("v' in u/2 - 0.8*Dir(v)/2"));
    assert!(half.is_certified());
    expect(&text("2*v' in u - 0.8*Dir(v)"), half.objective());
}

/// Three charges in as much of the time as there is cost more than `6 / (1 - e^-2)`, and come as
/// near to that as one likes. The number of spikes is a condition and follows from their sequence:
/// its multiplier may be anything, and must not excuse what is not stationary.
#[test]
fn large_multipliers_excuse_nothing() {
    let text = "time t in [0, 3]  state v start 0  state n start 0  control I in [0, 10] guess 2
        surface level = v - 1  dynamics { v' = I - v  n' = 0 }
        jump spike on level rising at most 4 { v := 0  n := n + 1 }
        end n >= 3  minimize integral(I^2)";
    let solution = solved(text);
    let least = 6.0 / (1.0 - (-2.0_f64).exp());
    let off = solution.objective() - least;
    assert!(!solution.is_certified() || off < 1e-6, "{off}");
}

/// At `h0 = 1` the motion ends on the surface of a jump that is worth 0.1 and does not happen; it
/// does for all that begin lower, so that nothing is the least.
#[test]
fn an_end_on_the_surface_of_a_jump_is_no_optimum() {
    let text = "free h0 in [0.5, 2] guess 1  time t in [0, 1]
        state x start h0  state y start 0  surface s = x  dynamics { x' = -1  y' = 0 }
        jump j on s falling at most 1 { y := 1 }  minimize (h0 - 1)^2 - 0.1*y(end)";
    let solution = solved(text);
    assert!(!solution.is_certified() || solution.objective() < -0.09, "{}", solution.objective());
}
