//! The cases of a file: a table in CSV, or JSON with an object on each line.

use crate::output::rows::case;

/// A name and its values, one for each case.
type List = (String, Vec<String>);

/// Reads a text; what begins with `{` is JSON.
///
/// # Errors
///
/// What is wrong with it, with the number of the line.
pub fn lists(text: &str) -> Result<Vec<List>, String> {
    let text = text.strip_prefix('\u{feff}').unwrap_or(text);
    let lines = text.lines().enumerate().map(|(at, line)| (at + 1, line.trim()));
    let mut lines = lines.filter(|(_, line)| !line.is_empty() && !line.starts_with('#')).peekable();
    match lines.peek() {
        None => Err("there are no cases in it".into()),
        Some((_, line)) if line.starts_with('{') => objects(lines),
        Some(_) => table(lines),
    }
}

fn objects<'t>(lines: impl Iterator<Item = (usize, &'t str)>) -> Result<Vec<List>, String> {
    let mut lists: Vec<List> = Vec::new();
    for (number, line) in lines {
        let mut values = case(line).map_err(|what| format!("line {number}: {what}"))?;
        if lists.is_empty() {
            lists = values.iter().map(|(name, _)| (name.clone(), Vec::new())).collect();
        }
        for (name, list) in &mut lists {
            let at = values.iter().position(|(own, _)| own == name);
            let at = at.ok_or_else(|| format!("line {number}: `{name}` has no value"))?;
            list.push(values.swap_remove(at).1);
        }
        if let Some((name, _)) = values.first() {
            return Err(format!("line {number}: `{name}` is not on the first line"));
        }
    }
    Ok(lists)
}

fn table<'t>(mut lines: impl Iterator<Item = (usize, &'t str)>) -> Result<Vec<List>, String> {
    let header = lines.next().map(|(_, line)| cells(line)).unwrap_or_default();
    let mut lists: Vec<List> = header.into_iter().map(|name| (name, Vec::new())).collect();
    for (number, line) in lines {
        let cells = cells(line);
        if cells.len() != lists.len() {
            let (own, all) = (cells.len(), lists.len());
            return Err(format!("line {number} has {own} values for {all} names"));
        }
        for ((name, list), cell) in lists.iter_mut().zip(cells) {
            if cell.is_empty() {
                return Err(format!("line {number}: `{name}` has no value"));
            }
            list.push(cell);
        }
    }
    match lists.first() {
        Some((_, values)) if values.is_empty() => Err("there is no case below the names".into()),
        _ => Ok(lists),
    }
}

/// The cells of a line; one in quotes may have a comma, and a quote that is doubled.
fn cells(line: &str) -> Vec<String> {
    let (mut cells, mut cell, mut is_quoted) = (Vec::new(), String::new(), false);
    let mut characters = line.chars().peekable();
    while let Some(it) = characters.next() {
        match it {
            '"' if is_quoted && characters.peek() == Some(&'"') => {
                cell.push('"');
                characters.next();
            }
            '"' => is_quoted = !is_quoted,
            ',' if !is_quoted => cells.push(std::mem::take(&mut cell).trim().to_owned()),
            _ => cell.push(it),
        }
    }
    cells.push(cell.trim().to_owned());
    cells
}

#[cfg(test)]
mod tests {
    use super::lists;

    fn of(names: &[(&str, &[&str])]) -> Vec<(String, Vec<String>)> {
        let list = |values: &[&str]| values.iter().map(|it| (*it).to_owned()).collect();
        names.iter().map(|(name, values)| ((*name).to_owned(), list(values))).collect()
    }

    #[test]
    fn a_table_and_lines_of_json_are_lists() {
        let expected = of(&[("mu", &["0.1", "200[g]"]), ("continue", &["0.1, 0.01", "1"])]);
        let table = "# cases\nmu, continue\n0.1,\"0.1, 0.01\"\n\n200[g],1\n";
        assert_eq!(lists(table), Ok(expected.clone()));
        let json = "{\"mu\": 0.1, \"continue\": \"0.1, 0.01\"}\n\
                    {\"continue\": 1, \"mu\": \"200[g]\"}";
        assert_eq!(lists(json), Ok(expected));
    }

    #[test]
    fn what_is_wrong_has_its_line() {
        for (text, words) in [
            ("", "no cases"),
            ("mu\n", "no case below"),
            ("mu,m\n1\n", "line 2 has 1 values for 2 names"),
            ("mu,m\n1,2\n1,\n", "line 3: `m` has no value"),
            ("{\"mu\": 1}\n{\"m\": 1}", "line 2: `mu` has no value"),
            ("{\"mu\": 1}\n{\"mu\": 1, \"m\": 2}", "line 2: `m` is not on the first line"),
            ("{\"mu\": [1]}", "line 1: `mu` needs a number or a text"),
            ("{\"mu\": 1", "line 1: this is no JSON object"),
        ] {
            let why = lists(text).expect_err(text);
            assert!(why.contains(words), "{text}: {why}");
        }
    }
}
