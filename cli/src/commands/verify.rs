//! `fdcc verify`: what the controls of a solution do on the true system.

use super::options::{Changes, Gap, read};
use super::solver::{sha256, wrote};
use crate::exit::Exit;
use crate::failure::Failure;
use crate::output::saved::Saved;
use crate::output::verified::{VerifyDocument, VerifyPhasesDocument};
use crate::output::{self, files};
use crate::page;
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
    /// Write MODEL.verify.json and MODEL.verify.html to this folder
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
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
            Ok(document) => self.report(&document, &model),
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

    fn verify(&self, saved: &Saved, model: &Model) -> Result<Document, Failure> {
        let solved = model.changed(|meaning| {
            meaning.restore_params(&saved.params());
            Ok::<(), Error>(())
        })?;
        let source = model.source();
        let same_source = saved.source_sha256 == sha256(&source.text);
        if !same_source {
            output::complain(&format!(
                "{} is not the text that was solved; it is taken all the same",
                source.name
            ));
        }
        if !model.meaning().phases.is_empty() {
            return self.verify_phases(saved, &solved, same_source).map(Document::Phases);
        }
        let verified = solved.verify(&saved.record()).map_err(|it| self.failed(it))?;
        let gap = self.gap.of(&model.meaning().method);
        let document = VerifyDocument::new(&verified, saved.objective(), source, same_source, gap);
        let document = document.in_units(model.into());
        Ok(Document::One(document.of_solution(&saved.record(), &source.text)))
    }

    fn verify_phases(
        &self,
        saved: &Saved,
        model: &Model,
        same_source: bool,
    ) -> Result<VerifyPhasesDocument, Failure> {
        let record = saved.record();
        let (all, links) = model.verify_phases(&record).map_err(|it| self.failed(it))?;
        let gap = self.gap.of(&model.meaning().method);
        let phase = |(own, it): (Model, &fdcc::Verification)| {
            let document = VerifyDocument::new(it, None, model.source(), same_source, gap);
            (it.system.name.clone(), document.in_units((&own).into()))
        };
        let phases = model.phases().into_iter().zip(&all).map(phase).collect();
        let name = &model.meaning().name;
        let document =
            VerifyPhasesDocument::new((phases, &links), name, saved.objective(), same_source, gap);
        Ok(document.in_units(model.into()).of_solution(&record, &model.source().text))
    }

    fn failed(&self, error: Error) -> Failure {
        match error {
            Error::Record(what) => Failure::File(format!("{}: {what}", self.solution.display())),
            other => other.into(),
        }
    }

    fn report(&self, document: &Document, model: &Model) -> Exit {
        let (json, words, is_confirmed) = match document {
            Document::One(it) => (output::json(it), it.words(), it.is_confirmed()),
            Document::Phases(it) => (output::json(it), it.words(), it.is_confirmed()),
        };
        let written = match &self.out {
            Some(folder) => {
                let page = page::of(&json);
                let all = [("verify.json", json.clone()), ("verify.html", page)];
                files::write_all(folder, model.name(), &all)
            }
            None => Ok(Vec::new()),
        };
        output::print(if self.json { &json } else { &words });
        let exit = if is_confirmed { Exit::Fine } else { Exit::NotSolved };
        wrote(written, self.json, exit, model.source())
    }
}

/// Of a model of one piece, or of one with phases.
enum Document {
    One(VerifyDocument),
    Phases(VerifyPhasesDocument),
}
