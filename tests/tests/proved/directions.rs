//! What is proved about the vector of a `Dir`, against sampling: drift `a` and pull `B` of `psi' =
//! a + B s` are read off the model by itself, at points where `psi` is 0.

use fdcc_compiler::graph::{ExprId, Graph, evaluate};
use fdcc_compiler::model::{Model, Symbol};
use fdcc_compiler::{SurfaceClass, check, graph::derivative, surfaces};
use fdcc_grammar::{Code, Severity, parse};
use fdcc_tests::random::Random;
use std::collections::BTreeMap;

const MODELS: u64 = 500;
const POINTS: usize = 40;
const DIRECTIONS: usize = 16;
const ROUNDING: f64 = 1e-7;

/// The states `v.x, v.y, q.x, q.y` within [-2, 2], a control `u`.
fn model_text(random: &mut Random) -> String {
    let size = |random: &mut Random| random.between(0.3, 4.0);
    let psi =
        ["v", "v - q", "v - (0.5, 1)", "v - (0, 3)", "v - (sin(q.y), q.x/2)"][random.below(5)];
    let drift = |random: &mut Random| {
        let scale = random.between(0.0, 2.0);
        let term = ["u", "1", "q.x", "q.x*q.y", "sin(q.y) - v.x", "4 + u", "v.y"][random.below(7)];
        format!("{scale:.1}*({term})")
    };
    let (one, other) = (drift(random), drift(random));
    let sign = if random.below(4) == 0 { "" } else { "-" };
    let pull = match random.below(5) {
        0 | 1 => format!("{sign}{:.1}*Dir({psi})", size(random)),
        2 => format!("{sign}({:.1} + q.x^2)*Dir({psi})", size(random)),
        3 => format!("u*{:.1}*Dir({psi})", size(random)),
        _ => {
            let (a, b) = (size(random), size(random));
            let (c, d) = (random.between(-3.0, 3.0), random.between(-3.0, 3.0));
            format!(
                "({sign}{a:.1}*Dir({psi}).x + ({c:.1})*Dir({psi}).y, ({d:.1})*Dir({psi}).x {} \
                 {b:.1}*Dir({psi}).y)",
                if sign.is_empty() { "+" } else { "-" }
            )
        }
    };
    format!(
        "time t in [0, 2]\nstate v(x, y) in [-2, 2] start free\nstate q(x, y) in [-2, 2] start \
         free\n\
         control u in [-1, 1]\ndynamics {{\n  v' in ({one}, {other}) + {pull}\n  q' = (u, \
         0.3*q.x)\n}}\n\
         minimize integral(u^2)\n"
    )
}

/// `psi` and its rate, as expressions over the symbols of a model.
struct Sampled {
    graph: Graph,
    psi: [ExprId; 2],
    rates: [ExprId; 2],
    states: [usize; 4],
    control: usize,
    selectors: [usize; 2],
    inputs: usize,
}

impl Sampled {
    fn new(model: &Model) -> Self {
        let mut graph = model.graph.clone();
        let input = |symbol| model.input_of(symbol).expect("all of it occurs") as usize;
        let states = [0, 1, 2, 3].map(|at| input(Symbol::State(at)));
        let psi = [0, 1].map(|at| model.surfaces[at].psi);
        let rates = psi.map(|psi| {
            let mut terms = Vec::new();
            for (state, &at) in model.states.iter().zip(&states) {
                let slope = derivative(&mut graph, psi, at as u32);
                terms.push(graph.mul(slope, state.rate));
            }
            graph.sum(&terms)
        });
        let selectors = [0, 1].map(|at| input(Symbol::Selector(at)));
        let control = input(Symbol::Control(0));
        Sampled { graph, psi, rates, states, control, selectors, inputs: model.symbols.len() }
    }

    /// Values where the states and the control are these, and the selectors those.
    fn values(&self, roots: [ExprId; 2], at: &[f64; 5], selectors: [f64; 2]) -> [f64; 2] {
        let mut point = vec![0.0; self.inputs];
        self.states.iter().zip(at).for_each(|(&input, &value)| point[input] = value);
        point[self.control] = at[4];
        self.selectors.iter().zip(selectors).for_each(|(&input, value)| point[input] = value);
        let values = evaluate(&self.graph, &roots, &point, &[]);
        [values[0], values[1]]
    }

    /// A point where `psi = v - ...` is 0, within the bounds.
    fn point(&self, control: Option<f64>, random: &mut Random) -> Option<[f64; 5]> {
        let mut at = [0.0; 5].map(|_: f64| random.between(-2.0, 2.0));
        at[4] = control.unwrap_or(at[4] / 2.0);
        let psi = self.values(self.psi, &at, [0.0; 2]);
        at[0] -= psi[0];
        at[1] -= psi[1];
        let psi = self.values(self.psi, &at, [0.0; 2]);
        (psi[0].abs() + psi[1].abs() < 1e-12 && at[..2].iter().all(|it| it.abs() <= 2.0))
            .then_some(at)
    }

    /// `a`, and the columns of `B`.
    fn drift_and_pull(&self, at: &[f64; 5]) -> ([f64; 2], [[f64; 2]; 2]) {
        let drift = self.values(self.rates, at, [0.0; 2]);
        let column = |selectors| {
            let rate = self.values(self.rates, at, selectors);
            [rate[0] - drift[0], rate[1] - drift[1]]
        };
        (drift, [column([1.0, 0.0]), column([0.0, 1.0])])
    }
}

/// What is proved and not true at a point.
fn contradiction(class: &SurfaceClass, a: [f64; 2], [b, c]: [[f64; 2]; 2]) -> bool {
    let determinant = b[0] * c[1] - b[1] * c[0];
    // a + s_1 b + s_2 c = 0
    let holding =
        [(a[1] * c[0] - a[0] * c[1]) / determinant, (a[0] * b[1] - a[1] * b[0]) / determinant];
    let along = |drift: [f64; 2], at: usize| {
        let angle = at as f64 / DIRECTIONS as f64 * std::f64::consts::TAU;
        let d = [angle.cos(), angle.sin()];
        (0..2).map(|i| d[i] * (drift[i] + b[i] * d[0] + c[i] * d[1])).sum::<f64>()
    };
    let directions = 0..DIRECTIONS;
    match class {
        SurfaceClass::Apart => true,
        SurfaceClass::Crossed { .. } => holding[0].hypot(holding[1]) < 1.0 - ROUNDING,
        SurfaceClass::Held => {
            holding[0].hypot(holding[1]) > 1.0 + ROUNDING
                || directions.into_iter().any(|at| along(a, at) > ROUNDING)
        }
        SurfaceClass::Attracting => directions.into_iter().any(|at| along([0.0; 2], at) > ROUNDING),
        SurfaceClass::Repelling => directions.into_iter().any(|at| along(a, at) < -ROUNDING),
        SurfaceClass::Degenerate | SurfaceClass::RepellingFor(_) | SurfaceClass::Unknown { .. } => {
            false
        }
    }
}

#[test]
fn what_is_proved_about_directions_is_true_at_every_point() {
    let mut random = Random::new(7);
    let mut seen: BTreeMap<&str, usize> = BTreeMap::new();
    for _ in 0..MODELS {
        let text = model_text(&mut random);
        let checked = check(&parse(&text).tree);
        let errors = checked.diagnostics.iter().filter(|it| it.severity == Severity::Error);
        assert!(
            errors.clone().all(|it| it.code == Code::Repelling),
            "{text}\n{:#?}",
            checked.diagnostics
        );
        let model = checked.model.expect("what is not unique has a meaning");
        let class = surfaces(&model).expect("there are no parameters")[0].class.clone();
        assert_eq!(errors.count() > 0, class == SurfaceClass::Repelling, "{text}");
        let (mut wanted, mut control) = (class.clone(), None);
        if let SurfaceClass::RepellingFor(choice) = &class {
            (wanted, control) = (SurfaceClass::Repelling, choice.first().map(|it| it.1));
        }
        let sampled = Sampled::new(&model);
        for _ in 0..POINTS {
            let Some(at) = sampled.point(control, &mut random) else { continue };
            let (drift, pull) = sampled.drift_and_pull(&at);
            assert!(
                !contradiction(&wanted, drift, pull),
                "{class:?} at {at:?}: {drift:?}, {pull:?}\n{text}"
            );
        }
        let name = match class {
            SurfaceClass::Apart => "apart",
            SurfaceClass::Crossed { .. } => "crossed",
            SurfaceClass::Held => "held",
            SurfaceClass::Attracting => "attracting",
            SurfaceClass::Repelling => "repelling",
            SurfaceClass::RepellingFor(_) => "repelling for some controls",
            SurfaceClass::Degenerate | SurfaceClass::Unknown { .. } => "unknown",
        };
        *seen.entry(name).or_default() += 1;
    }
    for name in
        ["apart", "crossed", "held", "attracting", "repelling", "repelling for some controls"]
    {
        assert!(
            seen.get(name).is_some_and(|&count| count >= 10),
            "{name} is hardly ever proved: {seen:?}"
        );
    }
}
