//! Which method is answered by which function.

use crate::analysis::Analysis;
use crate::client::Failure;
use crate::documents::Document;
use crate::features::{
    actions, completion, diagnostics, folding, formatting, hints, hover, lens, navigation, rename, signature,
    symbols, tokens,
};
use crate::session::Session;
use fdcc_compiler::{Model, NamedUnit, SurfaceReport};
use fdcc_grammar::{Edit, Span};
// The types of the requests that are answered, and of their parts.
#[allow(clippy::wildcard_imports)]
use lsp_types::*;
use serde::de::DeserializeOwned;
use serde_json::Value;

/// Answers a request about a text.
pub fn request(session: &mut Session, request: lsp_server::Request) -> Result<Value, Failure> {
    let lsp_server::Request { method, params, .. } = request;
    let call = Call { session, params };
    match method.as_str() {
        "textDocument/diagnostic" => call.about::<DocumentDiagnosticRequest>(diagnostics::report),
        "textDocument/definition" => call.about::<DefinitionRequest>(navigation::definition),
        "textDocument/references" => call.about::<ReferencesRequest>(navigation::references),
        "textDocument/documentHighlight" => call.about::<DocumentHighlightRequest>(navigation::highlights),
        "textDocument/prepareRename" => call.about::<PrepareRenameRequest>(rename::prepare),
        "textDocument/rename" => call.about::<RenameRequest>(rename::rename),
        "textDocument/documentSymbol" => call.about::<DocumentSymbolRequest>(symbols::symbols),
        "textDocument/foldingRange" => call.about::<FoldingRangeRequest>(folding::folding),
        "textDocument/selectionRange" => call.about::<SelectionRangeRequest>(folding::selection),
        "textDocument/semanticTokens/full" => call.about::<SemanticTokensRequest>(tokens::full),
        "textDocument/semanticTokens/range" => call.about::<SemanticTokensRangeRequest>(tokens::range),
        "textDocument/formatting" => call.about::<DocumentFormattingRequest>(formatting::whole),
        "textDocument/rangeFormatting" => call.about::<DocumentRangeFormattingRequest>(formatting::range),
        "textDocument/onTypeFormatting" => call.about::<DocumentOnTypeFormattingRequest>(formatting::on_type),
        "textDocument/hover" => call.about::<HoverRequest>(hover::hover),
        "textDocument/completion" => call.about::<CompletionRequest>(completion::completion),
        "textDocument/signatureHelp" => call.about::<SignatureHelpRequest>(signature::help),
        "textDocument/inlayHint" => call.about::<InlayHintRequest>(hints::hints),
        "textDocument/codeLens" => call.about::<CodeLensRequest>(lens::lenses),
        "textDocument/codeAction" => call.about::<CodeActionRequest>(actions::actions),
        _ => Err(Failure {
            code: lsp_server::ErrorCode::MethodNotFound,
            message: format!("there is no `{method}` here"),
        }),
    }
}

/// A request that is being answered.
struct Call<'s> {
    session: &'s mut Session,
    params: Value,
}

impl Call<'_> {
    /// By a function of the text that it is about.
    fn about<R: lsp_types::Request>(
        self,
        answer: impl Fn(&Context<'_>, R::Params) -> Result<R::Result, Failure>,
    ) -> Result<Value, Failure> {
        let address = self.params.pointer("/textDocument/uri").and_then(Value::as_str);
        let uri = Uri(address.ok_or_else(|| Failure::params("`textDocument.uri` is missing"))?.to_owned());
        let params = parsed(self.params)?;
        let document = self.session.documents.get(&uri);
        let document = document.ok_or_else(|| Failure::request(format!("`{uri}` is not open")))?;
        let result = answer(&Context { session: self.session, document }, params)?;
        Ok(serde_json::to_value(result).expect("types of the protocol are JSON"))
    }
}

/// What a request is answered from.
pub struct Context<'s> {
    /// The session.
    pub session: &'s Session,
    /// The text it is about.
    pub document: &'s Document,
}

impl Context<'_> {
    /// What is known about the text.
    pub fn analysis(&self) -> &Analysis {
        self.document.analysis()
    }

    /// What the text means, or meant when it had no mistakes.
    pub fn model(&self) -> Option<&Model> {
        self.document.modelled()?.reviewed.model.as_ref()
    }

    /// What is known about each surface of that.
    pub fn surfaces(&self) -> &[SurfaceReport] {
        self.document.modelled().map_or(&[], |it| it.surfaces())
    }

    /// The unit of each name; what was known before where the text has none that can be told now.
    pub fn units(&self) -> &[NamedUnit] {
        let now = &self.analysis().reviewed.units;
        let before = || self.document.modelled().map_or(&[][..], |it| &it.reviewed.units);
        if now.is_empty() { before() } else { now }
    }

    /// The byte of a place.
    pub fn offset(&self, position: Position) -> u32 {
        self.analysis().text.offset(position)
    }

    /// The place of some bytes.
    pub fn range(&self, span: Span) -> Range {
        self.analysis().text.range(span)
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

fn parsed<P: DeserializeOwned>(params: Value) -> Result<P, Failure> {
    serde_json::from_value(params).map_err(|error| Failure::params(error.to_string()))
}

/// Takes note of something.
pub fn notification(session: &mut Session, notification: lsp_server::Notification) -> Result<(), Failure> {
    match notification.method.as_str() {
        "textDocument/didOpen" => {
            let it = parsed::<DidOpenTextDocumentParams>(notification.params)?.text_document;
            session.documents.open(it.uri, it.version, &it.text, session.agreed.encoding);
        }
        "textDocument/didChange" => {
            let it: DidChangeTextDocumentParams = parsed(notification.params)?;
            let uri = &it.text_document.text_document_identifier.uri;
            session.documents.change(uri, it.text_document.version, &it.content_changes);
        }
        "textDocument/didClose" => {
            let it: DidCloseTextDocumentParams = parsed(notification.params)?;
            close(session, it.text_document.uri);
        }
        "window/workDoneProgress/cancel" => {
            let it: WorkDoneProgressCancelParams = parsed(notification.params)?;
            session.commands.cancel_progress(&it.token);
        }
        _ => {}
    }
    Ok(())
}

/// What was said about a text is taken back with it.
fn close(session: &mut Session, uri: Uri) {
    if session.documents.close(&uri) && !session.agreed.pulls {
        let params = PublishDiagnosticsParams { uri, version: None, diagnostics: Vec::new() };
        session.client.notify::<PublishDiagnosticsNotification>(params);
    }
}
