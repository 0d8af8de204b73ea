//! What we do for a client.

use crate::agreed::Agreed;
use crate::commands::COMMANDS;
use crate::features::tokens;
use lsp_types::{
    CodeActionKind, CodeActionOptions, CodeLensOptions, CompletionOptions, DiagnosticOptions,
    DocumentOnTypeFormattingOptions, ExecuteCommandOptions, InitializeResult, RenameOptions, Save,
    SemanticTokensOptions, ServerCapabilities, ServerInfo, SignatureHelpOptions,
    TextDocumentSyncKind, TextDocumentSyncOptions,
};
use serde_json::Value;

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
