//! The regions of a text that could not be parsed, and the findings that may follow from them.

use fdcc_grammar::{Code, Diagnostic, SourceFile, Span};

/// The regions of a text that could not be parsed. A finding that may follow from them is left out.
pub(crate) struct UnparsedRegions<'t> {
    /// The texts of the items that were given up.
    lost: Vec<&'t str>,
    /// The lines on which something is wrong already.
    lines: Vec<usize>,
    source: &'t SourceFile,
}

impl<'t> UnparsedRegions<'t> {
    /// What is lost of a text, and what has been told about it.
    pub fn new(source: &'t SourceFile, told: &[Diagnostic], lost: &[Span]) -> Self {
        let line = |it: &Diagnostic| source.line_column(it.span().start).line;
        UnparsedRegions {
            lost: lost.iter().map(|span| source.slice(*span)).collect(),
            lines: told.iter().map(line).collect(),
            source,
        }
    }

    /// Whether something that could not be read may be the reason of a finding.
    pub fn may_be_behind(&self, found: &Diagnostic) -> bool {
        let name = self.source.slice(found.span());
        let is_absence = match found.code {
            // Without its head the inside of a phase lies outside.
            Code::DuplicateName => {
                self.lost.iter().any(|item| item.contains('{') || item.starts_with("phase"))
            }
            Code::UnknownName | Code::UnknownPart => {
                self.lost.iter().any(|item| item.contains(name) || has_no_name(item))
            }
            // A guess that is not there: its line is broken.
            Code::NotAllowedHere => self.lines.iter().any(|line| self.may_guess(*line, name)),
            Code::NoDuration => !self.lost.is_empty(),
            Code::UnitMismatch | Code::UnitHere | Code::UnitOfPower | Code::BareNumber => {
                self.is_about_lost_name(found)
            }
            code => {
                matches!(code, Code::NoBoundary | Code::NoEquation | Code::NoTime | Code::Unused)
            }
        };
        is_absence || self.lines.contains(&self.source.line_column(found.span().start).line)
    }
}

impl UnparsedRegions<'_> {
    /// Whether a finding is about a name that a broken line declares.
    fn is_about_lost_name(&self, found: &Diagnostic) -> bool {
        let lines = self.lines.iter().filter_map(|line| self.source.text.lines().nth(line - 1));
        let declared: Vec<&str> = lines.filter_map(|line| words(line).nth(1)).collect();
        let spoken_of = found.labels.iter().flat_map(|label| words(self.source.slice(label.span)));
        spoken_of.into_iter().any(|word| declared.contains(&word))
    }

    /// Whether a line may be the guess of a name.
    fn may_guess(&self, line: usize, name: &str) -> bool {
        let text = self.source.text.lines().nth(line - 1).unwrap_or_default().trim_start();
        text.starts_with(name) || text.starts_with('=')
    }
}

/// Names and other words of a text.
fn words(text: &str) -> impl Iterator<Item = &str> {
    text.split(|c: char| !c.is_alphanumeric() && c != '_').filter(|word| !word.is_empty())
}

/// Words that stand behind a name and not for one.
const BEHIND_A_NAME: &[&str] = &["in", "start", "guess"];

/// Whether an item has no name behind its word: `param = 2`.
fn has_no_name(item: &str) -> bool {
    let behind = item.trim_start().trim_start_matches(char::is_alphabetic).trim_start();
    let end = behind.find(|c: char| !c.is_alphanumeric() && c != '_').unwrap_or(behind.len());
    end == 0 || BEHIND_A_NAME.contains(&&behind[..end])
}
