//! What the reader knows before the session comes to it: that a text has changed again, and what
//! was called off.

use lsp_server::RequestId;
use std::collections::BTreeSet;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Mutex, PoisonError};

/// Set by the reader, looked at by the session.
#[derive(Default)]
pub struct Signals {
    changes: AtomicU64,
    cancelled: Mutex<BTreeSet<RequestId>>,
}

impl Signals {
    /// A text has changed; the session will come to it.
    pub fn change(&self) {
        self.changes.fetch_add(1, Ordering::SeqCst);
    }

    /// How often texts have changed.
    pub fn changes(&self) -> u64 {
        self.changes.load(Ordering::SeqCst)
    }

    /// A request has been called off.
    pub fn cancel(&self, id: RequestId) {
        self.cancelled.lock().unwrap_or_else(PoisonError::into_inner).insert(id);
    }

    /// Whether a request has been called off; forgets it.
    pub fn take_cancelled(&self, id: &RequestId) -> bool {
        self.cancelled.lock().unwrap_or_else(PoisonError::into_inner).remove(id)
    }
}
