//! The commands, one file each, and the exit codes that they share.

mod accuracy;
mod check;
mod driven;
mod explain;
mod fix;
mod fmt;
mod grad;
mod lsp;
mod new;
mod options;
mod rewrite;
mod show;
mod simulate;
mod solve;
mod sweep;
mod test;
mod verify;

pub use options::{Options, show};

use std::process::ExitCode;

use clap::Subcommand;

/// How a command ended. The numbers are a contract with scripts; the worst of several is the
/// largest.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Exit {
    /// Solved, or nothing wrong.
    Fine = 0,
    /// The model has errors.
    ModelError = 1,
    /// Not solved; the best iterate is written all the same.
    NotSolved = 2,
    /// Wrong usage.
    Usage = 3,
    /// A file could not be read or written.
    File = 4,
}

impl From<Exit> for ExitCode {
    fn from(exit: Exit) -> Self {
        ExitCode::from(exit as u8)
    }
}

/// What `fdcc` can do.
#[derive(Subcommand)]
pub enum Command {
    Check(check::Check),
    Solve(Box<solve::Solve>),
    Simulate(Box<simulate::Simulate>),
    Grad(Box<grad::Grad>),
    Verify(verify::Verify),
    Sweep(Box<sweep::Sweep>),
    Test(Box<test::Test>),
    Show(show::Show),
    Fix(fix::Fix),
    Fmt(fmt::Fmt),
    New(new::New),
    Explain(explain::Explain),
    Lsp(lsp::Lsp),
}

impl Command {
    /// Does it.
    pub fn run(self) -> Exit {
        match self {
            Command::Check(check) => check.run(),
            Command::Solve(solve) => solve.run(),
            Command::Simulate(simulate) => simulate.run(),
            Command::Grad(grad) => grad.run(),
            Command::Verify(verify) => verify.run(),
            Command::Sweep(sweep) => sweep.run(),
            Command::Test(test) => test.run(),
            Command::Show(show) => show.run(),
            Command::Fix(fix) => fix.run(),
            Command::Fmt(fmt) => fmt.run(),
            Command::New(new) => new.run(),
            Command::Explain(explain) => explain.run(),
            Command::Lsp(lsp) => lsp.run(),
        }
    }
}
