//! The grammars of the editors use the words of the compiler, which stand in one list, `editors/words.json`.
//!
//! `UPDATE=1 cargo test -p fdcc-tests --test editors` writes the list and the places where others repeat it anew.

use fdcc_compiler::function_names;
use fdcc_grammar::words::{WORDS, inner_words};
use fdcc_tests::pages::check_file;
use fdcc_tests::repository;
use std::collections::BTreeMap;
use std::fs;

/// The words of each kind, in the order in which the compiler lists them.
fn words() -> BTreeMap<&'static str, Vec<&'static str>> {
    let reserved =
        |is_item: bool| WORDS.iter().filter(move |it| it.item.is_some() == is_item).map(|it| it.text);
    let mut clauses: Vec<&str> = reserved(true).flat_map(inner_words).copied().collect();
    clauses.retain(|word| WORDS.iter().all(|it| it.text != *word));
    BTreeMap::from([
        ("items", reserved(true).collect()),
        ("keywords", reserved(false).collect()),
        ("clauses", clauses),
        ("functions", function_names()),
        ("constants", vec!["pi"]),
    ])
}

#[test]
fn the_list_of_words_is_that_of_the_compiler() {
    let list = serde_json::to_string_pretty(&words()).expect("words are text");
    check_file("editors/words.json", &format!("{list}\n"));
}

/// Files that repeat the words: each line below one that says `words: KIND`.
const REPEATED: &[&str] =
    &["editors/tree-sitter-fdc/queries/highlights.scm", "editors/vscode/syntaxes/fdc.tmLanguage.json"];

#[test]
fn grammars_repeat_the_list() {
    for path in REPEATED {
        let text = fs::read_to_string(repository().join(path)).expect("the grammar is there");
        check_file(path, &with_words(&text));
    }
}

/// The text with every list written anew: `(?:a|b)` in a regular expression, else `"a" "b"` on a line of its own.
fn with_words(text: &str) -> String {
    let words = words();
    let mut marked: Option<&Vec<&str>> = None;
    let line = |line: &str| {
        let listed = marked.take().map(|words| with_list(line, words));
        marked =
            line.split_once("words: ").and_then(|(_, rest)| words.get(rest.trim_end_matches(['"', ','])));
        listed.unwrap_or_else(|| line.to_owned()) + "\n"
    };
    text.lines().map(line).collect()
}

fn with_list(line: &str, words: &[&str]) -> String {
    let regex = line.split_once("(?:").and_then(|(before, rest)| Some((before, rest.split_once(')')?.1)));
    match regex {
        Some((before, after)) => format!("{before}(?:{}){after}", words.join("|")),
        None => {
            let indent = &line[..line.len() - line.trim_start().len()];
            format!("{indent}\"{}\"", words.join("\" \""))
        }
    }
}

/// `tree-sitter generate` reads the list, too; it is run by hand.
#[test]
fn the_parser_of_tree_sitter_was_made_from_the_list() {
    let grammar = repository().join("editors/tree-sitter-fdc/src/grammar.json");
    let grammar = fs::read_to_string(grammar).expect("the grammar is there");
    let words = words();
    for word in ["items", "keywords", "clauses"].iter().flat_map(|kind| &words[kind]) {
        let token = format!("\"value\": \"{word}\"");
        assert!(
            grammar.contains(&token),
            "grammar.js has no `{word}`; see docs/recipes/change-the-syntax.md"
        );
    }
}
