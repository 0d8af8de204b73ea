//! What must hold of the canonical layout: same tree, same comments, and stable.

use fdcc_grammar::{comments, format, parse};

/// Lays a text out, and panics if that changes more than blanks; a text that cannot be read is
/// refused.
pub fn assert_only_the_layout_changes(text: &str) {
    let Ok(formatted) = format(text) else { return };
    assert!(
        meaning(&formatted) == meaning(text),
        "the meaning has changed:\n{text}\n--- became\n{formatted}"
    );
    assert_eq!(remarks(&formatted), remarks(text), "{text}\n--- became\n{formatted}");
    let again = format(&formatted).expect("what is formatted can be read");
    assert!(
        again == formatted,
        "not stable:\n{text}\n--- became\n{formatted}\n--- and then\n{again}"
    );
    assert!(
        formatted.lines().all(|line| line == line.trim_end()),
        "blanks at the end of a line: {text}"
    );
}

/// The tree without places.
fn meaning(text: &str) -> String {
    let tree = parse(text).tree;
    let tree = format!("{:?}", fdcc_grammar::ast::Model { line_starts: Vec::new(), ..tree });
    let mut parts = tree.split("Span { start: ");
    let first = parts.next().unwrap_or_default().to_owned();
    parts.fold(first, |sum, part| sum + part.split_once(" }").map_or(part, |(_, rest)| rest))
}

fn remarks(text: &str) -> Vec<&str> {
    comments(text).into_iter().map(|span| &text[span.range()]).collect()
}
