//! A file of rows that grows by a line for each row that is solved, so that a sweep that was ended,
//! by whatever, goes on where it was.
//!
//! The name of a file has what all its rows have in common: `MODEL.IDENTITY.I-of-N.jsonl`, where
//! the identity stands for the text of the model, its data, the version of the program and all
//! options that change results. What was solved before a model was changed is in another file.

use super::part::Part;
use crate::failure::Failure;
use crate::output::rows::{Line, Scalars};
use std::collections::BTreeMap;
use std::fmt::Display;
use std::fs::{self, File, OpenOptions, TryLockError};
use std::io::{self, BufRead, BufReader, Write};
use std::path::{Path, PathBuf};
use std::sync::Mutex;

/// What the files of a sweep have in common.
pub struct Sweep<'s> {
    /// `MODEL.IDENTITY`
    pub name: String,
    /// How many rows it has.
    pub rows: usize,
    /// What stands for the values of a row, counted from 0.
    pub key: &'s dyn Fn(usize) -> String,
}

/// The file of one process.
pub struct Journal {
    path: PathBuf,
    /// That of the sweep.
    name: String,
    /// Whether a row was solved before.
    done: Vec<bool>,
    file: Mutex<Growing>,
}

struct Growing {
    file: File,
    tally: Tally,
}

/// How many rows of a part ended how.
#[derive(Clone, Default)]
pub struct Tally {
    /// By their status.
    pub statuses: BTreeMap<String, usize>,
    /// How many there are.
    pub rows: usize,
    /// How many of them can be used, and are confirmed if that was asked.
    pub fine: usize,
}

impl Tally {
    fn add(&mut self, row: &Scalars) {
        self.rows += 1;
        self.fine += usize::from(row.is_fine());
        *self.statuses.entry(row.status.clone()).or_default() += 1;
    }
}

fn failure(path: &Path, what: impl Display) -> Failure {
    Failure::File(format!("{}: {what}", path.display()))
}

impl Journal {
    /// Opens the file of a part, behind its last whole line, and looks what is in it and in the
    /// files of other parts; or begins it `anew`.
    ///
    /// # Errors
    ///
    /// A file that cannot be read or written, or that another process writes; rows of other cases.
    pub fn open(folder: &Path, sweep: &Sweep, part: Part, anew: bool) -> Result<Journal, Failure> {
        fs::create_dir_all(folder).map_err(|error| failure(folder, error))?;
        let path = folder.join(format!("{}.{}.jsonl", sweep.name, part.words()));
        let options = OpenOptions::new().create(true).append(true).open(&path);
        let file = options.map_err(|error| failure(&path, error))?;
        if is_locked(&file) {
            return Err(failure(&path, "another process writes to it"));
        }
        let end = if anew { 0 } else { whole_lines(&path)? };
        cut(&path, end).map_err(|error| failure(&path, error))?;
        let (mut done, mut tally) = (vec![false; sweep.rows], Tally::default());
        for path in files(folder, &sweep.name)?.iter().filter(|it| !anew || **it == path) {
            for line in lines(path)? {
                let (_, line) = line?;
                let row = check(&line, sweep).map_err(|what| failure(path, what))?;
                if part.has(row) && !std::mem::replace(&mut done[row], true) {
                    tally.add(&line.scalars);
                }
            }
        }
        let name = sweep.name.clone();
        Ok(Journal { path, name, done, file: Mutex::new(Growing { file, tally }) })
    }

    /// Where it is.
    pub fn path(&self) -> String {
        self.path.display().to_string()
    }

    /// What its files have in common.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// How many rows the sweep has.
    pub fn rows(&self) -> usize {
        self.done.len()
    }

    /// The files of all parts.
    ///
    /// # Errors
    ///
    /// A folder that cannot be read.
    pub fn files(&self, folder: &Path) -> Result<Vec<PathBuf>, Failure> {
        files(folder, &self.name)
    }

    /// Whether a row, counted from 0, was solved before.
    pub fn has(&self, row: usize) -> bool {
        self.done[row]
    }

    /// Appends a row.
    ///
    /// # Errors
    ///
    /// A file that cannot be written.
    pub fn append(&self, line: &Line) -> Result<(), Failure> {
        let mut growing = self.file.lock().expect("no thread panics with the lock");
        growing.tally.add(&line.scalars);
        let written = growing.file.write_all(line.text().as_bytes());
        written.map_err(|error| failure(&self.path, error))
    }

    /// How many rows ended how, those from before included.
    pub fn tally(&self) -> Tally {
        self.file.lock().expect("no thread panics with the lock").tally.clone()
    }
}

/// Whether another process has the file; if not, it is ours until we end. On Windows a lock would
/// keep others from reading, and not every file system has locks.
fn is_locked(file: &File) -> bool {
    !cfg!(windows) && matches!(file.try_lock(), Err(TryLockError::WouldBlock))
}

/// Leaves the first bytes of a file.
fn cut(path: &Path, length: u64) -> io::Result<()> {
    OpenOptions::new().write(true).open(path)?.set_len(length)
}

/// The row, counted from 0, that a line is about, unless that is another one than the sweep has.
fn check(line: &Line, sweep: &Sweep) -> Result<usize, String> {
    let row = line.row.wrapping_sub(1);
    match row < sweep.rows && line.key == (sweep.key)(row) {
        true => Ok(row),
        false => Err(format!(
            "row {} has other values than now: cases may be added at the end, but not changed or \
             left out; choose another folder",
            line.row
        )),
    }
}

/// The files of a sweep, by name.
fn files(folder: &Path, name: &str) -> Result<Vec<PathBuf>, Failure> {
    let entries = fs::read_dir(folder).map_err(|error| failure(folder, error))?;
    let is_own = |path: &PathBuf| {
        let own = path.file_name().and_then(|it| it.to_str());
        own.is_some_and(|own| own.starts_with(&format!("{name}.")) && own.ends_with(".jsonl"))
    };
    let mut files: Vec<PathBuf> =
        entries.flatten().map(|entry| entry.path()).filter(is_own).collect();
    files.sort();
    Ok(files)
}

/// Up to where a file has whole lines.
fn whole_lines(path: &Path) -> Result<u64, Failure> {
    let file = File::open(path).map_err(|error| failure(path, error))?;
    let (mut reader, mut end, mut line) = (BufReader::new(file), 0, Vec::new());
    loop {
        line.clear();
        let count = reader.read_until(b'\n', &mut line).map_err(|error| failure(path, error))?;
        if !line.ends_with(b"\n") {
            return Ok(end);
        }
        end += count as u64;
    }
}

/// The rows of a file, each with where its line begins; a last line that is torn, as when the
/// machine stopped, is none.
pub fn lines(
    path: &Path,
) -> Result<impl Iterator<Item = Result<(u64, Line), Failure>> + use<>, Failure> {
    let path = path.to_owned();
    let file = File::open(&path).map_err(|error| failure(&path, error))?;
    let (mut reader, mut begin, mut number) = (BufReader::new(file), 0u64, 0);
    Ok(std::iter::from_fn(move || {
        let mut text = Vec::new();
        if let Err(error) = reader.read_until(b'\n', &mut text) {
            return Some(Err(failure(&path, error)));
        }
        if !text.ends_with(b"\n") {
            return None;
        }
        let here = begin;
        (begin, number) = (begin + text.len() as u64, number + 1);
        let wrong = || failure(&path, format!("line {number} is no row of a sweep"));
        Some(Line::read(&text).map(|line| (here, line)).ok_or_else(wrong))
    }))
}
