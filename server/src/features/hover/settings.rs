//! Keys of the method and the words they take: what each does and what it costs.

use crate::context::Context;
use fdcc_compiler::{Grid, grid, kernels, vocabulary};

/// What each key does.
const KEYS: &[(&str, &str)] = &[
    (
        "sigma",
        "The width of the layer in which `Sgn` and `match` are smoothed. Half the width, half the \
         error, and a steeper layer that asks for a finer grid.",
    ),
    (
        "kernel",
        "The shape of the smoothed step. `cubic` is the default: half the bias of `tanh`, and a \
         clean expansion in the width.",
    ),
    (
        "N",
        "Control intervals. Time and memory of an iteration grow with it, in proportion. `auto` \
         refines the grid where steps have errors, and with `scheme = radau` or `gauss` finds the \
         order as well.",
    ),
    ("tolerance", "With `N = auto`: the sum of the errors of all steps that the grid may have."),
    ("steps", "Integration steps in each control interval."),
    (
        "scheme",
        "How the equations are discretised. Implicit schemes may take steps that are long for the \
         smoothed layer.",
    ),
    (
        "controls",
        "What a control is on an interval: `constant`, `linear` and continuous, or a `polynomial` \
         through its values at the nodes.",
    ),
    (
        "solver",
        "Interior point method, or the conic solver for convex problems. Without it the problem \
         decides.",
    ),
    (
        "linear",
        "The factorisation of the interior point method: `riccati` along the grid, `sparse_ldl` \
         for any structure.",
    ),
    (
        "continue",
        "Widths that are passed through before `sigma`, each solve begun from the one before. Each \
         costs a solve, a short one.",
    ),
    ("tol", "Tolerance on the scaled optimality error. The last digits cost few iterations."),
    ("max_iter", "Iterations of one solve before it is given up."),
    ("seed", "Seed of everything random: the same seed, the same result."),
];

/// What each word stands for, apart from kernels, which have a table.
const WORDS: &[(&str, &str)] = &[
    (
        "euler",
        "`x1 = x0 + h f(x0)`, order 1. Oscillates where a step is longer than the smoothed layer.",
    ),
    (
        "implicit_euler",
        "`x1 = x0 + h f(x1)`, order 1. Never oscillates; `lagged (th)` takes the named states at \
         the old time.",
    ),
    ("midpoint", "`x1 = x0 + h f((x0 + x1)/2)`, order 2."),
    ("trapezoid", "`x1 = x0 + h (f(x0) + f(x1))/2`, order 2."),
    (
        "rk4",
        "The classical Runge-Kutta scheme, order 4; its whole step is one compiled function, so it \
         costs no further unknowns.",
    ),
    (
        "radau",
        "Collocation of Radau, with `N = auto`: stages are added, up to 5, where that takes fewer \
         nodes than dividing intervals.",
    ),
    (
        "gauss",
        "Collocation of Gauss, with `N = auto`: the number of stages is found like that of \
         `radau`.",
    ),
    (
        "constant",
        "One value on each interval: for schemes of low order, and where the control jumps.",
    ),
    (
        "linear",
        "Linear on each interval and continuous, for `trapezoid`, `radau2` to `radau5` and \
         `gauss2` to `gauss5`.",
    ),
    (
        "polynomial",
        "A polynomial through its values at the nodes of the collocation; it may jump from \
         interval to interval.",
    ),
    ("interior_point", "Interior point method with a filter line search; for every problem."),
    (
        "convex",
        "The conic solver: what it finds is the global optimum. For problems that are convex.",
    ),
    ("riccati", "A recursion along the grid: the fastest where all goes well."),
    ("sparse_ldl", "A sparse factorisation: slower, and more robust."),
    (
        "auto",
        "The choice is left open: `linear` takes the recursion, and the sparse factorisation where \
         that fails; `N` follows the errors of the steps.",
    ),
];

/// What a key does, and what its value costs in this model.
pub fn told(context: &Context<'_>, key: &str) -> Option<String> {
    let takes = vocabulary::settings().iter().find(|row| row.0 == key)?.1;
    let does = KEYS.iter().find(|row| row.0 == key).map_or("", |row| row.1);
    let mut text = format!("`{key}`: {takes}\n\n{does}");
    if let Some(grid) = context.model().and_then(grid).filter(|it| it.step.is_finite()) {
        text += &costs(key, &grid);
    }
    Some(text)
}

/// In numbers of this model, with the duration of its guess.
fn costs(key: &str, grid: &Grid) -> String {
    let Grid { intervals, unknowns, step, sigma } = *grid;
    let against = |power: i32| sigma.map(|sigma| short(step / sigma.powi(power)));
    match key {
        "N" | "steps" => {
            let unknowns = unknowns.map_or(String::new(), |it| format!("{it} unknowns, "));
            let ratio = against(1).map_or(String::new(), |it| format!(", h/sigma = {it}"));
            format!("\n\n{intervals} intervals: {unknowns}h = {}{ratio}", short(step))
        }
        "sigma" => against(1).zip(against(2)).map_or(String::new(), |(first, second)| {
            let h = short(step);
            format!(
                "\n\nh = {h}, h/sigma = {first}, h/sigma^2 = {second}: gradients converge if \
                     these go to 0, the last one where a surface is held."
            )
        }),
        _ => String::new(),
    }
}

/// Three digits are enough to judge.
fn short(value: f64) -> String {
    let rounded: f64 = format!("{value:.2e}").parse().unwrap_or(value);
    rounded.to_string()
}

/// What a word of the method stands for.
pub fn value(word: &str) -> Option<String> {
    if let Some(kernel) = kernels::find(word) {
        let smoothness = kernel.continuity.map_or("smooth".into(), |times| format!("C^{times}"));
        let support =
            if kernel.compact { "exact outside of the layer" } else { "never quite exact" };
        return Some(format!("`S(u) = {}`, u = z/sigma: {smoothness}, {support}", kernel.formula));
    }
    let written = WORDS.iter().find(|row| row.0 == word).map(|row| row.1.to_owned());
    written.or_else(|| collocation(word))
}

/// `radau3`: the order of so many stages.
fn collocation(word: &str) -> Option<String> {
    let stages = |name: &str| word.strip_prefix(name)?.parse::<usize>().ok();
    let (name, stages, order) = match (stages("radau"), stages("gauss")) {
        (Some(stages), _) => ("Radau", stages, 2 * stages - 1),
        (_, Some(stages)) => ("Gauss", stages, 2 * stages),
        _ => return None,
    };
    Some(format!(
        "Collocation of {name} with {stages} stages, order {order}. Each stage has its own states \
         as unknowns; a few intervals give many digits where all is smooth."
    ))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_key_and_every_word_says_what_it_does() {
        for (key, _) in vocabulary::settings() {
            assert!(KEYS.iter().any(|row| row.0 == *key), "KEYS needs `{key}`");
            for word in vocabulary::setting_words(key) {
                assert!(value(&word).is_some(), "WORDS needs `{word}` of `{key}`");
            }
        }
    }
}
