//! Which method is answered by which function.

use crate::client::Failure;
use crate::context::Context;
use crate::features::{
    actions, completion, diagnostics, folding, formatting, hints, hover, lens, navigation, rename,
    signature, symbols, tokens, workspace,
};
use crate::state::State;
// The types of the requests that are answered, and of their parts.
use lsp_types::*;
use serde::de::DeserializeOwned;
use serde_json::Value;

/// Answers a request about a text.
pub fn request(state: &mut State, request: lsp_server::Request) -> Result<Value, Failure> {
    let lsp_server::Request { method, params, .. } = request;
    let call = Call { state, params };
    match method.as_str() {
        "textDocument/diagnostic" => call.about::<DocumentDiagnosticRequest>(diagnostics::report),
        "textDocument/definition" => call.about::<DefinitionRequest>(navigation::definition),
        "textDocument/references" => call.about::<ReferencesRequest>(navigation::references),
        "textDocument/documentHighlight" => {
            call.about::<DocumentHighlightRequest>(navigation::highlights)
        }
        "textDocument/prepareRename" => call.about::<PrepareRenameRequest>(rename::prepare),
        "textDocument/rename" => call.about::<RenameRequest>(rename::rename),
        "textDocument/documentSymbol" => call.about::<DocumentSymbolRequest>(symbols::symbols),
        "textDocument/foldingRange" => call.about::<FoldingRangeRequest>(folding::folding),
        "textDocument/selectionRange" => call.about::<SelectionRangeRequest>(folding::selection),
        "textDocument/semanticTokens/full" => call.about::<SemanticTokensRequest>(tokens::full),
        "textDocument/semanticTokens/range" => {
            call.about::<SemanticTokensRangeRequest>(tokens::range)
        }
        "textDocument/formatting" => call.about::<DocumentFormattingRequest>(formatting::whole),
        "textDocument/rangeFormatting" => {
            call.about::<DocumentRangeFormattingRequest>(formatting::range)
        }
        "textDocument/onTypeFormatting" => {
            call.about::<DocumentOnTypeFormattingRequest>(formatting::on_type)
        }
        "textDocument/hover" => call.about::<HoverRequest>(hover::hover),
        "textDocument/completion" => call.about::<CompletionRequest>(completion::completion),
        "textDocument/signatureHelp" => call.about::<SignatureHelpRequest>(signature::help),
        "textDocument/inlayHint" => call.about::<InlayHintRequest>(hints::hints),
        "textDocument/codeLens" => call.about::<CodeLensRequest>(lens::lenses),
        "workspace/symbol" => {
            let result: WorkspaceSymbolResponse =
                workspace::symbols(call.state, &parsed(call.params)?).into();
            Ok(serde_json::to_value(result).expect("types of the protocol are JSON"))
        }
        "textDocument/codeAction" => call.about::<CodeActionRequest>(actions::actions),
        _ => Err(Failure {
            code: lsp_server::ErrorCode::MethodNotFound,
            message: format!("there is no `{method}` here"),
        }),
    }
}

/// A request that is being answered.
struct Call<'s> {
    state: &'s mut State,
    params: Value,
}

impl Call<'_> {
    /// By a function of the text that it is about.
    fn about<R: lsp_types::Request>(
        self,
        answer: impl Fn(&Context<'_>, R::Params) -> Result<R::Result, Failure>,
    ) -> Result<Value, Failure> {
        let address = self.params.pointer("/textDocument/uri").and_then(Value::as_str);
        let uri = Uri(address
            .ok_or_else(|| Failure::params("`textDocument.uri` is missing"))?
            .to_owned());
        let params = parsed(self.params)?;
        let document = self.state.documents.get(&uri);
        let document = document.ok_or_else(|| Failure::request(format!("`{uri}` is not open")))?;
        let result = answer(&Context { state: self.state, document }, params)?;
        Ok(serde_json::to_value(result).expect("types of the protocol are JSON"))
    }
}

fn parsed<P: DeserializeOwned>(params: Value) -> Result<P, Failure> {
    serde_json::from_value(params).map_err(|error| Failure::params(error.to_string()))
}

/// Takes note of something.
pub fn notification(
    state: &mut State,
    notification: lsp_server::Notification,
) -> Result<(), Failure> {
    match notification.method.as_str() {
        "textDocument/didOpen" => {
            let it = parsed::<DidOpenTextDocumentParams>(notification.params)?.text_document;
            state.documents.open(it.uri, it.version, &it.text, state.agreed.encoding);
        }
        "textDocument/didChange" => {
            let it: DidChangeTextDocumentParams = parsed(notification.params)?;
            let uri = &it.text_document.text_document_identifier.uri;
            state.documents.change(uri, it.text_document.version, &it.content_changes);
        }
        "textDocument/didClose" => {
            let it: DidCloseTextDocumentParams = parsed(notification.params)?;
            close(state, it.text_document.uri);
        }
        "window/workDoneProgress/cancel" => {
            let it: WorkDoneProgressCancelParams = parsed(notification.params)?;
            state.commands.cancel_progress(&it.token);
        }
        _ => {}
    }
    Ok(())
}

/// What was said about a text is taken back with it.
fn close(state: &mut State, uri: Uri) {
    if state.documents.close(&uri) && !state.agreed.pulls {
        let params = PublishDiagnosticsParams { uri, version: None, diagnostics: Vec::new() };
        state.client.notify::<PublishDiagnosticsNotification>(params);
    }
}
