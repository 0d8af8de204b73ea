//! A model with phases as a chain of problems: what each phase depends on, and what ties them
//! together, by hand.

use fdcc_compiler::{
    Model, analyze, chain_expectations, compile_chain, integrands, with_jumps_in_phases,
};
use fdcc_runtime::problem::{Bounds, Chain, Columns, End, Function, Link};

fn model(text: &str) -> Model {
    let analysis = analyze(text);
    analysis.model.unwrap_or_else(|| panic!("{:#?}", analysis.diagnostics))
}

fn chain(text: &str) -> Chain {
    compile_chain(&model(text)).unwrap_or_else(|found| panic!("{found:#?}"))
}

fn values(function: &dyn Function, point: &[f64], parameters: &[f64]) -> Vec<f64> {
    let mut values = Columns::new(function.outputs(), 1);
    function.value(&Columns::of_point(point), parameters, &mut values);
    (0..function.outputs()).map(|row| values.column(row)[0]).collect()
}

/// The names of the unknowns of a phase.
fn unknowns(chain: &Chain, phase: usize) -> Vec<&str> {
    let problem = &chain.phases[phase];
    let name = |at: usize| problem.parameters[at].name.as_str();
    problem.unknowns.iter().map(|unknown| name(unknown.parameter)).collect()
}

/// The labels of the conditions of a link.
fn labels(link: &Link) -> Vec<String> {
    (1..link.function.outputs()).map(|row| link.function.origin(row).label.to_string()).collect()
}

const TWO_STAGES: &str = include_str!("../../models/twostage.fdc");

#[test]
fn the_rocket_with_two_stages_is_a_chain_of_two() {
    let chain = chain(TWO_STAGES);
    assert_eq!(chain.name, "twostage");
    let names: Vec<&str> = chain.phases.iter().map(|phase| phase.name.as_str()).collect();
    assert_eq!(names, ["boost", "coast"]);
    for phase in &chain.phases {
        let states: Vec<&str> = phase.states.iter().map(|it| it.name.as_str()).collect();
        assert_eq!(states, ["h", "v", "m"]);
        let parameters: Vec<&str> = phase.parameters.iter().map(|it| it.name.as_str()).collect();
        assert_eq!(parameters, ["c", "drop", "T1", "T2"]);
        assert!(phase.has_objective && phase.sense == -1.0);
    }
    assert_eq!(chain.phases[0].start, [Some(0.0), Some(0.0), Some(1500.0)]);
    assert_eq!(chain.phases[1].start, [None, None, None]);
    let all: Vec<usize> = chain.unknowns.iter().map(|it| it.parameter).collect();
    assert_eq!(all, [2, 3]);
}

#[test]
fn a_phase_depends_on_its_own_duration_alone() {
    let chain = chain(TWO_STAGES);
    assert_eq!(unknowns(&chain, 0), ["T1"]);
    assert_eq!(unknowns(&chain, 1), ["T2"]);
    let p = [2500.0, 300.0, 40.0, 80.0];
    // (T2) (v, thrust/m - g, -thrust/c)
    let rates = values(&*chain.phases[1].dynamics, &[0.5, 7.0, 3.0, 400.0, 2000.0], &p);
    assert_eq!(rates, [80.0 * 3.0, 80.0 * (2000.0 / 400.0 - 9.81), 80.0 * (-2000.0 / 2500.0)]);
    let times = values(&*chain.phases[1].interval, &[], &p);
    assert_eq!(times, [40.0, 120.0]);
}

#[test]
fn a_link_is_the_start_of_the_second_phase_less_what_the_first_hands_over() {
    let chain = chain(TWO_STAGES);
    let [link] = &chain.links[..] else { panic!("{} links", chain.links.len()) };
    assert_eq!(link.ends, [End::Last(0), End::First(1)]);
    assert_eq!(link.bounds, [Bounds::fixed(0.0); 3]);
    assert_eq!(labels(link), ["boost -> coast: h", "boost -> coast: v", "boost -> coast: m"]);
    // Three states and a control at each end.
    let ends = [100.0, 20.0, 1000.0, 5.0, 101.0, 18.0, 650.0, 6.0];
    let rows = values(&*link.function, &ends, &[2500.0, 300.0, 40.0, 80.0]);
    assert_eq!(rows, [0.0, 1.0, -2.0, 650.0 - (1000.0 - 300.0)]);
}

#[test]
fn the_objective_belongs_to_the_phase_that_it_reads() {
    let chain = chain(TWO_STAGES);
    let ends = [1.0, 2.0, 3.0, 400.0, 5.0, 600.0];
    let p = [2500.0, 300.0, 40.0, 80.0];
    assert_eq!(values(&*chain.phases[0].boundary, &ends, &p), [0.0]);
    // The height at the end is maximised; m(end) >= 120, v(end) == 0.
    assert_eq!(values(&*chain.phases[1].boundary, &ends, &p), [-400.0, 600.0, 5.0]);
}

/// Two carts, each with its own time: the second is written first, and hands nothing over.
const CARTS: &str = "
param w = 3
free T in [1, 9] guess 2
let gap = b.x - a.x
phase b {
  time t in [T, T + D]
  free D in [1, 5] guess 4
  param k = 2*w
  let power = k*u*x
  state x
  control u in [-1, 1]
  dynamics { x' = u }
}
phase a {
  time t in [0, T]
  state x start 1
  control v in [-1, 1]
  dynamics { x' = v }
}
link a -> b { x := x + 2*v }
end gap <= 5
start b.x >= 0
end integral(a.v^2) + integral(b.u^2) <= 10
minimize w*(integral(a.v^2) + integral(b.power)) + T + b.D + b.k*b.x(end)*a.x(start)
";

#[test]
fn phases_stand_in_the_order_of_their_links() {
    let chain = chain(CARTS);
    let names: Vec<&str> = chain.phases.iter().map(|phase| phase.name.as_str()).collect();
    assert_eq!(names, ["a", "b"]);
    let parameters: Vec<&str> =
        chain.phases[0].parameters.iter().map(|it| it.name.as_str()).collect();
    assert_eq!(parameters, ["w", "b.k", "T", "b.D"]);
    let values: Vec<f64> = chain.phases[0].parameters.iter().map(|it| it.value).collect();
    assert_eq!(values, [3.0, 6.0, 2.0, 4.0]);
    assert_eq!(unknowns(&chain, 0), ["T"]);
    assert_eq!(unknowns(&chain, 1), ["b.D"]);
}

/// `w`, `b.k`, `T`, `b.D`.
const GIVEN: [f64; 4] = [3.0, 6.0, 2.0, 4.0];

#[test]
fn a_link_reads_the_control_of_the_last_interval() {
    let chain = chain(CARTS);
    let link = &chain.links[0];
    assert_eq!(link.ends, [End::Last(0), End::First(1)]);
    // The state, the hidden integral and the control of each end.
    let rows = values(&*link.function, &[10.0, 0.1, 0.5, 12.0, 0.2, 0.7], &GIVEN);
    assert_eq!(rows, [0.0, 12.0 - (10.0 + 2.0 * 0.5)]);
}

#[test]
fn conditions_belong_to_the_phases_that_they_read() {
    let chain = chain(CARTS);
    let of_b: Vec<_> = (1..chain.phases[1].boundary.outputs())
        .map(|row| chain.phases[1].boundary.origin(row).label.to_string())
        .collect();
    assert_eq!(of_b, ["start b.x >= 0"]);
    let link = chain.links.iter().find(|link| link.bounds.len() == 2).expect("it has both");
    assert_eq!(link.ends, [End::Last(0), End::Last(1)]);
    assert_eq!(labels(link), ["end gap <= 5", "end integral(a.v^2) + integral(b.u^2) <= 10"]);
    let rows = values(&*link.function, &[10.0, 0.1, 0.5, 12.0, 0.2, 0.7], &GIVEN);
    assert_eq!(rows, [0.0, 2.0, 0.1 + 0.2]);
    let upper: Vec<f64> = link.bounds.iter().map(|bounds| bounds.upper).collect();
    assert_eq!(upper, [5.0, 10.0]);
}

#[test]
fn a_sum_is_minimised_term_by_term() {
    let chain = chain(CARTS);
    // tau, x, the hidden integral, the control: T (v, v^2), then T w v^2.
    let rates = values(&*chain.phases[0].dynamics, &[0.5, 2.0, 0.0, 0.5], &GIVEN);
    assert_eq!(rates, [2.0 * 0.5, 2.0 * 0.25, 2.0 * 3.0 * 0.25]);
    // D (u, u^2), then D w (k u x).
    let rates = values(&*chain.phases[1].dynamics, &[0.5, 2.0, 0.0, 0.5], &GIVEN);
    assert_eq!(rates, [4.0 * 0.5, 4.0 * 0.25, 4.0 * 3.0 * (6.0 * 0.5 * 2.0)]);
    // The times, each where it counts.
    let ends = [0.0; 4];
    assert_eq!(values(&*chain.phases[0].boundary, &ends, &GIVEN)[0], 2.0);
    assert_eq!(values(&*chain.phases[1].boundary, &ends, &GIVEN)[0], 4.0);
    // What reads both: k x_b(end) x_a(start).
    let link = chain.links.iter().find(|link| link.bounds.is_empty()).expect("it has no row");
    assert_eq!(link.ends, [End::First(0), End::Last(1)]);
    let product = values(&*link.function, &[5.0, 0.0, 0.0, 7.0, 0.0, 0.0], &GIVEN);
    assert_eq!(product, [6.0 * 7.0 * 5.0]);
}

#[test]
fn parameters_have_one_value_in_all_phases() {
    let mut model = model(CARTS);
    model.set_param("w", "5").expect("it is a parameter");
    let chain = compile_chain(&model).expect("it is compiled");
    for phase in &chain.phases {
        let values: Vec<f64> = phase.parameters[..2].iter().map(|it| it.value).collect();
        assert_eq!(values, [5.0, 10.0]);
    }
    model.set_param("b.k", "7").expect("it is a parameter of a phase");
    let chain = compile_chain(&model).expect("it is compiled");
    assert_eq!(chain.phases[0].parameters[1].value, 7.0);
    model.set_method("N", "20").expect("it is a setting");
    let chain = compile_chain(&model).expect("it is compiled");
    assert!(chain.phases.iter().all(|phase| phase.method.intervals() == 20));
}

/// What stands outside of all phases holds in each: a thrown ball with drag after a while.
const BALL: &str = "
const g = 9.81
free T in [0.1, 5] guess 1
state x in [0, 100] start 0
state v start 10
path ceiling: x <= 50
method { N = 10 }
phase up {
  time t in [0, T]
  dynamics { x' = v  v' = -g }
}
phase down {
  time t in [T, T + 1]
  method { N = 4 }
  dynamics { x' = v  v' = -g - v }
}
link up -> down { v := 0.5*v }
start v <= 11
end x == 1
minimize x(end) + integral(v^2)
";

#[test]
fn a_state_outside_of_all_phases_goes_on() {
    let chain = chain(BALL);
    assert_eq!(chain.phases[0].start, [Some(0.0), Some(10.0)]);
    assert_eq!(chain.phases[1].start, [None, None]);
    assert_eq!(chain.phases[1].states[0].bounds, Bounds { lower: 0.0, upper: 100.0 });
    let [link, first] = &chain.links[..] else { panic!("{} links", chain.links.len()) };
    assert_eq!(labels(link), ["up -> down: v", "up -> down: x"]);
    assert_eq!(labels(first), ["ceiling"]);
    assert_eq!(first.ends, [End::First(1)]);
    let rows = values(&*link.function, &[3.0, 4.0, 5.0, 7.0], &[1.0]);
    assert_eq!(rows, [0.0, 7.0 - 0.5 * 4.0, 5.0 - 3.0]);
    for phase in &chain.phases {
        assert_eq!(phase.path.origin(0).label.as_ref(), "ceiling");
    }
    let intervals: Vec<usize> = chain.phases.iter().map(|it| it.method.intervals()).collect();
    assert_eq!(intervals, [10, 4]);
    let label = |phase: usize| chain.phases[phase].boundary.origin(1).label.to_string();
    assert_eq!([label(0), label(1)], ["start v <= 11", "end x == 1"]);
    let ends = [1.0, 2.0, 3.0, 4.0];
    assert_eq!(values(&*chain.phases[0].boundary, &ends, &[1.0])[0], 0.0);
    assert_eq!(values(&*chain.phases[1].boundary, &ends, &[1.0])[0], 3.0);
    // The integral goes over both.
    assert_eq!(values(&*chain.phases[0].dynamics, &[0.0, 1.0, 3.0], &[2.0])[2], 2.0 * 9.0);
    assert_eq!(values(&*chain.phases[1].dynamics, &[0.0, 1.0, 3.0], &[2.0])[2], 9.0);
}

#[test]
fn expectations_read_all_phases() {
    let text =
        format!("{CARTS}expect {{ b.x(end) - a.x(start) == integral(a.v^2) + b.D within 0.1 }}");
    let model = model(&text);
    let asked = chain_expectations(&model);
    assert_eq!(asked.list.len(), 1);
    // State and control at the ends of `a`, then of `b`; parameters; the integrals of each phase.
    let ends = [1.0, 0.0, 2.0, 0.0, 3.0, 0.0, 7.0, 0.0];
    let mut given = GIVEN.to_vec();
    given.extend([0.25, 0.5, 0.75]);
    assert_eq!(values(&*asked.function, &ends, &given), [6.0, 0.25 + 4.0, 0.1]);
    // tau, x, the hidden integral, the control: T v^2.
    let integrands = integrands(&model.phases[0].model);
    assert_eq!(values(&*integrands, &[0.5, 2.0, 0.0, 0.5], &GIVEN), [2.0 * 0.25]);
}

/// Unknown jumps of a state, which no phase reads.
#[test]
fn unknowns_of_links_are_paid_for_there() {
    let text = "
free push in [0, 2]
phase a { time t in [0, 1]  state x start 0  dynamics { x' = x } }
phase b { time t in [1, 2]  state x  dynamics { x' = x }  end x == 1 }
link a -> b { x := x + push }
minimize push^2";
    let chain = chain(text);
    assert!(unknowns(&chain, 0).is_empty() && unknowns(&chain, 1).is_empty());
    let [link] = &chain.links[..] else { panic!("{} links", chain.links.len()) };
    assert_eq!(values(&*link.function, &[3.0, 5.0], &[0.5]), [0.25, 5.0 - 3.5]);
}

/// The first phase ends where `x = 0` and begins again at 1; only its own pieces know of that time.
#[test]
fn a_jump_cuts_its_phase_in_two() {
    let text = "
phase a {
  time t in [0, 1]
  state x start 1
  surface low = x
  dynamics { x' = -3 }
  jump up on low falling { x := 1 }
}
phase b { time t in [1, 2]  state x  dynamics { x' = x } }
link a -> b { x := 2*x }";
    let cut = with_jumps_in_phases(&model(text), &[vec![0], vec![]]).expect("it is cut");
    let names: Vec<&str> = cut.phases.iter().map(|it| it.place.name.as_str()).collect();
    assert_eq!(names, ["a", "a.up", "b"]);
    let chain = compile_chain(&cut).expect("it can be solved");
    assert_eq!([0, 1, 2].map(|at| unknowns(&chain, at).len()), [1, 1, 0]);
    let [jump, link] = &chain.links[..] else { panic!("{} links", chain.links.len()) };
    assert_eq!(jump.ends, [End::Last(0), End::First(1)]);
    // Integrals of a phase are those of all of its pieces.
    assert_eq!(link.ends, [End::Last(0), End::Last(1), End::First(2)]);
    assert_eq!(values(&*link.function, &[7.0, 3.0, 5.0], &[0.5])[1], 5.0 - 2.0 * 3.0);
}

/// Two vectors; the second phase takes over everything but what it says itself.
const LIKE: &str = "
param g = 10
phase up {
  time t in [0, 1]
  state p(x, y) start (0, 1)
  state m start 5
  control u in [-1, 1]
  dynamics { p' = (1, -g)  m' = u }
  path p.y <= 4
  end m >= 1
  end p.x <= 9
}
phase down like up {
  time t in [1, 3]
  control u in [0, 2]
  dynamics { m' = -u*t }
  end m == 2
}
link up -> down {
  same
  p.y := -0.5*p.y
}
minimize down.m(end)";

#[test]
fn a_phase_like_another_takes_over_what_it_does_not_replace() {
    let chain = chain(LIKE);
    let down = &chain.phases[1];
    assert_eq!(down.start, [None, None, None]);
    assert_eq!(down.controls[0].bounds, Bounds { lower: 0.0, upper: 2.0 });
    assert_eq!(down.path.origin(0).label.as_ref(), "p.y <= 4");
    let rows = (1..down.boundary.outputs()).map(|row| down.boundary.origin(row).label.to_string());
    assert_eq!(rows.collect::<Vec<_>>(), ["end p.x <= 9", "end m == 2"]);
    // tau, p, m, u; the time goes from 1 to 3.
    let rates = values(&*down.dynamics, &[0.5, 0.0, 0.0, 0.0, 3.0], &[10.0]);
    assert_eq!(rates, [2.0, -20.0, 2.0 * -3.0 * 2.0]);
    let rates = values(&*chain.phases[0].dynamics, &[0.5, 0.0, 0.0, 0.0, 3.0], &[10.0]);
    assert_eq!(rates, [1.0, -10.0, 3.0]);
}

#[test]
fn what_a_link_does_not_give_goes_on_by_same() {
    let chain = chain(LIKE);
    let [link, _] = &chain.links[..] else { panic!("{} links", chain.links.len()) };
    assert_eq!(labels(link), ["up -> down: p.y", "up -> down: p.x", "up -> down: m"]);
    let ends = [1.0, 2.0, 3.0, 0.0, 4.0, 5.0, 6.0, 0.0];
    assert_eq!(values(&*link.function, &ends, &[10.0]), [0.0, 5.0 + 0.5 * 2.0, 3.0, 3.0]);
}

#[test]
fn a_definition_knows_the_ends_of_time() {
    let chain = chain(
        "
param a = 2
time t in [a, 3*a]
let tau = (t - t(start))/(t(end) - t(start))
state x start 0
dynamics { x' = tau }",
    );
    // 4 tau at tau = 1/4.
    assert_eq!(values(&*chain.phases[0].dynamics, &[0.25, 0.0], &[2.0]), [1.0]);
}
