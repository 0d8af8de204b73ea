//! Comments at the ends of neighbouring lines stand below each other, at one of two columns where
//! the lines are short.

use super::lines::Line;

/// Where comments stand: the first column that leaves two blanks to all lines of a group.
const COLUMNS: [usize; 2] = [42, 60];

/// Gives every comment behind words its blanks, and those that go on below it.
pub(super) fn line_up(lines: &mut [Line<'_>]) {
    let mut start = 0;
    while start < lines.len() {
        let has_comment = is_in_group(&lines[start]);
        let follows =
            |at: &usize| has_comment && is_in_group(&lines[*at]) && !lines[*at].blank_before;
        let end = (start + 1..lines.len()).find(|at| !follows(at)).unwrap_or(lines.len());
        line_up_group(&mut lines[start..end]);
        start = end;
    }
}

fn is_in_group(line: &Line<'_>) -> bool {
    line.comment.is_some_and(|comment| !line.words.is_empty() || comment.continues)
}

fn line_up_group(lines: &mut [Line<'_>]) {
    // Lines that are longer than the last column do not move the others.
    let last = COLUMNS[COLUMNS.len() - 1];
    let ends = lines.iter().map(|line| line.width() + 2).filter(|end| *end <= last);
    let widest = ends.max().unwrap_or(0);
    let column = COLUMNS.into_iter().find(|column| widest <= *column).unwrap_or(last);
    let mut above = column;
    for line in lines.iter_mut().filter(|line| is_in_group(line)) {
        let place = match line.comment {
            Some(comment) if comment.continues => above,
            _ => column.max(line.width() + 2),
        };
        above = place;
        let width = line.width();
        if let Some(comment) = &mut line.comment {
            comment.blanks = place.saturating_sub(width);
        }
    }
}
