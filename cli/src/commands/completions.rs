//! `fdcc completions`: what a shell needs to complete command lines.

use crate::exit::Exit;
use crate::{CommandLine, output};
use clap::{Args, CommandFactory};
use clap_complete::{Shell, generate};

/// Print a script that completes the command line in a shell
#[derive(Args)]
pub struct Completions {
    /// Which shell
    #[arg(value_enum)]
    shell: Shell,
}

impl Completions {
    /// Prints it.
    pub fn run(self) -> Exit {
        let mut script = Vec::new();
        generate(self.shell, &mut CommandLine::command(), "fdcc", &mut script);
        output::print(&String::from_utf8_lossy(&script));
        Exit::Fine
    }
}
