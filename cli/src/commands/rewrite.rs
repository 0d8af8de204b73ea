//! Commands that write model files anew: a file that cannot be read, or is no text, stays as it is.

use crate::exit::Exit;
use fdcc_grammar::{Diagnostic, SourceFile};

use crate::drawing::difference;
use crate::drawing::render::Renderer;
use crate::model;
use crate::output::{self, files};
use std::path::Path;

/// Does something with each text and returns the worst that came of it.
pub fn each(files: &[String], work: impl Fn(&str, &SourceFile) -> Exit) -> Exit {
    let one = |file: &String| match model::read(file) {
        Ok((source, None)) => work(file, &source),
        Ok((source, Some(diagnostic))) => refuse(&source, &[diagnostic]),
        Err(error) => complain(file, "read", &error),
    };
    files.iter().map(one).max().unwrap_or(Exit::Fine)
}

/// Puts a new text in the place of the old one; the standard input goes to the standard output.
pub fn replace(file: &str, source: &SourceFile, text: &str) -> Exit {
    if file == "-" {
        output::print(text);
    } else if *source.text != *text
        && let Err(error) = files::replace(Path::new(file), text)
    {
        return complain(file, "written", &error);
    }
    Exit::Fine
}

/// Prints what would change.
pub fn show(source: &SourceFile, text: &str) {
    output::print(&difference::unified(&source.name, &source.text, text));
}

/// Says why a text is left alone.
pub fn refuse(source: &SourceFile, diagnostics: &[Diagnostic]) -> Exit {
    let renderer = Renderer::for_stderr();
    diagnostics.iter().for_each(|it| output::tell(&renderer.render(it, source)));
    output::complain(&format!("{} is left as it is", source.name));
    Exit::ModelError
}

fn complain(file: &str, verb: &str, error: &std::io::Error) -> Exit {
    output::complain(&format!("{file} cannot be {verb}: {error}"));
    Exit::File
}
