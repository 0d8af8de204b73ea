//! What must hold of any text: it is read, checked, laid out and repaired without a panic, and
//! every place that is named lies in it.

use fdcc_compiler::{analyze, repair};
use fdcc_grammar::{Diagnostic, parse};

use crate::layout::assert_only_the_layout_changes;

/// Reads, checks, lays out and repairs a text, and panics if something does not hold.
pub fn understand(text: &str) {
    analyze(text).diagnostics.iter().for_each(|one| assert_sound(one, text));
    assert_only_the_layout_changes(text);
    assert_repairs_end(text);
}

/// Repairs a text, once with what is certain only, and panics if the result can be repaired again
/// or is harder to read.
pub fn assert_repairs_end(text: &str) {
    for unsafely in [false, true] {
        let repaired = repair(text, unsafely);
        assert!(
            repair(&repaired, unsafely) == repaired,
            "repaired again:\n{text}\n---\n{repaired}"
        );
        assert!(mistakes(&repaired) <= mistakes(text), "harder to read:\n{text}\n---\n{repaired}");
        analyze(&repaired).diagnostics.iter().for_each(|one| assert_sound(one, &repaired));
    }
}

/// How many pieces cannot be read.
fn mistakes(text: &str) -> usize {
    parse(text).diagnostics.len()
}

fn assert_sound(found: &Diagnostic, text: &str) {
    assert!(!found.message.is_empty() && !found.labels.is_empty(), "something is said: {found:?}");
    let labels = found.labels.iter().map(|label| label.span);
    let edits = found.fixes.iter().flat_map(|fix| &fix.edits).map(|edit| edit.span);
    for span in labels.chain(edits) {
        assert!(text.get(span.range()).is_some(), "{span:?} lies in the text: {found:?}");
    }
}
