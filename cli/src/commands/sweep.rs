//! `fdcc sweep`: one solve per case, side by side: a table of what came out, or a file of rows that
//! another run goes on with.

use super::options::{Gap, Options, prepare};
use super::solver::{document, sha256, warm, wrong_start};
use super::written;
use crate::command;
use crate::exit::Exit;
use crate::failure::Failure;
use crate::input;
use crate::output::document::Seconds;
use crate::output::named::Named;
use crate::output::rows::{Line, Row, Summary};
use crate::output::saved::Saved;
use crate::output::units::Units;
use crate::output::{self, files, plural, table};
use crate::page::sweep as page;
use crate::report::log::{self, Level, Log};
use crate::solved::Solved;
use crate::sweep::journal::{Journal, Sweep as Rows};
use crate::sweep::merge::Merged;
use crate::sweep::part::Part;
use crate::sweep::values;
use crate::version::{BUILD, VERSION};
use crate::watch::{Deadline, catch_interrupts, is_interrupted};
use clap::Args;
use fdcc::{Cases, Executor, Grid, Model, Start, Stop};
use indicatif::ProgressBar;
use std::path::{Path, PathBuf};
use std::time::Instant;

/// Solve once for each of several values, and print a table
///
/// Each solve with other parameters begins at the solution for those of the model. With `--json`
/// the rows are one array of objects with `swept` (what was swept, numbers in SI units), `status`,
/// `objective`, `free`, `iterations`, `kkt_error`, `constraint_violation` and `seconds`, as in the
/// document of `solve`; with `--confirmed` also `confirmed`, `verification` and `optimality`. With
/// `--out` the rows are the lines of a file in that folder, written as they are solved; the same
/// command once more goes on where it was, and `fdcc merge` makes a table of them.
#[derive(Args)]
pub struct Sweep {
    /// The model; `-` is the standard input
    #[arg(value_name = "FILE")]
    file: String,
    /// A `param` or a key of the `method` block, with its values, or a range `FIRST:STEP:LAST`;
    /// several lists go together row by row
    ///
    /// A number may have its unit, `m=100[g],1[kg]`; one behind the last number of a list is that
    /// of all numbers without their own, and a number without any is in the declared unit.
    ///
    /// Without any, the lists of the `sweep` block of the model.
    #[arg(value_name = "NAME=V1,V2,...")]
    lists: Vec<String>,
    /// A table of values: CSV with a line of names, or a JSON object on each line
    #[arg(long, value_name = "FILE")]
    values: Option<PathBuf>,
    /// All combinations of the lists; the last one changes fastest
    #[arg(long, conflicts_with = "values")]
    product: bool,
    /// Only the Ith of N parts of the rows, for one of several processes
    #[arg(long, value_name = "I/N", requires = "out")]
    part: Option<Part>,
    /// With `--out`, write MODEL.ROW.sol.json, .csv and .html of each row, too
    #[arg(long, requires = "out")]
    trajectories: bool,
    /// Start each solve from the solution before it, one after the other
    #[arg(long = "continue", conflicts_with_all = ["jobs", "part"])]
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

/// So many rows are begun before any of the next ones: what they leave behind is let go of then.
const BATCH: usize = 10_000;

/// What all rows share.
struct Run<'r> {
    grid: &'r Grid,
    cases: Cases,
    warm: Option<Saved>,
    journal: Option<&'r Journal>,
    bar: ProgressBar,
}

/// What is kept of the rows that ran, with their numbers from 0.
type Kept = Vec<(usize, Row)>;

impl Sweep {
    /// Solves all rows and prints the table.
    pub fn run(self) -> Exit {
        catch_interrupts();
        let model = match prepare(&self.file, &self.options) {
            Ok(model) => model,
            Err(exit) => return exit,
        };
        let exit = self.grid(&model).and_then(|grid| match &self.options.out {
            None => self.to_table(&model, &grid),
            Some(folder) => {
                let journal = self.journal(folder, &model, &grid)?;
                self.to_file(&model, &grid, &journal)
            }
        });
        exit.unwrap_or_else(|failure| failure.report(model.source()))
    }

    /// The values of all rows.
    fn grid(&self, model: &Model) -> Result<Grid, Failure> {
        if self.product {
            return Ok(Grid::product(&self.lists, model)?);
        }
        let Some(path) = &self.values else {
            return Ok(match self.lists.as_slice() {
                [] => Grid::of(model)?,
                lists => Grid::read(lists, model)?,
            });
        };
        let wrong = |what: String| Failure::File(format!("{}: {what}", path.display()));
        let text = input::text(path).map_err(|error| wrong(error.to_string()))?;
        let mut lists = values::lists(&text).map_err(wrong)?;
        for text in &self.lists {
            lists.push(Grid::list(text)?);
        }
        Ok(Grid::new(lists, model)?)
    }

    fn level(&self) -> Level {
        self.options.log.unwrap_or(Level::Short)
    }

    fn to_table(&self, model: &Model, grid: &Grid) -> Result<Exit, Failure> {
        let kept = self.solve(model, grid, None, &(0..grid.rows).collect::<Vec<_>>())?;
        if kept.len() < grid.rows {
            output::complain(&format!("interrupted: {} of {} rows ran", kept.len(), grid.rows));
        }
        let rows = kept.iter().map(|(at, row)| (grid.row(*at), row));
        output::print(&match self.options.json {
            true => output::json(&kept.iter().map(|(_, row)| row).collect::<Vec<_>>()),
            false => table::table(rows, &Units::from(model), self.confirmed),
        });
        let is_fine = kept.len() == grid.rows && kept.iter().all(|(_, row)| row.scalars.is_fine());
        Ok(if is_fine { Exit::Fine } else { Exit::NotSolved })
    }

    /// The file of rows.
    fn journal(&self, folder: &Path, model: &Model, grid: &Grid) -> Result<Journal, Failure> {
        let name = format!("{}.{}", model.name(), self.identity(model)?);
        let rows = Rows { name, rows: grid.rows, key: &|row| key(grid, row) };
        Journal::open(folder, &rows, self.part.unwrap_or(Part::WHOLE), self.is_continued)
    }

    /// Stands for everything that changes results, but for the values of the rows.
    fn identity(&self, model: &Model) -> Result<String, Failure> {
        let Options { changes, warm, time_limit, starts, .. } = &self.options;
        let read = |path: &PathBuf| {
            input::text(path).map_err(|error| {
                Failure::File(format!("{} cannot be read: {error}", path.display()))
            })
        };
        let warm = warm.as_ref().map(read).transpose()?;
        let meaning = model.meaning();
        let tables = meaning.phases.iter().map(|phase| &phase.model.tables);
        let tables: Vec<_> = tables.chain([&meaning.tables]).collect();
        let (version, text) = (format!("{VERSION} {BUILD}"), &model.source().text);
        let confirmed = self.confirmed.then(|| self.gap.of(&meaning.method));
        let seed = meaning.method.seed;
        Ok(short(&format!(
            "{version} {text} {tables:?} {changes:?} {warm:?} {time_limit:?} {starts} {seed} \
             {confirmed:?} {}",
            self.is_continued
        )))
    }

    fn to_file(&self, model: &Model, grid: &Grid, journal: &Journal) -> Result<Exit, Failure> {
        let (begin, part) = (Instant::now(), self.part.unwrap_or(Part::WHOLE));
        let (before, all) = (journal.tally().rows, (0..grid.rows).filter(|row| part.has(*row)));
        let todo: Vec<usize> = all.filter(|row| !journal.has(*row)).collect();
        self.solve(model, grid, Some(journal), &todo)?;
        self.draw(model, folder_of(&self.options), journal)?;
        let tally = journal.tally();
        let expected = before + todo.len();
        if tally.rows < expected {
            output::complain(&format!("interrupted: {} of {expected} rows ran", tally.rows));
        }
        let (file, statuses) = (journal.path(), Named(tally.statuses.into_iter().collect()));
        let seconds = begin.elapsed().as_secs_f64();
        let summary = Summary { rows: tally.rows, before, statuses, seconds, file };
        let folder = folder_of(&self.options).display();
        output::print(&match self.options.json {
            true => output::json(&summary),
            false => {
                let page = page::too_many(journal.rows());
                format!(" {}\n in {folder}, {seconds:.3} s\n{page}", words(&summary))
            }
        });
        Ok(if tally.fine == expected { Exit::Fine } else { Exit::NotSolved })
    }

    /// The page of the rows that all parts have written so far; of very many there is none.
    fn draw(&self, model: &Model, folder: &Path, journal: &Journal) -> Result<(), Failure> {
        let (files, all) = (journal.files(folder)?, journal.rows());
        if all > page::MOST || journal.tally().rows == 0 {
            return Ok(());
        }
        let mut rows = Vec::new();
        Merged::new(&files)?.each(&mut |row, scalars| rows.push((row, scalars)))?;
        let (units, source) = (Units::from(model), &model.source().text);
        let params: Vec<String> =
            model.meaning().params.iter().map(|it| it.place.name.clone()).collect();
        let (units, params) = (&units, params.as_slice());
        let (model, command) = (model.name(), command::given());
        let page = page::Page { model, source, command, units, params, rows, all };
        files::write_file(&folder.join(format!("{}.html", journal.name())), page.html())
    }

    /// What is kept of the rows that ran.
    fn solve(
        &self,
        model: &Model,
        grid: &Grid,
        journal: Option<&Journal>,
        todo: &[usize],
    ) -> Result<Kept, Failure> {
        let (cases, warm) = (Cases::new(model), warm(&self.options)?);
        let bar = log::bar(self.level(), todo.len());
        let run = Run { grid, cases, warm, journal, bar };
        let kept =
            if self.is_continued { self.in_turn(&run, todo) } else { self.in_parallel(&run, todo) };
        run.bar.finish_and_clear();
        kept
    }

    /// Each row from the last one that was solved.
    fn in_turn(&self, run: &Run, todo: &[usize]) -> Result<Kept, Failure> {
        let (mut kept, mut before): (Kept, Option<Solved>) = (Vec::new(), None);
        for &row in todo {
            let Some(solved) = self.one(run, row, before.as_ref())? else { break };
            kept.extend(self.left(run, row, &solved)?);
            before = Some(solved).filter(Solved::is_good).or(before);
        }
        Ok(kept)
    }

    /// Each row for itself; which thread solves it makes no difference to the answer.
    fn in_parallel(&self, run: &Run, todo: &[usize]) -> Result<Kept, Failure> {
        let executor =
            self.jobs.map_or_else(Executor::default, |jobs| Executor::threads(jobs as usize));
        let mut kept = Vec::new();
        for rows in todo.chunks(BATCH) {
            let one = |at: usize| match self.one(run, rows[at], None)? {
                Some(solved) => self.left(run, rows[at], &solved),
                None => Ok(None),
            };
            // After a failure there will be no table.
            for row in executor.in_order(rows.len(), one, Result::is_err) {
                kept.extend(row?);
            }
        }
        Ok(kept)
    }

    /// Solves a row; nothing where Ctrl-C comes before it begins or while it runs into a file.
    fn one(
        &self,
        run: &Run,
        row: usize,
        before: Option<&Solved>,
    ) -> Result<Option<Solved>, Failure> {
        if is_interrupted() {
            return Ok(None);
        }
        let begin = Instant::now();
        // What all rows share has as much time as one of them.
        let shared = Deadline::after(begin, self.options.time_limit);
        let case = run.cases.case(&run.grid.values(row))?;
        if !case.is_compiled() {
            let case = case.clone();
            match shared.within(move || case.compile()) {
                Err(Stop::Interrupted) => return Ok(None),
                compiled => compiled.map_err(Failure::Stopped)??,
            }
        }
        let compile = begin.elapsed().as_secs_f64();
        let record = run.warm.as_ref().map(Saved::record);
        let start = match (before, &record) {
            (Some(before), _) => Start::Solution(&before.solution),
            (None, Some(record)) => Start::Record(record),
            (None, None) => Start::Guess,
        };
        let mut log = Log::of_several(self.level(), &run.bar, &format!("row {} ", row + 1));
        log.show_widths_in(&Units::from(case.model()));
        let options = fdcc::Options {
            starts: self.options.starts as usize,
            start,
            report: &|report| log.report(report),
            stop: &|| shared.check(),
            ..fdcc::Options::default()
        };
        if !self.is_continued {
            case.prepare(&options);
        }
        let before = begin.elapsed().as_secs_f64();
        let deadline = Deadline::after(Instant::now(), self.options.time_limit);
        let options = fdcc::Options { stop: &|| deadline.check(), ..options };
        // Without a row before it the first one of a continued sweep begins at the guess.
        let solution = match self.is_continued {
            true => case.model().solve(&options),
            false => case.solve(&options),
        };
        let solution = solution.map_err(|error| wrong_start(error, &self.options))?;
        let total = begin.elapsed().as_secs_f64();
        let seconds = Seconds { compile, solve: total - before, total };
        let document = document(&solution, seconds);
        let mut solved = Solved { solution, document };
        if self.confirmed && solved.is_good() {
            let gap = self.gap.of(&solved.solution.problem.method);
            solved.replay(gap);
        }
        Ok(Some(solved))
    }

    /// What a row leaves behind as soon as it is solved: what comes later cannot cost it.
    fn left(&self, run: &Run, at: usize, solved: &Solved) -> Result<Option<(usize, Row)>, Failure> {
        let Solved { document, .. } = solved;
        // What was interrupted did not run; with a file it is solved again.
        if document.status == "interrupted" {
            return Ok(None);
        }
        let row = Row::new(&run.grid.row(at), document, self.confirmed);
        run.bar.inc(1);
        let Some(journal) = run.journal else {
            self.tell(run, at, solved);
            return Ok(Some((at, row)));
        };
        if let (true, Some(folder)) = (self.trajectories, &self.options.out) {
            written::write(document, folder, &format!("{}.{}", document.model, at + 1))?;
        }
        let (rows, key) = (run.grid.rows, key(run.grid, at));
        journal.append(&Line { row: at + 1, rows, key, scalars: row.scalars })?;
        Ok(None)
    }

    fn tell(&self, run: &Run, at: usize, Solved { document, .. }: &Solved) {
        if self.level() != Level::None {
            let line = format!("row {} {}", at + 1, document.status.replace('_', " "));
            let iterations = plural(document.iterations, "iteration");
            run.bar.suspend(|| output::tell(&format!("{line}  {iterations}\n")));
        }
    }
}

/// Where the rows are written.
fn folder_of(options: &Options) -> &Path {
    options.out.as_deref().unwrap_or("".as_ref())
}

/// Stands for the values of a row.
fn key(grid: &Grid, row: usize) -> String {
    let values = grid.row(row);
    short(&values.iter().map(|(name, value)| format!("{name}={value}\n")).collect::<String>())
}

/// So many digits of a hash tell a billion texts apart.
const DIGITS: usize = 16;

fn short(text: &str) -> String {
    sha256(text)[..DIGITS].to_owned()
}

/// `2000 rows: 1998 solved, 2 none found, 500 of them before`
fn words(it: &Summary) -> String {
    let statuses = it.statuses.0.iter();
    let statuses: Vec<String> =
        statuses.map(|(status, count)| format!("{count} {}", status.replace('_', " "))).collect();
    let before = if it.before > 0 { format!(", {} of them before", it.before) } else { "".into() };
    format!("{}: {}{before}", plural(it.rows, "row"), statuses.join(", "))
}
