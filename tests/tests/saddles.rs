//! A stationary point that is no minimum is left, wherever its direction of negative curvature is:
//! along controls, states or unknowns, hidden by a barrier, or one that steps creep towards.

use fdcc_tests::models::{assert_solved, solved};

/// What a quantity gains that is small for the others: a barrier that is worth more keeps it in the
/// middle of its bounds, where it is a maximum. `J = -4e-12` and `-4e-10`, at both bounds of `p`.
#[test]
fn a_saddle_that_the_barrier_hides_is_left() {
    let at_a_saddle = |controls: &str, objective: &str| {
        format!(
            "time t in [0, 1] [s] state x [m] start 0 {controls} dynamics {{ x' = 1[1/s]*w }}
             minimize {objective} method {{ N = 10 }}"
        )
    };
    let apart = "control p [um] in [-2, 2] control w [m] in [-1, 1]";
    let alike = "control p [m] in [-2, 2] control w [m] in [-1, 1]";
    for (controls, objective, least) in [
        (apart, "integral(w^2 - p^2)", -4e-12),
        (apart, "x(end)^2 - integral(p^2)/1[s]", -4e-12),
        (alike, "integral(w^2 - 1e-10*p^2)", -4e-10),
        (alike, "integral(w^2 - 1e-12*p^2)", -4e-12),
    ] {
        let text = at_a_saddle(controls, objective);
        assert_solved(&text, &solved(&text), least);
    }
}

/// At the guess the gradient is exactly 0.
#[test]
fn a_guess_on_a_saddle_is_left() {
    let text = "time t in [0, 1] state x start 0 control u in [-1, 1] dynamics { x' = u }\n\
                minimize -x(end)^2 + integral(u^2)/2 method { N = 10 }";
    assert_solved(text, &solved(text), -0.5);
}

/// With a condition at the end the direction of negative curvature has to be told from others that
/// curve nearly as much. `J >= (1 - c) x(end)^2` by Cauchy and Schwarz, with equality for a
/// constant control.
#[test]
fn a_saddle_beside_a_condition_is_left() {
    let cases =
        [("1e3", "100", 5.0, -40000.0), ("300", "1", 1.5, -0.5), ("100", "10", 5.0, -400.0)];
    for (range, end, weight, least) in cases {
        for intervals in [10, 20, 21] {
            let text = format!(
                "time t in [0, 1] state x start 0 control u in [-{range}, {range}] dynamics {{ x' \
                 = u }}\nend -{end} <= x <= {end}\nminimize integral(u^2) - {weight}*x(end)^2 \
                 method {{ N = {intervals} }}"
            );
            assert_solved(&text, &solved(&text), least);
        }
    }
}

/// To pass by an obstacle on one side or the other; the way through its middle is a saddle, to
/// which regularised steps are slow. J on either side as from an asymmetric guess.
#[test]
fn a_saddle_to_which_steps_are_slow_is_left() {
    let text = |range: &str, guess: &str| {
        format!(
            "time t in [0, 1] state x start -1 state y start 0\n\
             control u in [-{range}, {range}] control w in [-{range}, {range}]\n\
             dynamics {{ x' = u  y' = w }} end x == 1 end y == 0 {guess}\n\
             minimize integral(u^2 + w^2 + 100*exp(-4*(x^2 + y^2))) method {{ N = 50 }}"
        )
    };
    let beside = solved(&text("1e3", "guess { y = sin(3*t) }"));
    assert_solved("through the middle", &solved(&text("1e6", "")), beside.objective);
}

/// An unknown that nothing but the objective reads is at its maximum at the guess, beside controls
/// of so little curvature that regularised steps creep; and ranges that are small beside a unit.
/// Whatever the rest does is least at 0, so that `J = -r^2` at either end of the range `r` of `p`.
#[test]
fn a_saddle_along_an_unknown_is_left() {
    let along = |range: &str, rate: &str, objective: &str| {
        let text = format!(
            "free w in [-1, 2] guess 0 free p in [-{range}, {range}] guess 0 time t in [0, 1]\n\
             state x start 0 state y start w control u in [-1, 1] guess 0 surface s = x\n\
             dynamics {{ x' in u - 0.2*x{rate} y' = u - y }}\nminimize {objective}"
        );
        let model = fdcc::Model::from_text("along", &text).expect("it has no mistakes");
        (text, model.solve(&fdcc::Options::default()).expect("it can be solved"))
    };
    let creeping = "integral(w^2 - p^2 + u^2 + y^2)";
    let small = "integral(w^2 + u^2 + y^2) - p^2";
    for (range, rate, objective) in [
        ("1", "", creeping),
        ("1", " - 0.3*Sgn(s)", creeping),
        ("1", "", small),
        ("1e-3", "", small),
        ("1e-4", "", small),
    ] {
        let (text, found) = along(range, rate, objective);
        let least = -range.parse::<f64>().expect("it is a number").powi(2);
        let difference = (found.objective() - least).abs();
        assert!(found.is_certified(), "{text}: {:?}", found.status());
        assert!(difference <= 1e-6 * least.abs(), "{text}: {}", found.objective());
    }
}

/// The same along a start, `J = -r^2`.
#[test]
fn a_saddle_along_a_start_is_left() {
    for range in [1.0f64, 1e-3, 1e-4, 1e-6] {
        let text = format!(
            "time t in [0, 1] state x start free in [-{range}, {range}] state v start 0\n\
             control u in [-1, 1] dynamics {{ x' = v  v' = u }}\n\
             minimize integral(u^2) - x(start)^2 + v(end)^2"
        );
        let model = fdcc::Model::from_text("start", &text).expect("it has no mistakes");
        let found = model.solve(&fdcc::Options::default()).expect("it can be solved");
        let least = -range.powi(2);
        assert!(found.is_certified(), "{text}: {:?}", found.status());
        assert!((found.objective() - least).abs() <= 1e-6 * range.powi(2), "{text}");
    }
}

/// A push of a truck in newtons: its bounds are no statement about its size, and one newton moves
/// nothing. `cos(x(end))` is least at `x = pi`, with the guess at its maximum; and a hill beside
/// the path of a truck, J as in kilonewtons.
#[test]
fn a_saddle_of_a_large_number_is_left() {
    let push = |unit: &str, room: &str| {
        format!(
            "free F in [-{room}, {room}] [{unit}] time t in [0, 2] [s] state x [m] start 0
             state v [m/s] start 0 const m = 1e5 [kg]
             dynamics {{ x' = v  m*v' = F }} minimize cos(x(end)/1[m])"
        )
    };
    let hill = |unit: &str, room: &str| {
        format!(
            "time t in [0, 12] [s] state x [m] start 0 state v [m/s] start 0 const m = 1e5 [kg]
             control F [{unit}] in [-{room}, {room}] dynamics {{ x' = v  m*v' = F }}
             end x == 0 end v == 0
             minimize integral(0.05*(F/1e5[N])^2 + exp(-(x/1[m])^2))"
        )
    };
    let solved = |text: &str| {
        let model = fdcc::Model::from_text("truck", text).expect("it has no mistakes");
        let found = model.solve(&fdcc::Options::default()).expect("it can be solved");
        assert!(found.is_certified(), "{text}: {:?}", found.certificate);
        found.objective()
    };
    assert!((solved(&push("N", "3e5")) + 1.0).abs() < 1e-6);
    let [large, small] = [solved(&hill("N", "5e5")), solved(&hill("kN", "500"))];
    assert!(large < 11.0 && (large - small).abs() < 1e-6 * small, "{large} {small}");
}

/// A way down from a flat point that the iterations do not suffice for is one all the same.
#[test]
fn a_saddle_at_the_last_iteration_is_no_optimum() {
    let text = "time t in [0, 1] state x start 0 control u in [-1, 1] dynamics { x' = u }
                minimize 1 + x(end)^3 method { N = 50 }";
    let model = fdcc::Model::from_text("cubic", text).expect("it has no mistakes");
    for most in 5..16 {
        let model = model.with_method("max_iter", f64::from(most)).expect("it is a number");
        let found = model.solve(&fdcc::Options::default()).expect("it can be solved");
        let is_least = found.objective().abs() < 1e-6;
        assert!(is_least || !found.status().is_solved(), "{most}: {}", found.objective());
    }
}
