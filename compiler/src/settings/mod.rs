//! The settings of the `method` block: one table of keys, used by the language, by the command line
//! and by editors.

pub(crate) mod conflicts;
pub(crate) mod words;

use crate::expressions::kernels;
use crate::syntax::closest;
use fdcc_runtime::problem::{ControlShape, Grid, Linear, Method, Order, Scheme, Solver};

/// A key of the `method` block: one row says everything about it.
pub(crate) struct Key {
    /// How it is written.
    pub name: &'static str,
    takes: Takes,
    /// What it does; for editors.
    pub doc: &'static str,
    /// Changes a method; nothing if it does not take the value.
    set: fn(&mut Method, &Given) -> Option<()>,
}

/// What a key takes.
enum Takes {
    /// Numbers, in the words of a message.
    Number(&'static str),
    /// One of these words.
    Words(fn() -> words::Groups),
}

/// The objective of a solution can improve by at most a hundred times `tol`.
const TOL_OF_ACCURACY: f64 = 1e-2;

/// **The table** of the keys.
pub(crate) const KEYS: &[Key] = &[
    Key {
        name: "sigma",
        takes: Takes::Number("a number from 0"),
        doc: "The width of the layer in which `Sgn` and `match` are smoothed. Half the width, half \
         the error, and a steeper layer that asks for a finer grid. With 0, as without a width, \
         the answer is that of the true system, with every switch located.",
        set: |m, given| {
            let width = number(given).filter(|it| *it >= 0.0)?;
            m.exact = width == 0.0;
            m.sigma = (!m.exact).then_some(width);
            Some(())
        },
    },
    Key {
        name: "kernel",
        takes: Takes::Words(words::kernels),
        doc: "The shape of the smoothed step. `cubic` is the default: half the bias of `tanh`, and \
         a clean expansion in the width.",
        set: |m, given| {
            let Given::Word(word) = given else { return None };
            m.kernel = kernels::find(word)?.name.into();
            m.names_kernel = true;
            Some(())
        },
    },
    Key {
        name: "N",
        takes: Takes::Number("a whole number from 1, or auto"),
        doc: "Control intervals. Time and memory of an iteration grow with it, in proportion. \
         `auto` refines the grid where steps have errors, and with `scheme = radau` or `gauss` \
         finds the order as well.",
        set: |m, given| {
            let is_open = matches!(given, Given::Word(word) if word == "auto");
            m.grid = if is_open { Grid::Auto } else { Grid::Uniform(count(given)?) };
            m.names_grid = true;
            Some(())
        },
    },
    Key {
        name: "accuracy",
        takes: Takes::Number("a number above 0"),
        doc: "How accurate the answer is to be, relative to sizes: sets `tolerance`, a hundredth \
         of it as `tol`, what a replay may differ by (`--gap`), and the limits of the certificate; \
         each of these, named, wins.",
        set: |m, given| {
            let accuracy = positive(given)?;
            m.accuracy = Some(accuracy);
            m.tol = if m.names_tol { m.tol } else { TOL_OF_ACCURACY * accuracy };
            m.tolerance = if m.names_tolerance { m.tolerance } else { accuracy };
            Some(())
        },
    },
    Key {
        name: "tolerance",
        takes: Takes::Number("a number above 0"),
        doc: "With `N = auto`: the sum of the errors of all steps that the grid may have.",
        set: |m, given| {
            m.tolerance = positive(given)?;
            m.names_tolerance = true;
            Some(())
        },
    },
    Key {
        name: "steps",
        takes: Takes::Number("a whole number from 1"),
        doc: "Integration steps in each control interval.",
        set: |m, given| {
            m.steps = count(given)?;
            Some(())
        },
    },
    Key {
        name: "scheme",
        takes: Takes::Words(words::schemes),
        doc: "How the equations are discretised. Implicit schemes may take steps that are long for \
         the smoothed layer.",
        set: |m, given| {
            let Given::Word(word) = given else { return None };
            m.scheme = Scheme::named(word)?;
            m.names_scheme = true;
            m.order = if Scheme::is_family(word) { Order::Auto } else { Order::Fixed };
            Some(())
        },
    },
    Key {
        name: "controls",
        takes: Takes::Words(words::shapes),
        doc: "What a control is on an interval: `constant`, `linear` and continuous, or a \
         `polynomial` through its values at the nodes.",
        set: |m, given| {
            let Given::Word(word) = given else { return None };
            m.controls = ControlShape::named(word)?;
            Some(())
        },
    },
    Key {
        name: "solver",
        takes: Takes::Words(words::solvers),
        doc: "Interior point method, or the conic solver for convex problems. Without it the \
         problem decides.",
        set: |m, given| {
            let Given::Word(word) = given else { return None };
            m.solver = if word == "auto" { Solver::Automatic } else { Solver::named(word)? };
            Some(())
        },
    },
    Key {
        name: "linear",
        takes: Takes::Words(words::linear_solvers),
        doc: "The factorisation of the interior point method: `riccati` along the grid, \
         `sparse_ldl` for any structure.",
        set: |m, given| {
            let Given::Word(word) = given else { return None };
            m.linear = Linear::named(word)?;
            Some(())
        },
    },
    Key {
        name: "continue",
        takes: Takes::Number("numbers above 0, each smaller than the one before"),
        doc: "Widths that are passed through before `sigma`, each solve begun from the one before. \
         Each costs a solve, a short one.",
        set: |m, given| {
            m.continuation = decreasing(given)?;
            Some(())
        },
    },
    Key {
        name: "tol",
        takes: Takes::Number("a number above 0"),
        doc: "Tolerance on the scaled optimality error. The last digits cost few iterations.",
        set: |m, given| {
            m.tol = positive(given)?;
            m.names_tol = true;
            Some(())
        },
    },
    Key {
        name: "max_iter",
        takes: Takes::Number("a whole number from 1"),
        doc: "Iterations of one solve before it is given up.",
        set: |m, given| {
            m.max_iter = count(given)?;
            Some(())
        },
    },
    Key {
        name: "seed",
        takes: Takes::Number("a whole number"),
        doc: "Seed of everything random: the same seed, the same result.",
        set: |m, given| {
            m.seed = whole(given)?;
            Some(())
        },
    },
];

impl Key {
    /// What it takes, in the words of a message: `one of constant, linear, polynomial`.
    pub fn takes(&self) -> String {
        let groups = match self.takes {
            Takes::Number(text) => return text.into(),
            Takes::Words(groups) => groups(),
        };
        let group = |words: Vec<String>| match words.as_slice() {
            [first, .., last] => format!("{first} to {last}"),
            _ => words.concat(),
        };
        let not_yet = words::REFUSED.iter().filter(|row| row.0 == self.name && row.2.is_none());
        let all = groups.into_iter().map(group).chain(not_yet.map(|row| row.1.to_owned()));
        format!("one of {}", all.collect::<Vec<_>>().join(", "))
    }

    /// The words that it takes; none where it takes numbers.
    pub fn words(&self) -> Vec<String> {
        match self.takes {
            Takes::Number(_) => Vec::new(),
            Takes::Words(groups) => groups().concat(),
        }
    }
}

/// The key of that name.
pub(crate) fn find(name: &str) -> Option<&'static Key> {
    KEYS.iter().find(|row| row.name == name)
}

/// A value of a setting.
#[derive(Clone, Debug)]
pub(crate) enum Given {
    Number(f64),
    Word(String),
    List(Vec<f64>),
}

/// Why a setting was not taken.
pub(crate) enum Refused {
    /// There is no such key.
    Key,
    /// The key takes something else.
    Value(String),
    /// Understood, but it does not exist yet.
    NotYet,
    /// It does not exist any more; what to write instead.
    Removed(&'static str),
}

/// Changes one setting.
pub(crate) fn set(method: &mut Method, key: &str, given: &Given) -> Result<(), Refused> {
    let row = find(key).ok_or(Refused::Key)?;
    let refused = words::REFUSED
        .iter()
        .find(|row| matches!(given, Given::Word(word) if row.0 == key && row.1 == word));
    if let Some((.., instead)) = refused {
        return Err(instead.map_or(Refused::NotYet, Refused::Removed));
    }
    (row.set)(method, given).ok_or_else(|| Refused::Value(row.takes()))?;
    method.begin();
    Ok(())
}

fn number(given: &Given) -> Option<f64> {
    match given {
        Given::Number(value) => Some(*value).filter(|value| value.is_finite()),
        _ => None,
    }
}

fn positive(given: &Given) -> Option<f64> {
    number(given).filter(|value| *value > 0.0)
}

fn whole(given: &Given) -> Option<u64> {
    number(given)
        .filter(|value| value.fract() == 0.0 && (0.0..=1e15).contains(value))
        .map(|value| value as u64)
}

/// However large: whether it is too much depends on the other settings ([`conflicts::misfit`]).
fn count(given: &Given) -> Option<usize> {
    number(given).filter(|value| value.fract() == 0.0 && *value >= 1.0).map(|value| value as usize)
}

fn decreasing(given: &Given) -> Option<Vec<f64>> {
    let list = match given {
        Given::Number(value) => vec![*value],
        Given::List(values) => values.clone(),
        Given::Word(_) => return None,
    };
    let falls = list.windows(2).all(|pair| pair[1] < pair[0]);
    (falls && list.iter().all(|&value| value > 0.0 && value.is_finite())).then_some(list)
}

/// Whether there is such a key.
pub fn is_key(key: &str) -> bool {
    find(key).is_some()
}

/// The nearest key, for "did you mean".
pub(crate) fn nearest_key(key: &str) -> Option<&'static str> {
    closest(key, KEYS.iter().map(|row| row.name))
}

/// All keys, for a message.
pub(crate) fn keys() -> String {
    KEYS.iter().map(|row| row.name).collect::<Vec<_>>().join(", ")
}

/// The nearest word that a key takes.
pub(crate) fn nearest_word<'e>(expected: &'e str, given: &str) -> Option<&'e str> {
    closest(
        given,
        expected.trim_start_matches("one of ").split([',', ' ']).filter(|word| word.len() > 2),
    )
}

/// The scheme of a model that adds up over rows of data, where it names none: by one of the first
/// order estimates would be many of their standard errors off.
pub(crate) const SCHEME_OF_FITS: Scheme = Scheme::Radau(3);

/// What is used where the model is silent.
pub fn default_method() -> Method {
    Method {
        scheme: Scheme::ImplicitEuler,
        controls: ControlShape::Constant,
        path_at_nodes: false,
        grid: Grid::Uniform(200),
        accuracy: None,
        names_tol: false,
        names_tolerance: false,
        names_grid: false,
        names_scheme: false,
        names_kernel: false,
        order: Order::Fixed,
        tolerance: 1e-3,
        lagged: Vec::new(),
        steps: 1,
        sigma: None,
        exact: false,
        continuation: Vec::new(),
        kernel: "cubic".into(),
        solver: Solver::Automatic,
        linear: Linear::Automatic,
        tol: 1e-8,
        max_iter: 3000,
        seed: 0,
    }
}
