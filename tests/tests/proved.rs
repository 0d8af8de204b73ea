//! Never wrong: what is proved about the surfaces of random models is compared with dense sampling.
//!
//! The rates `psi_t + psi_x f` on both sides are computed here from the model by itself, at points
//! of the surface found by Newton's method from random places within the bounds.

mod directions;

use fdcc_compiler::graph::derivative;
use fdcc_compiler::graph::{ExprId, Graph, evaluate};
use fdcc_compiler::model::{Model, Symbol};
use fdcc_compiler::{SurfaceClass, check, surfaces};
use fdcc_grammar::{Code, parse};
use fdcc_tests::random::Random;
use std::collections::BTreeMap;

const MODELS: u64 = 700;
const POINTS: usize = 60;
const ROUNDING: f64 = 1e-7;

fn number(random: &mut Random) -> String {
    format!("{:.1}", random.between(-2.0, 2.0))
}

/// An expression of `x`, `y` and `t`.
fn expression(random: &mut Random, depth: usize) -> String {
    if depth == 0 {
        let names = ["x", "y", "t", "k"];
        let at = random.below(6);
        return names
            .get(at)
            .map_or_else(|| format!("({})", number(random)), |name| name.to_string());
    }
    let a = expression(random, depth - 1);
    let b = expression(random, depth - 1);
    match random.below(12) {
        0 | 1 => format!("({a} + {b})"),
        2 => format!("({a} - {b})"),
        3 | 4 => format!("({a})*({b})"),
        5 => format!("({a})^2"),
        6 => format!("sin({a})"),
        7 => format!("cos({a})"),
        8 => format!("sqrt(1 + ({a})^2)"),
        9 => format!("exp(-({a})^2)"),
        10 => format!("({a})/(1 + ({b})^2)"),
        _ => format!("abs({a})"),
    }
}

/// The factor of a selector, often of one sign.
fn factor(random: &mut Random) -> String {
    let size = random.between(0.2, 3.0);
    let other = expression(random, 1);
    match random.below(6) {
        0 => format!("{size:.1}"),
        1 | 2 => format!("-{size:.1}"),
        3 => format!("-({size:.1} + ({other})^2)"),
        4 => format!("u*{size:.1}"),
        _ => expression(random, 2),
    }
}

fn function(random: &mut Random) -> String {
    let other = ["y", "t", "sin(y)", "y^2", "k*y"][random.below(5)];
    match random.below(8) {
        0 => "x".into(),
        1..=3 => format!("x - {other}"),
        4 => "x^2 + y^2 - 1".into(),
        5 => format!("({})^2", expression(random, 1)),
        6 => format!("sin(x) + {other}"),
        _ => expression(random, 2),
    }
}

fn model_text(random: &mut Random) -> String {
    let mut bounds = || match random.below(3) {
        0 => String::new(),
        _ => {
            let low = random.between(-3.0, 1.0);
            format!(" in [{low:.1}, {:.1}]", low + random.between(0.5, 4.0))
        }
    };
    let (x, y) = (bounds(), bounds());
    let control = random.between(0.0, 3.0);
    let (psi, drift, across) = (function(random), expression(random, 2), expression(random, 2));
    let (in_x, in_y) = (factor(random), factor(random));
    let with_control = ["", " + u", " - 2*u"][random.below(3)];
    let second = if random.below(2) == 0 { String::new() } else { format!(" + ({in_y})*Sgn(s)") };
    format!(
        "param k = 1.5\ntime t in [0, 2]\nstate x{x} start free\nstate y{y} start free\ncontrol u \
         in [-{control:.1}, {control:.1}]\n\
         surface s = {psi}\ndynamics {{\n  x' in {drift}{with_control} + ({in_x})*Sgn(s)\n  y' in \
         {across}{second}\n}}\n\
         minimize integral(u^2)\n"
    )
}

/// What is computed at a point: `psi`, its slopes by `x` and `y`, and the rates below and above.
struct Sampled {
    graph: Graph,
    roots: Vec<ExprId>,
    inputs: [usize; 4],
    selector: usize,
    fixed: Vec<f64>,
}

impl Sampled {
    fn new(model: &Model) -> Self {
        let mut graph = model.graph.clone();
        let input = |symbol| model.input_of(symbol).map(|at| at as usize);
        let states = [Symbol::State(0), Symbol::State(1)]
            .map(|it| input(it).expect("the model has two states"));
        let time = input(Symbol::Time).expect("the model has a time");
        let psi = model.surfaces[0].psi;
        let mut terms = vec![derivative(&mut graph, psi, time as u32)];
        let mut roots = vec![psi];
        for (state, at) in model.states.iter().zip(states) {
            let slope = derivative(&mut graph, psi, at as u32);
            roots.push(slope);
            terms.push(graph.mul(slope, state.rate));
        }
        roots.push(graph.sum(&terms));
        let control = input(Symbol::Control(0)).expect("the model has a control");
        let selector = input(Symbol::Selector(0)).expect("the model has a surface");
        let mut fixed = vec![0.0; model.symbols.len()];
        fixed[input(Symbol::Param(0)).expect("the model has a parameter")] = 1.5;
        Sampled { graph, roots, inputs: [states[0], states[1], time, control], selector, fixed }
    }

    fn values(&self, at: [f64; 4], side: f64) -> Vec<f64> {
        let mut point = self.fixed.clone();
        self.inputs.iter().zip(at).for_each(|(&input, value)| point[input] = value);
        point[self.selector] = side;
        evaluate(&self.graph, &self.roots, &point, &[])
    }

    /// A point on the surface within the bounds, near a random one.
    fn point(&self, bounds: &[[f64; 2]; 4], random: &mut Random) -> Option<[f64; 4]> {
        let mut at = bounds.map(|[low, high]| random.between(low.max(-3.0), high.min(3.0)));
        for _ in 0..40 {
            let values = self.values(at, 0.0);
            let size = values[1].powi(2) + values[2].powi(2);
            if values[0].abs() < 1e-13 {
                let inside =
                    at.iter().zip(bounds).all(|(value, [low, high])| low <= value && value <= high);
                return inside.then_some(at);
            }
            at[0] -= values[0] * values[1] / size;
            at[1] -= values[0] * values[2] / size;
        }
        None
    }
}

/// What is proved and not true at a point.
fn contradiction(class: &SurfaceClass, below: f64, above: f64) -> bool {
    let slack = ROUNDING * (1.0 + below.abs() + above.abs());
    match class {
        SurfaceClass::Apart => true,
        SurfaceClass::Crossed { strictly: true } => below * above < -slack,
        SurfaceClass::Crossed { strictly: false } => {
            below.min(above) < -slack && below.max(above) > slack
        }
        SurfaceClass::Held => below < -slack || above > slack,
        SurfaceClass::Attracting => above - below > slack,
        SurfaceClass::Repelling => below > slack || above < -slack,
        SurfaceClass::Degenerate | SurfaceClass::RepellingFor(_) | SurfaceClass::Unknown { .. } => {
            false
        }
    }
}

#[test]
fn what_is_proved_about_surfaces_is_true_at_every_point() {
    let mut random = Random::new(4);
    let mut seen: BTreeMap<&str, usize> = BTreeMap::new();
    for _ in 0..MODELS {
        let text = model_text(&mut random);
        let parsed = parse(&text);
        assert!(parsed.diagnostics.is_empty(), "{text}\n{:#?}", parsed.diagnostics);
        let checked = check(&parsed.tree);
        let degenerate = checked.diagnostics.iter().any(|it| it.code == Code::VanishingGradient);
        let Some(model) = checked.model else {
            assert!(degenerate, "{text}\n{:#?}", checked.diagnostics);
            *seen.entry("degenerate").or_default() += 1;
            continue;
        };
        let reports = surfaces(&model).expect("parameters have values");
        let class = &reports[0].class;
        let sampled = Sampled::new(&model);
        let bounds = |at: usize| {
            let range = model.states[at].range;
            [range.lower, range.upper]
                .map(|end| evaluate(&model.graph, &[end], &sampled.fixed, &[])[0])
        };
        let range = model.controls[0].range;
        let control = [range.lower, range.upper]
            .map(|end| evaluate(&model.graph, &[end], &sampled.fixed, &[])[0]);
        let mut bounds = [bounds(0), bounds(1), [0.0, 2.0], control];
        let mut wanted = class.clone();
        if let SurfaceClass::RepellingFor(choice) = class {
            choice.iter().for_each(|it| bounds[3] = [it.1, it.1]);
            wanted = SurfaceClass::Repelling;
        }
        for _ in 0..POINTS {
            let Some(at) = sampled.point(&bounds, &mut random) else { continue };
            let [below, above] = [-1.0, 1.0].map(|side| sampled.values(at, side)[3]);
            assert!(
                !contradiction(&wanted, below, above),
                "{class:?} at {at:?}: {below} and {above}\n{text}"
            );
        }
        let name = match class {
            SurfaceClass::Apart => "apart",
            SurfaceClass::Crossed { .. } => "crossed",
            SurfaceClass::Held => "held",
            SurfaceClass::Attracting => "attracting",
            SurfaceClass::Repelling | SurfaceClass::RepellingFor(_) => "repelling",
            SurfaceClass::Degenerate | SurfaceClass::Unknown { .. } => "unknown",
        };
        *seen.entry(name).or_default() += 1;
    }
    for name in ["apart", "crossed", "held", "attracting", "repelling", "degenerate"] {
        assert!(
            seen.get(name).is_some_and(|&count| count >= 10),
            "{name} is hardly ever proved: {seen:?}"
        );
    }
}
