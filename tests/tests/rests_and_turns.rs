//! Optima that rest or turn where a phase or the time ends, that brake by friction alone, or whose
//! controls go from one end of a disc to the other, against closed forms.

use fdcc::{Model, Options};
use fdcc_grammar::Code;

struct Case {
    name: &'static str,
    text: &'static str,
    objective: f64,
}

fn all() -> Vec<Case> {
    vec![
        // n = (16/9) (1 - t/2.25), at rest from 2.25 on; friction leads there, and no layer does.
        Case {
            name: "a brake that stops early",
            text: "time t in [0, 3]  state x start 0  state v start 2  control n in [0, 5]
                surface roll = v  dynamics { x' = v  v' in -n*Sgn(roll) }
                end x == 1.5  end v == 0  minimize integral(n^2)",
            objective: 64.0 / 27.0,
        },
        Case {
            name: "a brake that stops in the end",
            text: "time t in [0, 3]  state x start 0  state v start 2  control n in [0, 5]
                surface roll = v  dynamics { x' = v  v' in -n*Sgn(roll) }
                end x == 2  end v == 0  minimize integral(n^2)",
            objective: 16.0 / 9.0,
        },
        // u = 2.25 s - 1.25, f = 2.25 (1 - s) with s = 2 - t: both are at rest where they meet.
        Case {
            name: "two that meet where one would turn",
            text: "time t in [0, 2]  state x start 0  state v start 0  state y start 3
                state w start 0  control u in [-50, 50]  control f in [-50, 50]
                surface slip = v
                dynamics { x' = v  v' in u - Sgn(slip)  y' = w  w' = f }
                end x == y  end v == w  minimize integral(u^2 + f^2)",
            objective: 8.75,
        },
        // 12.25 each way: u = 6.5 - 12 t.
        Case {
            name: "a turn at a link",
            text: "state x start 0  state v start 0  control u in [-50, 50]  surface slip = v
                dynamics { x' = v  v' in u - 0.5*Sgn(slip) }
                phase out { time t in [0, 1]  end x == 1 }
                phase home { time t in [1, 2] }
                link out -> home { same }
                end x == 0  end v == 0  minimize integral(u^2)",
            objective: 24.5,
        },
        // 2 each way: u = 2 - 1.5 t.
        Case {
            name: "to and fro for ever",
            text: "phase there { time t in [0, 2]  state x  state v  control u in [-50, 50]
                    surface slip = v  dynamics { x' = v  v' in u - 0.5*Sgn(slip) }
                    start x == 0  end x == 1 }
                phase back like there { time t in [2, 4]  start x == 1  end x == 0 }
                link there -> back { same }  link back -> there { same }
                minimize integral(there.u^2) + integral(back.u^2)",
            objective: 4.0,
        },
        // Twice the optimum of `models/block.fdc`, with rests whose places nothing tells.
        Case {
            name: "there and back with time to spare",
            text: "state x start 0  state v start 0  control F in [-12, 12]  surface slip = v
                dynamics { x' = v  2*v' in F - 5.886*Sgn(slip) }
                phase there { time t in [0, 3]  end x == 1  end v == 0 }
                phase back { time t in [3, 6] }
                link there -> back { same }
                end x == 0  end v == 0  minimize integral(F^2)",
            objective: 2.0 * 65.956_825_709_9,
        },
        // 0.25 s to the speed of the slow belt; x = 0.5 T - 1/16 there, 0.5 s to that of the fast.
        Case {
            name: "two belts without a control",
            text: "free T1 in [0.2, 2.8] guess 1  state x start 0  state v start 0
                phase slow { time t in [0, T1]  surface s = v - 0.5
                    dynamics { x' = v  v' in -2*Sgn(s) } }
                phase fast { time t in [T1, 3]  surface s = v - 1.5
                    dynamics { x' = v  v' in -2*Sgn(s) } }
                link slow -> fast { same }
                end x == 2.5  minimize T1",
            objective: 27.0 / 16.0,
        },
        // Along a line: 1.4 of braking after 0.6 of pushing.
        Case {
            name: "a push that turns round",
            text: "free T in [0.3, 10] guess 2  time t in [0, T]
                state pos(x, y) start (0, 0)  state vel(x, y) start (0, 0)
                control u(x, y) in [-2, 2]
                dynamics { pos' = vel  vel' in u - 0.4*Dir(vel) }
                path normsq(u) <= 1
                end pos == (1.5, 0.5)  end vel == (0, 0)  minimize T",
            objective: (2.0 * 2.5_f64.sqrt() * (1.0 / 0.6 + 1.0 / 1.4)).sqrt(),
        },
    ]
}

#[test]
fn they_are_certified_at_their_closed_forms() {
    for Case { name, text, objective } in all() {
        let model = Model::from_text("case", text).expect("it is right");
        let solution = model.solve(&Options::default()).expect("it can be solved");
        assert!(solution.is_certified(), "{name}: {:?}", solution.certificate);
        let off = (solution.objective() - objective).abs() / objective;
        assert!(off < 1e-8, "{name}: {} instead of {objective}", solution.objective());
    }
}

/// Bounds of times that overlap: that no phase runs backwards is a condition.
#[test]
fn phases_whose_times_are_both_chosen_are_in_order() {
    let text = "free t1 in [0, 5] guess 1  free t2 in [0, 5] guess 4
        state x start 0  state v start 0
        phase push { time t in [0, t1]  dynamics { x' = v  v' = 1 } }
        phase stop { time t in [t1, t2]  dynamics { x' = v  v' = -1 } }
        link push -> stop { same }
        end x == 1  end v == 0  minimize t2";
    let model = Model::from_text("in order", text).expect("it is right");
    let solution = model.solve(&Options::default()).expect("it can be solved");
    let times: Vec<f64> = solution.unknowns().map(|it| it.1).collect();
    assert!(
        solution.is_certified() && times.iter().zip([1.0, 2.0]).all(|(a, b)| (a - b).abs() < 1e-8)
    );
    // Nothing but the condition keeps the second phase from taking less than no time.
    let text = "free t1 in [1, 5] guess 2  free t2 in [0, 5] guess 4  state x start 0
        phase one { time t in [0, t1]  dynamics { x' = 1 } }
        phase two { time t in [t1, t2]  dynamics { x' = 1 } }
        link one -> two { same }  minimize t2 - 0.1*t1";
    let model = Model::from_text("in order", text).expect("it is right");
    let solution = model.solve(&Options::default()).expect("it can be solved");
    assert!((solution.objective() - 0.9).abs() < 1e-6, "{}", solution.objective());
    let backwards = fdcc::check("in order", text.replace("guess 4", "guess 1").into());
    assert!(backwards.diagnostics.iter().any(|it| it.code == Code::NoDuration));
}

/// The last push is worth more than the Hamiltonian says, as it goes on as speed.
#[test]
fn a_link_that_reads_a_control_contradicts_no_optimum() {
    let text = "phase a { time t in [0, 1]  state x start 0  control u in [-2, 2]
            dynamics { x' = u }  method { grid N = 10 scheme gauss2 } }
        phase b { time t in [1, 2]  state x  state v  dynamics { x' = v  v' = 0 }
            end x == 1  method { grid N = 3 scheme gauss2 } }
        link a -> b { x := x  v := u }
        minimize integral(a.u^2)";
    let model = Model::from_text("push", text).expect("it is right");
    let solution = model.solve(&Options::default()).expect("it can be solved");
    assert!((solution.objective() - 1.0 / 13.0).abs() < 1e-9);
    let checks = solution.optimality(None);
    assert!(checks.iter().all(|it| !it.contradicts()), "{checks:?}");
}

/// Less of the last bounce would be better: that it still happens at the last time is a condition
/// of its sequence, which nobody wrote.
#[test]
fn a_jump_at_the_last_time_is_no_optimum() {
    let text = "free e in [0.3, 0.95] guess 0.35  time t in [0, 1]
        state h start 1.5  state v start 0  control u in [-1, 1]  surface ground = h
        dynamics { h' = v  v' = -9.81 + u }
        jump bounce on ground falling at most 2 { v := -e*v }
        minimize integral(u^2) + 3*sqrt((e - 0.8)^2)";
    let model = Model::from_text("bounce", text).expect("it is right");
    let solution = model.solve(&Options::default()).expect("it can be solved");
    assert!(!solution.is_certified() || solution.objective() < 1e-6, "{}", solution.objective());
}
