//! The command `fdcc`: reads the command line and hands over to one file for each command.

mod commands;
mod drawing;
mod exit;
mod failure;
mod input;
mod model;
mod output;
mod report;
mod solved;
mod watch;

use std::process::ExitCode;

use clap::Parser;
use exit::Exit;

/// Optimal control of systems with friction, switches and impacts.
#[derive(Parser)]
#[command(name = "fdcc", version, arg_required_else_help = true)]
struct CommandLine {
    #[command(subcommand)]
    command: commands::Command,
}

/// Blocks of memory up to this size are kept when they are given back.
const KEPT: usize = 16 << 20;

fn main() -> ExitCode {
    keep_memory();
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

/// The allocator of Linux hands large blocks back to the system, which clears every page anew when
/// the next solve asks for it: 2 to 7 % of the time of a short solve. It learns from the first
/// large block that is given back to keep blocks up to that size. This one is never touched, and
/// costs nothing.
fn keep_memory() {
    drop(std::hint::black_box(Vec::<u8>::with_capacity(KEPT)));
}
