//! The command `fdcc`.

use std::process::ExitCode;

/// Blocks of memory up to this size are kept when they are given back.
const KEPT: usize = 16 << 20;

fn main() -> ExitCode {
    keep_memory();
    fdcc_cli::run()
}

/// The allocator of Linux hands large blocks back to the system, which clears every page anew when
/// the next solve asks for it: 2 to 7 % of the time of a short solve. It learns from the first
/// large block that is given back to keep blocks up to that size. This one is never touched, and
/// costs nothing.
fn keep_memory() {
    drop(std::hint::black_box(Vec::<u8>::with_capacity(KEPT)));
}
