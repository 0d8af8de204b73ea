//! Controls that are polynomials in time: what they do is known in closed form.

use fdcc_compiler::{compile_sensitivities, compile_simulation};
use fdcc_runtime::sensitivity::{Quantity, gradient, hessian};
use fdcc_runtime::simulate::{
    Controls, EventKind, Options, Polynomials, Simulation, Status, System, simulate,
};
use fdcc_tests::models::meaning;

/// One segment for each pair of ends, with the values of a function at so many nodes.
fn through(times: &[f64], nodes: usize, u: impl Fn(f64) -> f64) -> Controls {
    let inside = |pair: &[f64]| {
        let (from, length) = (pair[0], pair[1] - pair[0]);
        (0..nodes).map(move |k| from + length * (k as f64 + 0.5) / nodes as f64)
    };
    let all: Vec<f64> = times.windows(2).flat_map(inside).collect();
    Controls::Polynomial(Polynomials {
        times: times.to_vec(),
        ranges: (1..times.len()).map(|k| (k - 1) * nodes..k * nodes).collect(),
        rows: all.iter().map(|time| vec![u(*time)]).collect(),
        nodes: all,
        is_stretched: true,
    })
}

fn run(text: &str, controls: &Controls, options: &Options) -> (System, Simulation) {
    let system = compile_simulation(&meaning(text)).expect("the model can be simulated");
    let simulation = simulate(&system, controls, options);
    assert!(matches!(simulation.status, Status::Completed), "{:?}", simulation.status);
    (system, simulation)
}

fn events(simulation: &Simulation) -> Vec<(f64, EventKind)> {
    simulation.events.iter().map(|event| (event.time, event.kind)).collect()
}

fn check_events(simulation: &Simulation, expected: &[(f64, EventKind)]) {
    let found = events(simulation);
    let agrees =
        |(a, b): (&(f64, EventKind), &(f64, EventKind))| (a.0 - b.0).abs() < 1e-12 && a.1 == b.1;
    let are_same = found.len() == expected.len() && found.iter().zip(expected).all(agrees);
    assert!(are_same, "{found:?}, not {expected:?}");
}

/// The root of a function that changes its sign between two times.
fn root(f: impl Fn(f64) -> f64, mut low: f64, mut high: f64) -> f64 {
    let rises = f(high) > 0.0;
    for _ in 0..100 {
        let middle = 0.5 * (low + high);
        if (f(middle) > 0.0) == rises { high = middle } else { low = middle }
    }
    high
}

/// `x' = t^2` on [0, 1], then `x' = 2 - t`; the integral of `u^2` is `1/5 + 1/3`.
#[test]
fn a_state_and_an_integral_follow_each_polynomial() {
    let text = "time t in [0, 2]  state x start 0  control u  dynamics { x' = u }
        minimize integral(u^2)";
    let u = |t: f64| if t < 1.0 { t * t } else { 2.0 - t };
    let options = Options { times: vec![0.5, 1.0, 1.5, 2.0], ..Options::default() };
    let (_, simulation) = run(text, &through(&[0.0, 1.0, 2.0], 3, u), &options);
    let exact = [1.0 / 24.0, 1.0 / 3.0, 1.0 / 3.0 + 0.375, 1.0 / 3.0 + 0.5];
    for (x, exact) in simulation.states[0].iter().zip(exact) {
        assert!((x - exact).abs() < 1e-12, "{x}, not {exact}");
    }
    let objective = simulation.objective.expect("the end is reached");
    assert!((objective - 8.0 / 15.0).abs() < 1e-12, "{objective}");
}

/// Before the first segment and after the last the values at their ends hold.
#[test]
fn outside_of_the_segments_a_control_stays_where_it_is() {
    let text = "time t in [0, 4]  state x start 0  control u  dynamics { x' = u }";
    let (_, simulation) = run(text, &through(&[1.0, 2.0], 2, |t| t), &Options::default());
    assert!((simulation.end[0] - (1.0 + 1.5 + 4.0)).abs() < 1e-9, "{:?}", simulation.end);
}

/// `x = t^3/3` crosses 1/24 at 1/2.
#[test]
fn a_surface_is_crossed_in_time() {
    let text = "time t in [0, 1]  state x start 0  state y start 0  control u  surface s = x - 1/24
        dynamics { x' = u  y' in Sgn(s) }";
    let (_, simulation) = run(text, &through(&[0.0, 1.0], 3, |t| t * t), &Options::default());
    check_events(&simulation, &[(0.5, EventKind::CrossesUp)]);
    assert!(simulation.end[1].abs() < 1e-12, "{:?}", simulation.end);
}

const BLOCK: &str = "time t in [0, 2]  state v start 0  control u  surface slip = v
    dynamics { v' in u - Sgn(slip) }";

/// `u = 2 t (2 - t)` frees a block of friction 1 at `1 - sqrt(1/2)`, and its speed does not come
/// back to 0.
#[test]
fn a_block_slides_from_where_a_force_exceeds_the_friction() {
    let u = |t: f64| 2.0 * t * (2.0 - t);
    let (_, simulation) = run(BLOCK, &through(&[0.0, 2.0], 3, u), &Options::default());
    let leaves = 1.0 - 0.5_f64.sqrt();
    let moved = |t: f64| 2.0 * t * t - 2.0 * t.powi(3) / 3.0 - t;
    check_events(&simulation, &[(0.0, EventKind::StartsSliding), (leaves, EventKind::LeavesUp)]);
    assert!((simulation.end[0] - (moved(2.0) - moved(leaves))).abs() < 1e-12);
}

/// A force that exceeds the friction by a millionth, twice for less than a thousandth of the time:
/// `u = 1 + e - (4 g)^2` with `g = (t - 0.3) (t - 0.7)`, which is 0 at both.
#[test]
fn no_short_excess_of_a_force_is_missed() {
    let excess = 1e-6;
    let g = |t: f64| (t - 0.3) * (t - 0.7);
    let u = |t: f64| 1.0 + excess - 16.0 * g(t).powi(2);
    let text = BLOCK.replace("[0, 2]", "[0, 1]");
    let (_, simulation) = run(&text, &through(&[0.0, 1.0], 5, u), &Options::default());
    let most = excess.sqrt() / 4.0;
    let first = 0.5 - (0.04 + most).sqrt();
    let second = 0.5 + (0.04 - most).sqrt();
    // v = integral of e - 16 g^2, over d = t - 0.5: g = d^2 - 0.04
    let moved = |t: f64| {
        let d = t - 0.5;
        excess * d - 16.0 * (d.powi(5) / 5.0 - 0.08 * d.powi(3) / 3.0 + 0.0016 * d)
    };
    let rests = |from: f64| {
        let until_highest = if from < 0.5 { 0.6 - from } else { 1.4 - from };
        root(|t| moved(t) - moved(from), until_highest - 1e-4, until_highest + 2e-3)
    };
    let expected = [
        EventKind::StartsSliding,
        EventKind::LeavesUp,
        EventKind::EntersSliding,
        EventKind::LeavesUp,
        EventKind::EntersSliding,
    ];
    let found = events(&simulation);
    assert_eq!(found.iter().map(|it| it.1).collect::<Vec<_>>(), expected, "{found:?}");
    assert!((found[1].0 - first).abs() < 1e-12, "{} is not {first}", found[1].0);
    assert!((found[3].0 - second).abs() < 1e-12, "{} is not {second}", found[3].0);
    // There v is as flat as 1e-9, and its root as uncertain.
    assert!((found[2].0 - rests(first)).abs() < 1e-9, "{} is not {}", found[2].0, rests(first));
    assert!((found[4].0 - rests(second)).abs() < 1e-9, "{} is not {}", found[4].0, rests(second));
}

/// `x = 1 + e - (4 g)^2` is above 1 twice for a moment.
#[test]
fn a_surface_that_is_passed_twice_is_not_missed() {
    let excess = 1e-8;
    let g = |t: f64| (t - 0.3) * (t - 0.7);
    let x = |t: f64| 1.0 + excess - 16.0 * g(t).powi(2);
    let u = |t: f64| -32.0 * g(t) * (2.0 * t - 1.0);
    let text = format!(
        "time t in [0, 1]  state x start {}  state y start 0  control u  surface s = x - 1
         dynamics {{ x' = u  y' in Sgn(s) }}",
        x(0.0)
    );
    let (_, simulation) = run(&text, &through(&[0.0, 1.0], 4, u), &Options::default());
    let most = excess.sqrt() / 4.0;
    let [far, near] = [most, -most].map(|it| (0.04 + it).sqrt());
    let times = [0.5 - far, 0.5 - near, 0.5 + near, 0.5 + far];
    let kinds = [
        EventKind::CrossesUp,
        EventKind::CrossesDown,
        EventKind::CrossesUp,
        EventKind::CrossesDown,
    ];
    let found = events(&simulation);
    assert_eq!(found.iter().map(|it| it.1).collect::<Vec<_>>(), kinds, "{found:?}");
    // The surface is met at a slope of 1e-3.
    for (found, time) in found.iter().zip(times) {
        assert!((found.0 - time).abs() < 1e-11, "{} is not {time}", found.0);
    }
}

/// The integral of `|g|` with `g = (t - 0.3) (t - 0.301)`, which is below 0 in between only.
#[test]
fn a_kink_that_a_control_crosses_for_a_moment_is_met_twice() {
    let g = |t: f64| (t - 0.3) * (t - 0.301);
    let text = "time t in [0, 1]  state x start 0  state y start 0  control u
        dynamics { x' = abs(u)  y' = u }";
    let (_, simulation) = run(text, &through(&[0.0, 1.0], 3, g), &Options::default());
    let below = 1e-3_f64.powi(3) / 6.0;
    let difference = simulation.end[0] - simulation.end[1];
    assert!((difference - 2.0 * below).abs() < 1e-14, "{difference}, not {}", 2.0 * below);
}

/// The greatest `u = 1 - (t - 0.37)^2` is between all nodes.
#[test]
fn the_extremes_of_a_path_condition_see_the_whole_polynomial() {
    let text = "time t in [0, 1]  state x start 0  control u  dynamics { x' = u }  path u <= 2";
    let options = Options { extremes: true, ..Options::default() };
    let controls = through(&[0.0, 1.0], 3, |t| 1.0 - (t - 0.37).powi(2));
    let (_, simulation) = run(text, &controls, &options);
    let [least, greatest] = &simulation.extremes[0];
    assert!((greatest.value - 1.0).abs() < 1e-9, "{greatest:?}");
    assert!((greatest.time - 0.37).abs() < 1e-4, "{greatest:?}");
    assert!((least.value - (1.0 - 0.63_f64.powi(2))).abs() < 1e-9, "{least:?}");
}

/// A force that grows from `a` at 0 to `b` at `T` frees a block of friction 1 at
/// `T (1 - a)/(b - a)`, so its speed at the end is `T (b - 1)^2 / (2 (b - a))`.
#[test]
fn derivatives_by_values_at_nodes_and_by_the_end_of_time() {
    let text = "param T = 2  time t in [0, T]  state v start 0  control u  surface slip = v
        dynamics { v' in u - Sgn(slip) }  minimize v(end)";
    let system = compile_sensitivities(&meaning(text)).expect("the model can be simulated");
    let [a, b, last] = [0.25, 3.0, 2.0];
    let controls = Controls::Polynomial(Polynomials {
        times: vec![0.0, last],
        ranges: std::iter::once(0..2).collect(),
        nodes: vec![0.0, last],
        rows: vec![vec![a], vec![b]],
        is_stretched: true,
    });
    let at = |row: usize| Quantity::Control { row, control: 0 };
    let quantities = [at(0), at(1), Quantity::Parameter(0)];
    let found = gradient(&system, &controls, &Options::default(), &quantities).expect("an end");
    let (c, d) = (b - 1.0, b - a);
    let speed = c * c / (2.0 * d);
    let exact = [last * speed / d, last * (c / d - speed / d), speed];
    for way in [&found.forward, &found.adjoint] {
        let is_exact = way.iter().zip(exact).all(|(got, exact)| (got - exact).abs() < 1e-11);
        assert!(is_exact, "{way:?}, not {exact:?}");
    }
    let second = hessian(&system, &controls, &found.simulation, &quantities).expect("there is one");
    let (aa, ab) = (2.0 * speed / (d * d), c / (d * d) - 2.0 * speed / (d * d));
    let bb = 1.0 / d - 2.0 * c / (d * d) + 2.0 * speed / (d * d);
    let exact = [
        [last * aa, last * ab, speed / d],
        [last * ab, last * bb, c / d - speed / d],
        [speed / d, c / d - speed / d, 0.0],
    ];
    let pairs = second.iter().flatten().zip(exact.iter().flatten());
    assert!(pairs.into_iter().all(|(a, b)| (a - b).abs() < 1e-10), "{second:?}, not {exact:?}");
}

/// The optimum of `block` is stuck, slides and is stuck again, under a force that is linear on each
/// of the three; `linear` has the force of a double integrator.
#[test]
fn a_replay_is_as_exact_as_the_solution() {
    let block = fdcc::Model::from_file("../models/block.fdc").expect("a model");
    let linear = fdcc::Model::from_text(
        "linear",
        "time t in [0, 1]  state x start 0  state v start 0  control u
         dynamics { x' = v  v' = u }  end x == 1  end v == 0  minimize integral(u^2)
         method { scheme = gauss4 controls = linear N = 5 }",
    );
    for model in [block, linear.expect("a model")] {
        let solution = model.solve(&fdcc::Options::default()).expect("a solution");
        let replay = solution.verify().expect("a replay");
        let gap = replay.largest_gap().expect("there are states");
        assert!(replay.is_whole && gap.difference < 1e-9, "{}: {}", gap.name, gap.difference);
    }
}
