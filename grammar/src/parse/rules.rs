//! Every rule of the grammar is used by some example of the language reference.

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

use pest::RuleType;

use super::{Rule, pairs};

/// The text of a file of the repository.
fn read(path: &Path) -> String {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("..").join(path);
    fs::read_to_string(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

/// The models on the pages of the reference.
fn examples() -> Vec<String> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs/reference");
    let pages = fs::read_dir(folder).expect("the reference is there");
    let pages = pages.map(|page| read(&page.expect("a page can be read").path()));
    let models = |page: String| page.split("\n```fdc").skip(1).filter_map(model).collect::<Vec<_>>();
    pages.flat_map(models).collect()
}

/// The model of a block, whose tag goes on to the end of the line.
fn model(block: &str) -> Option<String> {
    let (text, _) = block.split_once('\n')?.1.split_once("\n```")?;
    Some(text.to_owned())
}

/// The rules that leave no pair: silent ones, lookahead, and entries for recovery.
fn leave_no_pair() -> BTreeSet<String> {
    let grammar = read(Path::new("grammar/src/fdc.pest"));
    let silent = grammar.lines().filter_map(|line| line.split_once("= _{"));
    let silent = silent.map(|(name, _)| name.trim().to_owned());
    silent.chain(["reserved".to_owned()]).collect()
}

#[test]
fn every_rule_is_used_by_an_example() {
    let mut used = BTreeSet::new();
    for example in examples() {
        for pair in pairs(Rule::file, &example).into_iter().flat_map(|pairs| pairs.flatten()) {
            used.insert(format!("{:?}", pair.as_rule()));
        }
    }
    let without = leave_no_pair();
    let names = Rule::all_rules().iter().map(|rule| format!("{rule:?}"));
    let expected = names.filter(|name| !without.contains(name) && !name.starts_with("only_"));
    let missing: Vec<String> = expected.filter(|name| !used.contains(name)).collect();
    assert!(used.len() > 100 && missing.is_empty(), "write an example in docs/reference for {missing:?}");
}
