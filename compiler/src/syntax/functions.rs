//! **The table** of functions and forms that are no builtins of numbers, and the names of both.

use crate::expressions::graph::builtins;

/// What a row of the table is.
#[derive(Clone, Copy, PartialEq)]
pub(crate) enum Kind {
    /// A function of vectors.
    OfVectors,
    /// A form with a meaning of its own, which reads its arguments in its own way.
    Form,
}

/// A function or form of the language that has no row in the table of builtins.
pub(crate) struct Row {
    /// What it is.
    pub kind: Kind,
    /// Its name.
    pub name: &'static str,
    /// What its arguments are called.
    pub arguments: &'static [&'static str],
    /// What it means.
    pub doc: &'static str,
}

const fn row(
    kind: Kind,
    name: &'static str,
    arguments: &'static [&'static str],
    doc: &'static str,
) -> Row {
    Row { kind, name, arguments, doc }
}

const ROWS: &[Row] = &[
    row(Kind::OfVectors, "dot", &["a", "b"], "Scalar product of two vectors."),
    row(
        Kind::OfVectors,
        "norm",
        &["a"],
        "Length of a vector: `sqrt(dot(a, a))`. Its derivative is not unique at 0.",
    ),
    row(Kind::OfVectors, "normsq", &["a"], "Square of the length of a vector, smooth everywhere."),
    row(
        Kind::OfVectors,
        "cross",
        &["a", "b"],
        "Cross product: a number in the plane, a vector in space.",
    ),
    row(
        Kind::Form,
        "Sgn",
        &["surface"],
        "-1 below the surface, 1 above it, and the whole interval [-1, 1] on it; after `in`.",
    ),
    row(
        Kind::Form,
        "Dir",
        &["vector"],
        "The direction of a vector, and the whole unit ball where it is 0: isotropic friction; \
         after `in`.",
    ),
    row(
        Kind::Form,
        "selected",
        &["set"],
        "The value of a set that acts along the trajectory, such as the force of friction.",
    ),
    row(
        Kind::Form,
        "integral",
        &["e"],
        "The integral over the whole time; for the objective and for conditions at the ends.",
    ),
    row(
        Kind::Form,
        "sum",
        &["k in data", "e"],
        "The sum of an expression over the rows of measurements.",
    ),
    row(
        Kind::Form,
        "interpolate",
        &["times", "values", "at"],
        "A straight line between measurements, at a time.",
    ),
    row(
        Kind::Form,
        "blend",
        &["f", "width"],
        "The function with its knots and kinks rounded over a width, with two continuous \
         derivatives.",
    ),
    row(
        Kind::Form,
        "sliding",
        &["surface"],
        "For how long a surface is held; for `expect`, from a simulation of the true system.",
    ),
    row(
        Kind::Form,
        "sensitivity",
        &["e", "p"],
        "The derivative of a number by a parameter, an unknown or a start; for `expect`.",
    ),
];

/// The row of that name.
pub(crate) fn find(name: &str) -> Option<&'static Row> {
    ROWS.iter().find(|row| row.name == name)
}

/// Whether a name is called as a function by the language itself.
pub(crate) fn is_function(name: &str) -> bool {
    arity(name).is_some()
}

/// The number of arguments of a function or form of the language.
pub(crate) fn arity(name: &str) -> Option<usize> {
    let listed = find(name).map(|row| row.arguments.len());
    listed.or_else(|| builtins::find(name).map(|builtin| builtin.row().arity))
}

/// All functions and forms that the language itself calls by a name.
pub fn function_names() -> Vec<&'static str> {
    let table = builtins::ALL
        .iter()
        .map(|it| it.row())
        .filter(|row| row.notation == builtins::Notation::Function);
    table.map(|row| row.name).chain(ROWS.iter().map(|row| row.name)).collect()
}
