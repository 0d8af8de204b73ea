//! What was agreed on with the client.

use crate::text::Encoding;
use serde_json::Value;

/// What was agreed on. Read piece by piece: a client that says something strange elsewhere is
/// served all the same.
#[derive(Clone, Debug, Default)]
pub struct Agreed {
    /// What a column counts.
    pub encoding: Encoding,
    /// Whether the client asks for diagnostics; they are not sent unasked then, or it would show
    /// them twice.
    pub pulls: bool,
    /// Whether the client shows progress that it has not asked for.
    pub progress: bool,
    /// Whether what is completed may have places to go on at.
    pub snippets: bool,
    /// Whether a diagnostic may name further places.
    pub related: bool,
    /// Whether hints are asked for again where that is wished.
    pub refreshes_hints: bool,
}

/// Reads the parameters of `initialize`.
pub fn agree(params: &Value) -> Agreed {
    let offered =
        params.pointer("/capabilities/general/positionEncodings").cloned().unwrap_or_default();
    let offered: Vec<_> = serde_json::from_value(offered).unwrap_or_default();
    let says = |path: &str| params.pointer(&format!("/capabilities{path}"));
    let is_true = |path: &str| says(path).and_then(Value::as_bool).unwrap_or(false);
    Agreed {
        encoding: Encoding::agreed(&offered),
        pulls: says("/textDocument/diagnostic").is_some_and(Value::is_object),
        progress: is_true("/window/workDoneProgress"),
        snippets: is_true("/textDocument/completion/completionItem/snippetSupport"),
        related: is_true("/textDocument/publishDiagnostics/relatedInformation")
            || is_true("/textDocument/diagnostic/relatedInformation"),
        refreshes_hints: is_true("/workspace/inlayHint/refreshSupport"),
    }
}
