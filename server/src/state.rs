//! All that is known while a client is served.

use crate::agreed::Agreed;
use crate::client::Client;
use crate::documents::Documents;
use crate::results::Results;
use crate::runner::Running;
use lsp_server::RequestId;
use lsp_types::{ProgressToken, Uri};
use std::path::PathBuf;
use std::sync::{Arc, Mutex, PoisonError};

/// All that is known while a client is served.
pub struct State {
    /// The other end.
    pub client: Client,
    /// What was agreed on.
    pub agreed: Agreed,
    /// The open texts.
    pub documents: Documents,
    /// What runs.
    pub commands: Commands,
    /// What solves have said.
    pub results: Results,
    /// `fdcc`.
    pub program: PathBuf,
}

impl State {
    /// With nothing open.
    pub fn new(client: Client, program: PathBuf) -> Self {
        let (agreed, documents, commands, results) = Default::default();
        State { client, agreed, documents, commands, results, program }
    }
}

/// What runs at the moment.
#[derive(Default)]
pub struct Commands {
    /// Shared with the threads that wait for its end.
    pub running: Arc<Mutex<Vec<Arc<Running>>>>,
}

impl Commands {
    /// Calls off the command of a request.
    pub fn cancel(&self, id: &RequestId) {
        self.stop(|it| it.id == *id);
    }

    /// Calls off the command of a progress.
    pub fn cancel_progress(&self, token: &ProgressToken) {
        self.stop(|it| it.token.as_ref() == Some(token));
    }

    fn stop(&self, is_meant: impl Fn(&Running) -> bool) {
        let running = self.running.lock().unwrap_or_else(PoisonError::into_inner);
        running.iter().filter(|it| is_meant(it)).for_each(|it| it.stop());
    }

    /// Whether a model is being computed.
    pub fn is_busy(&self, uri: &Uri) -> bool {
        self.running.lock().unwrap_or_else(PoisonError::into_inner).iter().any(|it| it.uri == *uri)
    }
}

impl Drop for Commands {
    fn drop(&mut self) {
        self.stop(|_| true);
    }
}
