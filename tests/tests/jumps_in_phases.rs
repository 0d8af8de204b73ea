//! Jumps within phases: each cuts its phase into pieces, and all phases are solved at once. The
//! numbers are closed forms, or minima over one unknown of such, by SciPy.

use fdcc::{Model, Options, Solution, Start};

fn model(text: &str) -> Model {
    Model::from_text("a test", text).expect("a model")
}

fn certified(text: &str) -> Solution {
    let solution = model(text).solve(&Options::default()).expect("it can be solved");
    assert!(solution.is_certified(), "{}", solution.status_name());
    solution
}

/// The jumps of all phases, with the names of these before theirs.
fn jumps(solution: &Solution) -> Vec<String> {
    let of = |phase: &Solution| -> Vec<String> {
        phase.jumps.iter().map(|it| format!("{}.{}", phase.model().name(), it.name)).collect()
    };
    solution.phases().iter().flat_map(of).collect()
}

fn near(found: f64, wanted: f64) {
    assert!((found / wanted - 1.0).abs() < 1e-7, "{found} instead of {wanted}");
}

/// A ball thrown at a mark bounces once, then meets the wind.
const WINDY: &str = "
param e = 0.8
free T  in [0.3, 3] guess 1
free vx in [0, 20] guess 4
free vy in [-10, 10] guess 1
phase air {
  time t in [0, T]
  state x start 0
  state h start 1.5
  state v start vy
  surface ground = h
  dynamics { x' = vx  h' = v  v' = -9.81 }
  path over: h >= 0
  jump bounce on ground falling at most 2 { v := -e*v }
}
phase wind like air {
  time t in [T, T + 0.5]
  dynamics { x' = vx - 1 }
}
link air -> wind { same }
end wind.x == 6
end wind.h == 1
minimize vx^2 + vy^2";

#[test]
fn a_ball_bounces_in_one_phase_and_lands_in_the_next() {
    let solution = certified(WINDY);
    near(solution.objective(), 24.0315807218);
    near(solution.value("T").expect("an unknown"), 1.10984320);
    assert_eq!(jumps(&solution), ["air.bounce"]);
    near(solution.phases()[0].jumps[0].time, 0.9047802963);
    let answer = solution.sequences.iter().find(|it| it.is_answer).expect("one of them");
    assert_eq!(
        (answer.words.as_str(), &answer.jumps[..]),
        ("air.bounce", &["air.bounce".into()][..])
    );
    assert!(solution.sequences.iter().any(|it| it.words == "wind.bounce"));
    assert!(solution.sequences.iter().all(|it| it.crosses.is_empty()), "`over` keeps it there");
    // From the same minimum with 0.7999 and with 0.8001.
    let (_, slope) = solution.sensitivities()[0];
    assert!((slope / -42.670789 - 1.0).abs() < 1e-6, "{slope}");
}

/// The replay of each phase jumps where the solution does; the links hold between the replays.
#[test]
fn a_solution_is_replayed_and_begun_at() {
    let windy = model(WINDY);
    let first = windy.solve(&Options::default()).expect("it can be solved");
    let record = first.record();
    let (replays, links) = windy.verify_phases(&record).expect("it can be replayed");
    assert!(replays.iter().all(|it| it.confirms(1e-6)));
    assert!(links.iter().all(|it| it.part.abs() < 1e-6));
    let names = replays[0].gaps.iter().map(|it| it.name.as_str());
    assert!(names.into_iter().any(|it| it == "time of bounce"));
    let options = Options { start: Start::Record(&record), ..Options::default() };
    let again = windy.solve(&options).expect("it can be solved");
    near(again.objective(), 24.0315807218);
    let next = windy.with("e", 0.79).expect("a parameter");
    let next = next.solve(&Options { start: Start::Solution(&first), ..options });
    assert!(next.expect("it can be solved").is_certified());
}

/// Two walls in one phase: `u0` is 3.875 over the whole time, the heights are parabolas.
#[test]
fn several_jumps_in_one_phase_come_in_their_best_order() {
    let text = "
param e = 0.8
free T  in [0.5, 3] guess 1
free u0 in [3, 10] guess 5
free w  in [-6, 6] guess 3
phase air {
  time t in [0, T]
  state x start 0
  state h start 1
  state u start u0
  state v start w
  surface ground = h
  surface wall = 2 - x
  dynamics { x' = u  h' = v  u' = 0  v' = -9.81 }
  path over: h >= 0
  path before: x <= 2
  jump bounce on ground falling at most 2 { v := -e*v }
  jump back on wall falling at most 1 { u := -e*u }
}
phase lift like air {
  time t in [T, T + 0.4]
  dynamics { v' = -4 }
}
link air -> lift { same }
end lift.x == 0.5
end lift.h == 1
minimize u0^2 + w^2";
    let solution = certified(text);
    near(solution.objective(), 12.57169885681);
    assert_eq!(jumps(&solution), ["air.back", "air.bounce"]);
}

/// A block slides against a wall and comes back to rest, all by friction; then it is pulled over a
/// metre as that of `models/block.fdc`: 2 (1 + (0.1/0.25)) and 65.9568257099.
#[test]
fn friction_goes_with_jumps_in_a_phase() {
    let text = "
param e = 0.5
free T in [0.5, 5] guess 2
phase slide {
  time t in [0, T]
  state x start 0
  state v start free in [1.5, 5]
  surface slip = v
  surface wall = 1 - x
  dynamics { x' = v  v' in -Sgn(slip) }
  jump hit on wall falling at most 1 { v := -e*v }
  end x == 0.9
  end v == 0
}
phase pull {
  time t in [T, T + 4]
  state x
  state v
  control F in [-12, 12]
  surface slip = v
  dynamics { x' = v  2 * v' in -5.886*Sgn(slip) + F }
  end x == -0.1
  end v == 0
}
link slide -> pull { same }
minimize slide.v(start)^2 + integral(pull.F^2)";
    let solution = certified(text);
    near(solution.objective(), 2.8 + 65.9568257099);
    assert_eq!(jumps(&solution), ["slide.hit"]);
}

/// The heater of `docs/reference/jumps.md`, cut at t = 1: it goes off in the first phase, and on
/// again in the second.
#[test]
fn jumps_of_several_phases_take_turns() {
    let text = "
free power in [6, 12] guess 8
phase day {
  time t in [0, 1]
  state warmth start 18
  state on start 1
  surface warm = warmth - 21
  dynamics { warmth' = power*on - 0.3*(warmth - 5)  on' = 0 }
  jump off on warm rising at most 1 { on := 0 }
}
phase night {
  time t in [1, 1.8]
  state warmth
  state on
  surface cold = warmth - 19
  dynamics { warmth' = power*on - 0.3*(warmth - 5)  on' = 0 }
  jump again on cold falling at most 1 { on := 1 }
}
link day -> night { same }
minimize integral((day.warmth - 20)^2) + integral((night.warmth - 20)^2)";
    let solution = certified(text);
    near(solution.objective(), 1.078533514);
    assert_eq!(jumps(&solution), ["day.off", "night.again"]);
}

/// What rests after its last jump is lifted by the least effort of a double integrator, which from
/// rest over a height of 1 in a second costs 12 beside 9.81^2.
#[test]
fn what_rests_is_handed_over() {
    let text = "
phase fall {
  time t in [0, 1.2]
  state h start 1
  state v start 0
  surface ground = h
  dynamics { h' = v  v' = -9.81 }
  jump bounce on ground falling at most 2 then hold ground { v := -0.3*v }
}
phase lift {
  time t in [1.2, 2.2]
  state h
  state v
  control u in [0, 20]
  dynamics { h' = v  v' = u - 9.81 }
}
link fall -> lift { same }
end lift.h == 1
end lift.v == 0
minimize integral(lift.u^2)";
    let solution = certified(text);
    near(solution.objective(), 12.0 + 9.81 * 9.81);
    assert_eq!(jumps(&solution), ["fall.bounce", "fall.bounce"]);
}

/// A link is the first bounce, so that the phase behind it begins on the surface of its jump.
#[test]
fn a_phase_begins_on_the_surface_of_its_jump() {
    let text = "
param e = 0.8
free T in [0.1, 2] guess 0.5
free T2 in [0.1, 3] guess 1
free vx in [0, 10] guess 1
phase fall {
  time t in [0, T]
  state x start 0
  state h start 1
  state v start 0
  dynamics { x' = vx  h' = v  v' = -9.81 }
  end h == 0
}
phase rise like fall {
  time t in [T, T + T2]
  surface ground = h
  jump bounce on ground falling at most 2 { v := -e*v }
  end h == 0.3
  end x == 1
}
link fall -> rise { same  v := -e*v }
minimize vx^2 + T2";
    let solution = certified(text);
    let (g, e) = (9.81_f64, 0.8);
    let speed = (2.0 * g).sqrt();
    let again = e * e * speed;
    let last = 2.0 * e * speed / g + (again - (again * again - 0.6 * g).sqrt()) / g;
    near(solution.objective(), (speed / g + last).powi(-2) + last);
    assert_eq!(jumps(&solution), ["rise.bounce"]);
    let none = solution.sequences.iter().find(|it| it.words == "no jump").expect("it is tried");
    assert!(none.ended.is_solved && none.crosses.is_empty(), "it begins there and goes up");
}

/// Where there are more combinations than are tried, the search begins at that of the guess. Over
/// the power the objective has several minima; from 11 it falls to that of all jumps.
#[test]
fn of_many_sequences_the_search_begins_at_that_of_the_guess() {
    let heater = "
  surface warm = warmth - 21
  surface cold = warmth - 19
  dynamics { warmth' = power*on - 0.3*(warmth - 5)  on' = 0 }
  jump off on warm rising at most 2 { on := 0 }
  jump again on cold falling at most 2 { on := 1 }
";
    let text = format!(
        "
free power in [6, 12] guess 11
phase day {{
  time t in [0, 1]
  state warmth start 18
  state on start 1{heater}}}
phase night {{
  time t in [1, 1.8]
  state warmth
  state on{heater}}}
link day -> night {{ same }}
minimize integral((day.warmth - 20)^2) + integral((night.warmth - 20)^2)"
    );
    let solution = certified(&text);
    near(solution.objective(), 0.8402367154275);
    assert_eq!(jumps(&solution), ["day.off", "day.again", "night.off", "night.again"]);
    assert!(solution.sequences_left_out);
}
