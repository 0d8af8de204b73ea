//! Stiff modes: few steps, and the values of closed forms and of the IVP test set.
//!
//! F. Mazzia, C. Magherini: Test Set for Initial Value Problem Solvers, release 2.4 (2008):
//! problems `vdpol` and `rober`.

use fdcc_compiler::compile_simulation;
use fdcc_runtime::simulate::{Controls, Integrator, Options, Simulation, Status, simulate};
use fdcc_tests::models::meaning;

struct Case {
    text: &'static str,
    /// Where events are.
    events: &'static [f64],
    /// States at the end.
    end: &'static [f64],
    /// Relative to the value of a state.
    tolerance: f64,
    /// The relative tolerance of a step.
    rtol: f64,
    most_steps: usize,
}

/// `y = cos t + exp(-1e6 t)`
const LINEAR: Case = Case {
    text: "time t in [0, 10]
state y start 2
dynamics { y' = -1e6*(y - cos(t)) - sin(t) }
",
    events: &[],
    end: &[-0.839_071_529_076_452_5],
    tolerance: 1e-9,
    rtol: 1e-10,
    most_steps: 600,
};

const VAN_DER_POL: Case = Case {
    text: "time t in [0, 2]
state x start 2
state v start 0
dynamics {
  x' = v
  v' = 1e6*((1 - x^2)*v - x)
}
",
    events: &[],
    end: &[1.706_167_732_170_483, -0.892_809_701_024_797_5],
    tolerance: 1e-6,
    rtol: 1e-7,
    most_steps: 6000,
};

const ROBERTSON: Case = Case {
    text: "time t in [0, 1e11]
state a start 1
state b start 0
state c start 0
dynamics {
  a' = -0.04*a + 1e4*b*c
  b' = 0.04*a - 1e4*b*c - 3e7*b^2
  c' = 3e7*b^2
}
",
    events: &[],
    end: &[0.208_334_014_970_125_5e-7, 0.833_336_077_033_471_3e-13, 0.999_999_979_166_505],
    tolerance: 1e-5,
    rtol: 1e-7,
    most_steps: 2000,
};

/// `x = t - 1`, then `3 (t - 1)`; the fast state `y` lags by `x' e`, `e = 1e-6`, and is 1/2 at `t =
/// 7/6 + e`.
const CROSSINGS: Case = Case {
    text: "time t in [0, 2]
state x start -1
state y start -1 - 1e-6
state z start 0
surface middle = x
surface late = y - 1/2
dynamics {
  x' in 2 + Sgn(middle)
  y' = 1e6*(x - y)
  z' in 3 + Sgn(late)
}
",
    events: &[1.0, 7.0 / 6.0 + 1e-6],
    end: &[3.0, 3.0 - 3e-6, 8.0 - 7.0 / 3.0 - 2e-6],
    tolerance: 1e-9,
    rtol: 1e-10,
    most_steps: 600,
};

/// Sliding with `s = cos(t)/2`, which a fast state follows: `y = (L^2 cos t + L sin t)/(2 L^2 +
/// 2)`, `L = 1e6`.
const SLIDING: Case = Case {
    text: "time t in [0, 10]
state x start 0
state y start 1e12/(2e12 + 2)
surface slip = x
dynamics {
  x' in cos(t) - 2*Sgn(slip)
  y' in 1e6*(Sgn(slip) - y)
}
",
    events: &[0.0],
    end: &[0.0, -0.419_536_036_548_6],
    tolerance: 1e-9,
    rtol: 1e-10,
    most_steps: 600,
};

const CASES: [(&str, Case); 5] = [
    ("linear", LINEAR),
    ("van der Pol", VAN_DER_POL),
    ("Robertson", ROBERTSON),
    ("crossings", CROSSINGS),
    ("sliding", SLIDING),
];

fn run(case: &Case, options: &Options) -> Simulation {
    let system = compile_simulation(&meaning(case.text)).expect("the model can be simulated");
    simulate(&system, &Controls::Guess, &Options { rtol: case.rtol, ..options.clone() })
}

fn check(name: &str, case: &Case, simulation: &Simulation) {
    assert!(matches!(simulation.status, Status::Completed), "{name}: {:?}", simulation.status);
    let times: Vec<f64> = simulation.events.iter().map(|event| event.time).collect();
    let agree = times.iter().zip(case.events).all(|(a, b)| (a - b).abs() <= case.tolerance);
    assert!(times.len() == case.events.len() && agree, "{name}: events at {times:?}");
    for (got, exact) in simulation.end.iter().zip(case.end) {
        assert!(
            (got - exact).abs() <= case.tolerance * exact.abs().max(1e-12),
            "{name}: {got}, not {exact}"
        );
    }
    let counts = simulation.counts;
    println!("{name} {counts:?} {:?}", simulation.end);
    assert!(counts.steps + counts.rejected <= case.most_steps, "{name}: {counts:?}");
    assert!(counts.stiff > 0, "{name}: {counts:?}");
}

#[test]
fn stiff_systems_take_few_steps() {
    for (name, case) in CASES {
        check(name, &case, &run(&case, &Options::default()));
    }
}

#[test]
fn the_stiff_method_can_be_asked_for() {
    let options = Options { integrator: Integrator::Stiff, ..Options::default() };
    for (name, case) in CASES {
        let simulation = run(&case, &options);
        check(name, &case, &simulation);
        assert_eq!(simulation.counts.stiff, simulation.counts.steps);
    }
}

#[test]
fn the_explicit_method_alone_needs_a_thousand_times_as_many() {
    let options =
        Options { integrator: Integrator::Explicit, max_steps: 400_000, ..Options::default() };
    let simulation = run(&LINEAR, &options);
    assert!(matches!(simulation.status, Status::StepLimit) && simulation.counts.stiff == 0);
}

#[test]
fn states_inside_a_step_are_as_exact_as_at_its_end() {
    let times: Vec<f64> = (0..=20).map(|k| 0.5 * f64::from(k)).collect();
    let simulation = run(&LINEAR, &Options { times: times.clone(), ..Options::default() });
    for (time, got) in times.iter().zip(&simulation.states[0]).skip(1) {
        assert!((got - time.cos()).abs() < 1e-9, "{got} at {time}");
    }
}
