//! The words that keys of the method take, from **the tables** of the contract and of the kernels;
//! and those that are refused.

use crate::expressions::kernels::{self, KERNELS};
use fdcc_runtime::problem::{ControlShape, Linear, Scheme, Solver, Word};

/// Words that are understood, such as schemes that do not exist yet; and those that were taken
/// once, with what to write instead.
pub(super) const REFUSED: &[(&str, &str, Option<&str>)] = &[
    ("scheme", "fesd", None),
    ("solver", "sqp", Some("it was removed; leave `solver` out, or write `interior_point`")),
];

/// Words as a message lists them: one by one, or the first to the last of a family.
pub(super) type Groups = Vec<Vec<String>>;

pub(super) fn schemes() -> Groups {
    Scheme::names().collect()
}

pub(super) fn kernels() -> Groups {
    KERNELS.iter().map(|row| vec![row.name.to_owned()]).collect()
}

pub(super) fn shapes() -> Groups {
    names(ControlShape::WORDS)
}

pub(super) fn solvers() -> Groups {
    names(Solver::WORDS)
}

pub(super) fn linear_solvers() -> Groups {
    names(Linear::WORDS)
}

fn names<T>(table: &[Word<T>]) -> Groups {
    table.iter().map(|row| vec![row.name.to_owned()]).collect()
}

/// What a word of the method stands for.
pub(crate) fn doc(word: &str) -> Option<String> {
    fn of<T>(table: &[Word<T>], word: &str) -> Option<String> {
        table.iter().find(|row| row.name == word).map(|row| row.doc.to_owned())
    }
    let of_kernel = || kernels::find(word).map(kernels::Kernel::doc);
    of_kernel()
        .or_else(|| Scheme::doc(word))
        .or_else(|| of(ControlShape::WORDS, word))
        .or_else(|| of(Solver::WORDS, word))
        .or_else(|| of(Linear::WORDS, word))
}
