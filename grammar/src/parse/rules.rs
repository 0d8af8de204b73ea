//! Every rule of the grammar is used by some example of the language reference.

use std::collections::BTreeSet;

use super::grammar::{Rule, pairs};

/// Pages of the reference, read when the tests are built.
macro_rules! pages {
    ($($name:literal)*) => {
        [$(include_str!(concat!("../../../docs/reference/", $name, ".md"))),*]
    };
}

const PAGES: &[&str] = &pages! {
    "models" "numbers" "expressions" "piecewise" "dynamics" "surfaces" "conditions" "objective"
    "guess" "method" "report-and-expect" "jumps" "phases" "data" "simulate" "gradient" "not-yet"
};

const GRAMMAR: &str = include_str!("../fdc.pest");

/// The examples of the reference.
pub(super) fn examples() -> impl Iterator<Item = &'static str> {
    PAGES.iter().flat_map(|page| page.split("\n```fdc").skip(1).filter_map(model))
}

/// The model of a block, whose tag goes on to the end of the line.
fn model(block: &str) -> Option<&str> {
    let (text, _) = block.split_once('\n')?.1.split_once("\n```")?;
    Some(text)
}

/// The rules that leave no pair: silent ones, lookahead, and entries for recovery.
fn leave_no_pair() -> BTreeSet<String> {
    let silent = GRAMMAR.lines().filter_map(|line| line.split_once("= _{"));
    let silent = silent.map(|(name, _)| name.trim().to_owned());
    silent.chain(["reserved".to_owned()]).collect()
}

#[test]
fn every_rule_is_used_by_an_example() {
    let mut used = BTreeSet::new();
    for example in examples() {
        for pair in pairs(Rule::file, example).into_iter().flat_map(|pairs| pairs.flatten()) {
            used.insert(format!("{:?}", pair.as_rule()));
        }
    }
    let without = leave_no_pair();
    let names = Rule::all_rules().iter().map(|rule| format!("{rule:?}"));
    let expected = names.filter(|name| !without.contains(name) && !name.starts_with("only_"));
    let missing: Vec<String> = expected.filter(|name| !used.contains(name)).collect();
    assert!(
        used.len() > 100 && missing.is_empty(),
        "write an example in docs/reference for {missing:?}"
    );
}
