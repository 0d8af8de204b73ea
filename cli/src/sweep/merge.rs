//! The rows of all parts of a sweep, in their order, as one table.

use super::journal::lines;
use crate::failure::Failure;
use crate::output::rows::{Line, Scalars, Value};
use crate::output::sequence;
use std::collections::BTreeMap;
use std::fs::{self, File};
use std::io::{BufRead, BufReader, Seek, SeekFrom};
use std::path::{Path, PathBuf};

/// Where each row stands: of the rows themselves one is in memory at a time.
pub struct Merged {
    files: Vec<PathBuf>,
    /// The file and the byte at which the line of a row begins, and its key.
    places: BTreeMap<usize, (usize, u64, String)>,
    /// How many rows the sweep has.
    rows: usize,
    /// Whether a row tells what follows what.
    has_sequences: bool,
}

fn wrong(what: String) -> Failure {
    Failure::File(what)
}

fn io(path: &Path, error: std::io::Error) -> Failure {
    wrong(format!("{}: {error}", path.display()))
}

impl Merged {
    /// Looks through files, and all files `*.jsonl` of folders.
    ///
    /// # Errors
    ///
    /// A file that cannot be read; rows of several sweeps.
    pub fn new(paths: &[PathBuf]) -> Result<Self, Failure> {
        let mut files = Vec::new();
        for path in paths {
            if path.is_dir() { files.extend(inside(path)?) } else { files.push(path.clone()) }
        }
        files.sort();
        files.dedup();
        refuse_several(&files)?;
        let mut merged = Merged { files, places: BTreeMap::new(), rows: 0, has_sequences: false };
        for at in 0..merged.files.len() {
            merged.look_through(at)?;
        }
        match merged.rows {
            0 => Err(wrong("there are no rows of a sweep".into())),
            _ => Ok(merged),
        }
    }

    fn look_through(&mut self, at: usize) -> Result<(), Failure> {
        let path = self.files[at].clone();
        for line in lines(&path)? {
            let (begin, line) = line?;
            self.rows = self.rows.max(line.rows);
            self.has_sequences |= !line.scalars.sequence.is_empty();
            let known = self.places.entry(line.row);
            let (other, _, key) = known.or_insert((at, begin, line.key.clone()));
            if *key != line.key {
                return Err(wrong(format!(
                    "row {} has other values in {} than in {}",
                    line.row,
                    path.display(),
                    self.files[*other].display()
                )));
            }
        }
        Ok(())
    }

    /// How many rows are not there, and the first of them.
    pub fn missing(&self) -> Option<(usize, usize)> {
        let first = (1..=self.rows).find(|row| !self.places.contains_key(row))?;
        Some((self.rows - self.places.len(), first))
    }

    /// How many rows there are to be.
    pub fn rows(&self) -> usize {
        self.rows
    }

    /// Writes the table: one line for each row, in their order, without what differs from run to
    /// run.
    ///
    /// # Errors
    ///
    /// A file that cannot be read.
    pub fn write(&self, to: &mut dyn FnMut(&str)) -> Result<(), Failure> {
        let mut is_first = true;
        self.each(&mut |row, scalars| {
            if std::mem::take(&mut is_first) {
                to(&joined(names(&scalars, self.has_sequences)));
            }
            to(&joined(cells(row, &scalars, self.has_sequences)));
        })
    }

    /// Shows each row with its number, in their order.
    ///
    /// # Errors
    ///
    /// A file that cannot be read.
    pub fn each(&self, to: &mut dyn FnMut(usize, Scalars)) -> Result<(), Failure> {
        let mut readers = Vec::new();
        for path in &self.files {
            readers.push(BufReader::new(File::open(path).map_err(|error| io(path, error))?));
        }
        for (row, (file, begin, _)) in &self.places {
            let (path, reader, mut text) = (&self.files[*file], &mut readers[*file], Vec::new());
            reader.seek(SeekFrom::Start(*begin)).map_err(|error| io(path, error))?;
            reader.read_until(b'\n', &mut text).map_err(|error| io(path, error))?;
            let line = Line::read(&text);
            let line = line.ok_or_else(|| wrong(format!("{} has changed", path.display())))?;
            to(*row, line.scalars);
        }
        Ok(())
    }
}

fn inside(folder: &Path) -> Result<Vec<PathBuf>, Failure> {
    let entries = fs::read_dir(folder).map_err(|error| io(folder, error))?;
    let paths = entries.flatten().map(|entry| entry.path());
    Ok(paths.filter(|path| path.extension().is_some_and(|it| it == "jsonl")).collect())
}

/// What a file is called before its part: `block.3f2a91c05e7d8b46`.
fn sweep_of(path: &Path) -> String {
    let name = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
    name.rsplit_once('.').map_or(name.clone(), |(sweep, _)| sweep.to_owned())
}

fn refuse_several(files: &[PathBuf]) -> Result<(), Failure> {
    let mut sweeps: Vec<String> = files.iter().map(|path| sweep_of(path)).collect();
    sweeps.dedup();
    match sweeps.len() {
        0 | 1 => Ok(()),
        _ => Err(wrong(format!(
            "these are rows of several sweeps, of other models, versions or options: {}; name the \
             files of one, as in `{}.*`",
            sweeps.join(", "),
            sweeps[0]
        ))),
    }
}

fn names(row: &Scalars, has_sequences: bool) -> Vec<String> {
    let swept = row.swept.0.iter().map(|(name, _)| name.as_str());
    let free = row.free.0.iter().map(|(name, _)| name.as_str());
    let all = ["row"].into_iter().chain(swept).chain(["status", "objective"]).chain(free);
    let all = all.chain(["iterations", "kkt_error", "constraint_violation"]);
    let all = all.chain(row.confirmed.map(|_| "confirmed"));
    all.chain(has_sequences.then_some("sequence")).map(str::to_owned).collect()
}

fn cells(at: usize, row: &Scalars, has_sequences: bool) -> Vec<String> {
    let number = |it: Option<f64>| it.map(|it| format!("{it:?}")).unwrap_or_default();
    let value = |it: &Value| match it {
        Value::Whole(it) => it.to_string(),
        Value::Number(it) => format!("{it:?}"),
        Value::Word(it) => it.clone(),
    };
    let mut cells = vec![at.to_string()];
    cells.extend(row.swept.0.iter().map(|(_, it)| value(it)));
    cells.extend([row.status.clone(), number(row.objective)]);
    cells.extend(row.free.0.iter().map(|(_, it)| number(*it)));
    cells.push(row.iterations.to_string());
    cells.extend([number(row.kkt_error), number(row.constraint_violation)]);
    cells.extend(row.confirmed.map(|it| it.to_string()));
    cells.extend(has_sequences.then(|| sequence::words(&row.sequence)));
    cells
}

/// A line of CSV; a cell with a comma or a quote is quoted.
fn joined(cells: Vec<String>) -> String {
    let cell = |it: String| match it.contains([',', '"']) {
        true => format!("\"{}\"", it.replace('"', "\"\"")),
        false => it,
    };
    cells.into_iter().map(cell).collect::<Vec<_>>().join(",") + "\n"
}
