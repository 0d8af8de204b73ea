//! Measured data: the texts of data files as tables of numbers.
//!
//! The compiler opens no files. Whoever calls it may give it [`Files`], which hand in the text of
//! a file by the name that the model writes; without them a model with data waits.

mod csv;
mod each;
mod pattern;

use crate::units;
use csv::{Misfit, Sheet};
pub(crate) use each::{told_once, written_out};
use fdcc_grammar::ast::{Each, Ident, Item, ItemKind, Unit};
use fdcc_grammar::{Code, Diagnostic, Span};
pub use pattern::matches;
use std::collections::HashMap;

/// Hands in data files by their names in the model.
///
/// A function that gives texts is enough for models without patterns of file names.
pub trait Files {
    /// The text of a file.
    ///
    /// # Errors
    ///
    /// Why there is none, in words.
    fn text(&self, name: &str) -> Result<String, String>;

    /// Names among which are those of all files that match a pattern, as [`matches()`] says; others
    /// do no harm, and neither does their order.
    ///
    /// # Errors
    ///
    /// Why nobody can tell, in words.
    fn names(&self, pattern: &str) -> Result<Vec<String>, String>;
}

impl<F: Fn(&str) -> Result<String, String>> Files for F {
    fn text(&self, name: &str) -> Result<String, String> {
        self(name)
    }

    fn names(&self, _: &str) -> Result<Vec<String>, String> {
        Err("nothing says which files there are".into())
    }
}

/// The declared columns of a data file.
#[derive(Clone, Debug)]
pub struct Table {
    /// The name of the data set.
    pub name: String,
    /// The name of the file.
    pub file: String,
    /// Where that stands in the model.
    pub place: Span,
    /// Whether it is one of the files of a pattern, which the name of the data set does not tell.
    pub is_of_pattern: bool,
    /// The line of the file at which each row stands, counted from 1.
    pub lines: Vec<usize>,
    /// The names of the columns that the model takes.
    pub names: Vec<String>,
    /// In SI, one entry for each row.
    pub columns: Vec<Vec<f64>>,
}

/// All data sets of a text that could be read.
#[derive(Default)]
pub(crate) struct Tables {
    /// By the place of the file name. Of several files of a pattern it is the same.
    tables: HashMap<Span, Vec<Table>>,
}

impl Tables {
    /// The data set that a place of the text and a file name stand for.
    pub fn get(&self, place: Span, file: &str) -> Option<&Table> {
        self.tables.get(&place)?.iter().find(|table| table.file == file)
    }
}

impl Table {
    /// Whether it is the data set of a place and a file.
    pub(crate) fn is(&self, place: Span, file: &str) -> bool {
        self.place == place && self.file == file
    }

    /// What tells it from the others: its name, or that of its file.
    pub fn called(&self) -> &str {
        if self.is_of_pattern { &self.file } else { &self.name }
    }

    /// Number of rows.
    pub fn rows(&self) -> usize {
        self.lines.len()
    }

    /// A row in words: `line 7 of slider.csv`.
    pub(crate) fn row_in_words(&self, row: usize) -> String {
        format!("line {} of `{}`", self.lines[row], self.file)
    }
}

/// Reads the data sets of some items, also those inside phases.
pub(crate) fn read(items: &[Item], files: &dyn Files, found: &mut Vec<Diagnostic>) -> Tables {
    let mut tables = Tables::default();
    read_into(&mut tables, items, None, files, found);
    tables
}

fn read_into(
    tables: &mut Tables,
    items: &[Item],
    each: Option<&Each>,
    files: &dyn Files,
    found: &mut Vec<Diagnostic>,
) {
    for item in items {
        match &item.kind {
            ItemKind::Data { file, .. } if each::is_waiting(each, file) => {}
            ItemKind::Data { name, file, file_span, columns } => {
                match table(name, (file, *file_span), columns, files) {
                    Ok(mut table) => {
                        table.is_of_pattern = each.is_some_and(|it| it.file_span == *file_span);
                        tables.tables.entry(*file_span).or_default().push(table);
                    }
                    Err(diagnostic) => found.push(diagnostic),
                }
            }
            ItemKind::Phase { items, each, .. } => {
                read_into(tables, items, each.as_ref(), files, found)
            }
            _ => {}
        }
    }
}

fn table(
    name: &Ident,
    (file, place): (&str, Span),
    columns: &[(Ident, Option<Unit>)],
    files: &dyn Files,
) -> Result<Table, Diagnostic> {
    let text = files.text(file).map_err(|reason| unreadable(file, place, &reason))?;
    let names: Vec<&str> = columns.iter().map(|column| column.0.name.as_str()).collect();
    let Sheet { lines, columns: numbers } =
        csv::read(&text, &names).map_err(|misfit| unfit(file, place, columns, misfit))?;
    let scale = |unit: &Option<Unit>| {
        // Unknown units have been told.
        unit.as_ref().map_or(1.0, |unit| units::scale(unit, &mut Vec::new()))
    };
    let in_si = |(column, values): (&(Ident, Option<Unit>), Vec<f64>)| {
        let scale = scale(&column.1);
        values.into_iter().map(|value| scale * value).collect()
    };
    Ok(Table {
        name: name.name.clone(),
        file: file.to_owned(),
        place,
        is_of_pattern: false,
        lines,
        names: columns.iter().map(|it| it.0.name.clone()).collect(),
        columns: columns.iter().zip(numbers).map(in_si).collect(),
    })
}

fn unreadable(file: &str, place: Span, reason: &str) -> Diagnostic {
    let message = format!("the data file `{file}` cannot be read");
    Diagnostic::new(Code::DataFile, message, place, reason)
        .help("data files stand in the folder of the model, or below the one of `--data DIR`")
}

fn unfit(file: &str, place: Span, columns: &[(Ident, Option<Unit>)], misfit: Misfit) -> Diagnostic {
    let Misfit { column, message, help } = misfit;
    let found = Diagnostic::new(
        Code::DataColumns,
        format!("`{file}`: {message}"),
        column.map_or(place, |at| columns[at].0.span),
        "does not fit the file",
    );
    let found = if column.is_some() { found.label(place, "this file") } else { found };
    found.help(help)
}
