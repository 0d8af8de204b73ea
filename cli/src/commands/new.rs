//! `fdcc new`: a commented model to start from. Never overwrites.

use crate::exit::Exit;
use clap::{Args, ValueEnum};
use fdcc_grammar::parse;
use std::io;
use std::path::{Path, PathBuf};

use crate::output::{self, files};

/// Write a commented model to start from
#[derive(Args)]
pub struct New {
    /// What it is about; without it, the templates are listed
    #[arg(value_enum)]
    template: Option<Template>,
    /// The file, or a folder for it; TEMPLATE.fdc if left out
    path: Option<PathBuf>,
}

#[derive(Clone, Copy, ValueEnum)]
enum Template {
    /// A slide with dry friction, moved with little effort
    Friction,
    /// A small car on a bend, driven with little effort
    Racecar,
    /// A motor that changes at a speed, in the shortest time
    Switched,
    /// A ball that bounces, and how it is thrown best
    Bounce,
    /// A friction coefficient from measurements
    Fit,
}

impl Template {
    fn name(self) -> &'static str {
        match self {
            Template::Friction => "friction",
            Template::Racecar => "racecar",
            Template::Switched => "switched",
            Template::Bounce => "bounce",
            Template::Fit => "fit",
        }
    }

    fn text(self) -> &'static str {
        match self {
            Template::Friction => include_str!("../../templates/friction.fdc"),
            Template::Racecar => include_str!("../../templates/racecar.fdc"),
            Template::Switched => include_str!("../../templates/switched.fdc"),
            Template::Bounce => include_str!("../../templates/bounce.fdc"),
            Template::Fit => include_str!("../../templates/fit.fdc"),
        }
    }
}

impl New {
    /// Writes the file and says what to do next.
    pub fn run(self) -> Exit {
        let Some(template) = self.template else {
            output::tell(&templates());
            return Exit::Usage;
        };
        let path = file(self.path, template);
        match files::create(&path, &named_after(&path, template)) {
            Ok(()) => {
                let path = path.display();
                output::print(&format!(
                    "wrote {path}\n\nnext:\n  fdcc check {path}\n  fdcc solve {path}\n"
                ));
                Exit::Fine
            }
            Err(error) if error.kind() == io::ErrorKind::AlreadyExists => {
                output::complain(&format!("{} exists already; name another file", path.display()));
                Exit::File
            }
            Err(error) => {
                output::complain(&format!("{} cannot be written: {error}", path.display()));
                Exit::File
            }
        }
    }
}

/// A line for each template.
fn templates() -> String {
    let line = |template: &Template| {
        let described = template.to_possible_value()?.get_help()?.to_string();
        Some(format!("  {:<10}{described}\n", template.name()))
    };
    let lines: String = Template::value_variants().iter().filter_map(line).collect();
    format!("name a template, as in `fdcc new friction`:\n{lines}")
}

/// Where the model goes.
fn file(path: Option<PathBuf>, template: Template) -> PathBuf {
    let usual = format!("{}.fdc", template.name());
    match path {
        Some(folder) if folder.is_dir() => folder.join(usual),
        Some(file) => file,
        None => usual.into(),
    }
}

/// The template with the file's name for the model, if that can be a name.
fn named_after(path: &Path, template: Template) -> String {
    let (name, text) = (template.name(), template.text());
    let Some(stem) = path.file_stem().and_then(|stem| stem.to_str()) else {
        return text.to_owned();
    };
    let named = text.replace(&format!("model {name}\n"), &format!("model {stem}\n"));
    let named = named.replace(&format!("{name}.fdc"), &format!("{stem}.fdc"));
    if parse(&named).diagnostics.is_empty() { named } else { text.to_owned() }
}
