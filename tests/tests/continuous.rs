//! Smooth models that say nothing of a grid: the optimum in continuous time, certified, against
//! closed forms and the literature.

use fdcc::{Model, Options, Solution};

fn solved(text: &str) -> Solution {
    let model = Model::from_text("continuous", text).expect("it has no mistakes");
    model.solve(&Options::default()).expect("it can be solved")
}

fn is_global(solution: &Solution) -> bool {
    solution.outcome.solution.global
}

#[track_caller]
fn assert_certified(solution: &Solution, objective: f64, within: f64) {
    assert!(solution.is_certified(), "{:?}", solution.certificate);
    let off = (solution.objective() - objective).abs() / objective.abs();
    assert!(off <= within, "{} instead of {objective}", solution.objective());
}

/// `x'' = x`, so that the cost is `tanh T`; the problem is convex.
#[test]
fn a_regulator_has_its_closed_form() {
    let text = "time t in [0, 5]\nstate x start 1\ncontrol u\ndynamics { x' = u }\n\
                minimize integral(x^2 + u^2)\n";
    let solution = solved(text);
    assert_certified(&solution, 5.0_f64.tanh(), 1e-10);
    assert!(is_global(&solution));
}

/// Of `x' = u`, from 0 to 1 at cost `u^2 exp(t)`: `u` is proportional to `exp(-t)`. What is proved
/// at the nodes of a grid says nothing between them where time itself matters.
#[test]
fn a_proof_on_a_grid_is_none_where_time_matters() {
    let text = "time t in [0, 1]\nstate x start 0\ncontrol u in [-9, 9]\ndynamics { x' = u }\n\
                end x == 1\nminimize integral(exp(t)*u^2)\n";
    let solution = solved(text);
    assert_certified(&solution, 1.0 / (1.0 - (-1.0_f64).exp()), 1e-9);
    assert!(!is_global(&solution));
}

/// A bound that is far away is no size of the control: neither slopes at the other bound nor what
/// is beyond it between nodes are compared with its distance.
#[test]
fn wide_bounds_say_nothing_of_sizes() {
    let text = |upper: &str| {
        format!(
            "time t in [0, 1]\nstate x start 0\ncontrol u in [0, {upper}]\ndynamics {{ x' = u - \
             2*x }}\nminimize integral(1e-5*u^2 + 5*(x - t*sin(10*t))^2)\n"
        )
    };
    let narrow = solved(&text("100"));
    assert_certified(&narrow, narrow.objective(), 0.0);
    for upper in ["1e4", "1e6", "1e8"] {
        assert_certified(&solved(&text(upper)), narrow.objective(), 1e-8);
    }
}

/// The double integrator from rest to rest in the least time, and in the least time with a limit
/// of the speed: an arc of a state.
#[test]
fn arcs_of_controls_and_states_are_located() {
    let text = |limit: &str| {
        format!(
            "free T in [0.1, 20]\ntime t in [0, T]\nstate x start 0\nstate v {limit}start 0\n\
             control u in [-1, 1]\ndynamics {{ x' = v  v' = u }}\nend x == 1\nend v == 0\n\
             minimize T\n"
        )
    };
    assert_certified(&solved(&text("")), 2.0, 1e-9);
    assert_certified(&solved(&text("in [-9, 0.5] ")), 2.5, 1e-9);
}

/// Singular arcs, on which a polynomial of high degree is noise: the batch with two catalysts of
/// Jackson (1968), bang, singular, bang, and catalyst mixing of COPS 3.0.
#[test]
fn singular_arcs_are_followed() {
    let jackson = "time t in [0, 4]\nstate a start 1\nstate b start 0\nstate c start 0\n\
                   control u in [0, 1]\ndynamics {\n  a' = -u*(a - 10*b)\n\
                     b' = u*(a - 10*b) - (1 - u)*b\n  c' = (1 - u)*b\n}\nmaximize c(end)\n";
    assert_certified(&solved(jackson), 0.191814, 3e-6);
    let mixing = "time t in [0, 1]\nstate a start 1\nstate b start 0\ncontrol u in [0, 1]\n\
                  dynamics {\n  a' = u*(10*b - a)\n  b' = u*(a - 10*b) - (1 - u)*b\n}\n\
                  maximize 1 - a(end) - b(end)\n";
    assert_certified(&solved(mixing), 0.048055686, 2e-6);
}

/// `p^3` is flat at 0 and least at -1; a solve on a grid may end at 0, a certificate does not.
#[test]
fn a_flat_point_is_not_certified() {
    let text = "time t in [0, 1]\ncontrol p in [-1, 2]\nminimize integral(p^3)\n";
    let solution = solved(text);
    assert!(!solution.is_certified() || (solution.objective() + 1.0).abs() < 1e-6);
}

/// Who says on how many intervals asks for the problem on these.
#[test]
fn a_number_of_intervals_asks_for_the_problem_on_them() {
    let text = "time t in [0, 5]\nstate x start 1\ncontrol u\ndynamics { x' = u }\n\
                minimize integral(x^2 + u^2)\nmethod { N = 200 }\n";
    let solution = solved(text);
    assert!(solution.certificate.is_none() && is_global(&solution));
    assert!((solution.objective() - 5.0_f64.tanh()).abs() > 1e-3);
}

/// With given modes these are convex programs; as they are written they have better answers
/// elsewhere, which are found from other starts.
#[test]
fn what_switches_is_never_called_global() {
    let relay = "time t in [0, 1]\nstate x start 0\nstate v start 0\ncontrol u in [-10, 10]\n\
                 surface s = x - 1\ndynamics { x' = u\n v' in 50 + 50*Sgn(s) }\n\
                 minimize integral(u^2) - v(end)\n";
    let friction = "time t in [0, 4]\nstate x start 0\nstate v start 0\ncontrol u in [-10, 10]\n\
                    dynamics { x' = v\n v' in u - 2*Sgn(v) }\n\
                    minimize integral(u^2) - 5*x(end)\n";
    for text in [relay, friction] {
        assert!(!is_global(&solved(text)), "{text}");
    }
}

/// `w(t)` below.
type Weight = fn(f64) -> f64;

/// Of `minimize integral(w(t) u^2)` with `x' = u` and a given end the control is `p / (2 w)`, as
/// far as its bounds allow, and at a bound where `w` is negative: it is steep where that changes,
/// which no polynomial between its nodes is.
#[test]
fn weights_that_change_their_sign_are_followed_to_the_end_of_each_arc() {
    let problems: [(&str, Weight, [f64; 3]); 4] = [
        ("0.3 + cos(t)", |t| 0.3 + t.cos(), [6.0, 1.0, 3.0]),
        ("0.3 + cos(t)", |t| 0.3 + t.cos(), [6.0, 1.0, 2.6]),
        ("t - 0.01", |t| t - 0.01, [1.0, 3.0, 0.3]),
        (
            "1 - 1.3*exp(-((t - 0.503)/0.002)^2)",
            |t| 1.0 - 1.3 * (-((t - 0.503) / 0.002).powi(2)).exp(),
            [1.0, 3.0, 0.3],
        ),
    ];
    for (text, weight, [last, most, end]) in problems {
        let model = format!(
            "time t in [0, {last}]\nstate x start 0\ncontrol u in [-{most}, {most}]
dynamics {{ x' = u }}\nend x == {end}\nminimize integral(u^2*({text}))"
        );
        let model = Model::from_text("weights", &model).expect("it is a model");
        let solution = model.solve(&Options::default()).expect("it can be solved");
        let [expected, terms] = least_weighted(weight, [last, most, end]);
        assert!(solution.is_certified(), "{text}: {}", solution.status_name());
        let off = (solution.objective() - expected).abs() / terms;
        assert!(off < 1e-6, "{text}: {} instead of {expected}", solution.objective());
    }
}

/// The least value, and the integral of the size of its terms, by the rule of the middle.
fn least_weighted(weight: Weight, [last, most, end]: [f64; 3]) -> [f64; 2] {
    const COUNT: usize = 200_000;
    let step = last / COUNT as f64;
    let weights: Vec<f64> = (0..COUNT).map(|k| weight((k as f64 + 0.5) * step)).collect();
    let control = |w: f64, p: f64| if w > 0.0 { (p / (2.0 * w)).min(most) } else { most };
    let [mut low, mut high] = [0.0, 10.0];
    for _ in 0..50 {
        let p = 0.5 * (low + high);
        let moved: f64 = weights.iter().map(|w| control(*w, p) * step).sum();
        if moved < end { low = p } else { high = p }
    }
    let term = |w: &f64| w * control(*w, low).powi(2) * step;
    [weights.iter().map(term).sum(), weights.iter().map(|w| term(w).abs()).sum()]
}

/// To lose a tenth of the speed as late as possible takes a hundredth of a second, less than any
/// interval of the first grid.
#[test]
fn a_short_arc_at_an_end_is_found() {
    for (end, sign) in [("end v == 0.9  start v == 1", 1), ("start v == 0.9  end v == 1", -1)] {
        let text = format!(
            "time t in [0, 10]\nstate v\ncontrol q in [0, 10]\n
            dynamics {{ v' = {}*q }}\n{end}\nmaximize integral(v)\n",
            -sign
        );
        assert_certified(&solved(&text), 10.0 - 0.1 * 0.01 / 2.0, 1e-9);
    }
}

/// From `(0, 0)` at the speed `(0.6, 0.8)` to rest at `(2, 0)`, with an acceleration of 1: least
/// time by shooting with the direction `c - t d` of Pontryagin (scipy, residuals 1e-15).
const TURN: f64 = 2.593_165_244_608_84;

/// On each interval of a grid a heading may have another full turn.
#[test]
fn a_heading_needs_no_bounds_and_may_have_any() {
    for bounds in ["", "in [-4, 4]", "in [-6, 6]", "in [-20, 20]", "in [-1000, 1000]"] {
        let solution = solved(&format!(
            "free T in [0.6, 8] guess 3.8\ntime t in [0, T]\nstate p(x, y) start (0, 0)
             state v(x, y) start (0.6, 0.8)\ncontrol th {bounds}
             dynamics {{ p' = v  v' = (cos(th), sin(th)) }}
             guess {{ th = 1.1 - 3.0*t/T }}\nend p == (2, 0)\nend v == (0, 0)\nminimize T"
        ));
        assert_certified(&solution, TURN, 1e-8);
    }
}

/// The same by shooting, from rest to rest at `(1, 0.5)` in a wind of `(-0.3, -0.1)`: the
/// acceleration turns within a hundredth of the time.
#[test]
fn an_acceleration_in_a_disc_turns_between_nodes() {
    for limit in ["normsq(u) <= 1", "norm(u) <= 1"] {
        let solution = solved(&format!(
            "free T in [0.5, 10] guess 3\ntime t in [0, T]\nstate p(x, y) start 0
             state v(x, y) start 0\ncontrol u(x, y)\ndynamics {{ p' = v  v' = u - (0.3, 0.1) }}
             path {limit}\nend p == (1, 0.5)\nend v == 0\nminimize T"
        ));
        assert_certified(&solution, 2.227_380_551_848_29, 1e-8);
    }
}

/// A dose that decays to 1 in the end, and one that grows from 1; the least stiffness with which a
/// mass that is thrown turns at 0.6.
#[test]
fn what_unknowns_alone_move_touches_its_limit() {
    let dose = solved(
        "free d in [0, 10] guess 2\ntime t in [0, 3]\nstate c in [1, 20] start d
         dynamics { c' = -0.35*c }\nminimize d",
    );
    assert_certified(&dose, 1.05_f64.exp(), 1e-8);
    let rising = solved(
        "free c0 in [0, 10] guess 2\ntime t in [0, 3]\nstate c in [1, 20] start c0
         dynamics { c' = 0.1*c }\nminimize c0",
    );
    assert_certified(&rising, 1.0, 1e-8);
    let reach = |k: f64| {
        let (decay, rate) = (0.25, (k - 0.0625).sqrt());
        let time = rate.atan2(decay) / rate;
        2.0 / k.sqrt() * (-decay * time).exp()
    };
    let (mut low, mut high) = (1.0, 50.0);
    for _ in 0..100 {
        let middle: f64 = 0.5 * (low + high);
        *if reach(middle) > 0.6 { &mut low } else { &mut high } = middle;
    }
    let spring = solved(
        "free k in [0.1, 50] guess 5\ntime t in [0, 4]\nstate x start 0\nstate v start 2
         dynamics { x' = v  v' = -k*x - 0.5*v }\npath x <= 0.6\nminimize k",
    );
    assert_certified(&spring, low, 1e-8);
}

/// What is feasible in continuous time is not called infeasible because implicit Euler damps an
/// oscillator, or is late by half of an interval: without a control `x = cos(10 t)`; and as the
/// speed falls by 4 at most, from 1 to 0, `x(1)` may be 0.875.
#[test]
fn what_only_a_coarse_scheme_cannot_do_is_found() {
    let free = solved(
        "time t in [0, 2] state x start 1 state v start 0 control u in [-1, 1]
         dynamics { x' = v  v' = -100*x + u } end x == cos(20) end v == -10*sin(20)
         minimize integral(u^2)",
    );
    assert!(free.is_certified() && free.objective().abs() < 1e-12, "{}", free.objective());
    let late = solved(
        "time t in [0, 1] state x start 0 state v in [0, 1] start 1 control u in [-4, 4]
         dynamics { x' = v  v' = u } end x == 0.8745 end v == 0 minimize integral(u^2)",
    );
    assert!(late.is_certified(), "{}", late.status_name());
    let never = solved(
        "time t in [0, 1] state x start 0 state v in [0, 1] start 1 control u in [-4, 4]
         dynamics { x' = v  v' = u } end x == 0.8755 end v == 0 minimize integral(u^2)",
    );
    assert!(!never.status().is_solved(), "{}", never.status_name());
}

/// Speed is kept at 2.5 after `1/1.5 + 2.5` units of time, all of them with an S-shaped rise: the
/// time is `20/2.5 + 2.5/1 + 1/1.5`. 200 steps of implicit Euler end at the limit of iterations.
#[test]
fn where_one_scheme_comes_to_no_end_another_one_is_tried() {
    let solution = solved(
        "free T in [1, 60] guess 12  time t in [0, T]
         state x start 0  state v in [0, 2.5] start 0  state a in [-1, 1] start 0
         control j in [-1.5, 1.5]  dynamics { x' = v  v' = a  a' = j }
         end x == 20  end v == 0  end a == 0  minimize T",
    );
    let off = (solution.objective() - (8.0 + 2.5 + 1.0 / 1.5)).abs();
    assert!(solution.is_certified() && off < 1e-6, "{}", solution.objective());
}
