//! **The tables** of the words that keys of the method take. One row says everything about a word:
//! how it is written, what it stands for, what editors say of it.
//!
//! The order and the nodes of a scheme are its row in `runtime/src/problem/scheme.rs`; the formulas
//! of a kernel are in its own table.

use super::Given;
use crate::expressions::kernels::{self, KERNELS};
use fdcc_runtime::problem::{ControlShape, Linear, MOST_STAGES, Scheme, Solver};

/// A word that a key takes.
pub(super) struct Word<T: 'static> {
    /// How it is written.
    name: &'static str,
    /// What it stands for.
    value: T,
    /// What editors say of it.
    doc: &'static str,
}

const fn word<T>(name: &'static str, value: T, doc: &'static str) -> Word<T> {
    Word { name, value, doc }
}

/// Schemes. A collocation without a number has the fewest stages; see
/// [`Method::begin`](fdcc_runtime::problem::Method::begin).
pub(super) const SCHEMES: &[Word<Scheme>] = &[
    word(
        "euler",
        Scheme::Euler,
        "`x1 = x0 + h f(x0)`, order 1. Oscillates where a step is longer than the smoothed layer.",
    ),
    word(
        "implicit_euler",
        Scheme::ImplicitEuler,
        "`x1 = x0 + h f(x1)`, order 1. Never oscillates; `lagged (th)` takes the named states at \
         the old time.",
    ),
    word("midpoint", Scheme::Midpoint, "`x1 = x0 + h f((x0 + x1)/2)`, order 2."),
    word("trapezoid", Scheme::Trapezoid, "`x1 = x0 + h (f(x0) + f(x1))/2`, order 2."),
    word(
        "rk4",
        Scheme::RungeKutta4,
        "The classical Runge-Kutta scheme, order 4; its whole step is one compiled function, so it \
         costs no further unknowns.",
    ),
    word(
        "radau",
        Scheme::Radau(1),
        "Collocation of Radau, with `N = auto`: stages are added, up to 5, where that takes fewer \
         nodes than dividing intervals.",
    ),
    word(
        "gauss",
        Scheme::Gauss(1),
        "Collocation of Gauss, with `N = auto`: the number of stages is found like that of \
         `radau`.",
    ),
];

/// What a control is on an interval.
pub(super) const SHAPES: &[Word<ControlShape>] = &[
    word(
        "constant",
        ControlShape::Constant,
        "One value on each interval: for schemes of low order, and where the control jumps.",
    ),
    word(
        "linear",
        ControlShape::Linear,
        "Linear on each interval and continuous, for `trapezoid`, `radau2` to `radau5` and \
         `gauss2` to `gauss5`.",
    ),
    word(
        "polynomial",
        ControlShape::Polynomial,
        "A polynomial through its values at the nodes of the collocation; it may jump from \
         interval to interval.",
    ),
];

/// Solvers of the nonlinear program.
pub(super) const SOLVERS: &[Word<Solver>] = &[
    word(
        "interior_point",
        Solver::InteriorPoint,
        "Interior point method with a filter line search; for every problem.",
    ),
    word(
        "convex",
        Solver::Convex,
        "The conic solver: what it finds is the global optimum. For problems that are convex.",
    ),
];

/// Factorisations.
pub(super) const LINEAR_SOLVERS: &[Word<Linear>] = &[
    word(
        "auto",
        Linear::Automatic,
        "The choice is left open: `linear` takes the recursion, and the sparse factorisation where \
         that fails; `N` follows the errors of the steps.",
    ),
    word(
        "riccati",
        Linear::Riccati,
        "A recursion along the grid: the fastest where all goes well.",
    ),
    word("sparse_ldl", Linear::SparseLdl, "A sparse factorisation: slower, and more robust."),
];

/// Words that are understood, such as schemes that do not exist yet; and those that were taken
/// once, with what to write instead.
pub(super) const REFUSED: &[(&str, &str, Option<&str>)] = &[
    ("scheme", "fesd", None),
    ("solver", "sqp", Some("it was removed; leave `solver` out, or write `interior_point`")),
];

/// The value of a word of a table.
pub(super) fn value<T: Copy>(table: &[Word<T>], given: &Given) -> Option<T> {
    let Given::Word(word) = given else { return None };
    table.iter().find(|row| row.name == word).map(|row| row.value)
}

fn is_family(scheme: Scheme) -> bool {
    matches!(scheme, Scheme::Radau(_) | Scheme::Gauss(_))
}

/// Words as a message lists them: one by one, or the first to the last of a family.
pub(super) type Groups = Vec<Vec<String>>;

fn names<T>(table: &[Word<T>]) -> Groups {
    table.iter().map(|row| vec![row.name.to_owned()]).collect()
}

pub(super) fn schemes() -> Groups {
    let numbered = |name: &str| (1..=MOST_STAGES).map(|stages| format!("{name}{stages}")).collect();
    let of = |row: &Word<Scheme>| {
        let family = is_family(row.value).then(|| numbered(row.name));
        [Some(vec![row.name.to_owned()]), family].into_iter().flatten()
    };
    SCHEMES.iter().flat_map(of).collect()
}

pub(super) fn kernels() -> Groups {
    KERNELS.iter().map(|row| vec![row.name.to_owned()]).collect()
}

pub(super) fn shapes() -> Groups {
    names(SHAPES)
}

pub(super) fn solvers() -> Groups {
    names(SOLVERS)
}

pub(super) fn linear_solvers() -> Groups {
    names(LINEAR_SOLVERS)
}

/// What a word of the method stands for.
pub(crate) fn doc(word: &str) -> Option<String> {
    fn of<T>(table: &[Word<T>], word: &str) -> Option<String> {
        table.iter().find(|row| row.name == word).map(|row| row.doc.to_owned())
    }
    let of_kernel = || kernels::find(word).map(kernels::Kernel::doc);
    of_kernel()
        .or_else(|| of(SCHEMES, word))
        .or_else(|| of(SHAPES, word))
        .or_else(|| of(SOLVERS, word))
        .or_else(|| of(LINEAR_SOLVERS, word))
        .or_else(|| stages_doc(Scheme::named(word)?))
}

/// `radau3`: the order of so many stages.
fn stages_doc(scheme: Scheme) -> Option<String> {
    let name = match scheme {
        Scheme::Radau(_) => "Radau",
        Scheme::Gauss(_) => "Gauss",
        _ => return None,
    };
    Some(format!(
        "Collocation of {name} with {} stages, order {}. Each stage has its own states as \
         unknowns; a few intervals give many digits where all is smooth.",
        scheme.stages(),
        scheme.order()
    ))
}
