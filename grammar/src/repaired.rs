//! Applying repairs to the text that they are about.

use crate::{Diagnostic, Edit, Span};

/// A text with the first repair of each finding, as far as the repairs do not touch one another;
/// `None` if there is nothing to repair. With `unsafely`, what is likely is done as well.
pub fn repaired(text: &str, diagnostics: &[Diagnostic], unsafely: bool) -> Option<String> {
    let mut edits: Vec<&Edit> = Vec::new();
    for diagnostic in diagnostics {
        let fix = diagnostic.fixes.iter().find(|fix| fix.certain || unsafely);
        let new = fix.map_or(&[][..], |fix| &fix.edits);
        let is_free = |edit: &Edit| edits.iter().all(|other| are_apart(edit.span, other.span));
        if new.iter().all(is_free) {
            edits.extend(new);
        }
    }
    edits.sort_by_key(|edit| edit.span);
    let mut result = text.to_owned();
    for edit in edits.iter().rev() {
        result.replace_range(edit.span.range(), &edit.replacement);
    }
    (result != text).then_some(result)
}

/// Whether two edits do not meet: two insertions at one place would have no order.
fn are_apart(one: Span, other: Span) -> bool {
    one.end < other.start || other.end < one.start
}
