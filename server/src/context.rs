//! What a request is answered from: the text it is about, in the words of the protocol and in those
//! of the compiler.

use crate::documents::TextDocument;
use crate::results::Said;
use crate::snapshot::Snapshot;
use crate::state::State;
use fdcc::language::NamedUnit;
use fdcc_grammar::{Edit, Span};
use lsp_types::{Location, Position, Range, TextEdit, WorkspaceEdit};

/// What a request is answered from.
pub struct Context<'s> {
    /// What is known beside it.
    pub state: &'s State,
    /// The text it is about.
    pub document: &'s TextDocument,
}

impl Context<'_> {
    /// What is known about the text.
    pub fn snapshot(&self) -> &Snapshot {
        self.document.snapshot()
    }

    /// The text, or its last state without mistakes.
    pub fn without_mistakes(&self) -> Option<&Snapshot> {
        self.document.modelled().map(|it| &**it)
    }

    /// The unit of each name; what was known before where the text has none that can be told now.
    pub fn units(&self) -> &[NamedUnit] {
        let now = self.snapshot().units();
        let before = || self.document.modelled().map_or(&[][..], |it| it.units());
        if now.is_empty() { before() } else { now }
    }

    /// What the last solve of this very text said.
    pub fn said(&self) -> Option<Said> {
        self.state.results.of(&self.document.uri, &self.snapshot().text.text)
    }

    /// The byte of a place.
    pub fn offset(&self, position: Position) -> u32 {
        self.snapshot().text.offset(position)
    }

    /// The place of some bytes.
    pub fn range(&self, span: Span) -> Range {
        self.snapshot().text.range(span)
    }

    /// The place of some bytes, with the address of the text.
    pub fn location(&self, span: Span) -> Location {
        Location { uri: self.document.uri.clone(), range: self.range(span) }
    }

    /// A change in the words of the protocol.
    pub fn text_edit(&self, edit: &Edit) -> TextEdit {
        TextEdit { range: self.range(edit.span), new_text: edit.replacement.clone() }
    }

    /// Changes of this text.
    pub fn workspace_edit(&self, edits: &[Edit]) -> WorkspaceEdit {
        let edits = edits.iter().map(|it| self.text_edit(it)).collect();
        let changes = Some([(self.document.uri.clone(), edits)].into());
        WorkspaceEdit { changes, ..WorkspaceEdit::default() }
    }
}
