//! `fdcc lsp`: the language server, for editors.

use super::Exit;
use clap::Args;
use std::io::{BufReader, stdin, stdout};

/// Serve an editor over the standard streams (Language Server Protocol)
#[derive(Args)]
pub struct Lsp {
    /// Editors say so; there is no other way
    #[arg(long, hide = true)]
    stdio: bool,
}

impl Lsp {
    /// Serves until the editor ends it; a conversation that breaks off is none.
    pub fn run(self) -> Exit {
        match fdcc_server::serve(BufReader::new(stdin()), stdout()) {
            true => Exit::Fine,
            false => Exit::ModelError,
        }
    }
}
