//! The settings of the `method` block: one table of keys, used by the language and by the command
//! line.

pub(crate) mod conflicts;

use crate::expressions::kernels;
use crate::syntax::closest;
use fdcc_runtime::problem::{ControlShape, Linear, Method, Scheme, Solver};

/// The keys, each with what it takes.
pub(crate) const KEYS: &[(&str, &str)] = &[
    ("sigma", "a number above 0"),
    ("kernel", "one of tanh, sqrt, linear, cubic, quintic"),
    ("N", "a whole number from 1, or auto"),
    ("tolerance", "a number above 0"),
    ("steps", "a whole number from 1"),
    (
        "scheme",
        "one of euler, implicit_euler, midpoint, trapezoid, rk4, radau, radau1 to radau5, gauss, \
         gauss1 to gauss5, fesd",
    ),
    ("controls", "one of constant, linear, polynomial"),
    ("solver", "one of interior_point, convex"),
    ("linear", "one of auto, riccati, sparse_ldl"),
    ("continue", "numbers above 0, each smaller than the one before"),
    ("tol", "a number above 0"),
    ("max_iter", "a whole number from 1"),
    ("seed", "a whole number"),
];

/// Schemes and solvers that are understood but do not exist yet.
const NOT_YET: &[&str] = &["fesd"];

/// Words that a key took once, and what to write instead.
const REMOVED: &[(&str, &str, &str)] =
    &[("solver", "sqp", "it was removed; leave `solver` out, or write `interior_point`")];

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
    Value(&'static str),
    /// Understood, but it does not exist yet.
    NotYet,
    /// It does not exist any more; what to write instead.
    Removed(&'static str),
}

/// Changes one setting.
pub(crate) fn set(method: &mut Method, key: &str, given: &Given) -> Result<(), Refused> {
    let expected = KEYS.iter().find(|row| row.0 == key).ok_or(Refused::Key)?.1;
    let refused = || Refused::Value(expected);
    let positive = || number(given).filter(|value| *value > 0.0).ok_or_else(refused);
    let count = || count(given).ok_or_else(refused);
    let word = || match given {
        Given::Word(word)
            if NOT_YET.contains(&word.as_str()) && expected.contains(word.as_str()) =>
        {
            Err(Refused::NotYet)
        }
        Given::Word(word) => {
            let removed = REMOVED.iter().find(|row| (row.0, row.1) == (key, word.as_str()));
            removed.map_or(Ok(word.as_str()), |row| Err(Refused::Removed(row.2)))
        }
        _ => Err(refused()),
    };
    match (key, given) {
        ("sigma", _) => method.sigma = Some(positive()?),
        ("tol", _) => method.tol = positive()?,
        ("N", _) => {
            method.is_refined = matches!(given, Given::Word(word) if word == "auto");
            if !method.is_refined {
                method.intervals = count()?;
            }
        }
        ("tolerance", _) => method.tolerance = positive()?,
        ("steps", _) => method.steps = count()?,
        ("max_iter", _) => method.max_iter = count()?,
        ("seed", _) => method.seed = whole(given).ok_or_else(refused)?,
        ("continue", _) => method.continuation = decreasing(given).ok_or_else(refused)?,
        ("kernel", _) => method.kernel = kernels::find(word()?).ok_or_else(refused)?.name.into(),
        ("controls", _) => method.controls = shape(word()?).ok_or_else(refused)?,
        ("scheme", _) => {
            method.scheme = Scheme::named(word()?).ok_or_else(refused)?;
            method.is_raised = Scheme::is_family(word()?);
        }
        ("solver", _) => method.solver = solver(word()?).ok_or_else(refused)?,
        _ => method.linear = linear(word()?).ok_or_else(refused)?,
    }
    method.begin();
    Ok(())
}

fn shape(word: &str) -> Option<ControlShape> {
    Some(match word {
        "constant" => ControlShape::Constant,
        "linear" => ControlShape::Linear,
        "polynomial" => ControlShape::Polynomial,
        _ => return None,
    })
}

fn solver(word: &str) -> Option<Solver> {
    Some(match word {
        "auto" => Solver::Automatic,
        "interior_point" => Solver::InteriorPoint,
        "convex" => Solver::Convex,
        _ => return None,
    })
}

fn linear(word: &str) -> Option<Linear> {
    Some(match word {
        "auto" => Linear::Automatic,
        "riccati" => Linear::Riccati,
        "sparse_ldl" => Linear::SparseLdl,
        _ => return None,
    })
}

fn number(given: &Given) -> Option<f64> {
    match given {
        Given::Number(value) => Some(*value).filter(|value| value.is_finite()),
        _ => None,
    }
}

fn whole(given: &Given) -> Option<u64> {
    number(given)
        .filter(|value| value.fract() == 0.0 && (0.0..=1e15).contains(value))
        .map(|value| value as u64)
}

/// However large: whether it is too much depends on the other settings ([`misfit`]).
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
    KEYS.iter().any(|row| row.0 == key)
}

/// The words that a key takes today; none where it takes numbers.
pub(crate) fn words(key: &str) -> Vec<String> {
    let expected = KEYS.iter().find(|row| row.0 == key).map_or("", |row| row.1);
    let Some(list) = expected.strip_prefix("one of ") else { return Vec::new() };
    let is_taken =
        |word: &String| set(&mut default_method(), key, &Given::Word(word.clone())).is_ok();
    list.split(", ").flat_map(spelt_out).filter(is_taken).collect()
}

/// `radau1 to radau5` is five words.
fn spelt_out(listed: &str) -> Vec<String> {
    let Some((first, last)) = listed.split_once(" to ") else { return vec![listed.to_owned()] };
    let stem = first.trim_end_matches(|c: char| c.is_ascii_digit());
    let ends = [first, last].map(|word| word[stem.len()..].parse().unwrap_or(0));
    (ends[0]..=ends[1]).map(|number: usize| format!("{stem}{number}")).collect()
}

/// The nearest key, for "did you mean".
pub(crate) fn nearest_key(key: &str) -> Option<&'static str> {
    closest(key, KEYS.iter().map(|row| row.0))
}

/// All keys, for a message.
pub(crate) fn keys() -> String {
    KEYS.iter().map(|row| row.0).collect::<Vec<_>>().join(", ")
}

/// The nearest word that a key takes.
pub(crate) fn nearest_word(expected: &'static str, given: &str) -> Option<&'static str> {
    closest(
        given,
        expected.trim_start_matches("one of ").split([',', ' ']).filter(|word| word.len() > 2),
    )
}

/// What is used where the model is silent.
pub fn default_method() -> Method {
    Method {
        scheme: Scheme::ImplicitEuler,
        controls: ControlShape::Constant,
        mesh: Vec::new(),
        is_refined: false,
        is_raised: false,
        tolerance: 1e-3,
        lagged: Vec::new(),
        intervals: 200,
        steps: 1,
        sigma: None,
        continuation: Vec::new(),
        kernel: "cubic".into(),
        solver: Solver::Automatic,
        linear: Linear::Automatic,
        tol: 1e-8,
        max_iter: 3000,
        seed: 0,
    }
}
