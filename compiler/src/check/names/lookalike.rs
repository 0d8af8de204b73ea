//! FDC0112: two names that are different to a computer and the same to a reader.
//!
//! Names are compared in the normal form NFKC, and then letter by letter by the skeletons of
//! Unicode's table of confusables. Greek letters stand for themselves: `ν` beside `v` and `ρ`
//! beside `p` are what formulas are made of; but for those that nobody can tell from Latin ones. So
//! do names of ASCII letters alone: `l` and `I` are lengths and currents.

use crate::syntax::scope;
use fdcc_grammar::ast::{self, Ident, Item, ItemKind};
use fdcc_grammar::{Code, Diagnostic};
use std::collections::HashMap;
use unicode_normalization::UnicodeNormalization;
use unicode_security::skeleton;

/// Reports each name that looks like one above it.
pub(crate) fn check(tree: &ast::Model) -> Vec<Diagnostic> {
    let mut names: Vec<&Ident> = Vec::new();
    tree.items.iter().for_each(|item| declared(item, &mut names));
    let mut seen: HashMap<String, &Ident> = HashMap::new();
    let mut found = Vec::new();
    for name in names {
        let first = *seen.entry(shape(&name.name)).or_insert(name);
        let is_other = first.name != name.name && !(first.name.is_ascii() && name.name.is_ascii());
        found.extend(is_other.then(|| told(name, first)));
    }
    found
}

fn declared<'a>(item: &'a Item, names: &mut Vec<&'a Ident>) {
    names.extend(scope::declared(item));
    names.extend(scope::parts(item));
    if let ItemKind::Phase { items, .. } = &item.kind {
        items.iter().for_each(|item| declared(item, names));
    }
}

/// Greek letters that are drawn as Latin ones.
const SAME_AS_LATIN: &str = "ΑΒΕΖΗΙΚΜΝΟΡΤΥΧο";

/// What a reader sees; of names in ASCII, which are compared with others alone, as of others.
fn shape(name: &str) -> String {
    let letter = |letter: char| match letter {
        '\u{370}'..='\u{3ff}' if !SAME_AS_LATIN.contains(letter) => letter.to_string(),
        _ => skeleton(letter.encode_utf8(&mut [0; 4])).collect(),
    };
    name.nfkc().map(letter).collect()
}

fn told(name: &Ident, first: &Ident) -> Diagnostic {
    let message = format!("`{}` looks like `{}`, but is another name", name.name, first.name);
    let codes = |text: &str| {
        text.chars().map(|it| format!("U+{:04X}", it as u32)).collect::<Vec<_>>().join(" ")
    };
    Diagnostic::new(Code::Lookalike, message, name.span, codes(&name.name))
        .label(first.span, codes(&first.name))
        .help("rename one of them, or type both with the same letters")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn told(first: char, second: char) -> bool {
        let text = format!("param {first} = 1\nparam {second} = 2\n");
        !check(&fdcc_grammar::parse(&text).tree).is_empty()
    }

    #[test]
    fn greek_letters_that_are_drawn_as_latin_ones_are_told_beside_them() {
        let latin = "ABEZHIKMNOPTYXo";
        assert_eq!(SAME_AS_LATIN.chars().count(), latin.chars().count());
        for (greek, latin) in SAME_AS_LATIN.chars().zip(latin.chars()) {
            assert!(told(greek, latin) && told(latin, greek), "{greek} {latin}");
        }
    }

    #[test]
    fn greek_letters_of_formulas_stand_beside_latin_ones() {
        for (greek, latin) in "αγινρυχωΓ".chars().zip("ayivpuxwT".chars()) {
            assert!(!told(greek, latin), "{greek} {latin}");
        }
    }
}
