//! Claims: comments in a model that say which diagnostic begins on their line.
//!
//! ```text
//! v' = F m    # error[FDC0001] missing operator
//! ```
//!
//! The words after the bracket, if there are any, stand in the message. Every diagnostic must be
//! claimed and every claim met. Severities are `error`, `warning` and `advice`.

use fdcc_grammar::{Diagnostic, Severity, SourceFile};

/// What is claimed and not found, and what is found and not claimed; empty if all is well.
pub fn unclaimed(text: &str, diagnostics: &[Diagnostic]) -> Vec<String> {
    let source = SourceFile::new("model.fdc", text);
    let mut found: Vec<(usize, &Diagnostic)> = diagnostics
        .iter()
        .map(|diagnostic| (source.line_column(diagnostic.span().start).line, diagnostic))
        .collect();
    let mut problems = Vec::new();
    for claim in claims(text) {
        match found.iter().position(|(line, diagnostic)| claim.is_met_by(*line, diagnostic)) {
            Some(at) => drop(found.remove(at)),
            None => problems.push(format!("line {}: claimed but not found: {claim:?}", claim.line)),
        }
    }
    let surplus = |(line, diagnostic): &(usize, &Diagnostic)| {
        format!("line {line}: not claimed: {diagnostic:#?}")
    };
    problems.extend(found.iter().map(surplus));
    problems
}

#[derive(Debug)]
struct Claim<'t> {
    line: usize,
    severity: Severity,
    code: &'t str,
    message: &'t str,
}

impl Claim<'_> {
    fn is_met_by(&self, line: usize, diagnostic: &Diagnostic) -> bool {
        self.line == line
            && self.severity == diagnostic.severity
            && self.code == diagnostic.code.as_str()
            && diagnostic.message.contains(self.message)
    }
}

fn claims(text: &str) -> Vec<Claim<'_>> {
    text.lines().enumerate().flat_map(|(at, line)| claims_of_line(at + 1, line)).collect()
}

/// A line may carry several claims, each after its own `#`.
fn claims_of_line(line: usize, text: &str) -> impl Iterator<Item = Claim<'_>> {
    text.split("# ").skip(1).filter_map(move |part| read_claim(line, part))
}

fn read_claim(line: usize, text: &str) -> Option<Claim<'_>> {
    let (severity, rest) = text.split_once('[')?;
    let severity = match severity {
        "error" => Severity::Error,
        "warning" => Severity::Warning,
        "advice" => Severity::Advice,
        _ => return None,
    };
    let (code, message) = rest.split_once(']')?;
    Some(Claim { line, severity, code, message: message.trim() })
}
