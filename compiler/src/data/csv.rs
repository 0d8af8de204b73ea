//! Comma-separated values: a line of names, then a line of numbers for each row.
//!
//! Commas may be semicolons or tabs, names may stand in quotes, and lines that are empty or begin
//! with `#` are passed over. A file without names has the declared columns in their order.

use crate::syntax::closest;

/// The wanted columns of a file.
pub(super) struct Sheet {
    /// The line of each row, from 1.
    pub lines: Vec<usize>,
    /// One entry for each row.
    pub columns: Vec<Vec<f64>>,
}

/// Why a file does not fit.
pub(super) struct Misfit {
    /// The wanted column that it is about.
    pub column: Option<usize>,
    pub message: String,
    pub help: String,
}

impl Misfit {
    fn new(column: Option<usize>, message: String, help: impl Into<String>) -> Self {
        Misfit { column, message, help: help.into() }
    }
}

/// The fields of a line that says something, with its number.
struct Line<'t> {
    number: usize,
    fields: Vec<&'t str>,
}

/// Reads the columns of these names.
pub(super) fn read(text: &str, names: &[&str]) -> Result<Sheet, Misfit> {
    let text = text.trim_start_matches('\u{FEFF}');
    let mut lines = lines(text).peekable();
    let Some(first) = lines.peek() else {
        return Err(Misfit::new(None, "the file is empty".into(), "it needs a row at least"));
    };
    let has_names = first.fields.iter().any(|field| field.parse::<f64>().is_err());
    let places = if has_names { by_name(first, names)? } else { in_order(first, names)? };
    let width = first.fields.len();
    let mut sheet = Sheet { lines: Vec::new(), columns: vec![Vec::new(); names.len()] };
    for line in lines.skip(usize::from(has_names)) {
        row(&line, width, names, &places, &mut sheet)?;
    }
    match sheet.lines.is_empty() {
        true => Err(Misfit::new(None, "the file has no rows".into(), "it needs one at least")),
        false => Ok(sheet),
    }
}

fn lines(text: &str) -> impl Iterator<Item = Line<'_>> {
    let says_something = |line: &str| !line.trim().is_empty() && !line.starts_with('#');
    let first = text.lines().find(|line| says_something(line)).unwrap_or_default();
    let separator = [',', ';', '\t'].into_iter().find(|it| first.contains(*it)).unwrap_or(',');
    let numbered = text.lines().enumerate().filter(move |(_, line)| says_something(line));
    numbered.map(move |(at, line)| Line {
        number: at + 1,
        fields: line.split(separator).map(field).collect(),
    })
}

/// Without blanks and quotes around it.
fn field(text: &str) -> &str {
    let text = text.trim();
    text.strip_prefix('"').and_then(|text| text.strip_suffix('"')).unwrap_or(text)
}

fn by_name(header: &Line, names: &[&str]) -> Result<Vec<usize>, Misfit> {
    let place = |(at, name): (usize, &&str)| {
        let mut places = (0..header.fields.len()).filter(|it| header.fields[*it] == *name);
        let place = places.next();
        if places.next().is_some() {
            let message = format!("there are two columns `{name}`");
            let help = "which one is meant? give the other one another name in the file";
            return Err(Misfit::new(Some(at), message, help));
        }
        place.ok_or_else(|| {
            let message = format!("there is no column `{name}`");
            let there = format!("its columns are `{}`", header.fields.join("`, `"));
            let help = match closest(name, header.fields.iter().copied()) {
                Some(close) => format!("did you mean `{close}`? {there}"),
                None => there,
            };
            Misfit::new(Some(at), message, help)
        })
    };
    names.iter().enumerate().map(place).collect()
}

fn in_order(first: &Line, names: &[&str]) -> Result<Vec<usize>, Misfit> {
    if first.fields.len() == names.len() {
        return Ok((0..names.len()).collect());
    }
    let (there, wanted) = (first.fields.len(), names.len());
    let message = format!("it has {there} columns without names, and the model declares {wanted}");
    Err(Misfit::new(None, message, "give the columns of the file names in its first line"))
}

fn row(
    line: &Line,
    width: usize,
    names: &[&str],
    places: &[usize],
    sheet: &mut Sheet,
) -> Result<(), Misfit> {
    let (number, count) = (line.number, line.fields.len());
    if count != width {
        let message = format!("line {number} has {count} fields, and the first one has {width}");
        return Err(Misfit::new(None, message, "each line needs a number for each column"));
    }
    for (at, place) in places.iter().enumerate() {
        let text = line.fields[*place];
        let value: Option<f64> = text.parse().ok().filter(|value: &f64| value.is_finite());
        sheet.columns[at].push(value.ok_or_else(|| no_number(number, (at, names[at]), text))?);
    }
    sheet.lines.push(number);
    Ok(())
}

fn no_number(line: usize, (at, name): (usize, &str), text: &str) -> Misfit {
    let what = match text {
        "" => "nothing stands".into(),
        _ => format!("`{text}` stands"),
    };
    let is_with_comma = text.replacen(',', ".", 1).parse::<f64>().is_ok();
    let help = match is_with_comma && text.contains(',') {
        true => "numbers have a decimal point: `1.5`, not `1,5`",
        false => {
            "for what was not measured write any number and give it the weight 0, in a column of \
             weights: `k.w*(x(k.t) - k.x)^2`"
        }
    };
    let message = format!("line {line}: {what} where `{name}` needs a finite number");
    Misfit::new(Some(at), message, help)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn columns(text: &str) -> Vec<Vec<f64>> {
        read(text, &["t", "x"]).map(|sheet| sheet.columns).unwrap_or_default()
    }

    #[test]
    fn the_same_table_is_written_in_several_ways() {
        let expected = vec![vec![0.0, 0.5], vec![1.0, -2e-3]];
        for text in [
            "t,x\n0,1\n0.5,-2e-3\n",
            "\u{FEFF}\"x\"; \"y\" ;\"t\"\r\n1;7;0\r\n\r\n-2e-3; 8 ;0.5",
            "# measured in May\nx\tt\n1\t0\n# a break\n-0.002\t.5\n",
            "0,1\n0.5,-2e-3",
        ] {
            assert_eq!(columns(text), expected, "{text}");
        }
    }

    #[test]
    fn what_does_not_fit_is_told_with_its_line() {
        let told = |text: &str| read(text, &["t", "x"]).err().expect("it does not fit").message;
        for (text, words) in [
            ("", "empty"),
            ("t,x\n", "no rows"),
            ("t,y\n0,1", "no column `x`"),
            ("t,x,x\n0,1,2", "there are two columns `x`"),
            ("0,1,2", "3 columns without names"),
            ("t,x\n0,1\n1", "line 3 has 1 fields"),
            ("t,x\n0,1\n\n1,nan", "line 4: `nan` stands where `x`"),
            ("t,x\n,1", "line 2: nothing stands where `t`"),
        ] {
            assert!(told(text).contains(words), "{text}: {}", told(text));
        }
    }
}
