//! The language server of `.fdc` models: what `fdcc check`, `fmt`, `fix` and `explain` say, while a
//! model is written.
//!
//! ```text
//! client ──▶ reader ──▶ queue ──▶ session ──▶ client
//! ```
//!
//! One thread reads the protocol and notes what has become stale; another, the session, owns the
//! documents, does everything in the order in which it was asked, and checks a text as soon as
//! nothing else is asked. Both sleep while nothing happens. Nothing is decided here about the
//! language: that is what the grammar and the compiler are for.

mod agreed;
mod capabilities;
mod client;
mod commands;
mod context;
mod dispatch;
mod documents;
mod features;
mod pages;
mod reader;
mod results;
mod runner;
mod session;
mod signals;
mod snapshot;
mod state;
mod text;
mod wire;

use client::Client;
use session::Session;
use signals::Signals;
use std::io::{BufRead, Write};
use std::path::PathBuf;
use std::sync::Arc;
use std::sync::mpsc::channel;

/// Checking goes as deep as expressions are nested.
const STACK: usize = 16 << 20;

/// Serves one client until it says `exit` or goes away; says whether it ended as the protocol wants
/// it, with `shutdown` before `exit`. `program` is `fdcc`, which solves and simulates.
pub fn serve(
    input: impl BufRead + Send + 'static,
    output: impl Write + Send + 'static,
    program: PathBuf,
) -> bool {
    let (queue, events) = channel();
    let client = Client::new(output);
    let signals = Arc::new(Signals::default());
    let session = {
        let (client, signals) = (client.clone(), signals.clone());
        move || Session::new(client, signals, program).run(&events)
    };
    std::thread::spawn(move || reader::run(input, &queue, &signals));
    let session =
        std::thread::Builder::new().name("session".into()).stack_size(STACK).spawn(session);
    session.is_ok_and(|session| session.join().unwrap_or(false))
}
