//! What the client can do, and what we do for it.

use crate::commands::COMMANDS;
use crate::features::tokens;
use crate::text::Encoding;
use lsp_types::{
    CodeActionKind, CodeActionOptions, CodeLensOptions, CompletionOptions, DiagnosticOptions,
    DocumentOnTypeFormattingOptions, ExecuteCommandOptions, InitializeResult, RenameOptions, Save,
    SemanticTokensOptions, ServerCapabilities, ServerInfo, SignatureHelpOptions,
    TextDocumentSyncKind, TextDocumentSyncOptions,
};
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
        diagnostic_provider: Some(diagnostics().into()),
        hover_provider: Some(true.into()),
        completion_provider: Some(completion()),
        signature_help_provider: Some(signatures()),
        inlay_hint_provider: Some(true.into()),
        definition_provider: Some(true.into()),
        references_provider: Some(true.into()),
        document_highlight_provider: Some(true.into()),
        rename_provider: Some(
            RenameOptions { prepare_provider: Some(true), ..RenameOptions::default() }.into(),
        ),
        document_symbol_provider: Some(true.into()),
        workspace_symbol_provider: Some(true.into()),
        folding_range_provider: Some(true.into()),
        selection_range_provider: Some(true.into()),
        semantic_tokens_provider: Some(semantic_tokens().into()),
        document_formatting_provider: Some(true.into()),
        document_range_formatting_provider: Some(true.into()),
        document_on_type_formatting_provider: Some(DocumentOnTypeFormattingOptions::new(
            "}".into(),
            Some(vec!["\n".into()]),
        )),
        code_action_provider: Some(code_actions().into()),
        code_lens_provider: Some(CodeLensOptions::default()),
        execute_command_provider: Some(commands()),
        ..ServerCapabilities::default()
    }
}

fn diagnostics() -> DiagnosticOptions {
    DiagnosticOptions { identifier: Some("fdcc".into()), ..DiagnosticOptions::default() }
}

fn semantic_tokens() -> SemanticTokensOptions {
    SemanticTokensOptions {
        legend: tokens::legend(),
        range: Some(true.into()),
        full: Some(true.into()),
        ..SemanticTokensOptions::default()
    }
}

fn code_actions() -> CodeActionOptions {
    let kinds = vec![CodeActionKind::QuickFix, CodeActionKind::SourceFixAll];
    CodeActionOptions { code_action_kinds: Some(kinds), ..CodeActionOptions::default() }
}

fn completion() -> CompletionOptions {
    let triggers = [".", "[", "(", " "].map(str::to_owned).to_vec();
    CompletionOptions { trigger_characters: Some(triggers), ..CompletionOptions::default() }
}

fn signatures() -> SignatureHelpOptions {
    let triggers = ["(", ","].map(str::to_owned).to_vec();
    SignatureHelpOptions { trigger_characters: Some(triggers), ..SignatureHelpOptions::default() }
}

fn commands() -> ExecuteCommandOptions {
    let names = COMMANDS.iter().map(|row| row.0.to_owned()).collect();
    ExecuteCommandOptions { commands: names, ..ExecuteCommandOptions::default() }
}
