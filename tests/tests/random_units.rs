//! Formulas that are well dimensioned by construction are never complained about; with one factor
//! of a metre too many they always are.

use fdcc_compiler::check;
use fdcc_grammar::{Code, parse};
use fdcc_tests::random::Random;

/// Powers of m, s, kg.
type Powers = [i32; 3];

/// Names and what they measure; that of `open` is found from its start.
const NAMES: &[(&str, Powers)] = &[
    ("x", [1, 0, 0]),
    ("v", [1, -1, 0]),
    ("F", [1, -2, 1]),
    ("m", [0, 0, 1]),
    ("k", [0, -2, 1]),
    ("t", [0, 1, 0]),
    ("mu", [0, 0, 0]),
    ("open", [2, -2, 1]),
    ("later", [1, -2, 0]),
];

const HEAD: &str = "
param m = 2 [kg]
param mu = 0.3
param k = 3 [N/m]
const later = 9.81 [m/s^2]
fn half(e) = e/2
fn length(a, b) = sqrt(a^2 + b^2)
fn bump(e) = piecewise { e <= 1 => e^2  otherwise => 2*e }
time t in [0, 1] [min]
state x [cm] start 1
state v [km/h] start 1
state open start 1 [J]
control F [kN] in [-1, 1]
";

/// A formula as it grows; with a metre too many at one of its leaves, if it is to be wrong.
struct Grower {
    random: Random,
    leaves: usize,
    wrong_at: Option<usize>,
}

impl Grower {
    fn leaf(&mut self, powers: Powers) -> String {
        let fitting: Vec<&str> = NAMES.iter().filter(|it| it.1 == powers).map(|it| it.0).collect();
        let at = self.random.below(fitting.len() + 1);
        let right = match fitting.get(at) {
            Some(name) => name.to_string(),
            None => format!("{} [{}]", 1 + self.random.below(9), unit(powers)),
        };
        self.leaves += 1;
        if self.wrong_at == Some(self.leaves - 1) { format!("({right} * 1 [mm])") } else { right }
    }

    fn formula(&mut self, powers: Powers, depth: usize) -> String {
        if depth == 0 {
            return self.leaf(powers);
        }
        let is_plain = powers == [0; 3];
        let is_square = powers.iter().all(|power| power % 2 == 0);
        match self.random.below(if is_plain { 13 } else { 11 }) {
            0 | 1 => format!(
                "({} + {})",
                self.formula(powers, depth - 1),
                self.formula(powers, depth - 1)
            ),
            2 => format!(
                "({} - {})",
                self.formula(powers, depth - 1),
                self.formula(powers, depth - 1)
            ),
            3 => {
                let (own, rest) = self.split(powers, 1);
                format!("{} * {}", self.formula(own, depth - 1), self.formula(rest, depth - 1))
            }
            4 => {
                let (own, rest) = self.split(powers, -1);
                format!("{} / ({})", self.formula(own, depth - 1), self.formula(rest, depth - 1))
            }
            5 => format!("-abs({})", self.formula(powers, depth - 1)),
            6 => format!(
                "max({}, {})",
                self.formula(powers, depth - 1),
                self.formula(powers, depth - 1)
            ),
            7 => format!("sqrt({})", self.formula(powers.map(|power| 2 * power), depth - 1)),
            8 if is_square => {
                format!("({})^2", self.formula(powers.map(|power| power / 2), depth - 1))
            }
            8 => format!("half({})", self.formula(powers, depth - 1)),
            9 => format!(
                "length({}, {})",
                self.formula(powers, depth - 1),
                self.formula(powers, depth - 1)
            ),
            10 => format!(
                "norm(({}, {}))",
                self.formula(powers, depth - 1),
                self.formula(powers, depth - 1)
            ),
            11 => format!("bump({})", self.formula(powers, depth - 1)),
            _ => format!("sin({})", self.formula(powers, depth - 1)),
        }
    }

    /// Two units whose product, or quotient, is the one.
    fn split(&mut self, powers: Powers, sign: i32) -> (Powers, Powers) {
        let rest = [0; 3].map(|_: i32| self.random.below(3) as i32 - 1);
        let own = [0, 1, 2].map(|at| powers[at] - sign * rest[at]);
        (own, rest)
    }
}

fn unit(powers: Powers) -> String {
    let names = ["m", "s", "kg"].iter().zip(powers).filter(|it| it.1 != 0);
    let text: Vec<String> = names.map(|(name, power)| format!("{name}^{power}")).collect();
    if text.is_empty() { "1".into() } else { text.join(" ") }
}

/// The model with a formula for each of its equations.
fn model(seed: u64, wrong_at: Option<usize>) -> (String, usize) {
    let mut grower = Grower { random: Random::new(seed), leaves: 0, wrong_at };
    let mut equation = |powers: Powers| grower.formula(powers, 1 + (seed % 5) as usize);
    let (x, v, open) = (equation([1, -1, 0]), equation([1, -2, 0]), equation([2, -3, 1]));
    let force = equation([1, -2, 1]);
    let text = format!(
        "{HEAD}dynamics {{\n x' = {x}\n m * v' = {force} + m*({v})\n open' = {open}\n}}\nminimize \
         x(end)\n"
    );
    (text, grower.leaves)
}

fn unit_errors(text: &str) -> Vec<String> {
    let parsed = parse(text);
    assert!(parsed.diagnostics.is_empty(), "{text}\n{:#?}", parsed.diagnostics);
    let is_ours =
        |code: Code| matches!(code, Code::UnitMismatch | Code::UnitHere | Code::UnitOfPower);
    let found = check(&parsed.tree).diagnostics.into_iter().filter(|it| is_ours(it.code));
    found.map(|it| it.message).collect()
}

#[test]
fn what_fits_together_is_never_complained_about() {
    for seed in 0..600 {
        let (text, _) = model(seed, None);
        assert_eq!(unit_errors(&text), Vec::<String>::new(), "{text}");
    }
}

/// One mistake is told, and told once: what follows from it is silent.
#[test]
fn a_metre_too_many_is_always_found() {
    for seed in 0..600 {
        let (_, leaves) = model(seed, None);
        let wrong_at = Random::new(!seed).below(leaves);
        let (text, _) = model(seed, Some(wrong_at));
        assert_eq!(unit_errors(&text).len(), 1, "{text}\n{:?}", unit_errors(&text));
    }
}
