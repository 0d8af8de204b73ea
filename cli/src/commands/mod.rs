//! The commands, one file each, and what they share: options, and a solve.

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
pub mod solver;
mod sweep;
mod test;
mod verify;

pub use options::USUAL_GAP;

use crate::exit::Exit;
use clap::Subcommand;

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
