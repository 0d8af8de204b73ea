//! What the client can do, and what we do for it.

use crate::text::Encoding;
use lsp_types::{
    DiagnosticOptions, InitializeResult, Save, ServerCapabilities, ServerInfo, TextDocumentSyncKind,
    TextDocumentSyncOptions,
};
use serde_json::Value;

/// What was agreed on. Read piece by piece: a client that says something strange elsewhere is served all the same.
#[derive(Clone, Debug, Default)]
pub struct Agreed {
    /// What a column counts.
    pub encoding: Encoding,
    /// Whether the client asks for diagnostics; they are not sent unasked then, or it would show them twice.
    pub pulls: bool,
    /// Whether a diagnostic may name further places.
    pub related: bool,
}

/// Reads the parameters of `initialize`.
pub fn agree(params: &Value) -> Agreed {
    let offered = params.pointer("/capabilities/general/positionEncodings").cloned().unwrap_or_default();
    let offered: Vec<_> = serde_json::from_value(offered).unwrap_or_default();
    let says = |path: &str| params.pointer(&format!("/capabilities{path}"));
    let is_true = |path: &str| says(path).and_then(Value::as_bool).unwrap_or(false);
    Agreed {
        encoding: Encoding::agreed(&offered),
        pulls: says("/textDocument/diagnostic").is_some_and(Value::is_object),
        related: is_true("/textDocument/publishDiagnostics/relatedInformation")
            || is_true("/textDocument/diagnostic/relatedInformation"),
    }
}

/// The answer to `initialize`.
pub fn result(agreed: &Agreed) -> Value {
    let version = Some(env!("CARGO_PKG_VERSION").to_owned());
    let result = InitializeResult {
        capabilities: capabilities(agreed),
        server_info: Some(ServerInfo { name: "fdcc".into(), version }),
    };
    serde_json::to_value(result).expect("types of the protocol are JSON")
}

fn capabilities(agreed: &Agreed) -> ServerCapabilities {
    let sync = TextDocumentSyncOptions {
        open_close: Some(true),
        change: Some(TextDocumentSyncKind::Incremental),
        save: Some(Save::Bool(false)),
        ..TextDocumentSyncOptions::default()
    };
    ServerCapabilities {
        position_encoding: Some(agreed.encoding.kind()),
        text_document_sync: Some(sync.into()),
        diagnostic_provider: Some(
            DiagnosticOptions { identifier: Some("fdcc".into()), ..DiagnosticOptions::default() }.into(),
        ),
        ..ServerCapabilities::default()
    }
}
