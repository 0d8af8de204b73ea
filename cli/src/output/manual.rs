//! Pages of the manual on a terminal: tables and paragraphs as wide as that.

use super::wrap;
use comfy_table::{ContentArrangement, Table, presets};

/// The widest line that reads well.
const WIDEST: usize = 100;

/// A page in Markdown as a terminal shows it; as it is where the standard output is none.
pub fn for_terminal(markdown: &str) -> String {
    wrap::terminal().map_or_else(|| markdown.to_owned(), |it| formatted(markdown, it.min(WIDEST)))
}

/// Tables drawn, paragraphs broken, code as it is. Links have no address: it leads nowhere in a
/// terminal.
fn formatted(markdown: &str, width: usize) -> String {
    let (mut text, mut is_code) = (String::new(), false);
    let (mut rows, mut paragraph) = (Vec::new(), String::new());
    for line in markdown.lines().chain([""]) {
        let is_fence = line.starts_with("```");
        let is_plain = !is_code && !is_fence;
        if is_plain && line.starts_with('|') {
            rows.push(cells(&without_addresses(line)));
            continue;
        }
        text += &table(std::mem::take(&mut rows), width);
        if is_plain && continues(line) {
            paragraph += if paragraph.is_empty() { "" } else { " " };
            paragraph += line.trim();
            continue;
        }
        text += &broken(&std::mem::take(&mut paragraph), width);
        is_code ^= is_fence;
        text += &if is_plain { broken(line, width) } else { line.to_owned() + "\n" };
        if is_plain && line.is_empty() {
            text += "\n";
        }
    }
    text.trim_end().to_owned() + "\n"
}

/// Whether a line is one of a paragraph: no heading, and nothing of a list.
fn continues(line: &str) -> bool {
    !line.is_empty() && !line.starts_with(['#', '-', '*', '>', ' ']) && !is_numbered(line)
}

fn is_numbered(line: &str) -> bool {
    line.split_once(". ").is_some_and(|(number, _)| number.parse::<u32>().is_ok())
}

fn broken(line: &str, width: usize) -> String {
    let line = without_addresses(line);
    if line.is_empty() { line } else { wrap::hanging(&line, width, 0) + "\n" }
}

fn cells(row: &str) -> Vec<String> {
    // A bar in code is no border.
    let row = row.trim().trim_matches('|').replace("\\|", "\u{1}");
    row.split('|').map(|cell| cell.trim().replace('\u{1}', "|")).collect()
}

/// A table without the line under its head, which says how columns are aligned.
fn table(rows: Vec<Vec<String>>, width: usize) -> String {
    let Some((head, rows)) = rows.split_first() else { return String::new() };
    let mut table = Table::new();
    table.load_style(presets::UTF8_HORIZONTAL_ONLY);
    table.set_content_arrangement(ContentArrangement::Dynamic);
    table.set_width(width as u16).set_header(head);
    rows.iter().skip(1).for_each(|row| {
        table.add_row(row);
    });
    let lines = table.lines().map(|line| line.trim_end().to_string() + "\n");
    // What goes on in the next line of a row has nothing in the first column.
    lines.filter(|line| !line.starts_with('─')).collect()
}

/// `[words](address)` as `words`.
fn without_addresses(line: &str) -> String {
    let (mut text, mut rest) = (String::new(), line);
    while let Some(middle) = rest.find("](") {
        let begin = rest[..middle].rfind('[');
        let end = rest[middle..].find(')').map(|at| middle + at);
        let (Some(begin), Some(end)) = (begin, end) else { break };
        text += &rest[..begin];
        text += &rest[begin + 1..middle];
        rest = &rest[end + 1..];
    }
    text + rest
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_page_is_as_wide_as_a_terminal() {
        let words = "many words that go on and on ".repeat(8);
        let page = format!(
            "# Title\n\n{words}\n\n| a | b |\n|---|---|\n| `x \\| y` | {words}[link](to/it) |\n"
        );
        let shown = formatted(&page, 60);
        assert!(shown.lines().all(|line| line.chars().count() <= 60), "{shown}");
        assert!(shown.contains("link") && !shown.contains("to/it") && shown.contains("x | y"));
        assert!(!shown.contains("---"), "{shown}");
    }

    #[test]
    fn code_stays_as_it_is() {
        let code = format!("```fdc\n{}\n\n| a |\n```\n", "x' = a[1](t) ".repeat(9));
        let page = format!("# Title\n\n{code}\n- one\n- two\n");
        assert_eq!(formatted(&page, 60), page);
    }
}
