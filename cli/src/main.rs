//! The command `fdcc`: reads the command line and hands over to one file for each command.

mod alignment;
mod bounds;
mod commands;
mod conditions;
mod difference;
mod exact;
mod expectations;
mod failure;
mod fit;
mod gradients;
mod jumps;
mod log;
mod model;
mod output;
mod parallel;
mod pieces;
mod quantities;
mod render;
mod replay;
mod replayed;
mod rewrite;
mod search;
mod solver;
mod stays;
mod verdict;
mod verification;
mod warm;
mod watch;

use std::process::ExitCode;

use clap::Parser;

/// Optimal control of systems with friction, switches and impacts.
#[derive(Parser)]
#[command(name = "fdcc", version, arg_required_else_help = true)]
struct CommandLine {
    #[command(subcommand)]
    command: commands::Command,
}

fn main() -> ExitCode {
    match CommandLine::try_parse() {
        Ok(line) => line.command.run().into(),
        Err(error) => {
            // Nothing is left to do where even the complaint cannot be printed.
            let _ = error.print();
            if error.use_stderr() { commands::Exit::Usage.into() } else { commands::Exit::Fine.into() }
        }
    }
}
