//! Diagnostics as JSON. Lines and columns count from 1, columns in characters; an end is one past
//! the last character.

use fdcc_grammar::{Diagnostic, Edit, Fix, Severity, SourceFile, Span};
use serde::Serialize;

/// One diagnostic.
#[derive(Serialize)]
pub struct Entry<'d> {
    code: &'static str,
    severity: &'static str,
    message: &'d str,
    file: &'d str,
    #[serde(flatten)]
    place: TextRange,
    labels: Vec<LabelEntry<'d>>,
    help: Option<&'d str>,
    fixes: Vec<FixEntry<'d>>,
}

#[derive(Serialize)]
struct FixEntry<'d> {
    title: &'d str,
    /// Whether `fdcc fix` applies it without `--unsafe`.
    certain: bool,
    edits: Vec<EditEntry<'d>>,
}

#[derive(Serialize)]
struct EditEntry<'d> {
    span: TextRange,
    replacement: &'d str,
}

#[derive(Serialize)]
struct LabelEntry<'d> {
    span: TextRange,
    text: &'d str,
}

/// A range of the text as people count it.
#[derive(Serialize)]
struct TextRange {
    line: usize,
    column: usize,
    end_line: usize,
    end_column: usize,
}

/// The entry of a diagnostic in its file.
pub fn entry<'d>((source, diagnostic): (&'d SourceFile, &'d Diagnostic)) -> Entry<'d> {
    let labels = diagnostic.labels.iter();
    Entry {
        code: diagnostic.code.as_str(),
        severity: severity(diagnostic.severity),
        message: &diagnostic.message,
        file: &source.name,
        place: place(source, diagnostic.span()),
        labels: labels
            .map(|label| LabelEntry { span: place(source, label.span), text: &label.text })
            .collect(),
        help: diagnostic.help.as_deref(),
        fixes: diagnostic.fixes.iter().map(|fix| fix_entry(source, fix)).collect(),
    }
}

fn fix_entry<'d>(source: &SourceFile, fix: &'d Fix) -> FixEntry<'d> {
    let edit = |edit: &'d Edit| EditEntry {
        span: place(source, edit.span),
        replacement: &edit.replacement,
    };
    FixEntry {
        title: &fix.title,
        certain: fix.certain,
        edits: fix.edits.iter().map(edit).collect(),
    }
}

fn place(source: &SourceFile, span: Span) -> TextRange {
    let (start, end) = (source.line_column(span.start), source.line_column(span.end));
    TextRange { line: start.line, column: start.column, end_line: end.line, end_column: end.column }
}

/// `error`, `warning` or `advice`.
pub fn severity(severity: Severity) -> &'static str {
    match severity {
        Severity::Error => "error",
        Severity::Warning => "warning",
        Severity::Advice => "advice",
    }
}
