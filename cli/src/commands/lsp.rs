//! `fdcc lsp`: the language server, for editors.

use crate::exit::Exit;
use clap::Args;
use std::io::{BufReader, stdin, stdout};

/// Serve an editor over the standard streams (Language Server Protocol)
#[derive(Args)]
pub struct Lsp {
    /// Over the standard streams, as always; editors give it
    #[arg(long)]
    stdio: bool,
}

impl Lsp {
    /// Serves until the editor ends it; a conversation that breaks off is none.
    pub fn run(self) -> Exit {
        // Where a system does not tell where we are, the shell knows.
        let program = std::env::current_exe().unwrap_or_else(|_| "fdcc".into());
        match fdcc_server::serve(BufReader::new(stdin()), stdout(), program) {
            true => Exit::Fine,
            false => Exit::ModelError,
        }
    }
}
