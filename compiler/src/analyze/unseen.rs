//! FDC0011: characters that are not seen, so that a text reads otherwise than it is understood.

use fdcc_grammar::{Code, Diagnostic, Fix, Span};

/// Marks, embeddings, overrides and isolates of Unicode's bidirectional algorithm, characters
/// without width, and separators of lines and paragraphs, at which an editor may show a new line in
/// the middle of a comment; not those that join letters of a script or parts of a picture, U+200C
/// and U+200D, nor the mark in front of a text, which says how it is written.
fn is_unseen((at, letter): &(usize, char)) -> bool {
    match letter {
        '\u{61c}' | '\u{200b}' | '\u{200e}' | '\u{200f}' => true,
        '\u{2028}'..='\u{202e}' | '\u{2060}'..='\u{206f}' => true,
        '\u{ad}' | '\u{180e}' => true,
        '\u{feff}' => *at > 0,
        _ => false,
    }
}

/// One finding for all of them: whoever pastes one pastes several.
pub(crate) fn found(text: &str) -> Option<Diagnostic> {
    let place = |(at, letter): (usize, char)| (Span::new(at, at + letter.len_utf8()), letter);
    let mut all = text.char_indices().filter(is_unseen).map(place);
    let (first, letter) = all.next()?;
    let label = |letter: char| format!("U+{:04X}", letter as u32);
    let (message, shown) =
        ("a character that is not seen", format!("{}, which is not seen", label(letter)));
    let mut diagnostic = Diagnostic::new(Code::Unseen, message, first, shown);
    let mut fix = Fix::certain("take it out").remove(first);
    for (span, letter) in all {
        diagnostic = diagnostic.label(span, label(letter));
        fix = fix.remove(span);
    }
    Some(
        diagnostic
            .help("take it out: with it a text reads otherwise than it is understood")
            .fix(fix),
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    const UNSEEN: &str = "\u{61c}\u{200b}\u{200e}\u{200f}\u{2028}\u{2029}\u{202a}\u{202b}\u{202c}\
                          \u{202d}\u{202e}\u{2060}\u{2066}\u{2067}\u{2068}\u{2069}\u{ad}\u{180e}\
                          \u{feff}";

    #[test]
    fn what_is_not_seen_is_told_once_and_taken_out() {
        for letter in UNSEEN.chars() {
            let text = format!("# one{letter} two{letter}\n");
            let found = found(&text).expect("it is told");
            assert_eq!(found.labels.len(), 2, "{letter:?}");
            assert_eq!(found.fixes[0].edits.len(), 2, "{letter:?}");
        }
        assert_eq!(found(UNSEEN).expect("all are told").labels.len(), UNSEEN.chars().count());
    }

    #[test]
    fn what_joins_letters_may_stand_in_comments() {
        assert!(
            found("\u{feff}# \u{1f468}\u{200d}\u{1f469} \u{645}\u{6cc}\u{200c}\u{62e}").is_none()
        );
    }
}
