//! The words of the language with what they are for: functions, settings, units. For completion,
//! hover and signatures.

use crate::expressions::graph::builtins::{self, Notation as Written};
use crate::settings::words;
use crate::settings::{self, KEYS, Key};
use crate::syntax::functions::{self, function_names};
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

/// All functions that a model may call.
pub fn functions() -> Vec<Function> {
    let all = function_names().into_iter();
    all.filter_map(function).collect()
}

/// The function of that name.
pub fn function(name: &str) -> Option<Function> {
    if let Some(row) = functions::find(name) {
        let arguments = row.arguments.to_vec();
        return Some(Function { name: row.name, arguments, doc: row.doc });
    }
    let row = builtins::find(name)?.row();
    let arguments = ["a", "b", "c", "d"][..row.arity].to_vec();
    (row.notation == Written::Function).then_some(Function {
        name: row.name,
        arguments,
        doc: row.doc,
    })
}

/// The numbers that have a name of their own, and what each is.
pub const NUMBERS: &[(&str, &str)] =
    &[("pi", "3.141592653589793"), ("inf", "A side of bounds that is open: `in [0, inf]`.")];

/// A key of the method.
pub struct Setting {
    /// Its name.
    pub name: &'static str,
    /// What it takes, in words.
    pub takes: String,
    /// What it does.
    pub doc: &'static str,
}

/// The keys of the method.
pub fn settings() -> Vec<Setting> {
    let setting = |row: &Key| Setting { name: row.name, takes: row.takes(), doc: row.doc };
    KEYS.iter().map(setting).collect()
}

/// The words that a key of the method takes, none where it takes numbers.
pub fn setting_words(key: &str) -> Vec<String> {
    settings::find(key).map(Key::words).unwrap_or_default()
}

/// What a word of the method stands for.
pub fn setting_word(word: &str) -> Option<String> {
    words::doc(word)
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
            let function =
                function(name).unwrap_or_else(|| panic!("`{name}` has a row in a table"));
            assert!(!function.doc.is_empty() && !function.arguments.is_empty(), "{name}");
        }
    }

    #[test]
    fn every_word_of_a_setting_says_what_it_stands_for() {
        for word in settings().iter().flat_map(|it| setting_words(it.name)) {
            assert!(setting_word(&word).is_some(), "`{word}` has a row in a table");
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
