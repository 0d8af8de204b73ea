//! Models in closed loop on themselves, each step from the plan before.

use std::time::Instant;

use fdcc::{Model, Options, Start};

/// A model whose parameters `x0`, `v0` are the start of its states and whose `now`, if it has one,
/// is the time at which it begins.
pub struct Case {
    /// For tables.
    pub name: &'static str,
    /// The model.
    pub text: &'static str,
    /// Of the grid.
    pub intervals: usize,
    /// Of the loop.
    pub steps: usize,
}

/// A block with friction that follows a reference, one that is brought to a place, a pendulum that
/// is kept upright against its bound, and a block that follows steps.
pub const CASES: &[Case] = &[
    Case { name: "a block follows a sine", text: SINE, intervals: 40, steps: 100 },
    Case { name: "a block is brought to a place", text: PLACE, intervals: 40, steps: 60 },
    Case { name: "a pendulum swings up", text: PENDULUM, intervals: 40, steps: 60 },
    Case { name: "a block follows steps", text: STEPS, intervals: 40, steps: 100 },
];

const SINE: &str = "model sine
param now = 0 [s]
param x0 = 0 [m]
param v0 = 0 [m/s]
const w = 2 [1/s]
time t in [0, 1] [s]
state x [m] start x0
state v [m/s] start v0
control F in [-8, 8] [m/s^2]
surface slip = v
dynamics { x' = v  v' in F - 2 [m/s^2] * Sgn(slip) }
minimize integral(100 [1/s^4] * (x - 1 [m] * sin(w * (t + now)))^2 + 0.01 * F^2)
method { sigma = 0.05 [m/s] }
";

const PLACE: &str = "model place
param x0 = 0 [m]
param v0 = 0 [m/s]
time t in [0, 1] [s]
state x [m] start x0
state v [m/s] start v0
control F in [-8, 8] [m/s^2]
surface slip = v
dynamics { x' = v  v' in F - 2 [m/s^2] * Sgn(slip) }
minimize integral(100 [1/s^4] * (x - 1 [m])^2 + 1 [1/s^2] * v^2 + 0.01 * F^2)
method { sigma = 0.05 [m/s] }
";

const PENDULUM: &str = "model pendulum
param x0 = 3.1
param v0 = 0
time t in [0, 2]
state x start x0
state v start v0
control u in [-6, 6]
dynamics { x' = v  v' = 9.81 * sin(x) + u }
minimize integral(10 * (1 - cos(x)) + 0.1 * v^2 + 0.01 * u^2)
";

const STEPS: &str = "model steps
param now = 0 [s]
param x0 = 0 [m]
param v0 = 0 [m/s]
time t in [0, 1] [s]
state x [m] start x0
state v [m/s] start v0
control F in [-8, 8] [m/s^2]
dynamics { x' = v  v' = F }
let r = 0.5 [m] * tanh(20 * sin(2 [1/s] * (t + now)))
minimize integral(100 [1/s^4] * (x - r)^2 + 0.01 * F^2)
";

impl Case {
    /// The model on its grid.
    pub fn model(&self) -> Model {
        let model = Model::from_text(self.name, self.text).expect("it has no errors");
        model.with_method("N", self.intervals as f64).expect("it is a number")
    }
}

/// What a loop took.
pub struct Loop {
    /// Of all steps but the first.
    pub iterations: usize,
    /// The same.
    pub seconds: f64,
    /// Steps that were not solved.
    pub failures: usize,
    /// The last state.
    pub state: [f64; 2],
}

/// The loop: the model itself is what it controls.
pub fn run(case: &Case, is_later: bool) -> Loop {
    let model = case.model();
    let mut now = 0.0;
    let mut found = model.solve(&Options::default()).expect("it can be solved");
    let mut all = Loop { iterations: 0, seconds: 0.0, failures: 0, state: [0.0; 2] };
    for _ in 0..case.steps {
        now += found.time()[1];
        all.state = ["x", "v"].map(|name| found.state(name).expect("it is declared")[1]);
        let [x, v] = all.state;
        let values = [("x0", x.into()), ("v0", v.into()), ("now", now.into())];
        let values = if model.has_param("now") { &values[..] } else { &values[..2] };
        let compiled = model.with_all(values).and_then(|it| it.compile()).expect("numbers");
        let start = if is_later { Start::Later(&found) } else { Start::Solution(&found) };
        let begin = Instant::now();
        let next = compiled.solve(&Options { start, ..Options::default() });
        let next = next.expect("it can be solved");
        all.seconds += begin.elapsed().as_secs_f64();
        all.iterations += next.outcome.solution.counts.iterations;
        all.failures += usize::from(!next.is_solved());
        found = next;
    }
    all
}
