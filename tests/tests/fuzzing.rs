//! Texts that a search by coverage has found, and mutations of them: none is too much for parse,
//! check, layout and repair.
//!
//! The long search is told in `docs/recipes/fuzz.md`; this is the short one, the same on every run.

use std::time::{Duration, Instant};

use fdcc_grammar::{ParseCache, parse, parse_with};
use fdcc_tests::fuzzed::understand;
use fdcc_tests::random::Random;
use fdcc_tests::repository;

/// Generous: the tests share the machine.
const LIMIT: Duration = Duration::from_secs(5);

/// Mutations that are tried, a few seconds' worth.
const MUTATIONS: usize = 500;

/// Items that can be read and have a mistake all the same.
const MISTAKEN: &str = "path 1 <= x >= 0\nlet huge = 1e999\n";

/// Edits of each model, one after the other.
const EDITS: usize = 50;

fn corpus() -> Vec<String> {
    let text = std::fs::read_to_string(repository().join("tests/fuzz/corpus.txt"));
    text.expect("the corpus is there").split("\n----\n").map(str::to_owned).collect()
}

fn within_the_limit(text: &str) {
    let begin = Instant::now();
    understand(text);
    assert!(begin.elapsed() < LIMIT, "{:?} for\n{text}", begin.elapsed());
}

#[test]
fn what_has_been_found_is_understood() {
    let corpus = corpus();
    assert!(corpus.len() > 500, "the corpus is read");
    corpus.iter().for_each(|text| within_the_limit(text));
}

#[test]
fn mutations_of_what_has_been_found_are_understood() {
    let corpus = corpus();
    let mut random = Random::new(1);
    for _ in 0..MUTATIONS {
        let mut text = corpus[random.below(corpus.len())].clone();
        for _ in 0..=random.below(4) {
            text = mutated(&text, &corpus, &mut random);
        }
        within_the_limit(&text);
    }
}

#[test]
fn a_memory_of_former_texts_changes_nothing() {
    let corpus = corpus();
    let mut random = Random::new(2);
    for (name, model) in fdcc_tests::documents("models", "fdc") {
        let mut text = format!("{MISTAKEN}{model}");
        let mut memory = ParseCache::default();
        for _ in 0..EDITS {
            text = mutated(&text, &corpus, &mut random);
            assert!(parse_with(&mut memory, &text) == parse(&text), "{name}, edited:\n{text}");
        }
    }
}

/// A stretch of a text is taken out, doubled, or replaced by one of another text.
fn mutated(text: &str, corpus: &[String], random: &mut Random) -> String {
    let (from, to) = stretch(text, random);
    let other = &corpus[random.below(corpus.len())];
    let (first, last) = stretch(other, random);
    match random.below(3) {
        0 => [&text[..from], &text[to..]].concat(),
        1 => [&text[..to], &text[from..]].concat(),
        _ => [&text[..from], &other[first..last], &text[to..]].concat(),
    }
}

/// Two places in a text, not far apart.
fn stretch(text: &str, random: &mut Random) -> (usize, usize) {
    let places: Vec<usize> = text.char_indices().map(|(at, _)| at).chain([text.len()]).collect();
    let first = random.below(places.len());
    let last = (first + random.below(24)).min(places.len() - 1);
    (places[first], places[last])
}
