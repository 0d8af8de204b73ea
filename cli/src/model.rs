//! A model file, read and checked.

use std::fs::File;
use std::io::{self, Read};

use fdcc_compiler::{Analysis, Model, analyze};
use fdcc_grammar::{Code, Diagnostic, SourceFile, Span};
use fdcc_runtime::nlp::Stop;

use crate::watch::Deadline;

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
    /// The same, unless it takes too long.
    pub fn within(deadline: Deadline, path: &str) -> Result<io::Result<Loaded>, Stop> {
        let path = path.to_owned();
        deadline.within(move || Loaded::read(&path))
    }

    /// Reads and checks a file; `-` is the standard input.
    fn read(path: &str) -> io::Result<Loaded> {
        let (source, not_text) = read(path)?;
        if let Some(diagnostic) = not_text {
            return Ok(Loaded { source, model: None, diagnostics: vec![diagnostic] });
        }
        let Analysis { model, diagnostics, .. } = analyze(&source.text);
        Ok(Loaded { source, model, diagnostics })
    }
}

/// The text of a file, and what is wrong if it is none.
pub fn read(path: &str) -> io::Result<(SourceFile, Option<Diagnostic>)> {
    let mut bytes = Vec::new();
    match path {
        "-" => io::stdin().take(MOST_BYTES).read_to_end(&mut bytes)?,
        _ => File::open(path)?.take(MOST_BYTES).read_to_end(&mut bytes)?,
    };
    let name = if path == "-" { "<stdin>" } else { path };
    Ok(match String::from_utf8(bytes) {
        Ok(text) => (SourceFile::new(name, text), None),
        Err(error) => not_text(name, &error),
    })
}

fn not_text(name: &str, error: &std::string::FromUtf8Error) -> (SourceFile, Option<Diagnostic>) {
    let at = error.utf8_error().valid_up_to();
    let text = String::from_utf8_lossy(error.as_bytes()).into_owned();
    let span = Span::new(at, at + char::REPLACEMENT_CHARACTER.len_utf8());
    let diagnostic =
        Diagnostic::new(Code::NotText, "this is not a text file", span, "no character of UTF-8")
            .help("a model is plain text in UTF-8");
    (SourceFile::new(name, text), Some(diagnostic))
}
