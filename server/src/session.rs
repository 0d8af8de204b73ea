//! The session: one event after the other, and a check of what has changed whenever nothing is
//! waiting.

use crate::agreed::agree;
use crate::capabilities;
use crate::client::{Client, Failure};
use crate::commands;
use crate::dispatch;
use crate::features::diagnostics;
use crate::reader::{Event, cancelled};
use crate::signals::Signals;
use crate::state::State;
use lsp_server::{ErrorCode, Message, Notification, Request};
use lsp_types::PublishDiagnosticsNotification;
use serde_json::Value;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::PathBuf;
use std::sync::Arc;
use std::sync::mpsc::{Receiver, TryRecvError};

/// How far the conversation has come.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Stage {
    Before,
    Running,
    After,
}

/// A client that is being served.
pub struct Session {
    state: State,
    signals: Arc<Signals>,
    stage: Stage,
    /// Changes of texts that have been done.
    changes: u64,
}

impl Session {
    /// With nothing open.
    pub fn new(client: Client, signals: Arc<Signals>, program: PathBuf) -> Self {
        let state = State::new(client, program);
        Session { state, signals, stage: Stage::Before, changes: 0 }
    }

    /// Until the client ends it; says whether that was done as the protocol wants.
    pub fn run(mut self, events: &Receiver<Event>) -> bool {
        loop {
            let event = match events.try_recv() {
                Ok(event) => event,
                Err(TryRecvError::Empty) if self.publish_next() => continue,
                Err(_) => match events.recv() {
                    Ok(event) => event,
                    Err(_) => return false,
                },
            };
            match event {
                Event::Message(Message::Request(request)) => self.answer(request),
                Event::Message(Message::Notification(it)) if it.method == "exit" => {
                    return self.stage == Stage::After;
                }
                Event::Message(Message::Notification(it)) => self.hear(it),
                Event::Message(Message::Response(_)) => {}
                Event::Refused(refusal) => self.state.client.refuse(&refusal),
                Event::Closed => return false,
            }
        }
    }

    fn answer(&mut self, request: Request) {
        let id = request.id.clone();
        if self.signals.take_cancelled(&id) {
            return self.state.client.answer(id, Err(Failure::cancelled()));
        }
        if request.method == "workspace/executeCommand" && self.stage == Stage::Running {
            return commands::execute(&mut self.state, request);
        }
        // A mistake of ours costs this answer, not the session.
        let answered = catch_unwind(AssertUnwindSafe(|| self.result(request)));
        let failed = |_| {
            Err(Failure {
                code: ErrorCode::InternalError,
                message: "this went wrong; please report it".into(),
            })
        };
        self.state.client.answer(id, answered.unwrap_or_else(failed));
    }

    fn result(&mut self, request: Request) -> Result<Value, Failure> {
        let refused = |code, message: &str| Err(Failure { code, message: message.into() });
        match (self.stage, request.method.as_str()) {
            (Stage::Before, "initialize") => {
                self.stage = Stage::Running;
                self.state.agreed = agree(&request.params);
                Ok(capabilities::result(&self.state.agreed))
            }
            (Stage::Before, _) => {
                refused(ErrorCode::ServerNotInitialized, "`initialize` comes first")
            }
            (Stage::Running, "initialize") => {
                refused(ErrorCode::InvalidRequest, "`initialize` comes once")
            }
            (Stage::Running, "shutdown") => {
                self.stage = Stage::After;
                Ok(Value::Null)
            }
            (Stage::Running, _) => dispatch::request(&mut self.state, request),
            (Stage::After, _) => {
                refused(ErrorCode::InvalidRequest, "only `exit` comes after `shutdown`")
            }
        }
    }

    fn hear(&mut self, notification: Notification) {
        let is_change = matches!(
            notification.method.as_str(),
            "textDocument/didOpen" | "textDocument/didChange" | "textDocument/didClose"
        );
        self.changes += u64::from(is_change);
        if let Some(id) =
            cancelled(&notification).filter(|_| notification.method == "$/cancelRequest")
        {
            // Its request has been answered by now, or runs.
            self.signals.take_cancelled(&id);
            self.state.commands.cancel(&id);
        }
        if self.stage == Stage::Running {
            // There is nobody to tell that a notification cannot be understood.
            let _ = catch_unwind(AssertUnwindSafe(|| {
                dispatch::notification(&mut self.state, notification)
            }));
        }
    }

    /// Checks one text that has changed and says what was found; nothing if there is none, or if a
    /// change is waiting.
    fn publish_next(&mut self) -> bool {
        let is_stale = |session: &Self| session.signals.changes() != session.changes;
        if self.stage != Stage::Running || self.state.agreed.pulls || is_stale(self) {
            return false;
        }
        let Some(document) = self.state.documents.next_unpublished() else { return false };
        let found = catch_unwind(AssertUnwindSafe(|| {
            diagnostics::publishable(document, &self.state.agreed)
        }));
        let uri = document.uri.clone();
        let is_stale = is_stale(self);
        // A text that has made us fail is not tried again; one that has changed meanwhile is.
        self.state.documents.set_published(&uri, found.is_err() || !is_stale);
        if let (Ok(params), false) = (found, is_stale) {
            self.state.client.notify::<PublishDiagnosticsNotification>(params);
        }
        true
    }
}
