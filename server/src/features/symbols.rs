//! The outline of a text: its items, with what is inside of them.

use crate::client::Failure;
use crate::context::Context;
use fdcc::language::{Kind, Names};
use fdcc_grammar::Span;
use fdcc_grammar::ast::{Binding, Item, ItemKind, Sense};
use lsp_types::{DocumentSymbol, DocumentSymbolParams, DocumentSymbolResponse, SymbolKind};

/// `textDocument/documentSymbol`
pub fn symbols(
    context: &Context<'_>,
    _: DocumentSymbolParams,
) -> Result<Option<DocumentSymbolResponse>, Failure> {
    let outline = Outline { context, names: context.snapshot().names() };
    let items = &context.snapshot().tree().items;
    Ok(Some(outline.items(items).into()))
}

struct Outline<'c> {
    context: &'c Context<'c>,
    names: &'c Names,
}

impl Outline<'_> {
    fn items(&self, items: &[Item]) -> Vec<DocumentSymbol> {
        items.iter().filter_map(|item| self.item(item)).collect()
    }

    fn item(&self, item: &Item) -> Option<DocumentSymbol> {
        match &item.kind {
            ItemKind::Phase { name, items, .. } => Some(DocumentSymbol {
                children: Some(self.items(items)),
                ..self.symbol(&name.name, SymbolKind::Module, item.span, name.span)
            }),
            ItemKind::Dynamics { equations } => {
                let entries = equations
                    .iter()
                    .map(|it| (format!("{}'", it.state.name), it.span, it.state.span));
                Some(self.block("dynamics", item.span, entries))
            }
            ItemKind::Guess { bindings } => Some(self.bindings("guess", item.span, bindings)),
            ItemKind::Report { bindings } => Some(self.bindings("report", item.span, bindings)),
            ItemKind::Method { settings } => {
                let entries =
                    settings.iter().map(|it| (it.key.name.clone(), it.key.span, it.key.span));
                Some(self.block("method", item.span, entries))
            }
            ItemKind::Objective { sense, keyword, .. } => {
                let word = if *sense == Sense::Minimize { "minimize" } else { "maximize" };
                Some(self.symbol(word, SymbolKind::Operator, item.span, *keyword))
            }
            ItemKind::Fit { keyword, .. } => {
                Some(self.symbol("fit", SymbolKind::Operator, item.span, *keyword))
            }
            _ => self.declaration(item),
        }
    }

    fn bindings(&self, word: &str, whole: Span, bindings: &[Binding]) -> DocumentSymbol {
        let entry =
            |it: &Binding| (it.name.name.clone(), it.name.span.to(it.value.span), it.name.span);
        self.block(word, whole, bindings.iter().map(entry))
    }

    /// A block with entries: each has a name, its place, and that of the name.
    fn block(
        &self,
        word: &str,
        whole: Span,
        entries: impl Iterator<Item = (String, Span, Span)>,
    ) -> DocumentSymbol {
        let entry = |(name, whole, span): (String, Span, Span)| {
            self.symbol(&name, SymbolKind::Field, whole, span)
        };
        let children = Some(entries.map(entry).collect());
        DocumentSymbol { children, ..self.symbol(word, SymbolKind::Namespace, whole, whole) }
    }

    /// What an item declares, with its parts.
    fn declaration(&self, item: &Item) -> Option<DocumentSymbol> {
        let all = &self.names.definitions;
        let at = all.iter().position(|it| it.item == item.span)?;
        let symbol = |at: usize| {
            let it = &all[at];
            DocumentSymbol {
                detail: Some(it.kind.word().to_owned()),
                ..self.symbol(&it.name, kind(it.kind), it.item, it.span)
            }
        };
        let parts: Vec<DocumentSymbol> = self.names.parts_of(at).map(symbol).collect();
        Some(DocumentSymbol { children: (!parts.is_empty()).then_some(parts), ..symbol(at) })
    }

    fn symbol(&self, name: &str, kind: SymbolKind, whole: Span, name_span: Span) -> DocumentSymbol {
        let (range, selection_range) = (self.context.range(whole), self.context.range(name_span));
        DocumentSymbol::new(name.into(), None, kind, None, None, range, selection_range, None)
    }
}

/// The nearest of the protocol's kinds.
pub fn kind(kind: Kind) -> SymbolKind {
    match kind {
        Kind::Param | Kind::Const => SymbolKind::Constant,
        Kind::Function => SymbolKind::Function,
        Kind::State | Kind::Control | Kind::Free | Kind::Time | Kind::Let | Kind::Signal => {
            SymbolKind::Variable
        }
        Kind::Plot => SymbolKind::Object,
        Kind::Surface => SymbolKind::Interface,
        Kind::Jump => SymbolKind::Event,
        Kind::Path => SymbolKind::Boolean,
        Kind::Data => SymbolKind::Array,
        Kind::Phase | Kind::Model => SymbolKind::Module,
        Kind::Part | Kind::Column | Kind::Argument | Kind::Row | Kind::Report => SymbolKind::Field,
    }
}
