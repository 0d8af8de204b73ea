//! What a command changed in a file, as a unified difference. The only file that names similar.

use similar::TextDiff;
use std::io::IsTerminal;

const RED: &str = "\x1b[31m";
const GREEN: &str = "\x1b[32m";
const PLAIN: &str = "\x1b[0m";

/// The lines that differ with three lines around them; in colour where the standard output shows
/// colours.
pub fn unified(name: &str, before: &str, after: &str) -> String {
    let difference = TextDiff::from_lines(before, after);
    let mut unified = difference.unified_diff();
    let plain = unified.context_radius(3).header(name, name).to_string();
    if has_colours() { plain.lines().map(coloured).collect() } else { plain }
}

fn has_colours() -> bool {
    let no_color = std::env::var_os("NO_COLOR").is_some_and(|value| !value.is_empty());
    std::io::stdout().is_terminal() && !no_color
}

fn coloured(line: &str) -> String {
    match line.chars().next() {
        Some('-') => format!("{RED}{line}{PLAIN}\n"),
        Some('+') => format!("{GREEN}{line}{PLAIN}\n"),
        _ => format!("{line}\n"),
    }
}
