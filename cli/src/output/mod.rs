//! Everything that leaves the program: types for JSON, and the two streams.

pub mod certificate;
pub mod closed_loop;
pub mod control;
pub mod convergence;
pub mod csv;
pub mod derivatives;
pub mod diagnostics;
pub mod document;
pub mod ending;
pub mod estimates;
pub mod files;
pub mod gradient;
pub mod gradient_words;
pub mod hamiltonian_check;
pub mod manual;
mod method_used;
pub mod modes;
pub mod named;
pub mod number;
pub mod optimality;
pub mod phases;
pub mod picture;
pub mod plots;
pub mod reach;
pub mod rows;
pub mod sarif;
pub mod saved;
pub mod sequence;
pub mod simulation;
pub mod simulation_of_phases;
pub mod table;
pub mod tested;
pub mod tried;
pub mod units;
pub mod verification;
pub mod verified;
pub mod whole;
mod wrap;

use crate::exit::Exit;
use std::io::{ErrorKind, IsTerminal, Write};
use std::sync::OnceLock;

use serde::Serialize;

/// Why nothing more is printed.
static UNPRINTED: OnceLock<std::io::Error> = OnceLock::new();

/// Prints to the standard output. Where that fails, [`ended`] says so in the end: a command still
/// writes its files.
pub fn print(text: &str) {
    if UNPRINTED.get().is_none() {
        let mut stream = std::io::stdout();
        let printed = stream.write_all(text.as_bytes()).and_then(|()| stream.flush());
        note(printed);
    }
}

/// The same with lines that go on between words where a terminal ends.
pub fn print_lines(text: &str) {
    print(&wrap::for_terminal(text));
}

/// Remembers the first failure of the standard output.
pub fn note(printed: std::io::Result<()>) {
    if let Err(error) = printed {
        let _ = UNPRINTED.set(error);
    }
}

/// Whether nobody reads the standard output any more.
pub fn is_closed() -> bool {
    UNPRINTED.get().is_some()
}

/// How a command ends that would have ended so. A reader that has gone away, as in `fdcc check ...
/// | head`, has seen what it wanted; a disk that is full has lost the result.
pub fn ended(exit: Exit) -> Exit {
    match UNPRINTED.get() {
        None => exit,
        Some(error) if error.kind() == ErrorKind::BrokenPipe => Exit::Fine,
        Some(error) => {
            complain(&format!("cannot write to the standard output: {error}"));
            Exit::File
        }
    }
}

/// Prints to the standard error, which may have been closed just as well.
pub fn tell(text: &str) {
    let _ = std::io::stderr().write_all(text.as_bytes());
}

/// Begins a new screen where the standard output is a terminal.
pub fn clear_terminal() {
    if std::io::stdout().is_terminal() {
        print("\x1b[2J\x1b[3J\x1b[H");
    }
}

/// Says on the standard error why something was not done.
pub fn complain(text: &str) {
    tell(&format!("fdcc: {text}\n"));
}

/// `1 state`, `2 states`.
pub fn plural(number: usize, noun: &str) -> String {
    format!("{number} {noun}{}", if number == 1 { "" } else { "s" })
}

/// Indented JSON with a line end. A number that is not finite becomes `null`.
pub fn json(value: &impl Serialize) -> String {
    serde_json::to_string_pretty(value).expect("our own types have text keys only") + "\n"
}
