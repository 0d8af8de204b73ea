//! One slip, one message: models of the repository with one word, number or sign taken away.
//!
//! Where what is left has a mistake in its syntax, that is all that is said, but for advice:
//! nothing follows from what could not be read.

use crate::common::{fdcc, folder, json, model};
use std::fs;
use std::ops::Range;

/// Words, numbers and signs; comments are left alone.
fn tokens(text: &str) -> Vec<Range<usize>> {
    let mut tokens = Vec::new();
    let mut at = 0;
    while let Some(first) = text[at..].chars().next() {
        let is_word = |c: char| c.is_alphanumeric() || c == '_';
        let rest = &text[at..];
        let length = match first {
            '#' => rest.find('\n').unwrap_or(rest.len()),
            _ if is_word(first) => rest.find(|c: char| !is_word(c)).unwrap_or(rest.len()),
            _ => first.len_utf8(),
        };
        if first != '#' && !first.is_whitespace() {
            tokens.push(at..at + length);
        }
        at += length;
    }
    tokens
}

#[test]
fn nothing_follows_from_what_cannot_be_read() {
    let mut problems = Vec::new();
    for name in ["block", "racecar", "turbo", "stacked", "bounce", "twostage", "crossing"] {
        let text = fs::read_to_string(model(name)).expect("the model is there");
        let slips = tokens(&text)
            .into_iter()
            .map(|token| [&text[..token.start], &text[token.end..]].concat());
        let files: Vec<(String, String)> =
            slips.enumerate().map(|(at, slip)| (format!("{name}{at:04}.fdc"), slip)).collect();
        let contents: Vec<(&str, &[u8])> =
            files.iter().map(|(name, text)| (name.as_str(), text.as_bytes())).collect();
        let folder = folder(&format!("consequences_{name}"), &contents);
        let names = contents.iter().map(|(name, _)| *name);
        let arguments: Vec<&str> = ["check", "--format", "json"].into_iter().chain(names).collect();
        let found = json(&fdcc(&folder, &arguments, ""));
        let found = found.as_array().expect("an array");
        for (file, slip) in &files {
            let of_file: Vec<_> = found
                .iter()
                .filter(|it| it["file"] == file.as_str() && it["severity"] != "advice")
                .collect();
            let is_syntax = |code: &str| code.starts_with("FDC000") && code != "FDC0008";
            let is_broken =
                of_file.iter().any(|it| is_syntax(it["code"].as_str().unwrap_or_default()));
            if is_broken && of_file.len() > 1 {
                let lines = of_file.iter().map(|it| {
                    let line = it["line"].as_u64().unwrap_or(1) as usize;
                    let text = slip.lines().nth(line - 1).unwrap_or_default();
                    format!("  {line}: {} {}   | {text}\n", it["code"], it["message"])
                });
                problems.push(format!("{file}\n{}", lines.collect::<String>()));
            }
        }
    }
    assert!(
        problems.is_empty(),
        "{} slips with more than one message\n{}",
        problems.len(),
        problems.join("\n")
    );
}
