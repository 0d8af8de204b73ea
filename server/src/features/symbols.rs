//! The outline of a text: its items, with what is inside of them.

use crate::client::Failure;
use crate::context::Context;
use fdcc_compiler::names::{Kind, Names};
use fdcc_grammar::Span;
use fdcc_grammar::ast::{Item, ItemKind, Sense};
use lsp_types::{DocumentSymbol, DocumentSymbolParams, DocumentSymbolResponse, SymbolKind};

/// `textDocument/documentSymbol`
pub fn symbols(
    context: &Context<'_>,
    _: DocumentSymbolParams,
) -> Result<Option<DocumentSymbolResponse>, Failure> {
    let outline = Outline { context, names: context.analysis().names() };
    let items = &context.analysis().reviewed.tree.items;
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
        let block = |name: &str, entries: Vec<DocumentSymbol>| {
            let kind = SymbolKind::Namespace;
            Some(DocumentSymbol { children: Some(entries), ..self.symbol(name, kind, item.span, item.span) })
        };
        let entry =
            |name: String, whole: Span, span: Span| self.symbol(&name, SymbolKind::Field, whole, span);
        match &item.kind {
            ItemKind::Phase { name, items } => {
                let children = Some(self.items(items));
                Some(DocumentSymbol {
                    children,
                    ..self.symbol(&name.name, SymbolKind::Module, item.span, name.span)
                })
            }
            ItemKind::Dynamics { equations } => block(
                "dynamics",
                equations
                    .iter()
                    .map(|it| entry(format!("{}'", it.state.name), it.span, it.state.span))
                    .collect(),
            ),
            ItemKind::Guess { bindings } | ItemKind::Report { bindings } => {
                let word = if matches!(item.kind, ItemKind::Guess { .. }) { "guess" } else { "report" };
                let whole = |it: &fdcc_grammar::ast::Binding| it.name.span.to(it.value.span);
                block(
                    word,
                    bindings.iter().map(|it| entry(it.name.name.clone(), whole(it), it.name.span)).collect(),
                )
            }
            ItemKind::Method { settings } => block(
                "method",
                settings.iter().map(|it| entry(it.key.name.clone(), it.key.span, it.key.span)).collect(),
            ),
            ItemKind::Objective { sense, keyword, .. } => {
                let word = if *sense == Sense::Minimize { "minimize" } else { "maximize" };
                Some(self.symbol(word, SymbolKind::Operator, item.span, *keyword))
            }
            _ => self.declaration(item),
        }
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
        Kind::State | Kind::Control | Kind::Free | Kind::Time | Kind::Let => SymbolKind::Variable,
        Kind::Surface => SymbolKind::Interface,
        Kind::Jump => SymbolKind::Event,
        Kind::Path => SymbolKind::Boolean,
        Kind::Data => SymbolKind::Array,
        Kind::Phase | Kind::Model => SymbolKind::Module,
        Kind::Part | Kind::Column | Kind::Argument | Kind::Row | Kind::Report => SymbolKind::Field,
    }
}
