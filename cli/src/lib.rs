//! The command `fdcc` as a library: what it says and writes, for the command itself and for front
//! ends in other languages.

mod answers;
mod command;
mod commands;
mod drawing;
mod exit;
mod failure;
mod input;
mod model;
mod output;
mod page;
mod report;
mod solved;
mod sweep;
mod version;
mod watch;

pub use answers::{Answer, Saved, diagnostics, drawn, gradient, row};
pub use answers::{simulation, simulation_of_phases};

use std::process::ExitCode;

use clap::Parser;
use exit::Exit;

/// Optimal control of systems with friction, switches and impacts.
#[derive(Parser)]
#[command(name = "fdcc", version = version::VERSION, long_version = version::LONG.as_str())]
#[command(arg_required_else_help = true)]
struct CommandLine {
    #[command(subcommand)]
    command: commands::Command,
}

/// Reads the command line and hands over to one file for each command.
pub fn run() -> ExitCode {
    command::remember(std::env::args_os().skip(1).map(|it| it.to_string_lossy().into_owned()));
    match CommandLine::try_parse() {
        Ok(line) => output::ended(line.command.run()).into(),
        Err(error) if error.use_stderr() => {
            // Nothing is left to do where even the complaint cannot be printed.
            let _ = error.print();
            Exit::Usage.into()
        }
        Err(help) => {
            output::note(help.print());
            output::ended(Exit::Fine).into()
        }
    }
}
