//! Models with jumps, solved with a phase between each two jumps: against closed forms, and against
//! other programs (`tests/peers/bounce.py`).

use fdcc_compiler::{
    Model, compile, compile_by_parameters, compile_chain, compile_chain_by_parameters, sequences,
    with_phases,
};
use fdcc_grammar::Code;
use fdcc_runtime::nlp::Status;
use fdcc_runtime::problem::Chain;
use fdcc_runtime::solution::by_parameters;
use fdcc_runtime::solution::phases::{Jump, joined};
use fdcc_runtime::solve::{ChainOutcome, Outcome, by_parameters_of_chain};
use fdcc_tests::Solved;
use fdcc_tests::models::{Changes, changed, meaning, solve_chain, text_of};

/// A solution in which given jumps happen.
struct Pieces {
    /// The phases between the jumps, one after the other.
    solved: Solved,
    jumps: Vec<Jump>,
    /// What the optimum is worth to each parameter.
    slopes: Vec<f64>,
}

fn solve(text: &str, sequence: &[usize], methods: Changes) -> Pieces {
    let model = changed(text, &[], methods);
    let phases = with_phases(&model, sequence).expect("its jumps can be phases");
    let chain = compile_chain(&phases).expect("it can be solved");
    let outcome = solve_chain(&chain);
    assert_eq!(outcome.solution.status, Status::Solved, "{text}");
    let between = compile(&model).expect("there is something between the jumps");
    let (whole, jumps) = joined(&between, &chain, &outcome);
    let slopes = slopes(&phases, &chain, &outcome);
    Pieces { solved: Solved { problem: between, outcome: whole }, jumps, slopes }
}

fn slopes(model: &Model, chain: &Chain, outcome: &ChainOutcome) -> Vec<f64> {
    if model.phases.is_empty() {
        let by = compile_by_parameters(model).expect("it can be solved");
        let Outcome { solution, trajectory, .. } = &outcome.phases[0];
        return by_parameters(&chain.phases[0], solution, &trajectory.parameters, &by);
    }
    let by = compile_chain_by_parameters(model).expect("it can be solved");
    by_parameters_of_chain(chain, outcome, &by)
}

#[track_caller]
fn expect_near(found: f64, expected: f64, tolerance: f64) {
    assert!(
        (found - expected).abs() <= tolerance * expected.abs().max(1.0),
        "{found} instead of {expected}"
    );
}

/// From height 1 with speed `v0` the ball comes to `H = e^2 (1 + v0^2/2g)`, so that `v0^2 = 2g
/// (H/e^2 - 1)`.
#[test]
fn a_ball_that_has_to_bounce_to_a_height_is_thrown_with_the_speed_that_takes() {
    let (g, e, height) = (9.81, 0.8, 1.5);
    let text = "model apex\nparam e = 0.8\nfree T in [0.1, 5] guess 1\nfree v0 in [0, 20] guess \
                3\ntime t in [0, T]\n\
                state h start 1\nstate v start -v0\nsurface ground = h\ndynamics {\n  h' = v\n  v' \
                = -9.81\n}\n\
                jump bounce on ground falling at most 1 { v := -e*v }\nend h == 1.5\nend v == \
                0\nminimize v0^2\n\
                method { scheme = midpoint  N = 20 }\n";
    let found = solve(text, &[0], &[]);
    let expected = 2.0 * g * (height / (e * e) - 1.0);
    expect_near(found.solved.objective(), expected, 1e-7);
    let bounce = (-expected.sqrt() + (expected + 2.0 * g).sqrt()) / g;
    expect_near(found.jumps[0].time, bounce, 1e-7);
    expect_near(found.jumps[0].before[1], -(expected + 2.0 * g).sqrt(), 1e-7);
    expect_near(found.jumps[0].after[1], e * (expected + 2.0 * g).sqrt(), 1e-7);
    expect_near(found.slopes[0], -4.0 * g * height / e.powi(3), 1e-6);
}

/// Each phase against its own solution: `tests/peers/bounce.py`.
#[test]
fn throws_are_those_of_another_program() {
    let page = fdcc_tests::documents("docs/reference", "md");
    let (_, page) = page.iter().find(|(name, _)| name == "jumps").expect("jumps have a page");
    let text = fdcc_tests::blocks(page).remove(0).text;
    for (sequence, objective, time) in [
        (&[] as &[usize], 54.159021408976, 1.107917680446),
        (&[0], 21.539392321535, 1.556951571727),
    ] {
        let found = solve(&text, sequence, &[]);
        expect_near(found.solved.objective(), objective, 1e-7);
        expect_near(found.solved.value("T"), time, 1e-6);
    }
}

/// CasADi and IPOPT: `tests/peers/bounce.py`; IPOPT relaxes bounds by 1e-8.
#[test]
fn a_bounce_with_a_control_is_that_of_another_program() {
    let found = solve(&text_of("bounce"), &[0], &[("scheme", "midpoint")]);
    expect_near(found.solved.objective(), 20.970192027263, 2e-8);
    expect_near(found.solved.value("T"), 1.430562444782, 1e-6);
    expect_near(found.jumps[0].time, 0.548708373339, 1e-6);
    let slope = |e: &str| {
        let text = text_of("bounce").replace("param e = 0.8", &format!("param e = {e}"));
        solve(&text, &[0], &[("scheme", "midpoint")]).solved.objective()
    };
    expect_near(found.slopes[0], (slope("0.801") - slope("0.799")) / 0.002, 1e-4);
}

const HEATER: &str = "model heater\nfree rest in [0, 1] guess 0.5\ntime t in [0, 1.2]\nstate \
                      warmth start 20\nstate on start 1\n\
    surface warm = warmth - 21\nsurface cold = warmth - 19\n\
    dynamics {\n  warmth' = 8*on - 0.3*(warmth - 5)\n  on' = 0\n}\n\
    jump off on warm rising at most 2 { on := 0 }\njump again on cold falling at most 1 { on := 1 \
    }\n\
    end warmth <= 21\nminimize rest^2\nmethod { scheme = radau3  N = 20 }\n";

/// A heater: from 20 up to 21, then down to 19, by exponentials.
#[test]
fn jumps_that_take_turns_happen_when_they_have_to() {
    let found = solve(HEATER, &[0, 1], &[]);
    let (limit_on, limit_off) = (5.0 + 8.0 / 0.3, 5.0);
    let off = ((20.0 - limit_on) / (21.0f64 - limit_on)).ln() / 0.3;
    let again = off + ((21.0 - limit_off) / (19.0f64 - limit_off)).ln() / 0.3;
    expect_near(found.jumps[0].time, off, 1e-8);
    expect_near(found.jumps[1].time, again, 1e-8);
    expect_near(found.jumps[0].after[1], 0.0, 1e-12);
    expect_near(found.jumps[1].after[1], 1.0, 1e-12);
}

/// A state that has just come through a surface is still on it; that is no second jump.
#[test]
fn no_jump_follows_itself_after_no_time() {
    let phases = with_phases(&meaning(HEATER), &[0, 0, 1]).expect("its jumps can be phases");
    let outcome = solve_chain(&compile_chain(&phases).expect("it can be tried"));
    assert_eq!(outcome.solution.status, Status::Infeasible);
}

/// After its last bounce a ball lies still: here from the second on, `sqrt(2/g) (1 + 2e)` after it
/// was dropped. Then a push to the side takes it as far as it is to come.
#[test]
fn after_the_last_bounce_the_ball_lies_still() {
    let text = "model rest\ntime t in [0, 3]\nstate h in [0, 2] start 1\nstate v start 0\nstate x \
                start 0\ncontrol u in [-1, 1]\n\
                surface ground = h\npath low: h >= 0\ndynamics {\n  h' = v\n  v' = -9.81\n  x' = \
                u\n}\n\
                jump bounce on ground falling at most 2 then hold ground { v := -0.5*v }\nend x == \
                1\n\
                minimize integral(u^2) + v(end)^2 + h(end)^2\nmethod { scheme = midpoint  N = 20 \
                }\n";
    let found = solve(text, &[0, 0], &[]);
    let fall = (2.0 / 9.81f64).sqrt();
    expect_near(found.jumps[0].time, fall, 1e-7);
    expect_near(found.jumps[1].time, 2.0 * fall, 1e-7);
    expect_near(found.jumps[1].after[1], 0.0, 1e-9);
    expect_near(found.solved.objective(), 1.0 / 3.0, 1e-7);
    let height = &found.solved.outcome.trajectory.states[0];
    assert!(height[40..].iter().all(|height| height.abs() < 1e-7), "{height:?}");
}

/// A ball that lies on the ground is kicked up: `h(end) = k/2 - g/8`, and `k = 5` is best.
#[test]
fn a_kick_ends_a_hold() {
    let text = "model kick\nfree k in [0.5, 9] guess 3\ntime t in [0, 2.5]\nstate h start \
                0.2\nstate v start 0\nsurface ground = h\nsurface clock = t - 2\n\
                dynamics {\n  h' = v\n  v' = -9.81\n}\n\
                jump bounce on ground falling at most 1 then hold ground { v := -0.1*v }\n\
                jump kick on clock rising at most 1 { v := k }\n\
                minimize 0.05*k^2 - h(end)\nmethod { scheme = midpoint  N = 20 }\n";
    let found = solve(text, &[0, 1], &[]);
    expect_near(found.solved.objective(), 9.81 / 8.0 - 1.25, 1e-7);
    expect_near(found.jumps[1].time, 2.0, 1e-9);
}

/// From 0 with speed 1 to a cushion at 0.8 and back, as fast as thrust 1 allows: there it has the
/// speed `sqrt(2.6)`, of which 0.7 are left. However it is said that nothing goes through the
/// cushion, it says nothing new where the cushion is hit.
#[test]
fn conditions_that_say_the_same_as_the_surface_change_nothing() {
    let (speed, rest) = (2.6f64.sqrt(), 0.7 * 2.6f64.sqrt());
    let fastest = (speed - 1.0) + ((rest * rest + 1.6).sqrt() - rest);
    let cases = [
        ("", ""),
        (" in [-1, 0.8]", ""),
        ("", "path inside: x <= 0.8\n"),
        ("", "path inside: 3*x - 2.4 <= 0\n"),
        (" in [-1, 0.8]", "path inside: 2*(0.8 - x) >= 0\n"),
    ];
    for (bounds, path) in cases {
        let text = format!(
            "model cushioned\nfree T in [0.5, 6] guess 2\ntime t in [0, T]\nstate x{bounds} start \
             0\nstate v start 1\n\
             control u in [-1, 1]\nsurface cushion = 2*(0.8 - x)\ndynamics {{\n  x' = v\n  v' = \
             u\n}}\n\
             jump bank on cushion falling at most 1 {{ v := -0.7*v }}\n{path}end x == 0\nminimize \
             T\n\
             method {{ scheme = midpoint  N = 40 }}\n"
        );
        expect_near(solve(&text, &[0], &[]).solved.objective(), fastest, 1e-7);
    }
}

/// A puck slides 1 m to a wall and half a metre back: `e^2 (v0^2 - 2a) = 2a/2` with the
/// deceleration `a`.
#[test]
fn friction_and_an_impact_go_together() {
    let (a, e): (f64, f64) = (0.5, 0.6);
    let text = "model puck\nfree v0 in [0.5, 5] guess 2\nfree T in [0.5, 9] guess 4\ntime t in [0, \
                T]\nstate x start 0\nstate v start v0\n\
                surface slip = v\nsurface wall = 1 - x\ndynamics {\n  x' = v\n  v' in \
                -0.5*Sgn(slip)\n}\n\
                jump hit on wall falling at most 1 { v := -0.6*v }\nend x == 0.5\nminimize v0^2 + \
                1e-9*T\n\
                method { scheme = radau2  N = 200  sigma = 1e-4 }\n";
    let found = solve(text, &[0], &[]);
    let expected = 2.0 * a * (1.0 + 0.5 / (e * e));
    expect_near(found.solved.objective(), expected, 1e-3);
    assert_eq!(found.solved.outcome.modes.len(), 1, "the wall is no surface of friction");
}

/// From `depth` below the rim up through it, down on it, and up to `height` above it: `v0^2 = 2g
/// (depth + height/e^2)`.
#[test]
fn a_ball_from_below_the_rim_rises_through_it_before_it_falls_on_it() {
    let (g, e) = (9.81, 0.8);
    for (rim, begin, end) in [(0.0, -1.0, 0.5), (1.0, 0.0, 1.5), (-2.0, -2.25, -1.75)] {
        let text = format!(
            "model rim\nfree T in [0.1, 5] guess 1.5\nfree v0 in [0, 20] guess 8\ntime t in [0, \
             T]\nstate h start {begin}\n\
             state v start v0\nsurface rim = h - {rim}\ndynamics {{\n  h' = v\n  v' = -9.81\n}}\n\
             jump bounce on rim falling at most 1 {{ v := -0.8*v }}\nend h == {end}\nend v == \
             0\nminimize v0^2\n\
             method {{ scheme = midpoint  N = 20 }}\n"
        );
        let all = sequences(&meaning(&text)).expect("these can be solved").all;
        assert_eq!(
            all,
            [vec![], vec![1], vec![1, 0]],
            "it is not on the rim before it has risen through it"
        );
        let found = solve(&text, &[1, 0], &[]);
        let on_rim = 2.0 * g * (end - rim) / (e * e);
        let expected = 2.0 * g * (rim - begin) + on_rim;
        expect_near(found.solved.objective(), expected, 1e-7);
        expect_near(found.jumps[0].time, (expected.sqrt() - on_rim.sqrt()) / g, 1e-7);
        // Nothing happens on the way up.
        for (before, after) in found.jumps[0].before.iter().zip(&found.jumps[0].after) {
            expect_near(1.0 + after, 1.0 + before, 1e-9);
        }
        expect_near(found.jumps[1].after[1], e * on_rim.sqrt(), 1e-7);
    }
}

/// The same heater from 18: it warms through 19, where only cooling switches it on.
#[test]
fn a_relay_that_begins_beyond_its_surface_comes_to_it_from_the_other_side() {
    let text = HEATER.replace("start 20", "start 18").replace("[0, 1.2]", "[0, 1.6]");
    let found = solve(&text, &[3, 0, 1], &[]);
    let (limit_on, limit_off) = (5.0 + 8.0 / 0.3, 5.0);
    let heats = |from: f64, to: f64| ((from - limit_on) / (to - limit_on)).ln() / 0.3;
    let off = heats(18.0, 21.0);
    expect_near(found.jumps[0].time, heats(18.0, 19.0), 1e-8);
    expect_near(found.jumps[1].time, off, 1e-8);
    expect_near(
        found.jumps[2].time,
        off + ((21.0 - limit_off) / (19.0f64 - limit_off)).ln() / 0.3,
        1e-8,
    );
}

/// Which sides are possible is a matter of what the start may be: the numbers behind the jumps are
/// crossings.
#[test]
fn a_surface_is_crossed_first_where_the_state_may_begin_beyond_it() {
    let cases: [(&str, &str, &[&[usize]]); 7] = [
        ("start 1", "falling", &[&[], &[0]]),
        ("start -1", "falling", &[&[], &[1], &[1, 0]]),
        ("start 1", "rising", &[&[], &[1], &[1, 0]]),
        ("start 0", "falling", &[&[], &[0]]),
        ("start free in [0.5, 1]", "falling", &[&[], &[0]]),
        ("start free in [-1, 1]", "falling", &[&[], &[0], &[1], &[1, 0]]),
        ("start 2*p - 1", "falling", &[&[], &[0], &[1], &[1, 0]]),
    ];
    for (start, direction, expected) in cases {
        let text = format!(
            "free p in [0, 1]\ntime t in [0, 1]\nstate x {start}\ncontrol u in [-1, 1]\nsurface a \
             = x\n\
             dynamics {{ x' = u*p }}\njump f on a {direction} at most 1 {{ x := 1 }}\nminimize \
             x(end)^2\n"
        );
        let found = sequences(&meaning(&text)).expect("these can be solved");
        assert_eq!(found.all, expected, "{start} {direction}");
        assert_eq!(
            found.may_cross,
            [expected.contains(&(&[1_usize] as &[usize]))],
            "{start} {direction}"
        );
    }
}

/// One trajectory: times ascend, each piece has its intervals, and the state after a jump stands at
/// its time.
#[test]
fn phases_are_put_one_after_the_other() {
    let found = solve(&text_of("bounce"), &[0], &[("scheme", "midpoint"), ("N", "10")]);
    let trajectory = &found.solved.outcome.trajectory;
    assert_eq!((trajectory.time.len(), trajectory.controls[0].len()), (21, 20));
    assert!(trajectory.time.windows(2).all(|pair| pair[0] < pair[1]), "{:?}", trajectory.time);
    expect_near(trajectory.time[10], found.jumps[0].time, 1e-15);
    expect_near(trajectory.time[20], found.solved.value("T"), 1e-15);
    expect_near(trajectory.states[2][10], found.jumps[0].after[2], 0.0);
    assert!(
        trajectory.states[2][9] < 0.0 && found.jumps[0].before[2] < 0.0,
        "it falls before the bounce"
    );
    assert!(
        trajectory.states[1].iter().all(|height| *height > -1e-9),
        "{:?}",
        trajectory.states[1]
    );
    assert_eq!((trajectory.path_multipliers[0].len(), trajectory.end_multipliers.len()), (20, 2));
}

#[test]
fn sequences_are_all_that_may_happen() {
    let jumps = |jumps: &str| {
        format!(
            "param n = 2\ntime t in [0, 1]\nstate x start 1\nstate y start 0\nsurface a = \
             x\nsurface b = y - 1\n\
             dynamics {{\n  x' = -1\n  y' = 1\n}}\n{jumps}minimize x(end)^2\n"
        )
    };
    let cases: [(&str, usize, bool); 7] = [
        ("jump f on a falling at most 1 { x := 1 }\n", 2, false),
        ("jump f on a falling at most n { x := 1 }\n", 3, false),
        ("jump f on a falling { x := 1 + 0*y }\n", 4, true),
        ("jump f on a falling at most 2 then hold a { x := 0.5 }\n", 2, true),
        ("jump f on a falling at most 20 { x := 1 }\n", 4, true),
        (
            "jump f on a falling at most 2 { x := 1 }\njump g on b rising at most 1 { y := 0 }\n",
            9,
            false,
        ),
        (
            "jump f on a falling at most 5 { x := 1 }\njump g on b rising at most 5 { y := 0 }\n",
            32,
            true,
        ),
    ];
    for (text, count, is_cut) in cases {
        let found = sequences(&meaning(&jumps(text))).expect("these can be solved");
        assert_eq!((found.all.len(), found.is_cut), (count, is_cut), "{text}");
        assert!(
            found.all.windows(2).all(|pair| pair[0].len() <= pair[1].len()),
            "the short ones come first"
        );
    }
    let reads = jumps("jump f on a falling at most 1 { x := Sgn(b) }\n");
    let refused = sequences(&meaning(&reads)).err().expect("a jump has no time to choose a side");
    assert_eq!(refused[0].code, Code::NotYet);
}
