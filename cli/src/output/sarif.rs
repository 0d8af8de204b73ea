//! Diagnostics in SARIF 2.1.0, the format of code scanning services.

use fdcc_grammar::{Code, Diagnostic, Edit, Fix, Severity, SourceFile, Span};
use serde_json::{Value, json};

/// One run of `fdcc check`.
pub fn log<'d>(found: impl Iterator<Item = (&'d SourceFile, &'d Diagnostic)>) -> Value {
    let rule =
        |code: &Code| json!({ "id": code.as_str(), "shortDescription": { "text": code.title() } });
    let rules: Vec<Value> = Code::ALL.iter().map(rule).collect();
    let results: Vec<Value> =
        found.map(|(source, diagnostic)| result(source, diagnostic)).collect();
    let driver = json!({ "name": "fdcc", "version": crate::version::VERSION, "rules": rules });
    json!({
        "$schema": "https://json.schemastore.org/sarif-2.1.0.json",
        "version": "2.1.0",
        "runs": [{
            "tool": { "driver": driver },
            "columnKind": "unicodeCodePoints",
            "results": results,
        }],
    })
}

fn result(source: &SourceFile, diagnostic: &Diagnostic) -> Value {
    let related = |label: &fdcc_grammar::Label| {
        let mut place = location(source, label.span);
        place["message"] = json!({ "text": label.text });
        place
    };
    let help = diagnostic.help.as_ref().map_or(String::new(), |help| format!("\n{help}"));
    let mut result = json!({
        "ruleId": diagnostic.code.as_str(),
        "level": level(diagnostic.severity),
        "message": { "text": format!("{}{help}", diagnostic.message) },
        "locations": [location(source, diagnostic.span())],
        "relatedLocations": diagnostic.labels.iter().map(related).collect::<Vec<_>>(),
    });
    if !diagnostic.fixes.is_empty() {
        result["fixes"] = diagnostic.fixes.iter().map(|it| fix(source, it)).collect();
    }
    result
}

fn fix(source: &SourceFile, fix: &Fix) -> Value {
    let replacement = |edit: &Edit| {
        let inserted = json!({ "text": edit.replacement });
        json!({ "deletedRegion": region(source, edit.span), "insertedContent": inserted })
    };
    let replacements: Vec<Value> = fix.edits.iter().map(replacement).collect();
    let artifact = json!({ "uri": source.name });
    json!({
        "description": { "text": fix.title },
        "artifactChanges": [{ "artifactLocation": artifact, "replacements": replacements }],
    })
}

fn location(source: &SourceFile, span: Span) -> Value {
    let artifact = json!({ "uri": source.name });
    json!({ "physicalLocation": { "artifactLocation": artifact, "region": region(source, span) } })
}

fn region(source: &SourceFile, span: Span) -> Value {
    let (start, end) = (source.line_column(span.start), source.line_column(span.end));
    json!({
        "startLine": start.line,
        "startColumn": start.column,
        "endLine": end.line,
        "endColumn": end.column,
    })
}

fn level(severity: Severity) -> &'static str {
    match severity {
        Severity::Error => "error",
        Severity::Warning => "warning",
        Severity::Advice => "note",
    }
}
