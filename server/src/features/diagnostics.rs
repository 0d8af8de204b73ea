//! What is wrong with a text, pushed or pulled.

use crate::agreed::Agreed;
use crate::client::Failure;
use crate::context::Context;
use crate::documents::TextDocument;
use crate::pages;
use crate::snapshot::Snapshot;
use fdcc_grammar::{Code, Diagnostic, Label, Severity};
use lsp_types::{
    CodeDescription, DiagnosticRelatedInformation, DiagnosticSeverity, DiagnosticTag,
    DocumentDiagnosticParams, DocumentDiagnosticReport, FullDocumentDiagnosticReport, Location,
    PublishDiagnosticsParams, RelatedFullDocumentDiagnosticReport, Uri,
};

/// What is sent unasked.
pub fn publishable(document: &TextDocument, agreed: &Agreed) -> PublishDiagnosticsParams {
    let diagnostics = all(document, agreed);
    PublishDiagnosticsParams {
        uri: document.uri.clone(),
        version: Some(document.version),
        diagnostics,
    }
}

/// `textDocument/diagnostic`
pub fn report(
    context: &Context<'_>,
    _: DocumentDiagnosticParams,
) -> Result<DocumentDiagnosticReport, Failure> {
    let items = all(context.document, &context.state.agreed);
    let full = FullDocumentDiagnosticReport { result_id: None, items };
    Ok(RelatedFullDocumentDiagnosticReport::new(None, full).into())
}

fn all(document: &TextDocument, agreed: &Agreed) -> Vec<lsp_types::Diagnostic> {
    let snapshot = document.snapshot();
    let shown = |it| shown(it, snapshot, &document.uri, agreed);
    snapshot.diagnostics().iter().map(shown).collect()
}

/// A finding in the words of the protocol.
pub fn shown(
    found: &Diagnostic,
    snapshot: &Snapshot,
    uri: &Uri,
    agreed: &Agreed,
) -> lsp_types::Diagnostic {
    let related = |label: &Label| DiagnosticRelatedInformation {
        location: Location { uri: uri.clone(), range: snapshot.text.range(label.span) },
        message: label.text.clone(),
    };
    let others = &found.labels[1..];
    lsp_types::Diagnostic {
        range: snapshot.text.range(found.span()),
        severity: Some(severity(found.severity)),
        code: Some(found.code.as_str().to_owned().into()),
        code_description: pages::link(found.code).map(|href| CodeDescription { href }),
        source: Some("fdcc".into()),
        message: message(found).into(),
        tags: (found.code == Code::Unused).then(|| vec![DiagnosticTag::Unnecessary]),
        related_information: (agreed.related && !others.is_empty())
            .then(|| others.iter().map(related).collect()),
        data: None,
    }
}

/// What, why, and what to do about it.
fn message(found: &Diagnostic) -> String {
    let mut text = format!("{}\n{}", found.message, found.labels[0].text);
    if let Some(help) = &found.help {
        text += &format!("\nhelp: {help}");
    }
    text
}

fn severity(severity: Severity) -> DiagnosticSeverity {
    match severity {
        Severity::Error => DiagnosticSeverity::Error,
        Severity::Warning => DiagnosticSeverity::Warning,
        Severity::Advice => DiagnosticSeverity::Information,
    }
}
