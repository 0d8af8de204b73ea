//! The commands, one file each, and what they share: options, and a solve.

mod accuracy;
mod check;
mod completions;
mod driven;
mod emit;
mod explain;
mod fix;
mod fmt;
mod grad;
mod lsp;
mod man;
mod merge;
mod mpc;
mod new;
mod options;
mod plot;
mod report;
mod rewrite;
mod show;
mod simulate;
mod solve;
pub mod solver;
mod sweep;
mod test;
mod verify;
mod written;

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
    Mpc(Box<mpc::Mpc>),
    Report(report::Report),
    Plot(plot::Plot),
    Sweep(Box<sweep::Sweep>),
    Merge(merge::Merge),
    Test(Box<test::Test>),
    Show(show::Show),
    Emit(emit::Emit),
    Fix(fix::Fix),
    Fmt(fmt::Fmt),
    New(new::New),
    Explain(explain::Explain),
    Lsp(lsp::Lsp),
    Completions(completions::Completions),
    Man(man::Man),
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
            Command::Mpc(mpc) => mpc.run(),
            Command::Report(report) => report.run(),
            Command::Plot(plot) => plot.run(),
            Command::Sweep(sweep) => sweep.run(),
            Command::Merge(merge) => merge.run(),
            Command::Test(test) => test.run(),
            Command::Show(show) => show.run(),
            Command::Emit(emit) => emit.run(),
            Command::Fix(fix) => fix.run(),
            Command::Fmt(fmt) => fmt.run(),
            Command::New(new) => new.run(),
            Command::Explain(explain) => explain.run(),
            Command::Lsp(lsp) => lsp.run(),
            Command::Completions(completions) => completions.run(),
            Command::Man(man) => man.run(),
        }
    }
}
