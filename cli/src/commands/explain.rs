//! `fdcc explain`: why a diagnostic is given, a wrong model and a right one; what a verdict says.

use crate::exit::Exit;
use clap::Args;
use fdcc_grammar::Code;

use crate::output::{self, manual};

/// Explain a diagnostic, with a wrong and a right model, or what a verdict says
#[derive(Args)]
pub struct Explain {
    /// Such as FDC0101 or 101; or `verdict`
    code: String,
}

/// What each line says at the end of a solve.
const VERDICT: &str = include_str!("../../../docs/reference/verdict.md");

impl Explain {
    /// Prints the page of the code.
    pub fn run(self) -> Exit {
        if self.code.eq_ignore_ascii_case("verdict") {
            output::print(&manual::for_terminal(VERDICT));
            return Exit::Fine;
        }
        match self.code.parse::<Code>() {
            Ok(code) => {
                output::print(&manual::for_terminal(code.page()));
                Exit::Fine
            }
            Err(()) => {
                output::complain(&format!(
                    "there is no diagnostic `{}`\n{}",
                    self.code,
                    similar(&self.code)
                ));
                Exit::Usage
            }
        }
    }
}

/// The codes of the group that was meant, or all; the verdict where that was.
fn similar(code: &str) -> String {
    if code.to_ascii_lowercase().starts_with("ver") {
        return "did you mean `fdcc explain verdict`?".into();
    }
    let digits: String = code.chars().filter(char::is_ascii_digit).collect();
    let prefix = format!("FDC{}", digits.get(..2).unwrap_or_default());
    let same_group = |code: &&Code| code.as_str().starts_with(&prefix);
    let mut codes: Vec<Code> = Code::ALL.iter().filter(same_group).copied().collect();
    if codes.is_empty() {
        codes = Code::ALL.to_vec();
    }
    let lines = codes.iter().map(|code| format!("\n  {code}  {}", code.title()));
    format!("did you mean one of these?{}", lines.collect::<String>())
}
