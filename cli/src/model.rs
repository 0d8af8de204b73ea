//! A model file, read and checked.

use std::fs::File;
use std::io::{self, Read};

use fdcc_compiler::Model;
use fdcc_grammar::{Code, Diagnostic, Severity, SourceFile, Span, parse};

/// A model file with everything that is known about it.
pub struct Loaded {
    /// The text.
    pub source: SourceFile,
    /// What it means, if it has no error.
    pub model: Option<Model>,
    /// What is wrong with it, in the order of the text.
    pub diagnostics: Vec<Diagnostic>,
}

/// More is not even read; the parser complains about far less.
const MOST_BYTES: u64 = 64 << 20;

impl Loaded {
    /// Reads and checks a file; `-` is the standard input.
    pub fn read(path: &str) -> io::Result<Loaded> {
        let mut bytes = Vec::new();
        match path {
            "-" => io::stdin().take(MOST_BYTES).read_to_end(&mut bytes)?,
            _ => File::open(path)?.take(MOST_BYTES).read_to_end(&mut bytes)?,
        };
        let name = if path == "-" { "<stdin>" } else { path };
        Ok(match String::from_utf8(bytes) {
            Ok(text) => Loaded::check(SourceFile::new(name, text)),
            Err(error) => Loaded::not_text(name, &error),
        })
    }

    fn check(source: SourceFile) -> Loaded {
        let parsed = parse(&source.text);
        let mut diagnostics = parsed.diagnostics;
        let mut model = None;
        if !parsed.tree.items.is_empty() {
            let is_broken = !diagnostics.is_empty();
            let checked = fdcc_compiler::check(&parsed.tree);
            model = checked.model.filter(|_| !is_broken);
            let trusted = |it: &Diagnostic| !is_broken || !is_about_absence(&source.text, it);
            diagnostics.extend(checked.diagnostics.into_iter().filter(trusted));
        }
        diagnostics.retain(|diagnostic| !is_allowed(&source.text, diagnostic));
        diagnostics.sort_by_key(Diagnostic::span);
        Loaded { source, model, diagnostics }
    }

    fn not_text(name: &str, error: &std::string::FromUtf8Error) -> Loaded {
        let at = error.utf8_error().valid_up_to();
        let text = String::from_utf8_lossy(error.as_bytes()).into_owned();
        let span = Span::new(at, at + char::REPLACEMENT_CHARACTER.len_utf8());
        let diagnostic =
            Diagnostic::new(Code::NotText, "this is not a text file", span, "no character of UTF-8")
                .help("a model is plain text in UTF-8");
        Loaded { source: SourceFile::new(name, text), model: None, diagnostics: vec![diagnostic] }
    }
}

/// Whether a finding says that something is not there, though it may be in the part of the text that cannot be read.
fn is_about_absence(text: &str, diagnostic: &Diagnostic) -> bool {
    match diagnostic.code {
        Code::UnknownName => is_second_word(text, &text[diagnostic.span().range()]),
        code => matches!(code, Code::NoBoundary | Code::NoEquation | Code::NoTime | Code::Unused),
    }
}

/// Whether a line has a name where a declaration has it.
fn is_second_word(text: &str, name: &str) -> bool {
    let second = |line: &str| {
        let mut words =
            line.split(|c: char| !c.is_alphanumeric() && c != '_').filter(|word| !word.is_empty());
        words.nth(1) == Some(name)
    };
    text.lines().any(second)
}

/// Whether the line above says `# fdc: allow FDC0404`, perhaps with other codes. Errors cannot be allowed.
fn is_allowed(text: &str, diagnostic: &Diagnostic) -> bool {
    let before = text[..diagnostic.span().start as usize].trim_end_matches(|c| c != '\n');
    let above = before.trim_end().rsplit('\n').next().unwrap_or_default();
    let allowed = above
        .rsplit_once("# fdc: allow ")
        .is_some_and(|(_, codes)| codes.split_whitespace().any(|code| code == diagnostic.code.as_str()));
    allowed && diagnostic.severity != Severity::Error
}
