//! `fdcc test`: solves models and compares the solutions with their `expect` blocks.

use super::options::{Options, prepare, show};
use super::solver;
use super::written;
use crate::exit::Exit;
use crate::failure::Failure;
use crate::output;
use crate::output::tested::{Line, Tested, Word};
use crate::output::units::Units;
use crate::report::failure;
use crate::report::log::Level;
use crate::solved::Solved;
use crate::watch::catch_interrupts;
use clap::Args;
use fdcc::names::is_solved;
use fdcc::{Expectation, Expected, Model, Sides};
use std::time::Instant;

/// Solve models and check what their `expect` blocks say
#[derive(Args)]
pub struct Test {
    /// Models; `-` is the standard input
    #[arg(required = true, value_name = "FILE")]
    files: Vec<String>,
    #[command(flatten)]
    options: Options,
}

impl Test {
    /// Tests each file; an error in one does not keep the others from being tested.
    pub fn run(self) -> Exit {
        catch_interrupts();
        let mut exit = Exit::Fine;
        let mut all = Vec::new();
        for file in &self.files {
            match self.test(file) {
                Ok(tested) => {
                    exit = exit.max(tested.exit());
                    if !self.options.json {
                        output::print(&tested.lines());
                    }
                    all.push(tested);
                }
                Err(worse) => exit = exit.max(worse),
            }
        }
        output::print(&if self.options.json { output::json(&all) } else { summary(&all) });
        exit
    }

    fn test(&self, file: &str) -> Result<Tested, Exit> {
        let begin = Instant::now();
        let checked = prepare(file, &self.options)?;
        let model = checked.name().to_owned();
        if checked.meaning().expectations.is_empty() {
            let (expectations, units) = (Vec::new(), Units::default());
            return Ok(Tested { file: file.into(), model, status: None, expectations, units });
        }
        let solved =
            self.solve(&checked, begin).map_err(|failure| failure.report(checked.source()))?;
        show(failure::diagnostic(&solved).iter(), checked.source());
        let found = solved.solution.expectations();
        // What a solve did not reach is no news about the model.
        let found = found.into_iter().filter(|_| solved.is_good());
        let units = solved.document.units.clone();
        let expectations = found.map(|it| line(it, &checked)).collect();
        Ok(Tested {
            file: file.into(),
            model,
            status: Some(solved.document.status),
            expectations,
            units,
        })
    }

    fn solve(&self, model: &Model, begin: Instant) -> Result<Solved, Failure> {
        let solved = solver::solve(model, &self.options, begin, Level::None, |_| {})?;
        if let Some(folder) = &self.options.out {
            written::write(&solved.document, folder, &solved.document.model)?;
        }
        Ok(solved)
    }
}

fn line(found: Expectation, model: &Model) -> Line {
    let Expectation { origin, outcome } = found;
    let line = model.source().line_column(origin.span.0).line;
    let text = origin.label.to_string();
    match outcome {
        Expected::Untold(why) => Line {
            line,
            text,
            outcome: Word::Failed,
            left: None,
            right: None,
            tolerance: None,
            why: Some(why),
        },
        Expected::Compared(Sides { left, right, tolerance, holds }) => {
            let outcome = if holds { Word::Ok } else { Word::Failed };
            let [left, right, tolerance] = [left, right, tolerance].map(Some);
            Line { line, text, outcome, left, right, tolerance, why: None }
        }
    }
}

impl Tested {
    fn is_solved(&self) -> bool {
        self.status.as_deref().is_none_or(is_solved)
    }

    fn count(&self, outcome: Word) -> usize {
        self.expectations.iter().filter(|it| it.outcome == outcome).count()
    }

    fn exit(&self) -> Exit {
        if self.is_solved() && self.count(Word::Failed) == 0 { Exit::Fine } else { Exit::NotSolved }
    }

    /// One line for each expectation, or one that says why there is none.
    fn lines(&self) -> String {
        let file = &self.file;
        match &self.status {
            None => format!("{file}: nothing is expected\n"),
            Some(status) if !self.is_solved() => {
                format!("{file}: not solved: {}\n", status.replace('_', " "))
            }
            _ => self
                .expectations
                .iter()
                .map(|it| format!("{file}:{}: {}\n", it.line, it.words(&self.units)))
                .collect(),
        }
    }
}

impl Line {
    /// `ok       x(end) == 1 within 1e-3   (1.0002, 1)`
    fn words(&self, units: &Units) -> String {
        let Line { text, .. } = self;
        let digits = |value: Option<f64>| units.violation(text, value.unwrap_or(f64::NAN), 9);
        let [left, right, tolerance] = [self.left, self.right, self.tolerance].map(digits);
        match (self.outcome, &self.why) {
            (Word::Ok, _) => format!("ok       {text}   (left {left}, right {right})"),
            (Word::Failed, None) => {
                format!("FAILED   {text}   (left {left}, right {right}, tolerance {tolerance})")
            }
            (Word::Failed, Some(why)) => format!("FAILED   {text}   ({why})"),
        }
    }
}

/// `3 ok, 1 failed, 1 model not solved`
fn summary(all: &[Tested]) -> String {
    let count = |outcome| all.iter().map(|tested| tested.count(outcome)).sum::<usize>();
    let unsolved = all.iter().filter(|tested| !tested.is_solved()).count();
    let unsolved = match unsolved {
        0 => String::new(),
        1 => ", 1 model not solved".into(),
        many => format!(", {many} models not solved"),
    };
    format!("{} ok, {} failed{unsolved}\n", count(Word::Ok), count(Word::Failed))
}
