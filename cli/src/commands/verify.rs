//! `fdcc verify`: what the controls of a solution do on the true system.

use super::options::{Changes, Gap, read};
use super::solver::sha256;
use crate::exit::Exit;
use crate::failure::Failure;
use crate::output;
use crate::output::saved::Saved;
use crate::output::verified::VerifyDocument;
use clap::Args;
use fdcc::{Error, Model};
use fdcc_grammar::SourceFile;
use std::path::{Path, PathBuf};

/// Replay the controls of a solution on the true system
#[derive(Args)]
pub struct Verify {
    /// The .sol.json of a solve
    #[arg(value_name = "SOLUTION")]
    solution: PathBuf,
    /// Its model; if left out, NAME.fdc beside the solution or in the current folder
    #[arg(value_name = "MODEL")]
    model: Option<String>,
    #[command(flatten)]
    gap: Gap,
    /// Print the result as one JSON document, and nothing else, on the standard output
    #[arg(long)]
    json: bool,
}

impl Verify {
    /// Verifies and reports.
    pub fn run(self) -> Exit {
        let found = Saved::read(&self.solution).and_then(|saved| Ok((self.file(&saved)?, saved)));
        let (file, saved) = match found {
            Ok(found) => found,
            Err(failure) => {
                return failure.report(&SourceFile::new(self.solution.display().to_string(), ""));
            }
        };
        let model = match read(&file, &Changes::default()) {
            Ok(model) => model,
            Err(exit) => return exit,
        };
        match self.verify(&saved, &model) {
            Ok(document) => self.report(&document),
            Err(failure) => failure.report(model.source()),
        }
    }

    /// The file of the model.
    fn file(&self, saved: &Saved) -> Result<String, Failure> {
        if let Some(model) = &self.model {
            return Ok(model.clone());
        }
        let name = format!("{}.fdc", saved.model);
        let beside = self.solution.parent().unwrap_or(Path::new("")).join(&name);
        let candidates = [beside, PathBuf::from(&name)];
        let found = candidates.iter().find(|path| path.is_file());
        found.map(|path| path.display().to_string()).ok_or_else(|| {
            let solution = self.solution.display();
            Failure::File(format!(
                "{solution}: its model {name} is neither beside it nor here; name the file"
            ))
        })
    }

    fn verify(&self, saved: &Saved, model: &Model) -> Result<VerifyDocument, Failure> {
        let solved = model.changed(|meaning| {
            meaning.restore_params(&saved.params());
            Ok::<(), Error>(())
        })?;
        let verified = solved.verify(&saved.record()).map_err(|error| match error {
            Error::Record(what) => Failure::File(format!("{}: {what}", self.solution.display())),
            other => other.into(),
        })?;
        let source = model.source();
        let same_source = saved.source_sha256 == sha256(&source.text);
        if !same_source {
            output::complain(&format!(
                "{} is not the text that was solved; it is taken all the same",
                source.name
            ));
        }
        let gap = self.gap.of(&model.meaning().method);
        let document = VerifyDocument::new(&verified, saved.objective(), source, same_source, gap);
        Ok(document.in_units(model.meaning().into()))
    }

    fn report(&self, document: &VerifyDocument) -> Exit {
        output::print(&if self.json { output::json(document) } else { document.words() });
        if document.is_confirmed() { Exit::Fine } else { Exit::NotSolved }
    }
}
