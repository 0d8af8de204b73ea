//! A text and its lines as the protocol counts them: from 0, ended by `\n`, `\r\n` or `\r`, columns
//! in code units of the encoding that was agreed on.

use fdcc_grammar::Span;
use lsp_types::{Position, PositionEncodingKind, Range};
use std::sync::Arc;

/// What a column counts.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Encoding {
    /// Bytes.
    Utf8,
    /// Pairs of bytes: what the protocol means where nothing was agreed on.
    #[default]
    Utf16,
    /// Characters.
    Utf32,
}

impl Encoding {
    /// The first that the client offers and we know.
    pub fn agreed(offered: &[PositionEncodingKind]) -> Self {
        let known = |kind: &PositionEncodingKind| match kind {
            PositionEncodingKind::UTF8 => Some(Encoding::Utf8),
            PositionEncodingKind::UTF16 => Some(Encoding::Utf16),
            PositionEncodingKind::UTF32 => Some(Encoding::Utf32),
            _ => None,
        };
        offered.iter().find_map(known).unwrap_or_default()
    }

    /// In the words of the protocol.
    pub fn kind(self) -> PositionEncodingKind {
        match self {
            Encoding::Utf8 => PositionEncodingKind::UTF8,
            Encoding::Utf16 => PositionEncodingKind::UTF16,
            Encoding::Utf32 => PositionEncodingKind::UTF32,
        }
    }

    fn width(self, character: char) -> usize {
        match self {
            Encoding::Utf8 => character.len_utf8(),
            Encoding::Utf16 => character.len_utf16(),
            Encoding::Utf32 => 1,
        }
    }

    /// How many columns a text fills.
    pub fn columns(self, text: &str) -> u32 {
        text.chars().map(|character| self.width(character)).sum::<usize>() as u32
    }
}

/// A text with its lines.
#[derive(Clone, Debug)]
pub struct Text {
    /// All of it.
    pub text: Arc<str>,
    encoding: Encoding,
    line_starts: Arc<[u32]>,
}

impl Text {
    /// Finds the lines.
    pub fn new(text: impl Into<Arc<str>>, encoding: Encoding) -> Self {
        let text = text.into();
        let bytes = text.as_bytes();
        let ends_line = |&at: &usize| match bytes[at] {
            b'\n' => true,
            b'\r' => bytes.get(at + 1) != Some(&b'\n'),
            _ => false,
        };
        let ends = (0..bytes.len()).filter(ends_line).map(|at| at as u32 + 1);
        let line_starts = std::iter::once(0).chain(ends).collect();
        Text { text, encoding, line_starts }
    }

    /// What a column counts.
    pub fn encoding(&self) -> Encoding {
        self.encoding
    }

    /// The line of a byte, from 0.
    pub fn line(&self, offset: u32) -> u32 {
        self.line_starts.partition_point(|&start| start <= offset) as u32 - 1
    }

    /// The bytes of a line without its end; the last line for those beyond it.
    pub fn line_span(&self, line: u32) -> Span {
        let line = (line as usize).min(self.line_starts.len() - 1);
        let start = self.line_starts[line] as usize;
        let end = self.line_starts.get(line + 1).map_or(self.text.len(), |&next| next as usize);
        let content = self.text[start..end].trim_end_matches(['\n', '\r']);
        Span::new(start, start + content.len())
    }

    /// The place of a byte.
    pub fn position(&self, offset: u32) -> Position {
        let mut offset = (offset as usize).min(self.text.len());
        while !self.text.is_char_boundary(offset) {
            offset -= 1;
        }
        let line = self.line(offset as u32);
        let start = self.line_starts[line as usize] as usize;
        Position { line, character: self.encoding.columns(&self.text[start..offset]) }
    }

    /// The place of a range of bytes.
    pub fn range(&self, span: Span) -> Range {
        Range { start: self.position(span.start), end: self.position(span.end) }
    }

    /// The byte of a place. A column beyond the line is its end, one inside a character its
    /// beginning, as the protocol says.
    pub fn offset(&self, position: Position) -> u32 {
        if position.line as usize >= self.line_starts.len() {
            return self.text.len() as u32;
        }
        let span = self.line_span(position.line);
        let mut column = 0;
        for (at, character) in self.text[span.range()].char_indices() {
            column += self.encoding.width(character);
            if column > position.character as usize {
                return span.start + at as u32;
            }
        }
        span.end
    }

    /// The bytes of a range; one that runs backwards is turned round.
    pub fn span(&self, range: Range) -> Span {
        let (start, end) = (self.offset(range.start), self.offset(range.end));
        Span { start: start.min(end), end: start.max(end) }
    }

    /// The text with a range replaced.
    pub fn changed(&self, range: Range, with: &str) -> Text {
        let mut text = self.text.to_string();
        text.replace_range(self.span(range).range(), with);
        Text::new(text, self.encoding)
    }
}
