//! Families of systems with coefficients for parameters.

use crate::random_simulations::affine::Affine;
use fdcc_compiler::compile_sensitivities;
use fdcc_runtime::problem::Parameter;
use fdcc_runtime::simulate::{Controls, Polynomials, System};
use fdcc_tests::models::meaning;
use fdcc_tests::random::Random;
use std::collections::BTreeMap;
use std::fmt::Write;

/// How often the control changes.
const ROWS: usize = 4;

/// How many nodes a polynomial has between two changes.
const NODES: usize = 3;

/// One system with what drives it.
pub struct Case {
    pub system: System,
    pub controls: Controls,
}

type Coefficients = BTreeMap<String, f64>;

/// Systems that differ in their parameters.
pub struct Family {
    system: System,
    /// New parameters.
    draw: Box<dyn Fn(&mut Random) -> Coefficients>,
}

/// `name0*x0 + name1*x1 + ... + nameN*t + nameM`.
fn row(name: &str, size: usize) -> String {
    let states: String = (0..size).map(|j| format!("{name}{j}*x{j} + ")).collect();
    format!("{states}{name}{size}*t + {name}{}", size + 1)
}

fn affine_text(surfaces: usize, size: usize) -> String {
    let mut text = String::from("time t in [0, T]\ncontrol u\n");
    let mut equations = String::new();
    for i in 0..size {
        writeln!(text, "state x{i} start s{i}").expect("text");
        write!(equations, "x{i}' in {} + g{i}*u", row(&format!("a{i}_"), size)).expect("text");
        for k in 0..surfaces {
            write!(equations, " + ({})*Sgn(p{k})", row(&format!("b{k}_{i}_"), size)).expect("text");
        }
        equations.push('\n');
    }
    for k in 0..surfaces {
        writeln!(text, "surface p{k} = {}", row(&format!("c{k}_"), size)).expect("text");
    }
    let ends: String = (1..size).map(|i| format!(" + x{i}(end)")).collect();
    format!(
        "{text}dynamics {{\n{equations}}}\nminimize x0(end)^2{ends} + integral(x0^2 + \
         u*selected(Sgn(p0)))\n"
    )
}

fn numbers<'n>(name: String, values: &'n [f64]) -> impl Iterator<Item = (String, f64)> + 'n {
    values.iter().enumerate().map(move |(j, value)| (format!("{name}{j}"), *value))
}

fn affine_coefficients(random: &mut Random, surfaces: usize, size: usize) -> Coefficients {
    let system = loop {
        match Affine::new(random, surfaces) {
            Some(system) if system.size() == size => break system,
            _ => {}
        }
    };
    let mut all = Coefficients::new();
    let rows = |all: &mut Coefficients, name: &str, rows: &[Vec<f64>]| {
        rows.iter()
            .enumerate()
            .for_each(|(i, row)| all.extend(numbers(format!("{name}{i}_"), row)));
    };
    rows(&mut all, "a", &system.drift);
    system.push.iter().enumerate().for_each(|(k, push)| rows(&mut all, &format!("b{k}_"), push));
    rows(&mut all, "c", &system.normal);
    let begins_anywhere = random.below(8) > 0;
    for i in 0..size {
        let start = if begins_anywhere { random.between(-1.0, 1.0) } else { system.start[i] };
        all.insert(format!("s{i}"), start);
        all.insert(format!("g{i}"), random.between(-0.5, 0.5));
    }
    all.insert("T".to_string(), random.between(2.0, 4.0));
    all
}

/// Curved surfaces that move, products of states and selectors, a wall that resets.
const CURVED: &str = "
time t in [0, T]
control u
state x start k0
state y start k1
state z start k0*k1
surface p = k2*x + y + k3*sin(k4*t + z)
surface q = z + k5*x*y - k6*t
surface wall = x^2/4 + y - k7
dynamics {
  x' in sin(k8*y + t) - x/2 - k9*Sgn(p) + u/2
  y' in cos(k10*x) - y*z/4 - k11*Sgn(p) + k12*Sgn(q)
  z' in k13*x - z/2 - k14*(1 + x^2/4)*Sgn(q) + u*y/4
}
jump bounce on wall rising {
  x := k15*x + z/8
  y := y - 1 - k16*t - u*x/8
}
minimize x(end)*y(end) + z(end) + k1*integral(z^2 + x*selected(Sgn(p)))
";

/// Where each is drawn.
const CURVED_RANGES: [[f64; 2]; 17] = [
    [-1.0, 1.0],
    [-1.0, 0.2],
    [0.2, 1.0],
    [-0.5, 0.5],
    [0.5, 3.0],
    [-0.5, 0.5],
    [-0.5, 0.5],
    [0.3, 0.8],
    [0.5, 2.0],
    [0.2, 1.0],
    [0.5, 2.0],
    [0.5, 1.5],
    [-0.4, 0.4],
    [-2.0, 2.0],
    [0.5, 1.5],
    [0.2, 0.9],
    [0.0, 0.3],
];

fn curved_coefficients(random: &mut Random) -> Coefficients {
    let drawn: Vec<f64> =
        CURVED_RANGES.iter().map(|[low, high]| random.between(*low, *high)).collect();
    let mut all: Coefficients = numbers("k".to_string(), &drawn).collect();
    all.insert("T".to_string(), random.between(2.0, 4.0));
    all
}

impl Family {
    /// `x' = A x + a + g u + sum_k s_k (A_k x + b_k)` with so many surfaces and states.
    pub fn affine(surfaces: usize, size: usize) -> Self {
        let draw = move |random: &mut Random| affine_coefficients(random, surfaces, size);
        Family::new(&affine_text(surfaces, size), Box::new(draw))
    }

    /// Three states, two surfaces, a wall.
    pub fn curved() -> Self {
        Family::new(CURVED, Box::new(curved_coefficients))
    }

    fn new(text: &str, draw: Box<dyn Fn(&mut Random) -> Coefficients>) -> Self {
        let names = draw(&mut Random::new(1)).into_iter();
        let params: String =
            names.map(|(name, value)| format!("param {name} = {value}\n")).collect();
        let system = compile_sensitivities(&meaning(&format!("{params}{text}")));
        Family { system: system.expect("the model can be simulated"), draw }
    }

    /// One of them.
    pub fn random(&self, random: &mut Random) -> Case {
        let coefficients = (self.draw)(random);
        let value = |it: &Parameter| coefficients.get(&it.name).copied().unwrap_or(it.value);
        let values: Vec<f64> = self.system.parameters.iter().map(value).collect();
        let system = self.system.with_parameters(&values);
        let times = (0..ROWS).map(|row| system.interval[1] * row as f64 / ROWS as f64).collect();
        let rows = (0..ROWS).map(|_| vec![random.between(-1.0, 1.0)]).collect();
        Case { system, controls: Controls::Held { times, rows, is_stretched: true } }
    }
}

impl Case {
    /// The same system with polynomials in the place of rows that are held.
    pub fn with_polynomials(self, random: &mut Random) -> Self {
        let [first, last] = self.system.interval;
        let at = |part: f64| first + (last - first) * part / ROWS as f64;
        let node = |k: usize| at((k as f64 + 0.3) / NODES as f64);
        let controls = Controls::Polynomial(Polynomials {
            times: (0..=ROWS).map(|segment| at(segment as f64)).collect(),
            ranges: (0..ROWS).map(|segment| segment * NODES..(segment + 1) * NODES).collect(),
            nodes: (0..ROWS * NODES).map(node).collect(),
            rows: (0..ROWS * NODES).map(|_| vec![random.between(-1.0, 1.0)]).collect(),
            is_stretched: true,
        });
        Case { controls, ..self }
    }
}
