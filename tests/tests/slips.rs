//! Every kind of item with every missing and every superfluous piece: the text is read, or one
//! message says what is wrong with it, in the words of `snapshots/slips.txt`.
//!
//! The examples of `slips/items.md` stand between two right neighbours; each token is taken away
//! and doubled in turn.

use std::ops::Range;

use fdcc_grammar::ast::{Item, ItemKind};
use fdcc_grammar::{Diagnostic, Parse, SourceFile, parse};
use fdcc_tests::pages::check_file;
use fdcc_tests::{blocks, repository};

const BEFORE: &str = "param before = 1\n";
const AFTER: &str = "param after = 1\n";

#[test]
fn every_slip_in_every_item_has_one_message_at_its_line() {
    let examples = std::fs::read_to_string(repository().join("tests/tests/slips/items.md"));
    let mut page = String::new();
    let mut problems = Vec::new();
    for block in blocks(&examples.expect("the examples are there")) {
        page += &format!("{}\n", block.text.trim_end().replace('\n', " "));
        for slip in slips(&block.text) {
            let answer = answer(&slip);
            problems.extend(problem(&slip, &answer));
            page += &shown(&slip, &answer);
        }
        page.push('\n');
    }
    check_file("tests/snapshots/slips.txt", &page);
    assert!(problems.is_empty(), "{}", problems.join("\n"));
}

/// An example with one token taken away or doubled.
struct Slip {
    name: String,
    text: String,
    /// Bytes of the text where the token was or is doubled.
    at: usize,
}

fn slips(example: &str) -> Vec<Slip> {
    let tokens = tokens(example);
    let slip = |token: &Range<usize>, sign: char, replacement: String| {
        let (before, after) = (&example[..token.start], &example[token.end..]);
        let name = format!("{sign} {}", &example[token.clone()]);
        Slip { name, text: [before, &replacement, after].concat(), at: token.start }
    };
    let without = tokens.iter().map(|token| slip(token, '-', String::new()));
    let twice =
        tokens.iter().map(|token| slip(token, '+', format!("{0} {0}", &example[token.clone()])));
    without.chain(twice).collect()
}

/// Words, numbers, texts in quotes, and signs.
fn tokens(text: &str) -> Vec<Range<usize>> {
    let mut tokens: Vec<Range<usize>> = Vec::new();
    let mut at = 0;
    while at < text.len() {
        let rest = &text[at..];
        let is_number = rest.starts_with(|c: char| c.is_ascii_digit());
        let ends =
            |c: char| !c.is_alphanumeric() && c != '_' && !(is_number && matches!(c, '.' | '-'));
        let word = rest.find(ends).unwrap_or(rest.len());
        let is_value = rest.starts_with(|c: char| c.is_alphanumeric());
        let sign = ["<=", ">=", "==", "=>", ":=", "->"].iter().any(|sign| rest.starts_with(sign));
        let length = match rest.as_bytes()[0] {
            b'"' => 2 + rest[1..].find('"').expect("the quote ends"),
            _ if is_value => word,
            _ => 1 + usize::from(sign),
        };
        if !rest.starts_with(char::is_whitespace) {
            tokens.push(at..at + length);
        }
        at += length;
    }
    tokens
}

/// What the parser says to a slip between two right items, and whether both were read.
struct Answer {
    source: SourceFile,
    diagnostics: Vec<Diagnostic>,
    neighbours: usize,
    /// Items and the model line.
    items: usize,
}

fn answer(slip: &Slip) -> Answer {
    let before = if slip.text.trim_start().starts_with("model") { "" } else { BEFORE };
    let text = format!("{before}{}{AFTER}", slip.text);
    let Parse { tree, diagnostics, .. } = parse(&text);
    let is_neighbour = |span: &str| span == BEFORE.trim_end() || span == AFTER.trim_end();
    let neighbours =
        all(&tree.items).into_iter().filter(|item| is_neighbour(&text[item.span.range()])).count();
    let neighbours = neighbours + usize::from(before.is_empty());
    let items = tree.items.len() + 2 * usize::from(tree.name.is_some());
    Answer { source: SourceFile::new("model.fdc", text), diagnostics, neighbours, items }
}

/// Items and the items of phases: a phase that is not closed holds what follows it.
fn all(items: &[Item]) -> Vec<&Item> {
    let inside = |item| match item {
        &Item { kind: ItemKind::Phase { ref items, .. }, .. } => all(items),
        _ => Vec::new(),
    };
    items.iter().flat_map(|item| [vec![item], inside(item)].concat()).collect()
}

/// Why an answer is not good enough.
fn problem(slip: &Slip, answer: &Answer) -> Option<String> {
    let found = &answer.diagnostics;
    let reason = match &found[..] {
        [] if answer.items < 3 => "nothing is said",
        [] => return None,
        [one] if answer.neighbours < 2 && !one.message.contains("never closed") => {
            "a neighbour is lost"
        }
        [one] if one.help.is_none() => "no help",
        [one] if answer.source.slice(one.span()).contains("after") => "told at the neighbour",
        [one] if one.message.contains("cannot stand here") => "no words of its own",
        [_] => return None,
        _ => "more than one message",
    };
    Some(format!("{reason}: `{}`\n{found:#?}", slip.text))
}

fn shown(slip: &Slip, answer: &Answer) -> String {
    let begin = slip.text[..slip.at].rfind('\n').map_or(0, |at| at + 1);
    let text = slip.text[begin..].lines().next().unwrap_or_default();
    let mut shown = format!("  {:<14} {}\n", slip.name, text.trim());
    for one in &answer.diagnostics {
        let place = answer.source.line_column(one.span().start);
        let labels: Vec<String> = one
            .labels
            .iter()
            .map(|label| format!("`{}` {}", answer.source.slice(label.span), label.text))
            .collect();
        shown += &format!(
            "      {}:{} {}: {} | {} | {}\n",
            place.line,
            place.column,
            one.code,
            one.message,
            labels.join("; "),
            one.help.as_deref().unwrap_or("NO HELP")
        );
    }
    shown
}
