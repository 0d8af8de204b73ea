//! Optima that lie on kinks of `abs`, `min` and `max`, or cross them, against closed forms.

use fdcc::{Model, Options, Solution};

struct OnKink {
    text: &'static str,
    objective: f64,
    is_global: bool,
}

/// The work of both burns of a rocket that starts and ends at rest: `t (T - t) = d`.
const BURN: f64 = 0.267_949_192_431_122_7;

fn all() -> Vec<OnKink> {
    vec![
        // Least fuel: one burn at each end.
        OnKink {
            text: "time t in [0, 4]  state x start 0  state v start 0  control u in [-1, 1]
                dynamics { x' = v  v' = u }  end x == 1  end v == 0
                minimize integral(abs(u))",
            objective: 2.0 * BURN,
            is_global: true,
        },
        OnKink {
            text: "time t in [0, 4]  state x start 0  state v start 0  control u in [-1, 1]
                dynamics { x' = v  v' = u }  end x == 1  end v == 0
                maximize integral(-abs(u))",
            objective: -2.0 * BURN,
            is_global: true,
        },
        // Braking costs twice as much; both kinks are at one place.
        OnKink {
            text: "time t in [0, 4]  state x start 0  state v start 0  control u in [-1, 1]
                dynamics { x' = v  v' = u }  end x == 1  end v == 0
                minimize integral(max(u, 0) + 2*max(-u, 0))",
            objective: 3.0 * BURN,
            is_global: true,
        },
        // The same as a tariff by blocks, one knot of which is never met.
        OnKink {
            text: "fn c(u) = piecewise { u <= -2 => -2 - 3*u  u <= 0 => -2*u  otherwise => u }
                time t in [0, 4]  state x start 0  state v start 0  control u in [-1, 1]
                dynamics { x' = v  v' = u }  end x == 1  end v == 0
                minimize integral(c(u))",
            objective: 3.0 * BURN,
            is_global: true,
        },
        // A toll of 2 for each unit of x beyond 1: u is 1/2 until there, at t = 2, then grows by 1
        // in each unit of time.
        OnKink {
            text: "fn toll(x) = piecewise { x <= 1 => 0  otherwise => 2*(x - 1) }
                time t in [0, 3]  state x start 0  control u in [-3, 3]
                dynamics { x' = u }  end x == 2  minimize integral(u^2 + toll(x))",
            objective: 29.0 / 12.0,
            is_global: true,
        },
        // u = -3/8
        OnKink {
            text: "time t in [0, 1]  state x start 1  control u in [-5, 5]  dynamics { x' = u }
                minimize integral(u^2 + 0.5*abs(u)) + x(end)^2",
            objective: 0.718_75,
            is_global: true,
        },
        // The end is on the kink: 2*0.8 < 3.
        OnKink {
            text: "time t in [0, 1]  state x start 1  control u in [-1, 1]  dynamics { x' = u }
                minimize integral(u^2) + 3*abs(x(end) - 0.2)",
            objective: 0.64,
            is_global: true,
        },
        // A battery beside a sun that rises at 12: until 13 power costs 0.30, afterwards 0.08 is
        // paid for what is left. Its one unit is used at first and comes back from the sun. The
        // kink of time alone is none that an optimum lies on.
        OnKink {
            text: "time t in [0, 24]  state E in [0, 5] start 1  control b in [-2, 2]
                let net = 1 - max(0, t - 12) + b  dynamics { E' = b }  end E >= 1
                minimize integral(max(0.30*net, 0.08*net))",
            objective: 0.30 * 12.5 - 0.08 * 60.5 - 0.30 + 0.08,
            is_global: false,
        },
        // Rest at the kink from x = u^2/10 on.
        OnKink {
            text: "time t in [0, 2]  state x start 1  control u in [-1, 1]  dynamics { x' = u }
                minimize integral(abs(x) + 0.1*u^2)",
            objective: 0.495 + 0.09 + 1.0 / 75.0,
            is_global: true,
        },
        // A dead zone: the force that is left is half of what is paid for.
        OnKink {
            text: "time t in [0, 2]  state x start 1  control u in [-3, 3]
                dynamics { x' = max(u - 0.5, 0) - max(-u - 0.5, 0) }  end x == 0
                minimize integral(u^2)",
            objective: 2.0,
            is_global: false,
        },
        OnKink { text: LEAK, objective: leak(), is_global: false },
        // Two engines share a limit: first the longer way, then both.
        OnKink {
            text: "time t in [0, 3]  state x start 1  state y start 0.5  control u(a, b)
                dynamics { x' = u.a  y' = u.b }  path abs(u.a) + abs(u.b) <= 1
                minimize integral(x^2 + y^2)",
            objective: 7.0 / 12.0,
            is_global: true,
        },
        // The smaller of two returns is largest where both are equal.
        OnKink {
            text: "time t in [0, 1]  state x start 0  control u in [-2, 2]
                dynamics { x' = u }  maximize integral(min(u, 1 - u))",
            objective: 0.5,
            is_global: true,
        },
        // Nothing is done, and all kinks are at rest.
        OnKink {
            text: "time t in [0, 3]  state x start 1  control u in [-1, 1]
                dynamics { x' = abs(u) - abs(x) }  minimize integral(u^2) + abs(x(end))",
            objective: (-3.0_f64).exp(),
            is_global: false,
        },
        // A load that sets in at 0.7: the control is constant.
        OnKink {
            text:
                "time t in [0, 2]  state x start 0  control u  dynamics { x' = u - max(t - 0.7, 0) }
                minimize integral(u^2) + 10*(x(end) - 1)^2",
            objective: 10.0 * 1.845 * 1.845 / 21.0,
            is_global: false,
        },
        // A price that rises until 1.2: at the bound until 1, then 5*(1.4 - t), then 1.
        OnKink {
            text: "time t in [0, 2]  state x start 0  control u in [0, 2]  dynamics { x' = u }
                end x == 3.1  minimize integral(u*min(t, 1.2) + 0.1*u^2)",
            objective: 211.0 / 75.0,
            is_global: false,
        },
        // A load with a kink inside of a kink: it is there before 0.55 and behind 1.45.
        OnKink {
            text: "time t in [0, 2]  state x start 0  control u
                dynamics { x' = u - max(abs(t - 1) - 0.45, 0) }
                minimize integral(u^2) + 10*(x(end) - 1)^2",
            objective: 10.0 * 1.3025 * 1.3025 / 21.0,
            is_global: false,
        },
        // As far as a disc allows, from the middle of it: lengths have no derivative there.
        OnKink {
            text: "time t in [0, 1]  state x start 0  state y start 0  control u(a, b)
                dynamics { x' = u.a  y' = u.b }  path norm(u) <= 1
                maximize x(end) + y(end) - 0.01*integral(normsq(u))",
            objective: std::f64::consts::SQRT_2 - 0.01,
            is_global: false,
        },
        // The nearest point of a disc: (0.5, 0).
        OnKink {
            text: "param r = 0.5  time t in [0, 1]  state p(x, y) start (1, 0)  control u(x, y)
                dynamics { p' = u }  end norm(p) <= r  minimize integral(normsq(u))",
            objective: 0.25,
            is_global: false,
        },
        // The nearest point of a square: (0.5, 0).
        OnKink {
            text: "time t in [0, 1]  state x start 1  state y start 0.2  control u(a, b)
                dynamics { x' = u.a  y' = u.b }  end abs(x) + abs(y) <= 0.5
                minimize integral(normsq(u))",
            objective: 0.29,
            is_global: true,
        },
    ]
}

/// A leak that ends at 0.
const LEAK: &str = "time t in [0, 2]  state x start 1  control u  dynamics { x' = u - max(x, 0) }
    end x == -1  minimize integral(u^2)";

/// `u = -c e^t` until `x = 0`, constant from then on, where `sinh(t) = 2 - t`.
fn leak() -> f64 {
    let mut t: f64 = 1.0;
    for _ in 0..50 {
        t -= (t.sinh() + t - 2.0) / (t.cosh() + 1.0);
    }
    let grown = (2.0 * t).exp();
    let c = 2.0 / (grown - 1.0);
    c * c * (0.5 * (grown - 1.0) + grown * (2.0 - t))
}

fn solved(text: &str) -> Solution {
    let model = Model::from_text("kink", text).expect("it is right");
    model.solve(&Options::default()).expect("it can be solved")
}

#[test]
fn optima_on_kinks_are_certified_and_those_of_closed_forms() {
    for OnKink { text, objective, is_global } in all() {
        let solution = solved(text);
        assert!(solution.is_certified(), "{text}: {:?}", solution.status());
        let off = (solution.objective() - objective).abs() / objective.abs();
        assert!(off < 1e-8, "{text}: {} and not {objective}", solution.objective());
        assert_eq!(solution.outcome.solution.global, is_global, "{text}");
    }
}

/// What stands for a kink is the solver's own matter.
#[test]
fn an_answer_has_the_names_of_its_model_only() {
    for OnKink { text, .. } in all() {
        let solution = solved(text);
        let (problem, trajectory) = (&solution.problem, &solution.outcome.trajectory);
        assert_eq!(trajectory.controls.len(), problem.controls.len());
        assert_eq!(trajectory.parameters.len(), problem.parameters.len());
        assert_eq!(trajectory.switching.len(), problem.surfaces.len());
        assert_eq!(trajectory.path_multipliers.len(), problem.path_bounds.len());
        assert_eq!(trajectory.end_multipliers.len(), problem.boundary_bounds.len());
        let certificate = solution.certificate.as_ref().expect("the true optimum is meant");
        let arcs = certificate.arcs.iter().map(|it| it.0.as_str());
        let surfaces = certificate.switches.iter().map(|it| it.surface.as_str());
        assert!(arcs.chain(surfaces).all(|name| !fdcc_compiler::is_kink(name)), "{text}");
        assert!(solution.verify().is_ok_and(|it| it.worst().is_none_or(|it| it.part < 1e-6)));
    }
}

/// Those of all sides together: here the motion is on both.
#[test]
fn the_multiplier_of_a_condition_is_that_of_all_its_sides() {
    let solution = solved(
        "time t in [0, 1]  state x start 1  state y start 0.2  control u(a, b)
        dynamics { x' = u.a  y' = u.b }  end abs(x) + abs(y) <= 0.5
        minimize integral(normsq(u))",
    );
    // (1 - r)^2 + 0.2^2 by r at 0.5
    let multiplier = solution.end_multiplier("end abs(x) + abs(y) <= 0.5").expect("its text");
    assert!((multiplier + 1.0).abs() < 1e-6, "{multiplier}");
}

/// On a grid that is named the discrete problem is solved; the least work is `2 u dt` for an `u`
/// that acts for some of the intervals only.
#[test]
fn kinks_of_a_discrete_problem_are_those_of_a_linear_program() {
    let text = format!("{} method {{ N = 100 }}", all()[0].text);
    let solution = solved(&text);
    assert!(solution.is_solved() && solution.outcome.solution.global);
    // By the end of an interval the position has gained `dt^2 u` more than in continuous time.
    assert!((solution.objective() - 2.0 * BURN).abs() < 0.02, "{}", solution.objective());
    let from = Options { start: fdcc::Start::Solution(&solution), ..Options::default() };
    let again = solution.model().solve(&from).expect("it begins at a solution");
    assert!((again.objective() - solution.objective()).abs() < 1e-7);
}

/// The inner one is subtracted, so that what is allowed beside it would be worth something.
#[test]
fn kinks_inside_of_kinks_have_their_own_value() {
    let text = "time t in [0, 1]  state x start 1  control u in [-1, 1]  dynamics { x' = u }
        minimize integral(u^2) + 0.5*abs(x(end) - abs(x(end) - 0.3))";
    for method in ["", " method { N = 100 }"] {
        let solution = solved(&format!("{text}{method}"));
        assert!(solution.is_solved() && !solution.outcome.solution.global, "{method}");
        assert!((solution.objective() - 0.15).abs() < 1e-6, "{}", solution.objective());
    }
}

/// A file has nodes of the controls of the model only.
#[test]
fn a_solve_begins_at_a_record_of_another() {
    let first = solved(all()[0].text);
    let record = first.record();
    assert!(record.nodes.is_some());
    let from = Options { start: fdcc::Start::Record(&record), ..Options::default() };
    let again = first.model().solve(&from).expect("it begins at a solution");
    assert!(again.is_certified() && (again.objective() - first.objective()).abs() < 1e-8);
}

/// Where a kink is worth something, no optimum lies on it.
#[test]
fn a_kink_that_is_a_reward_is_left() {
    let solution = solved(
        "time t in [0, 2]  state x start 0  control u in [-1, 1]  dynamics { x' = u }
        end x == 0  minimize integral(0.1*u - abs(u))",
    );
    assert!(solution.status().is_solved(), "{:?}", solution.status());
    assert!((solution.objective() + 2.0).abs() < 1e-3, "{}", solution.objective());
}

/// `|x - sin t|` of a double integrator: to come to the kink takes switches without end, of which
/// five cost 0.5391189091 (closed forms of the arcs, minimised by SciPy). What comes to it at
/// once, by an impulse of its multiplier, costs 0.53912658 and is no optimum.
#[test]
fn a_motion_that_is_pushed_onto_a_kink_is_no_optimum() {
    let solution = solved(
        "time t in [0, 8]  state x start 0  state v start 0  control u in [-1, 1]
        dynamics { x' = v  v' = u }  minimize integral(abs(x - sin(t)))",
    );
    assert!(!solution.is_certified(), "{}", solution.objective());
}

/// The trajectory could lie on the kink at all times, where a surface that is held keeps the
/// unknown where it is, and no price of a gap is high: it is better off. Of one or two numbers the
/// least is known by hand.
#[test]
fn an_unknown_is_not_kept_where_a_kink_is_met_throughout() {
    let cases = [
        ("free p in [-1, 1] guess 0", "abs(p + 1) + integral(max(x, 0))", 0.0),
        (
            "free p in [-1, 1] guess 0.5  free q in [-1, 1] guess 0.3",
            "q^2 - p*q + 0.5*integral(abs(x + t))",
            -0.25,
        ),
        (
            "free p in [-1, 1] guess 0  free q in [-1, 1] guess 0.3",
            "-integral(max(x, 0)) + abs((p - q)*x(end) - 0.25)",
            -0.5,
        ),
        (
            "free p in [-1, 1] guess 0  free q in [-1, 1] guess 0.3",
            "3 - integral(max(x, 0)) + abs((p - q)*x(end) - 0.25)",
            2.5,
        ),
        ("free p in [-1, 1] guess 0", "-p*p - p - 0.5*integral(abs(x - 0.3*t))", -2.175),
    ];
    for (unknowns, objective, least) in cases {
        let solution = solved(&format!(
            "{unknowns} time t in [0, 1] state x start 0 dynamics {{ x' = p }} minimize {objective}"
        ));
        let off = (solution.objective() - least).abs();
        assert!(solution.status().is_solved(), "{objective}: {}", solution.status_name());
        assert!(off < 1e-6 * least.abs().max(1.0), "{objective}: {}", solution.objective());
    }
}

/// `x' = u - max(x, 0)` with `x = 0.3` at 1: `u = x' + x` costs least where `x` grows like
/// `sinh(t)` and then falls like `sinh(2 - t)`: `0.18 coth(1)`.
#[test]
fn a_kink_of_states_beside_a_condition_at_a_time() {
    let solution = solved(
        "time t in [0, 2] state x start 0 control u in [-4, 4] dynamics { x' = u - max(x, 0) }
         at 1: x == 0.3 end x == 0 minimize integral(u^2)",
    );
    let off = (solution.objective() - 0.18 / 1.0_f64.tanh()).abs();
    assert!(solution.status().is_solved() && off < 1e-6, "{}", solution.objective());
}
