//! Measured data: the texts of data files as tables of numbers.
//!
//! The compiler opens no files. Whoever calls it may give it [`Files`], which hand in the text of
//! a file by the name that the model writes; without them a model with data waits.

mod csv;

use crate::units;
use csv::{Misfit, Sheet};
use fdcc_grammar::ast::{Ident, Item, ItemKind, Unit};
use fdcc_grammar::{Code, Diagnostic, Span};
use std::collections::HashMap;

/// Hands in the text of a data file by its name in the model, or says why it cannot.
pub type Files<'f> = dyn Fn(&str) -> Result<String, String> + 'f;

/// The declared columns of a data file.
#[derive(Clone, Debug)]
pub struct Table {
    /// The name of the data set.
    pub name: String,
    /// The name of the file.
    pub file: String,
    /// Where that stands in the model.
    pub place: Span,
    /// The line of the file at which each row stands, counted from 1.
    pub lines: Vec<usize>,
    /// The names of the columns that the model takes.
    pub names: Vec<String>,
    /// In SI, one entry for each row.
    pub columns: Vec<Vec<f64>>,
}

/// All data sets of a text that could be read, by the places of their file names.
pub(crate) type Tables = HashMap<Span, Table>;

impl Table {
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
pub(crate) fn read(items: &[Item], files: &Files, found: &mut Vec<Diagnostic>) -> Tables {
    let mut tables = Tables::new();
    for item in items {
        match &item.kind {
            ItemKind::Data { name, file, file_span, columns } => {
                match table(name, (file, *file_span), columns, files) {
                    Ok(table) => {
                        tables.insert(*file_span, table);
                    }
                    Err(diagnostic) => found.push(diagnostic),
                }
            }
            ItemKind::Phase { items, .. } => tables.extend(read(items, files, found)),
            _ => {}
        }
    }
    tables
}

fn table(
    name: &Ident,
    (file, place): (&str, Span),
    columns: &[(Ident, Option<Unit>)],
    files: &Files,
) -> Result<Table, Diagnostic> {
    let text = files(file).map_err(|reason| unreadable(file, place, &reason))?;
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
