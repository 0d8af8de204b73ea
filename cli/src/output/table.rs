//! Tables for people: the rows of a sweep, and any columns with a head.

use super::number::aligned;
use super::rows::{Row, Scalars};
use super::sequence::Sequences;
use super::units::Units;
use comfy_table::{CellAlignment, Table, presets};

/// As many digits as Table 7.1 of the paper has.
const DIGITS: usize = 7;

/// The table: what was swept, as it was given, then what came out.
pub fn table<'d>(
    rows: impl Iterator<Item = (Vec<(&'d str, &'d str)>, &'d Row)>,
    units: &Units,
    confirmed: bool,
) -> String {
    let rows: Vec<_> = rows.collect();
    let sequences = Sequences::new(rows.iter().map(|it| &it.1.scalars));
    let mut table = Table::new();
    table.load_style(presets::NOTHING);
    for (swept, row) in rows {
        let found = row.scalars.free.0.iter().map(|(name, _)| name.as_str());
        let found = ["objective"].into_iter().chain(found).map(|name| units.title(name));
        let results =
            ["iterations", "seconds", "status"].into_iter().chain(confirmed.then_some("confirmed"));
        let names = swept.iter().map(|(name, _)| (*name).to_owned());
        let results = results.chain(sequences.differ().then_some("sequence"));
        table.set_header(names.chain(found).chain(results.map(str::to_string)));
        let confirmed = confirmed.then(|| answer(row).to_string());
        let letter = sequences.differ().then(|| sequences.letter(&row.scalars));
        let cells = cells(&swept, &row.scalars, units);
        table.add_row(cells.into_iter().chain(confirmed).chain(letter));
    }
    let words = 1 + usize::from(confirmed) + usize::from(sequences.differ());
    let last = table.column_count().saturating_sub(words);
    table
        .column_iter_mut()
        .take(last)
        .for_each(|column| column.set_cell_alignment(CellAlignment::Right));
    let lines = table.lines().map(|line| line.trim_end().to_string() + "\n");
    lines.collect::<String>() + &sequences.lines()
}

/// Whether a row is confirmed, and why not.
fn answer(row: &Row) -> &'static str {
    match (&row.verification, &row.optimality) {
        (None, _) => "no: not replayed",
        (Some(it), _) if !it.confirmed => "NO: the true system differs",
        (_, Some(it)) if it.contradicted => "NO: contradicted as an optimum",
        _ => "yes",
    }
}

fn cells(swept: &[(&str, &str)], row: &Scalars, units: &Units) -> Vec<String> {
    let values = swept.iter().map(|(_, value)| (*value).to_owned());
    let number = |value: Option<f64>| value.unwrap_or(f64::NAN);
    let free = row.free.0.iter();
    let free = free.map(|(name, value)| aligned(units.scaled(name, number(*value)), DIGITS));
    let rest = [
        row.iterations.to_string(),
        format!("{:.3}", row.seconds.total),
        row.status.replace('_', " "),
    ];
    let objective = aligned(units.scaled("objective", number(row.objective)), DIGITS);
    values.chain([objective]).chain(free).chain(rest).collect()
}

/// Aligned columns with a head; nothing without rows.
pub fn with_head(head: Vec<&str>, rows: Vec<Vec<String>>) -> String {
    if rows.is_empty() {
        return String::new();
    }
    let mut table = Table::new();
    table.load_style(presets::NOTHING);
    table.set_header(head);
    table.add_rows(rows);
    table
        .column_iter_mut()
        .skip(1)
        .for_each(|column| column.set_cell_alignment(CellAlignment::Right));
    table.lines().map(|line| line.trim_end().to_string() + "\n").collect()
}
