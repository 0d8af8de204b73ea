//! Columns: neighbouring rows of one kind have their names, units, bounds and values below each
//! other.

use super::lines::Line;
use crate::parse::{Column, Row};

const UNIT_FIRST: [Column; 4] = [Column::Name, Column::Unit, Column::Bounds, Column::Rest];
const BOUNDS_FIRST: [Column; 4] = [Column::Name, Column::Bounds, Column::Unit, Column::Rest];
const NEITHER: [Column; 2] = [Column::Name, Column::Rest];

/// Lines up all groups of neighbours.
pub(super) fn line_up(lines: &mut [Line<'_>]) {
    let mut start = 0;
    while start < lines.len() {
        let follows = |at: &usize| belong_together(&lines[at - 1], &lines[*at]);
        let end = (start + 1..lines.len()).find(|at| !follows(at)).unwrap_or(lines.len());
        line_up_group(&mut lines[start..end]);
        start = end;
    }
}

fn belong_together(above: &Line<'_>, below: &Line<'_>) -> bool {
    let same_kind = below.row().is_some_and(|row| row != Row::Alone && above.row() == Some(row));
    same_kind && !below.blank_before && above.indent == below.indent
}

fn line_up_group(rows: &mut [Line<'_>]) {
    let has_order = |first, second| rows.iter().any(|row| is_before(row, first, second));
    let unit_first = has_order(Column::Unit, Column::Bounds);
    let columns: &[Column] = match (unit_first, has_order(Column::Bounds, Column::Unit)) {
        (true, true) => &NEITHER,
        (false, true) => &BOUNDS_FIRST,
        _ => &UNIT_FIRST,
    };
    columns.iter().for_each(|column| line_up_column(rows, *column));
}

fn is_before(row: &Line<'_>, first: Column, second: Column) -> bool {
    matches!((find(row, first), find(row, second)), (Some(first), Some(second)) if first < second)
}

/// The word that begins a column.
fn find(row: &Line<'_>, column: Column) -> Option<usize> {
    row.words.iter().position(|word| word.column == Some(column))
}

/// Moves a column of all rows to where the longest of them has it.
fn line_up_column(rows: &mut [Line<'_>], column: Column) {
    let ends: Vec<Option<usize>> =
        rows.iter().map(|row| find(row, column).map(|at| row.width_before(at))).collect();
    let furthest = ends.iter().flatten().max().copied().unwrap_or(0);
    for (row, end) in rows.iter_mut().zip(ends) {
        if let (Some(at), Some(end)) = (find(row, column), end) {
            row.words[at].blanks = furthest - end + 1;
        }
    }
}
