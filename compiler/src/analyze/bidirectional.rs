//! FDC0011: characters that turn the direction of a text around, so that it reads otherwise than it
//! is understood.

use fdcc_grammar::{Code, Diagnostic, Fix, Span};

/// Embeddings, overrides and isolates of Unicode's bidirectional algorithm.
fn turns_around(letter: char) -> bool {
    matches!(letter, '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}')
}

/// One finding for all of them: whoever pastes one pastes several.
pub(crate) fn found(text: &str) -> Option<Diagnostic> {
    let place = |(at, letter): (usize, char)| (Span::new(at, at + letter.len_utf8()), letter);
    let mut all = text.char_indices().filter(|it| turns_around(it.1)).map(place);
    let (first, letter) = all.next()?;
    let message = "a character that turns the direction of the text around";
    let label = format!("U+{:04X}, which is not seen", letter as u32);
    let mut diagnostic = Diagnostic::new(Code::Bidirectional, message, first, label);
    let mut fix = Fix::certain("take it out").remove(first);
    for (span, letter) in all {
        diagnostic = diagnostic.label(span, format!("U+{:04X}", letter as u32));
        fix = fix.remove(span);
    }
    Some(
        diagnostic
            .help("take it out: with it a text reads otherwise than it is understood")
            .fix(fix),
    )
}
