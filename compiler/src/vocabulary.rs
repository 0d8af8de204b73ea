//! The words of the language with what they are for: functions, settings, units. For completion,
//! hover and signatures.

use crate::builtins::{self, Notation as Written};
use crate::resolve::{function_names, settings};
use crate::units;

/// A function of the language.
#[derive(Clone, Debug, PartialEq)]
pub struct Function {
    /// Its name.
    pub name: &'static str,
    /// What its arguments are called.
    pub arguments: Vec<&'static str>,
    /// What it is.
    pub doc: &'static str,
}

/// Functions of vectors and forms with a meaning of their own, which have no row in the table of
/// builtins.
const FORMS: &[(&str, &[&str], &str)] = &[
    ("dot", &["a", "b"], "Scalar product of two vectors."),
    ("norm", &["a"], "Length of a vector: `sqrt(dot(a, a))`. Its derivative is not unique at 0."),
    ("normsq", &["a"], "Square of the length of a vector, smooth everywhere."),
    ("cross", &["a", "b"], "Cross product: a number in the plane, a vector in space."),
    (
        "Sgn",
        &["surface"],
        "-1 below the surface, 1 above it, and the whole interval [-1, 1] on it; after `in`.",
    ),
    (
        "Dir",
        &["vector"],
        "The direction of a vector, and the whole unit ball where it is 0: isotropic friction; \
         after `in`.",
    ),
    (
        "selected",
        &["set"],
        "The value of a set that acts along the trajectory, such as the force of friction.",
    ),
    (
        "integral",
        &["e"],
        "The integral over the whole time; for the objective and for conditions at the ends.",
    ),
    ("sum", &["k in data", "e"], "The sum of an expression over the rows of measurements."),
    ("interpolate", &["times", "values", "at"], "A straight line between measurements, at a time."),
    (
        "blend",
        &["f", "width"],
        "The function with its knots and kinks rounded over a width, with two continuous \
         derivatives.",
    ),
    (
        "sliding",
        &["surface"],
        "For how long a surface is held; for `expect`, from a simulation of the true system.",
    ),
    (
        "sensitivity",
        &["e", "p"],
        "The derivative of a number by a parameter, an unknown or a start; for `expect`.",
    ),
];

/// All functions that a model may call.
pub fn functions() -> Vec<Function> {
    let all = function_names().into_iter();
    all.filter_map(function).collect()
}

/// The function of that name.
pub fn function(name: &str) -> Option<Function> {
    if let Some(&(name, arguments, doc)) = FORMS.iter().find(|row| row.0 == name) {
        return Some(Function { name, arguments: arguments.to_vec(), doc });
    }
    let row = builtins::find(name)?.row();
    let arguments = ["a", "b", "c", "d"][..row.arity].to_vec();
    (row.notation == Written::Function).then_some(Function {
        name: row.name,
        arguments,
        doc: row.doc,
    })
}

/// The keys of the method, each with what it takes.
pub fn settings() -> &'static [(&'static str, &'static str)] {
    settings::KEYS
}

/// The words that a key of the method takes, none where it takes numbers.
pub fn setting_words(key: &str) -> Vec<String> {
    settings::words(key)
}

/// The names of all units, those with prefixes not.
pub fn units() -> Vec<&'static str> {
    units::names()
}

/// A unit in SI and what it measures: `1 km = 1000 m, a length`.
pub fn unit(name: &str) -> Option<String> {
    units::described(name)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_function_has_a_signature_and_a_text() {
        for name in function_names() {
            let function = function(name).unwrap_or_else(|| panic!("`{name}` has a row in FORMS"));
            assert!(!function.doc.is_empty() && !function.arguments.is_empty(), "{name}");
        }
    }

    #[test]
    fn words_of_settings_are_those_that_are_taken() {
        assert_eq!(setting_words("kernel"), ["tanh", "sqrt", "linear", "cubic", "quintic"]);
        let schemes = setting_words("scheme");
        assert!(
            ["implicit_euler", "radau3", "gauss5"]
                .iter()
                .all(|it| schemes.iter().any(|word| word == it))
        );
        assert_eq!(setting_words("N"), [""; 0]);
    }

    #[test]
    fn a_unit_is_told_in_si() {
        assert_eq!(unit("km").as_deref(), Some("1 km = 1000 m, a length"));
        assert_eq!(unit("kN").as_deref(), Some("1 kN = 1000 N, a force"));
        assert_eq!(unit("deg").as_deref(), Some("1 deg = 0.017453292519943295, a plain number"));
        assert_eq!(unit("xyz"), None);
    }
}
