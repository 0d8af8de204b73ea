//! The other end: where answers, notifications and requests of our own go.

use crate::wire::{self, Refusal};
use lsp_server::{ErrorCode, Message, RequestId, Response, ResponseError};
use lsp_types::{Notification, Request};
use serde_json::Value;
use std::io::Write;
use std::sync::atomic::{AtomicI32, Ordering};
use std::sync::{Arc, Mutex, PoisonError};

/// Why a request has no result.
pub struct Failure {
    /// The kind of mistake.
    pub code: ErrorCode,
    /// In words.
    pub message: String,
}

impl Failure {
    /// The parameters do not fit the method.
    pub fn params(message: impl Into<String>) -> Self {
        Failure { code: ErrorCode::InvalidParams, message: message.into() }
    }

    /// The request is understood, and cannot be met.
    pub fn request(message: impl Into<String>) -> Self {
        Failure { code: ErrorCode::RequestFailed, message: message.into() }
    }

    /// Somebody has called it off.
    pub fn cancelled() -> Self {
        Failure { code: ErrorCode::RequestCanceled, message: "cancelled".into() }
    }
}

/// The client; every thread may have a copy. A client that has gone away hears nothing, and that is
/// no mistake.
#[derive(Clone)]
pub struct Client {
    output: Arc<Mutex<dyn Write + Send>>,
    asked: Arc<AtomicI32>,
}

impl Client {
    /// One that reads what is written here.
    pub fn new(output: impl Write + Send + 'static) -> Self {
        Client { output: Arc::new(Mutex::new(output)), asked: Arc::default() }
    }

    /// Answers a request.
    pub fn answer(&self, id: RequestId, result: Result<Value, Failure>) {
        let error =
            |it: Failure| ResponseError { code: it.code as i32, message: it.message, data: None };
        self.send(Message::Response(Response { id, response_result: result.map_err(error) }));
    }

    /// Answers what could not be read.
    pub fn refuse(&self, refusal: &Refusal) {
        let mut output = self.output.lock().unwrap_or_else(PoisonError::into_inner);
        let _ = wire::write_refusal(&mut *output, refusal);
    }

    /// Tells something.
    pub fn notify<N: Notification>(&self, params: N::Params) {
        let method = N::METHOD.as_str().to_owned();
        self.send(Message::Notification(lsp_server::Notification::new(method, params)));
    }

    /// Asks something whose answer does not matter.
    pub fn ask<R: Request>(&self, params: R::Params) {
        let id = self.asked.fetch_add(1, Ordering::Relaxed);
        let method = R::METHOD.as_str().to_owned();
        self.send(Message::Request(lsp_server::Request::new(id.into(), method, params)));
    }

    fn send(&self, message: Message) {
        let mut output = self.output.lock().unwrap_or_else(PoisonError::into_inner);
        let _ = wire::write(&mut *output, &message);
    }
}
