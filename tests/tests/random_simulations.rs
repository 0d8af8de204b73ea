//! Random systems with one to four surfaces, or with a ball among them, against simple, slow
//! references.
//!
//! Many that are affine in each mode, with starts on surfaces and with surfaces that move, against
//! a solution mode by mode: events, end, and every refusal. And a few against implicit Euler with
//! Gauss-Seidel, which knows no events:
//!
//! `x' = a + c cos(w t) - A x - B s`, `s_i in Sgn(x_i)`, `B` diagonally dominant, so the solution
//! is unique. One step of the reference solves `x+ = x + h (a + c cos(w t+) - A x - B s)`, `s_i in
//! Sgn(x+_i)`, surface by surface until nothing changes; its error is of order `h`. The first
//! components may form a ball, `s in Dir(x)`.

pub(crate) mod affine;
mod exact;
mod flow;

use affine::Affine;
use exact::{Ending, Exact, exact};
use fdcc_compiler::compile_simulation;
use fdcc_runtime::simulate::{Controls, EventKind, Options, Simulation, Status, simulate};
use fdcc_tests::models::meaning;
use fdcc_tests::random::Random;
use std::fmt::Write;

const LAST: f64 = 4.0;
const STEPS: usize = 40_000;

struct Friction {
    /// How many of the first components form a ball.
    ball: usize,
    start: Vec<f64>,
    constant: Vec<f64>,
    swing: Vec<f64>,
    frequency: f64,
    damping: Vec<Vec<f64>>,
    friction: Vec<Vec<f64>>,
}

fn matrix(random: &mut Random, size: usize, diagonal: [f64; 2], beside: f64) -> Vec<Vec<f64>> {
    let mut rows = vec![vec![0.0; size]; size];
    for (i, row) in rows.iter_mut().enumerate() {
        for (j, entry) in row.iter_mut().enumerate() {
            *entry = if i == j {
                random.between(diagonal[0], diagonal[1])
            } else {
                random.between(-beside, beside)
            };
        }
    }
    rows
}

impl Friction {
    fn new(random: &mut Random, size: usize, ball: usize) -> Self {
        let mut vector =
            |most: f64| -> Vec<f64> { (0..size).map(|_| random.between(-most, most)).collect() };
        let (start, constant, swing) = (vector(1.0), vector(0.5), vector(3.0));
        Friction {
            ball,
            start,
            constant,
            swing,
            frequency: random.between(1.0, 4.0),
            damping: matrix(random, size, [0.0, 0.5], 0.3),
            friction: matrix(random, size, [1.0, 2.0], 0.9 / size as f64),
        }
    }

    fn text(&self) -> String {
        let (mut states, mut equations) = (String::new(), String::new());
        for i in 0..self.start.len() {
            writeln!(states, "state x{i} start {}", self.start[i]).expect("text");
            if i >= self.ball {
                writeln!(states, "surface p{i} = x{i}").expect("text");
            }
            write!(
                equations,
                "x{i}' in {} + {}*cos({}*t)",
                self.constant[i], self.swing[i], self.frequency
            )
            .expect("text");
            for j in 0..self.start.len() {
                let (damping, friction) = (self.damping[i][j], self.friction[i][j]);
                let set = if j < self.ball {
                    format!("Dir(ball)[{}]", j + 1)
                } else {
                    format!("Sgn(p{j})")
                };
                write!(equations, " - ({damping})*x{j} - ({friction})*{set}").expect("text");
            }
            equations.push('\n');
        }
        if self.ball > 0 {
            let names: Vec<String> = (0..self.ball).map(|i| format!("x{i}")).collect();
            writeln!(states, "let ball = ({})", names.join(", ")).expect("text");
        }
        format!("time t in [0, {LAST}]\n{states}dynamics {{\n{equations}}}\n")
    }

    fn rest(&self, i: usize, t: f64, x: &[f64]) -> f64 {
        let damped: f64 = self.damping[i].iter().zip(x).map(|(a, x)| a * x).sum();
        self.constant[i] + self.swing[i] * (self.frequency * t).cos() - damped
    }

    fn reference(&self) -> Vec<f64> {
        let h = LAST / STEPS as f64;
        let mut x = self.start.clone();
        let mut s = vec![0.0; x.len()];
        for k in 1..=STEPS {
            let free: Vec<f64> =
                (0..x.len()).map(|i| x[i] + h * self.rest(i, k as f64 * h, &x)).collect();
            for _ in 0..200 {
                let before = s.clone();
                let wanted = |i: usize, s: &[f64]| {
                    let all: f64 = self.friction[i].iter().zip(s).map(|(b, s)| b * s).sum();
                    s[i] + (free[i] - h * all) / (h * self.friction[i][i])
                };
                let ball: Vec<f64> = (0..self.ball).map(|i| wanted(i, &s)).collect();
                let size = ball.iter().map(|s| s * s).sum::<f64>().sqrt().max(1.0);
                ball.iter().enumerate().for_each(|(i, value)| s[i] = value / size);
                for i in self.ball..x.len() {
                    s[i] = wanted(i, &s).clamp(-1.0, 1.0);
                }
                if before.iter().zip(&s).all(|(a, b)| (a - b).abs() < 1e-12) {
                    break;
                }
            }
            for i in 0..x.len() {
                x[i] =
                    free[i] - h * self.friction[i].iter().zip(&s).map(|(b, s)| b * s).sum::<f64>();
            }
        }
        x
    }
}

#[test]
fn random_systems_end_where_implicit_euler_ends() {
    let mut random = Random::new(7);
    let (mut entries, mut exits) = (0, 0);
    for case in 0..40 {
        let system = Friction::new(&mut random, 1 + case % 4, 0);
        let text = system.text();
        let compiled = compile_simulation(&meaning(&text)).expect("the model can be simulated");
        let simulation = simulate(&compiled, &Controls::Guess, &Options::default());
        assert!(matches!(simulation.status, Status::Completed), "{:?}\n{text}", simulation.status);
        for (got, slow) in simulation.end.iter().zip(system.reference()) {
            assert!((got - slow).abs() < 2e-3, "{got}, not {slow}\n{text}");
        }
        entries +=
            simulation.events.iter().filter(|event| event.kind == EventKind::EntersSliding).count();
        exits += simulation
            .events
            .iter()
            .filter(|it| matches!(it.kind, EventKind::LeavesUp | EventKind::LeavesDown))
            .count();
    }
    assert!(
        entries > 100 && exits > 50,
        "the systems are worth their while: {entries} entries, {exits} exits"
    );
}

/// Each component of a ball has the same friction, on which the others act.
#[test]
fn random_systems_with_a_ball_end_where_implicit_euler_ends() {
    let mut random = Random::new(11);
    let (mut entries, mut exits) = (0, 0);
    for case in 0..40 {
        let ball = 2 + case % 2;
        let mut system = Friction::new(&mut random, ball + case % 3, ball);
        let friction = system.friction[0][0];
        (0..ball).for_each(|i| system.friction[i][i] = friction);
        let text = system.text();
        let compiled = compile_simulation(&meaning(&text)).expect("the model can be simulated");
        let simulation = simulate(&compiled, &Controls::Guess, &Options::default());
        assert!(matches!(simulation.status, Status::Completed), "{:?}\n{text}", simulation.status);
        for (got, slow) in simulation.end.iter().zip(system.reference()) {
            assert!((got - slow).abs() < 2e-3, "{got}, not {slow}\n{text}");
        }
        let of_ball = simulation.events.iter().filter(|event| event.surface == 0);
        entries += of_ball.clone().filter(|event| event.kind == EventKind::EntersSliding).count();
        exits += of_ball.filter(|event| event.kind == EventKind::LeavesUp).count();
    }
    assert!(
        entries > 30 && exits > 20,
        "the balls stick and slip: {entries} entries, {exits} exits"
    );
}

/// What the systems had in them.
#[derive(Default, Debug)]
struct Seen {
    systems: usize,
    delicate: usize,
    refused: usize,
    held_together: usize,
    events: usize,
}

fn simulated(system: &Affine) -> Simulation {
    let compiled =
        compile_simulation(&meaning(&system.text())).expect("the model can be simulated");
    simulate(&compiled, &Controls::Guess, &Options { max_steps: 20_000, ..Options::default() })
}

/// How a simulation differs from the exact solution.
fn difference(simulation: &Simulation, exact: &Exact) -> Option<String> {
    let near = |a: f64, b: f64| (a - b).abs() <= 1e-7 * b.abs().max(1.0);
    let events: Vec<_> =
        simulation.events.iter().map(|it| (it.time, it.surface, it.kind)).collect();
    let agree =
        events.iter().zip(&exact.events).all(|(a, b)| near(a.0, b.0) && (a.1, a.2) == (b.1, b.2));
    if !agree || events.len() != exact.events.len() {
        return Some(format!("events {events:?}\n not {:?}", exact.events));
    }
    let end = simulation.end.iter().chain([&simulation.end_time]);
    if !end.zip(&exact.end).all(|(a, b)| near(*a, *b)) {
        return Some(format!("end {:?}\n not {:?}", simulation.end, exact.end));
    }
    match (&simulation.status, &exact.ending) {
        (Status::Completed, Ending::Completed) => None,
        (Status::NotUnique { candidates, .. }, Ending::NotUnique(sides)) => {
            let same = candidates.len() == sides.len()
                && candidates.iter().all(|it| sides.contains(&it.sides));
            (!same).then(|| format!("{candidates:?}\n not {sides:?}"))
        }
        (status, _) => Some(format!("status {status:?}")),
    }
}

/// So many systems with a number of surfaces, each against its exact solution.
fn check_systems(surfaces: usize, count: usize) -> Seen {
    let mut random = Random::new(surfaces as u64);
    let mut seen = Seen::default();
    while seen.systems < count {
        let Some(system) = Affine::new(&mut random, surfaces) else { continue };
        let (simulation, exact) = (simulated(&system), exact(&system));
        seen.systems += 1;
        assert!(!matches!(simulation.status, Status::StepLimit), "no end\n{}", system.text());
        if let Ending::Delicate = exact.ending {
            seen.delicate += 1;
            continue;
        }
        if let Some(difference) = difference(&simulation, &exact) {
            panic!("system {}: {difference}\n{}", seen.systems, system.text());
        }
        seen.refused += usize::from(matches!(exact.ending, Ending::NotUnique(_)));
        seen.held_together += usize::from(exact.most_held > 1);
        seen.events += exact.events.len();
    }
    assert!(
        seen.delicate * 12 < count && seen.refused * 30 > count && 2 * seen.events > count,
        "{seen:?}"
    );
    seen
}

#[test]
fn random_affine_systems_with_a_surface_follow_their_exact_solution() {
    check_systems(1, 600);
}

#[test]
fn random_affine_systems_with_two_surfaces_follow_their_exact_solution() {
    assert!(check_systems(2, 500).held_together > 100);
}

#[test]
fn random_affine_systems_with_three_surfaces_follow_their_exact_solution() {
    assert!(check_systems(3, 400).held_together > 150);
}

#[test]
fn random_affine_systems_with_four_surfaces_follow_their_exact_solution() {
    assert!(check_systems(4, 300).held_together > 120);
}
