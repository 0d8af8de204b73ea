//! `fdcc sweep`: one solve per value, side by side, and a table of what came out.

use super::options::{Gap, Options, prepare};
use super::solver::{Compiled, warm};
use crate::exit::Exit;
use crate::failure::Failure;
use crate::output::named::Named;
use crate::output::saved::Saved;
use crate::output::{self, files, plural, table};
use crate::report::log::{self, Level, Log};
use crate::solved::Solved;
use crate::watch::{catch_interrupts, is_interrupted};
use clap::Args;
use fdcc::{Executor, Grid, Model, Start, Stop};
use indicatif::ProgressBar;
use std::time::Instant;

/// Solve once for each of several values, and print a table
///
/// With `--json` the rows are one array of objects with `swept` (what was swept, numbers in SI
/// units), `status`, `objective`, `free`, `iterations`, `kkt_error`, `constraint_violation` and
/// `seconds`, as in the document of `solve`; with `--confirmed` also `confirmed`, `verification`
/// and `optimality`. With `--out` the files are called MODEL.1.sol.json and so on, by row, and
/// written when the row is solved.
#[derive(Args)]
pub struct Sweep {
    /// The model; `-` is the standard input
    #[arg(value_name = "FILE")]
    file: String,
    /// A `param` or a key of the `method` block, with its values; several lists go together row by
    /// row
    ///
    /// Without any, the lists of the `sweep` block of the model.
    #[arg(value_name = "NAME=V1,V2,...")]
    lists: Vec<String>,
    /// Start each solve from the solution before it, one after the other
    #[arg(long = "continue", conflicts_with = "jobs")]
    is_continued: bool,
    /// How many solves run at a time; without it as many as there are processors
    #[arg(long, value_name = "J", value_parser = clap::value_parser!(u32).range(1..))]
    jobs: Option<u32>,
    /// Replay each row on the true system; exit code 2 unless that confirms it and nothing
    /// contradicts that it is an optimum
    #[arg(long)]
    confirmed: bool,
    #[command(flatten)]
    options: Options,
    #[command(flatten)]
    gap: Gap,
}

/// One row of the sweep, ready to be solved.
struct Row {
    number: usize,
    model: Model,
}

/// What came out of a row; nothing where Ctrl-C came before it began.
type Ran = Result<Option<Solved>, Failure>;

impl Sweep {
    /// Solves all rows and prints the table.
    pub fn run(self) -> Exit {
        catch_interrupts();
        let model = match prepare(&self.file, &self.options) {
            Ok(model) => model,
            Err(exit) => return exit,
        };
        let exit = self.rows(&model).and_then(|(grid, rows)| {
            let solved = self.solve(&rows)?;
            self.report(&grid, &solved)
        });
        exit.unwrap_or_else(|failure| failure.report(model.source()))
    }

    /// The values, and the model with each of them.
    fn rows(&self, model: &Model) -> Result<(Grid, Vec<Row>), Failure> {
        let grid = match self.lists.as_slice() {
            [] => Grid::of(model)?,
            lists => Grid::read(lists, model)?,
        };
        let row = |index: usize| Ok(Row { number: index + 1, model: grid.apply(index, model)? });
        let rows: Result<Vec<Row>, Failure> = (0..grid.rows).map(row).collect();
        Ok((grid, rows?))
    }

    /// The rows that ran, each with its number.
    fn solve(&self, rows: &[Row]) -> Result<Vec<(usize, Solved)>, Failure> {
        let bar = log::bar(self.level(), rows.len());
        let ran =
            if self.is_continued { self.in_turn(rows, &bar) } else { self.in_parallel(rows, &bar) };
        bar.finish_and_clear();
        let numbered = |(row, ran): (&Row, Option<Solved>)| Some((row.number, ran?));
        let solved: Vec<_> = rows.iter().zip(ran?).filter_map(numbered).collect();
        if solved.len() < rows.len() {
            output::complain(&format!("interrupted: {} of {} rows ran", solved.len(), rows.len()));
        }
        Ok(solved)
    }

    fn level(&self) -> Level {
        self.options.log.unwrap_or(Level::Short)
    }

    /// Each row from the last one that was solved.
    fn in_turn(&self, rows: &[Row], bar: &ProgressBar) -> Result<Vec<Option<Solved>>, Failure> {
        let mut all: Vec<Option<Solved>> = Vec::new();
        for row in rows {
            let before = all.iter().flatten().rev().find(|solved| solved.is_good());
            let solved = self.one(row, before, bar)?;
            all.push(solved);
        }
        Ok(all)
    }

    /// Each row for itself; which thread solves it makes no difference to the answer.
    fn in_parallel(&self, rows: &[Row], bar: &ProgressBar) -> Result<Vec<Option<Solved>>, Failure> {
        let executor =
            self.jobs.map_or_else(Executor::default, |jobs| Executor::threads(jobs as usize));
        // After a failure there will be no table.
        let one = |i: usize| self.one(&rows[i], None, bar);
        let solved = executor.in_order(rows.len(), one, Result::is_err);
        solved.into_iter().collect()
    }

    fn one(&self, row: &Row, before: Option<&Solved>, bar: &ProgressBar) -> Ran {
        if is_interrupted() {
            return Ok(None);
        }
        let compiled = match Compiled::new(&row.model, Instant::now(), self.options.time_limit) {
            Err(Failure::Stopped(Stop::Interrupted)) => return Ok(None),
            compiled => compiled?,
        };
        let saved = if before.is_none() { warm(&self.options)? } else { None };
        let record = saved.as_ref().map(Saved::record);
        let start = match (before, &record) {
            (Some(before), _) => Start::Solution(&before.solution),
            (None, Some(record)) => Start::Record(record),
            (None, None) => Start::Guess,
        };
        compiled.check(start, &self.options)?;
        let mut log = Log::of_several(self.level(), bar, &format!("row {} ", row.number));
        let mut solved = compiled.solve(start, &self.options, &mut log)?;
        if self.confirmed && solved.is_good() {
            solved.replay(self.gap.gap);
        }
        self.write(row, &solved)?;
        bar.inc(1);
        if self.level() != Level::None {
            let line = format!("row {} {}", row.number, solved.document.status.replace('_', " "));
            let iterations = plural(solved.document.iterations, "iteration");
            bar.suspend(|| output::tell(&format!("{line}  {iterations}\n")));
        }
        Ok(Some(solved))
    }

    /// The files of a row, as soon as it is solved: what comes later cannot cost them.
    fn write(&self, row: &Row, Solved { document, .. }: &Solved) -> Result<(), Failure> {
        let Some(folder) = &self.options.out else { return Ok(()) };
        files::write(document, folder, &format!("{}.{}", document.model, row.number)).map(drop)
    }

    /// The table or the JSON.
    fn report(&self, grid: &Grid, solved: &[(usize, Solved)]) -> Result<Exit, Failure> {
        let swept: Vec<Named<String>> =
            solved.iter().map(|(number, _)| swept(grid, number - 1)).collect();
        let documents = swept.iter().zip(solved.iter().map(|(_, solved)| &solved.document));
        let text = if self.options.json {
            let row = |(swept, document)| table::row(swept, document, self.confirmed);
            output::json(&documents.map(row).collect::<Vec<_>>())
        } else {
            table::table(documents, self.confirmed)
        };
        output::print(&text);
        let is_whole = solved.len() == grid.rows;
        let worst = solved
            .iter()
            .map(|(_, solved)| solved.exit(self.confirmed))
            .max()
            .unwrap_or(Exit::Fine);
        Ok(if is_whole { worst } else { worst.max(Exit::NotSolved) })
    }
}

/// What was swept in a row.
fn swept(grid: &Grid, row: usize) -> Named<String> {
    grid.row(row).into_iter().map(|(name, value)| (name.to_owned(), value.to_owned())).collect()
}
