//! What a method chooses from, besides its scheme: for each choice **the table** of its words. One
//! row says everything about a word: how models and files write it, what it stands for, what
//! editors say of it.

/// A word of the `method` block.
pub struct Word<T: 'static> {
    /// How models and files write it.
    pub name: &'static str,
    /// What it stands for.
    pub value: T,
    /// What editors say of it.
    pub doc: &'static str,
}

const fn word<T>(name: &'static str, value: T, doc: &'static str) -> Word<T> {
    Word { name, value, doc }
}

/// What a word stands for.
fn named<T: Copy>(table: &[Word<T>], name: &str) -> Option<T> {
    table.iter().find(|row| row.name == name).map(|row| row.value)
}

/// The word for a value; `auto` where the choice is open.
fn name<T: PartialEq>(table: &[Word<T>], value: &T) -> &'static str {
    table.iter().find(|row| row.value == *value).map_or("auto", |row| row.name)
}

/// What a control is on an interval.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum ControlShape {
    /// One value.
    Constant,
    /// Linear, and continuous from interval to interval.
    Linear,
    /// A polynomial through its values at the nodes of a collocation scheme.
    Polynomial,
}

impl ControlShape {
    /// Its words.
    pub const WORDS: &[Word<Self>] = &[
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

    /// The shape of a word.
    pub fn named(word: &str) -> Option<Self> {
        named(Self::WORDS, word)
    }

    /// Its word in models and files.
    pub fn name(self) -> &'static str {
        name(Self::WORDS, &self)
    }
}

/// Which solver treats the transcribed problem.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Solver {
    /// Convex problems to the conic solver, all others to the interior point method.
    Automatic,
    /// The interior point method, always.
    InteriorPoint,
    /// The conic solver; refuses what is not convex.
    Convex,
}

impl Solver {
    /// Its words; a model leaves the key out, or writes `auto`, to leave the choice open.
    pub const WORDS: &[Word<Self>] = &[
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

    /// The solver of a word.
    pub fn named(word: &str) -> Option<Self> {
        named(Self::WORDS, word)
    }

    /// Its word in models and files.
    pub fn name(self) -> &'static str {
        name(Self::WORDS, &self)
    }
}

/// Which factorisation the interior point method uses.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Linear {
    /// Stage-wise Riccati recursion where the structure allows, else sparse LDL.
    Automatic,
    /// Stage-wise Riccati recursion.
    Riccati,
    /// Sparse LDL.
    SparseLdl,
}

impl Linear {
    /// Its words.
    pub const WORDS: &[Word<Self>] = &[
        word(
            "auto",
            Linear::Automatic,
            "The choice is left open: `linear` takes the recursion, and the sparse factorisation \
             where that fails; `N` follows the errors of the steps.",
        ),
        word(
            "riccati",
            Linear::Riccati,
            "A recursion along the grid: the fastest where all goes well.",
        ),
        word("sparse_ldl", Linear::SparseLdl, "A sparse factorisation: slower, and more robust."),
    ];

    /// The factorisation of a word.
    pub fn named(word: &str) -> Option<Self> {
        named(Self::WORDS, word)
    }

    /// Its word in models and files.
    pub fn name(self) -> &'static str {
        name(Self::WORDS, &self)
    }
}
