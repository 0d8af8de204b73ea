//! Which method is answered by which function.

use crate::client::Failure;
use crate::documents::Document;
use crate::features::diagnostics;
use crate::session::Session;
use lsp_server::{ErrorCode, Notification, Request};
use lsp_types::{
    DidChangeTextDocumentParams, DidCloseTextDocumentParams, DidOpenTextDocumentParams,
    PublishDiagnosticsNotification, PublishDiagnosticsParams, Uri,
};
use serde::de::DeserializeOwned;
use serde_json::Value;

/// Answers a request about a text.
pub fn request(session: &mut Session, request: Request) -> Result<Value, Failure> {
    let Request { method, params, .. } = request;
    let call = Call { session, params };
    match method.as_str() {
        "textDocument/diagnostic" => call.about::<lsp_types::DocumentDiagnosticRequest>(diagnostics::report),
        _ => {
            Err(Failure { code: ErrorCode::MethodNotFound, message: format!("there is no `{method}` here") })
        }
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

fn parsed<P: DeserializeOwned>(params: Value) -> Result<P, Failure> {
    serde_json::from_value(params).map_err(|error| Failure::params(error.to_string()))
}

/// Takes note of something.
pub fn notification(session: &mut Session, notification: Notification) -> Result<(), Failure> {
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
