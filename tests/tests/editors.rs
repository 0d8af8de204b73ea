//! The grammars of the editors use the words of the compiler, which stand in one list,
//! `editors/words.json`.
//!
//! `UPDATE=1 cargo test --release --test all editors::` writes the list and the places
//! where others repeat it anew.

use fdcc_compiler::{analyze, function_names};
use fdcc_grammar::parse;
use fdcc_grammar::words::{WORDS, Word, inner_words};
use fdcc_tests::pages::check_file;
use fdcc_tests::repository;
use serde_json::Value;
use std::collections::{BTreeMap, HashSet};
use std::fs;

/// The words of each kind, in the order in which the compiler lists them.
fn words() -> BTreeMap<&'static str, Vec<&'static str>> {
    let reserved = |is_item: bool| {
        let is_kind = move |it: &&Word| it.is_reserved && it.item.is_some() == is_item;
        WORDS.iter().filter(is_kind).map(|it| it.text)
    };
    let items = WORDS.iter().filter(|it| it.item.is_some());
    let mut clauses: Vec<&str> =
        items.clone().flat_map(|it| inner_words(it.text)).copied().collect();
    let mut seen = HashSet::new();
    clauses.retain(|word| WORDS.iter().all(|it| it.text != *word) && seen.insert(*word));
    clauses.extend(items.filter(|it| !it.is_reserved).map(|it| it.text));
    BTreeMap::from([
        ("items", reserved(true).collect()),
        ("keywords", reserved(false).collect()),
        ("clauses", clauses),
        ("functions", function_names()),
        ("constants", vec!["pi", "inf"]),
    ])
}

#[test]
fn the_list_of_words_is_that_of_the_compiler() {
    let list = serde_json::to_string_pretty(&words()).expect("words are text");
    check_file("editors/words.json", &format!("{list}\n"));
}

/// Files that repeat the words: each line below one that says `words: KIND`.
const REPEATED: &[&str] = &[
    "editors/tree-sitter-fdc/src/scanner.c",
    "editors/tree-sitter-fdc/queries/highlights.scm",
    "editors/vscode/syntaxes/fdc.tmLanguage.json",
    "editors/emacs/fdc-mode.el",
];

#[test]
fn grammars_repeat_the_list() {
    for path in REPEATED {
        let text = fs::read_to_string(repository().join(path)).expect("the grammar is there");
        check_file(path, &with_words(path, &text));
    }
}

/// The text with every list written anew: `(?:a|b)` in a regular expression, else `"a" "b"` on a
/// line of its own, with commas in C.
fn with_words(path: &str, text: &str) -> String {
    let words = words();
    let mut marked: Option<&Vec<&str>> = None;
    let line = |line: &str| {
        let listed = marked.take().map(|words| with_list(path, line, words));
        marked = line
            .split_once("words: ")
            .and_then(|(_, rest)| words.get(rest.trim_end_matches(['"', ','])));
        listed.unwrap_or_else(|| line.to_owned()) + "\n"
    };
    text.lines().map(line).collect()
}

fn with_list(path: &str, line: &str, words: &[&str]) -> String {
    let regex =
        line.split_once("(?:").and_then(|(before, rest)| Some((before, rest.split_once(')')?.1)));
    match regex {
        Some((before, after)) => format!("{before}(?:{}){after}", words.join("|")),
        None => {
            let indent = &line[..line.len() - line.trim_start().len()];
            let separator = if path.ends_with(".c") { "\", \"" } else { "\" \"" };
            format!("{indent}\"{}\"", words.join(separator))
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

/// Each snippet, as it stands before anything is filled in, is an item or an expression; a model by
/// itself is a right one.
#[test]
fn snippets_are_right() {
    let snippets = fs::read_to_string(repository().join("editors/vscode/snippets/fdc.json"));
    let snippets: BTreeMap<String, Value> =
        serde_json::from_str(&snippets.expect("the snippets are there"))
            .expect("the snippets are JSON");
    assert!(snippets.len() > 5);
    for (name, snippet) in snippets {
        let lines = snippet["body"].as_array().expect("a snippet has lines").iter();
        let lines: Vec<&str> = lines.map(|line| line.as_str().expect("a line is text")).collect();
        let text = filled_in(&lines.join("\n"));
        let found = match name.as_str() {
            "A model" => analyze(&text).diagnostics,
            "A right side that switches" | "A function in pieces" => {
                parse(&format!("let y = {text}")).diagnostics
            }
            _ => parse(&text).diagnostics,
        };
        assert!(found.is_empty(), "{name}: {found:#?}\n{text}");
    }
}

/// `${1:m}` is `m`, `${2|a,b|}` is `a`, and `$0` is nothing.
fn filled_in(snippet: &str) -> String {
    let mut pieces = snippet.split("${");
    let first = pieces.next().unwrap_or_default().to_owned();
    let filled = pieces.fold(first, |text, piece| {
        let (stop, after) = piece.split_once('}').expect("a placeholder is closed");
        let shown = stop.trim_start_matches(|c: char| c.is_ascii_digit());
        let shown = shown[1..].split([',', '|']).next().unwrap_or_default();
        text + shown + after
    });
    filled.replace("$0", "")
}
