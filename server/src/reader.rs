//! The thread that reads the protocol: passes everything on in order, and notes at once what makes
//! earlier work void.

use crate::signals::Signals;
use crate::wire::{self, Received, Refusal};
use lsp_server::{Message, Notification, RequestId};
use std::io::BufRead;
use std::sync::mpsc::Sender;

/// What the session hears of.
pub enum Event {
    /// A message of the client.
    Message(Message),
    /// A message that could not be read.
    Refused(Refusal),
    /// The client has gone away.
    Closed,
}

/// Reads until the client or the session goes away.
pub fn run(mut input: impl BufRead, queue: &Sender<Event>, signals: &Signals) {
    while let Ok(Some(received)) = wire::read(&mut input) {
        let event = match received {
            Received::Message(message) => {
                note(&message, signals);
                Event::Message(message)
            }
            Received::Refused(refusal) => Event::Refused(refusal),
            Received::Nothing => continue,
        };
        if queue.send(event).is_err() {
            return;
        }
    }
    // A session that has ended already does not mind.
    let _ = queue.send(Event::Closed);
}

fn note(message: &Message, signals: &Signals) {
    let Message::Notification(notification) = message else { return };
    match notification.method.as_str() {
        "textDocument/didOpen" | "textDocument/didChange" | "textDocument/didClose" => {
            signals.change()
        }
        "$/cancelRequest" => {
            if let Some(id) = cancelled(notification) {
                signals.cancel(id);
            }
        }
        _ => {}
    }
}

/// The request that a `$/cancelRequest` calls off.
pub fn cancelled(notification: &Notification) -> Option<RequestId> {
    serde_json::from_value(notification.params.get("id")?.clone()).ok()
}
