//! Tables and figures of a page that a test computes: compared with what is there, or written with
//! `UPDATE=1`.

use crate::repository;

/// A file of the repository is this text.
pub fn check_file(path: &str, found: &str) {
    let file = repository().join(path);
    if std::env::var_os("UPDATE").is_some() {
        std::fs::write(&file, found).unwrap_or_else(|error| panic!("{path}: {error}"));
    }
    let before = std::fs::read_to_string(&file).unwrap_or_default();
    assert!(
        before == found,
        "{path} has changed; if for good reasons, run the test with UPDATE=1\n{found}"
    );
}

/// The rows of tables of a page, each below a line `<!-- NAME -->` and its headings. One call for
/// all tables of a page.
pub fn check_tables(path: &str, tables: &[(&str, Vec<Vec<String>>)]) {
    let page = std::fs::read_to_string(repository().join(path));
    let page = page.unwrap_or_else(|error| panic!("{path}: {error}"));
    check_file(path, &tables.iter().fold(page, |page, (name, rows)| with_table(&page, name, rows)));
}

fn with_table(page: &str, name: &str, rows: &[Vec<String>]) -> String {
    let mark = format!("<!-- {name} -->\n");
    let (before, table) =
        page.split_once(&mark).unwrap_or_else(|| panic!("the page has no line {mark}"));
    let mut lines = table.split_inclusive('\n');
    let headings: String = lines.by_ref().take(2).collect();
    let after: String = lines.skip_while(|line| line.starts_with('|')).collect();
    let rows: String = rows.iter().map(|row| format!("| {} |\n", row.join(" | "))).collect();
    [before, &mark, &headings, &rows, &after].concat()
}

#[cfg(test)]
mod tests {
    use super::with_table;

    #[test]
    fn only_the_rows_of_a_table_are_replaced() {
        let page = "above\n<!-- one -->\n| a |\n|---|\n| 1 |\n| 2 |\n\nbelow\n<!-- two -->\n| b \
                    |\n|---|\n";
        let found =
            with_table(&with_table(page, "one", &[vec!["3".into()]]), "two", &[vec!["4".into()]]);
        assert_eq!(
            found,
            "above\n<!-- one -->\n| a |\n|---|\n| 3 |\n\nbelow\n<!-- two -->\n| b |\n|---|\n| 4 |\n"
        );
    }
}
