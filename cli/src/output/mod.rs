//! Everything that leaves the program: types for JSON, and the two streams.

pub mod control;
pub mod csv;
pub mod diagnostics;
pub mod document;
pub mod ending;
pub mod files;
pub mod gradient;
mod gradient_words;
pub mod html;
pub mod named;
pub mod number;
pub mod optimality;
pub mod plot;
pub mod sarif;
pub mod saved;
pub mod simulation;
pub mod table;
pub mod tested;
pub mod tried;
pub mod units;
pub mod verified;
pub mod words;

use std::io::{IsTerminal, Write};

use serde::Serialize;

/// Prints to the standard output. A reader that has gone away, as in `fdcc check ... | head`, is no error.
pub fn print(text: &str) {
    let _ = std::io::stdout().write_all(text.as_bytes());
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
