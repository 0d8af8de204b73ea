//! Where there is no derivative the result says so, why, and what the derivatives of both sides
//! are; all in closed form.

use fdcc_compiler::compile_sensitivities;
use fdcc_runtime::sensitivity::{
    KinkMet, NondifferentiabilityKind, Quantity, gradient, hessian, one_sided,
};
use fdcc_runtime::simulate::{Controls, Options, System};
use fdcc_tests::models::meaning;

struct Kink {
    text: &'static str,
    trouble: Option<(NondifferentiabilityKind, f64)>,
    by: &'static str,
    sides: [f64; 2],
}

/// The first derivative of each model is by the parameter named.
const KINKS: [Kink; 14] = [
    Kink {
        // x(T) = (x0 - T)+
        text: "param x0 = 1  time t in [0, 1]  state x start x0  surface zero = x
            dynamics { x' in -Sgn(zero) }  minimize x(end)",
        trouble: Some((NondifferentiabilityKind::End, 1.0)),
        by: "x0",
        sides: [0.0, 1.0],
    },
    Kink {
        // the same before and after the kink
        text: "param x0 = 1.5  time t in [0, 1]  state x start x0  surface zero = x
            dynamics { x' in -Sgn(zero) }  minimize x(end)",
        trouble: None,
        by: "x0",
        sides: [1.0, 1.0],
    },
    Kink {
        // example (g1) of the references: y(2) = p - 1 for p < 0, -1 for p > 0
        text:
            "param p = 0  time t in [0, 2]  state x start -1  state y start -1 + p  surface edge \
               = y
            dynamics { x' = 1  y' in match edge { below => -2*x, above => -2*x - 1 } }  minimize \
            y(end)",
        trouble: Some((NondifferentiabilityKind::Grazing, 1.0)),
        by: "p",
        sides: [1.0, 0.0],
    },
    Kink {
        // two surfaces at once: z(2) = 2 - 2 |x0 + 1|
        text: "param x0 = -1  time t in [0, 2]  state x start x0  state y start -1  state z start 0
            surface first = x  surface second = y
            dynamics { x' = 1  y' = 1  z' in Sgn(first)*Sgn(second) }  minimize z(end)",
        trouble: Some((NondifferentiabilityKind::Corner, 1.0)),
        by: "x0",
        sides: [2.0, -2.0],
    },
    Kink {
        // a start on a surface that is left: x(1) = x0 + 2 from above, and (x0 + 1/3) * ... from
        // below
        text: "param x0 = 0  time t in [0, 1]  state x start x0  surface zero = x
            dynamics { x' in match zero { below => 1, above => 2 } }  minimize x(end)",
        trouble: Some((NondifferentiabilityKind::Coincident, 0.0)),
        by: "x0",
        sides: [2.0, 1.0],
    },
    Kink {
        // a parameter that moves nothing at that start: x(1) = 2 a
        text: "param a = 1  time t in [0, 1]  state x start 0  surface zero = x
            dynamics { x' in match zero { below => 1, above => 2*a } }  minimize x(end)",
        trouble: Some((NondifferentiabilityKind::Coincident, 0.0)),
        by: "a",
        sides: [2.0, 2.0],
    },
    Kink {
        // one that ends sliding is differentiable
        text: "param x0 = 0.5  time t in [0, 1]  state x start x0  surface zero = x
            dynamics { x' in -Sgn(zero) }  minimize x(end)",
        trouble: None,
        by: "x0",
        sides: [0.0, 0.0],
    },
    Kink {
        // a force at the limit of friction: x(1) = (F - 1)/2 for F > 1
        text: "param F = 1  time t in [0, 1]  state x start 0  state v start 0  surface slip = v
            dynamics { x' = v  v' in F - Sgn(slip) }  minimize x(end)",
        trouble: Some((NondifferentiabilityKind::Limit, 0.0)),
        by: "F",
        sides: [0.0, 0.5],
    },
    Kink {
        // the same of a force that rises to the limit and stays, which rounding decides: for F > 1
        // x(2) = (F - 1)/2
        text: "param F = 1  time t in [0, 2]  state x start 0  state v start 0  surface slip = v
            dynamics { x' = v  v' in F*min(t, 1) - Sgn(slip) }  minimize x(end)",
        trouble: Some((NondifferentiabilityKind::End, 2.0)),
        by: "F",
        sides: [0.0, 0.5],
    },
    Kink {
        // one that starts at the limit and is let go at once: v(1) = 1/2 for a < 0
        text: "param a = 0  time t in [0, 1]  state v start a  surface p = v
            dynamics { v' in 1 + t - Sgn(p) }  minimize v(end)",
        trouble: Some((NondifferentiabilityKind::Limit, 0.0)),
        by: "a",
        sides: [0.0, 1.0],
    },
    Kink {
        // the same, written otherwise
        text: "param a = 0  time t in [0, 1]  state x start 0  state v start a  surface p = v
            dynamics { x' = v  v' in match p { below => 1, above => t } }  minimize v(end)",
        trouble: Some((NondifferentiabilityKind::Limit, 0.0)),
        by: "a",
        sides: [0.0, 1.0],
    },
    Kink {
        // friction in every direction: v(1) = F - 1 for F > 1
        text: "param F = 1  time t in [0, 1]  state v(x, y) start (0, 0)
            dynamics { v' in (0.6*F, 0.8*F) - Dir(v) }  minimize 5*v.x(end)",
        trouble: Some((NondifferentiabilityKind::Limit, 0.0)),
        by: "F",
        sides: [0.0, 3.0],
    },
    Kink {
        // what is at the limit and depends on nothing
        text: "param a = 2  time t in [0, 1]  state y start a  state v start 0  surface slip = v
            dynamics { y' = a  v' in 1 - Sgn(slip) }  minimize y(end) + v(end)",
        trouble: Some((NondifferentiabilityKind::Limit, 0.0)),
        by: "a",
        sides: [2.0, 2.0],
    },
    Kink {
        // a reset that is grazed: h = (t - 1)^2 + c bounces only if c < 0, then h(2) = 2 sqrt(-c) +
        // 1 + ...
        text: "param c = 0.01  time t in [0, 2]  state h start 1 + c  state v start -2  surface \
               floor = h
            dynamics { h' = v  v' = 2 }  jump bounce on floor falling { v := -v }  minimize h(end)",
        trouble: None,
        by: "c",
        sides: [1.0, 1.0],
    },
];

fn parameter(system: &System, name: &str) -> Quantity {
    Quantity::Parameter(
        system.parameters.iter().position(|it| it.name == name).expect("a parameter"),
    )
}

#[test]
fn a_kink_is_found_with_its_reason_and_both_derivatives() {
    for Kink { text, trouble, by, sides } in KINKS {
        let system = compile_sensitivities(&meaning(text)).expect("it can be simulated");
        let quantities = [parameter(&system, by)];
        let options = Options::default();
        let found =
            gradient(&system, &Controls::Guess, &options, &quantities).expect("it reaches the end");
        let named = found.nondifferentiabilities.first().map(|it| (it.kind, it.time));
        match (named, trouble) {
            (None, None) => {}
            (Some((kind, time)), Some((expected, at))) => {
                assert!(kind == expected && (time - at).abs() < 1e-6, "{text}: {kind:?} at {time}");
            }
            _ => panic!("{text}: {:?}", found.nondifferentiabilities),
        }
        let got = one_sided(&system, &Controls::Guess, &options, &quantities)[0];
        for (got, expected) in got.iter().zip(sides) {
            let got = got.expect("both sides reach the end");
            assert!((got - expected).abs() < 1e-3, "{text}: {got}, not {expected}");
        }
    }
}

/// An objective that is another one on one side has an infinite derivative there. Each is 0 or 1
/// more where something happens: below `p`, or above it.
#[test]
fn where_the_objective_jumps_a_derivative_is_infinite() {
    let jump = "dynamics { x' = -1  y' = 0 }
        jump j on s falling at most 1 { y := 1 }  minimize y(end)";
    let at = |p: &str| {
        format!(
            "param p = {p}  time t in [0, 1]  state x start p  state y start 0
            surface s = x {jump}"
        )
    };
    let both = "param p = 1  time t in [0, 2]  state x start 1  state y start p  state z start 1
        surface sx = x  surface sy = y  dynamics { x' = -1  y' = -1  z' = 0 }
        jump a on sx falling at most 1 { z := 2*z }  jump b on sy falling at most 1 { z := z + 1 }
        minimize z(end)";
    let grazed = "param p = 0  time t in [0, 2]  state h start 1 + p  state v start -2
        state y start 0  surface s = h  dynamics { h' = v  v' = 2  y' = 0 }
        jump j on s falling at most 1 { y := 1 }  minimize y(end)";
    // It happens at the end, at the start, before another jump, or not at all.
    for text in [at("1").as_str(), at("0").as_str(), both, grazed] {
        let system = compile_sensitivities(&meaning(text)).expect("it can be simulated");
        let (by, options) = ([parameter(&system, "p")], Options::default());
        let found = gradient(&system, &Controls::Guess, &options, &by).expect("it ends");
        assert!(!found.nondifferentiabilities.is_empty(), "{text}");
        let [below, above] = one_sided(&system, &Controls::Guess, &options, &by)[0];
        let sides = [below, above].map(|it| it.expect("both sides end").abs());
        assert!(sides.contains(&f64::INFINITY) && sides.contains(&0.0), "{text}: {sides:?}");
    }
}

/// `z(end) = 1 + max(0, p)`, `1 + |p|`, and `x(end) = |p|`: the surface is met on a kink of its
/// function. Beside it there is none.
#[test]
fn a_surface_that_is_met_on_a_kink_is_seen() {
    let crossing = "z' in match s { below => 0, above => 1 } }  minimize z(end)";
    let larger = format!(
        "state y start -1 + p  state z start 0  surface s = max(x, y)
         dynamics {{ x' = 1  y' = 1  {crossing}"
    );
    let farther = format!(
        "state y start p  state z start 0  surface s = x + abs(y)
         dynamics {{ x' = 1  y' = 0  {crossing}"
    );
    let slides = "state y start p  surface s = x - abs(y)
        dynamics { x' in 0.5 - 2*Sgn(s)  y' = 0 }  minimize x(end)";
    for text in [larger.as_str(), &farther, slides] {
        for p in [0.0, 0.25] {
            let text = format!("param p = {p}  time t in [0, 2]  state x start -1 {text}");
            let system = compile_sensitivities(&meaning(&text)).expect("it can be simulated");
            let by = [parameter(&system, "p")];
            let found = gradient(&system, &Controls::Guess, &Options::default(), &by);
            let kink = found.expect("it ends").kink;
            let is_met = kink.as_ref().is_some_and(|it| matches!(it.met, KinkMet::BySurface(_)));
            assert_eq!(is_met, p == 0.0, "{text}: {kink:?}");
        }
    }
}

/// A start on a surface that is held: by a direction that leaves it there is no second derivative.
#[test]
fn a_start_that_slides_has_second_derivatives_along_the_surface_only() {
    let text = "param c = 1  time t in [0, 1]  state x start 0  state y start 1  surface zero = x
        dynamics { x' in -Sgn(zero)  y' = c*c*y }  minimize y(end) + x(end)";
    let system = compile_sensitivities(&meaning(text)).expect("it can be simulated");
    let options = Options::default();
    let by_c = [parameter(&system, "c")];
    let found = gradient(&system, &Controls::Guess, &options, &by_c).expect("it reaches the end");
    let second = hessian(&system, &Controls::Guess, &found.simulation, &by_c)
        .expect("it stays on the surface")[0][0];
    // d2/dc2 exp(c^2) = (2 + 4 c^2) exp(c^2)
    assert!((second - 6.0 * 1.0_f64.exp()).abs() < 1e-7, "{second}");
    assert!(hessian(&system, &Controls::Guess, &found.simulation, &[Quantity::Start(0)]).is_none());
}

/// `x(end) = |a| + 1`, the last time is `max(a, 1)`, and `y(end) = -2 |a|`: with a kink of the
/// parameter alone, wherever the state is; beside it there is none. So have `exp(max(a, 0))` and
/// `e |a|`, as soon as the right side is not multiplied by 0.
#[test]
fn kinks_of_parameters_alone_are_seen() {
    let texts = [
        ("a", 0.0, "time t in [0, 1] state x start abs(a) dynamics { x' = 1 } minimize x(end)"),
        ("T", 1.0, "time t in [0, max(T, 1)] state x start 0 dynamics { x' = 1 } minimize x(end)"),
        (
            "a",
            0.0,
            "time t in [0, 1] state x start -0.5 state y start 0 surface s = x - abs(a)
             dynamics { x' = 1 y' in Sgn(s) } minimize y(end)",
        ),
        (
            "a",
            0.0,
            "time t in [0, 1] state x start 1 dynamics { x' = max(a, 0)*x } minimize x(end)",
        ),
        (
            "a",
            1.0,
            "time t in [0, 2] state x start 0 dynamics { x' = max(t - 1, 0)*min(a, 1) }
             minimize x(end)",
        ),
        (
            "a",
            0.0,
            "time t in [0, 1] state x start 1 dynamics { x' = x } minimize integral(x*abs(a))",
        ),
        (
            "a",
            0.0,
            "time t in [0, 1] state x start 1 dynamics { x' = max(a, 0) + min(a, 0) }
             minimize x(end)",
        ),
        (
            "a",
            0.0,
            "param b = max(a, 0) time t in [0, 1] state x start 1 dynamics { x' = b*x }
             minimize x(end)",
        ),
        (
            "a",
            0.0,
            "time t in [0, 1] state x start 1 control u in [-1, 1] dynamics { x' = u }
             guess { u = 0.1 + max(a, 0) } minimize x(end)",
        ),
        (
            "a",
            0.0,
            "time t in [0, 2] state x start 1 control u in [-9, 9] dynamics { x' = u }
             guess { u = abs(a)*t } minimize x(end)",
        ),
    ];
    for (name, place, text) in texts {
        for (value, is_on) in [(place, true), (place + 0.1, false), (place - 0.1, false)] {
            let whole = meaning(&format!("param {name} = {value} {text}"));
            let system = compile_sensitivities(&whole).expect("it can be simulated");
            let by = [parameter(&system, name)];
            let found = gradient(&system, &Controls::Guess, &Options::default(), &by);
            let kink = found.expect("the last time is reached").kink;
            let is_found = kink.is_some_and(|it| it.met == KinkMet::ByParameters);
            assert_eq!(is_found, is_on, "{text} at {value}");
        }
    }
}

/// `a |a|` and `max(a, 0)^2` have one derivative at 0, and what is multiplied by 0 has all.
#[test]
fn kinks_of_parameters_that_bend_nothing_are_none() {
    let text = "param a = 0 time t in [0, 1] state x start 1 state y start 0
        dynamics { x' = a*abs(a)*x + max(a, 0)^2 + 0.3*a + 1000.1 y' = max(a, 0)*y }
        minimize x(end) + y(end)";
    let system = compile_sensitivities(&meaning(text)).expect("it can be simulated");
    let by = [parameter(&system, "a")];
    let found = gradient(&system, &Controls::Guess, &Options::default(), &by);
    let kink = found.expect("the last time is reached").kink;
    assert!(kink.is_none(), "{kink:?}");
}

/// Surfaces, starts and resets that are sums which cancel and have no kink: where a regime begins
/// on its surface its value is rounding, and says nothing of the size of its terms.
#[test]
fn rounding_is_no_kink() {
    let on = |surface: &str| {
        format!(
            "time t in [0, 3] state x start -1 state y start 0.5 surface s = {surface}
             dynamics {{ x' in 2 - Sgn(s) y' = -0.1 }} minimize x(end)"
        )
    };
    let surfaces = ["x - 0.2*p", "x - p", "5*x - p", "x - p*y", "x + p*t", "sin(2.35*t + p)"];
    let mut texts: Vec<String> = surfaces.map(on).into();
    texts.push(
        "time t in [0, 1] state x start 1 - cos(p/300) dynamics { x' = 1 } minimize x(end)".into(),
    );
    texts.push(
        "time t in [0, 1] state x start -1 surface s = x dynamics { x' = 3 }
         jump j on s rising at most 1 { x := x + 3*p - 2.1 } minimize x(end)"
            .into(),
    );
    for text in texts {
        for p in [0.7, 0.83, 0.9, 1.0, 1.07, 1.1, 1.3] {
            let system = compile_sensitivities(&meaning(&format!("param p = {p} {text}")));
            let system = system.expect("it can be simulated");
            let by = [parameter(&system, "p")];
            let found = gradient(&system, &Controls::Guess, &Options::default(), &by);
            let kink = found.expect("the last time is reached").kink;
            assert!(kink.is_none(), "{text} at {p}: {kink:?}");
        }
    }
}

/// `x := x + |p - 0.7|` where `p` is 0.7: the state is 0, the reset as well.
#[test]
fn a_kink_of_a_reset_that_is_zero_is_seen() {
    let text = "param p = 0.7 time t in [0, 1] state x start -1 surface s = x dynamics { x' = 3 }
        jump j on s rising at most 1 { x := x + abs(p - 0.7) } minimize x(end)";
    let system = compile_sensitivities(&meaning(text)).expect("it can be simulated");
    let by = [parameter(&system, "p")];
    let found = gradient(&system, &Controls::Guess, &Options::default(), &by);
    let kink = found.expect("the last time is reached").kink.expect("it is on a kink");
    assert!(matches!(kink.met, KinkMet::ByJump(_)), "{kink:?}");
}
