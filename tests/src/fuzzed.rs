//! What must hold of any text: it is read, checked and repaired without a panic, and every place that is named lies in it.

use fdcc_grammar::{Diagnostic, fix, parse};

/// Reads, checks and repairs a text, and panics if something does not hold.
pub fn understand(text: &str) {
    let found = diagnostics(text);
    found.iter().for_each(|one| assert_sound(one, text));
    for unsafely in [false, true] {
        if let Some(repaired) = fix::apply(text, &found, unsafely) {
            diagnostics(&repaired).iter().for_each(|one| assert_sound(one, &repaired));
        }
    }
}

/// Like `fdcc check`: the meaning of everything that could be read is looked at.
fn diagnostics(text: &str) -> Vec<Diagnostic> {
    let parsed = parse(text);
    let mut found = parsed.diagnostics;
    if !parsed.tree.items.is_empty() {
        found.extend(fdcc_compiler::check(&parsed.tree).diagnostics);
    }
    found
}

fn assert_sound(found: &Diagnostic, text: &str) {
    assert!(!found.message.is_empty() && !found.labels.is_empty(), "something is said: {found:?}");
    let labels = found.labels.iter().map(|label| label.span);
    let edits = found.fixes.iter().flat_map(|fix| &fix.edits).map(|edit| edit.span);
    for span in labels.chain(edits) {
        assert!(text.get(span.range()).is_some(), "{span:?} lies in the text: {found:?}");
    }
}
