//! The page of a sweep: what came out over what was varied, and a table of all rows.

use super::STYLE;
use super::cells::{Cells, Dots};
use super::tags::{Cell, escape, section, table};
use crate::command::line;
use crate::output::number::significant;
use crate::output::plural;
use crate::output::rows::{Scalars, Value};
use crate::output::sequence::Sequences;
use crate::output::units::Units;

/// A sweep with more rows has no page: nobody reads it, and it would be megabytes.
pub const MOST: usize = 5_000;
/// Says that there are too many rows for a page, if there are.
pub fn too_many(rows: usize) -> String {
    match rows > MOST {
        true => format!(
            " no page: it has room for {MOST} rows; `fdcc merge` makes a table of them all\n"
        ),
        false => String::new(),
    }
}

/// More rows are not in the table.
const MOST_LISTED: usize = 500;

/// What is on a page.
pub struct Page<'p> {
    pub model: &'p str,
    pub source: &'p str,
    /// The arguments of the sweep.
    pub command: Vec<String>,
    pub units: &'p Units,
    /// The parameters of the model: whatever else is swept is a key of the method, without a unit.
    pub params: &'p [String],
    /// The rows that there are, with their numbers.
    pub rows: Vec<(usize, Scalars)>,
    /// How many there are to be.
    pub all: usize,
}

/// A name that is varied or found, and its value in each row, in its unit.
struct Column {
    title: String,
    values: Vec<f64>,
}

/// How a row counts.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Sort {
    /// It can be used.
    Fine,
    /// It has values that are not certified, or not confirmed.
    Open,
    /// It has none.
    Failed,
}

fn sort(row: &Scalars) -> Sort {
    match row.status.as_str() {
        "solved" | "acceptable" if row.is_fine() => Sort::Fine,
        "solved" | "acceptable" | "uncertified" => Sort::Open,
        _ => Sort::Failed,
    }
}

impl Page<'_> {
    /// Its HTML.
    pub fn html(&self) -> String {
        let model = escape(self.model);
        let body = [self.header(), self.pictures(), self.listed(), self.text()].concat();
        format!(
            "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\"/>\n\
             <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\"/>\n\
             <title>{model}: a sweep</title>\n<style>\n{STYLE}</style>\n</head>\n<body>\n{body}\
             </body>\n</html>\n"
        )
    }

    /// `m [kg]` of a parameter; the name of a key of the method.
    fn title(&self, name: &str) -> String {
        if self.is_param(name) { self.units.title(name) } else { name.to_owned() }
    }

    fn scaled(&self, name: &str, value: f64) -> f64 {
        if self.is_param(name) { self.units.scaled(name, value) } else { value }
    }

    fn is_param(&self, name: &str) -> bool {
        self.params.iter().any(|it| it == name)
    }

    fn header(&self) -> String {
        let sorts: Vec<Sort> = self.rows.iter().map(|(_, row)| sort(row)).collect();
        let count = |of: Sort| sorts.iter().filter(|it| **it == of).count();
        let (open, failed) = (count(Sort::Open), count(Sort::Failed));
        let missing = self.all - self.rows.len();
        let class = match (failed + missing, open) {
            (0, 0) => "certain",
            (0, _) => "open",
            _ => "wrong",
        };
        let mut told =
            vec![format!("{} of {} can be used", count(Sort::Fine), plural(self.all, "row"))];
        let more = [
            (open, "not certified or not confirmed"),
            (failed, "not solved"),
            (missing, "not there yet"),
        ];
        told.extend(more.iter().filter(|it| it.0 > 0).map(|(many, what)| format!("{many} {what}")));
        format!(
            "<header class=\"verdicts\">\n<div>\n<p class=\"model\">{}</p>\n\
             <h1 class=\"{class}\">Sweep: {}</h1>\n{}</div>\n</header>\n",
            escape(self.model),
            told.join(", "),
            legend()
        )
    }

    fn pictures(&self) -> String {
        let (varied, found) = (self.varied(), self.found());
        let mut figures = match &varied[..] {
            [x] => found.iter().map(|y| self.over(x, y, true)).collect(),
            [x, y] if is_grid(x, y) => found.iter().map(|it| self.map([x, y], it)).collect(),
            many => {
                let over = |x| found.iter().map(|y| self.over(x, y, false)).collect::<Vec<_>>();
                many.iter().flat_map(over).collect::<Vec<String>>()
            }
        };
        let varies = |it: &&Column| differ(&it.values);
        if let [objective, others @ ..] = &found[..] {
            let others = others.iter().filter(varies);
            figures.extend(others.map(|it| self.over(it, objective, false)));
        }
        match figures.is_empty() {
            true => String::new(),
            false => section(
                "What came out",
                &format!("<div class=\"plots\">\n{}</div>\n", figures.concat()),
            ),
        }
    }

    fn sorts(&self) -> impl Iterator<Item = Sort> {
        self.rows.iter().map(|(_, row)| sort(row))
    }

    /// A value over a number.
    fn over(&self, x: &Column, y: &Column, is_line: bool) -> String {
        let (titles, points) = ([&x.title, &y.title], x.values.iter().zip(&y.values));
        let points = points.zip(self.sorts()).map(|((x, y), sort)| (*x, *y, sort)).collect();
        figure(&y.title, &x.title, &Dots::new(titles, points, is_line).svg())
    }

    /// A value as colours over two numbers.
    fn map(&self, [x, y]: [&Column; 2], value: &Column) -> String {
        let places = x.values.iter().zip(&y.values).map(|(x, y)| [*x, *y]);
        let cells = places.zip(&value.values).zip(self.sorts());
        let cells = cells.map(|((place, value), sort)| (place, *value, sort)).collect();
        let picture = Cells::new([&x.title, &y.title], &value.title, cells).svg();
        figure(&value.title, &format!("{} and {}", x.title, y.title), &picture)
    }

    /// The numbers that have several values; of columns that all go the same way, as lists side by
    /// side do, the first.
    fn varied(&self) -> Vec<Column> {
        let Some((_, first)) = self.rows.first() else { return Vec::new() };
        let column = |(at, (name, _)): (usize, &(String, Value))| {
            let value = |(_, row): &(usize, Scalars)| match row.swept.0.get(at) {
                Some((_, Value::Whole(it))) => self.scaled(name, *it as f64),
                Some((_, Value::Number(it))) => self.scaled(name, *it),
                _ => f64::NAN,
            };
            Column { title: self.title(name), values: self.rows.iter().map(value).collect() }
        };
        let all = first.swept.0.iter().enumerate().map(column);
        let is_number = |it: &Column| it.values.iter().all(|it| it.is_finite());
        let mut all: Vec<Column> = all.filter(|it| is_number(it) && differ(&it.values)).collect();
        if all.split_first().is_some_and(|(x, others)| others.iter().all(|y| go_together(x, y))) {
            all.truncate(1);
        }
        all
    }

    /// The objective and the unknowns.
    fn found(&self) -> Vec<Column> {
        let Some((_, first)) = self.rows.first() else { return Vec::new() };
        let column = |name: &str, value: &dyn Fn(&Scalars) -> Option<f64>| Column {
            title: self.units.title(name),
            values: self
                .rows
                .iter()
                .map(|(_, row)| value(row).filter(|_| sort(row) != Sort::Failed))
                .map(|it| self.units.scaled(name, it.unwrap_or(f64::NAN)))
                .collect(),
        };
        let mut found = vec![column("objective", &|row: &Scalars| row.objective)];
        found.extend(first.free.0.iter().enumerate().map(|(at, (name, _))| {
            column(name, &|row: &Scalars| row.free.0.get(at).and_then(|it| it.1))
        }));
        found
    }

    fn listed(&self) -> String {
        let Some((_, first)) = self.rows.first() else { return String::new() };
        let names = |all: &[(String, Option<f64>)]| -> Vec<String> {
            all.iter().map(|it| self.units.title(&it.0)).collect()
        };
        let mut head = vec!["row".to_owned()];
        head.extend(first.swept.0.iter().map(|it| self.title(&it.0)));
        head.push(self.units.title("objective"));
        head.extend(names(&first.free.0));
        head.extend(["iterations", "status"].map(str::to_owned));
        let sequences = Sequences::new(self.rows.iter().map(|it| &it.1));
        head.extend(sequences.differ().then(|| "sequence".to_owned()));
        let head: Vec<&str> = head.iter().map(String::as_str).collect();
        let row = |it: &(usize, Scalars)| {
            let letter = sequences.differ().then(|| Cell::text(sequences.letter(&it.1)));
            self.row(it).into_iter().chain(letter).collect()
        };
        let rows: Vec<_> = self.rows.iter().take(MOST_LISTED).map(row).collect();
        let title = match self.rows.len() > MOST_LISTED {
            true => format!("The first {MOST_LISTED} rows"),
            false => "All rows".into(),
        };
        table(&title, &head, &rows) + &listed_sequences(&sequences)
    }

    fn row(&self, (number, row): &(usize, Scalars)) -> Vec<Cell> {
        let shown = |name: &str, it: f64| significant(self.units.scaled(name, it), 7);
        let swept = |name: &str, it: f64| Cell::Number(significant(self.scaled(name, it), 7));
        let mut cells = vec![Cell::Number(number.to_string())];
        cells.extend(row.swept.0.iter().map(|(name, value)| match value {
            Value::Whole(it) => swept(name, *it as f64),
            Value::Number(it) => swept(name, *it),
            Value::Word(it) => Cell::text(it),
        }));
        let number =
            |name: &str, it: Option<f64>| Cell::Number(it.map_or("-".into(), |it| shown(name, it)));
        cells.push(number("objective", row.objective));
        cells.extend(row.free.0.iter().map(|(name, it)| number(name, *it)));
        cells.push(Cell::Number(row.iterations.to_string()));
        let confirmed = match row.confirmed {
            Some(false) => ", NOT CONFIRMED",
            _ => "",
        };
        cells.push(Cell::text(format!("{}{confirmed}", row.status.replace('_', " "))));
        cells
    }

    fn text(&self) -> String {
        let words = self.command.iter().map(String::as_str).chain(["--out", "results"]);
        let again = match self.command.is_empty() {
            true => String::new(),
            false => format!("<p>To run it again:</p>\n<pre>{}</pre>\n", escape(&line(words))),
        };
        let body = format!(
            "{again}<details><summary>{}.fdc</summary>\n<pre>{}</pre></details>\n",
            escape(self.model),
            escape(self.source)
        );
        section("The model", &body)
    }
}

/// What the letters of the table stand for.
fn listed_sequences(sequences: &Sequences) -> String {
    let rows: Vec<Vec<Cell>> =
        sequences.all().map(|it| vec![Cell::text(it.0), Cell::text(it.1)]).collect();
    table("What follows what in certified rows", &["sequence", ""], &rows)
}

fn legend() -> &'static str {
    "<p>Filled: a row that can be used. <b class=\"open\">Hollow, amber</b>: not certified, or not \
     confirmed. <b class=\"wrong\">A red cross</b>: not solved, so that there is no value.</p>\n"
}

fn figure(title: &str, over: &str, svg: &str) -> String {
    let [title, over] = [title, over].map(escape);
    format!(
        "<figure><figcaption>{title} <span class=\"unit\">over {over}</span></figcaption>\n\
         <div class=\"drawn\" role=\"img\" aria-label=\"{title} over {over}\">{svg}</div>\n\
         </figure>\n"
    )
}

fn differ(values: &[f64]) -> bool {
    let mut known = values.iter().filter(|it| it.is_finite());
    let first = known.next();
    known.any(|it| Some(it) != first)
}

/// Whether a column rises or falls all the way with another one.
fn go_together(x: &Column, y: &Column) -> bool {
    let mut pairs: Vec<(f64, f64)> =
        x.values.iter().copied().zip(y.values.iter().copied()).collect();
    pairs.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.total_cmp(&b.1)));
    pairs.dedup();
    let goes = |is: fn(f64, f64) -> bool| {
        pairs.windows(2).all(|it| it[0].0 < it[1].0 && is(it[0].1, it[1].1))
    };
    goes(|a, b| a < b) || goes(|a, b| a > b)
}

/// Whether there is a row for most pairs of values of two columns.
fn is_grid(x: &Column, y: &Column) -> bool {
    let count = |values: &[f64]| {
        let mut all = values.to_vec();
        all.sort_by(f64::total_cmp);
        all.dedup();
        all.len()
    };
    2 * x.values.len() > count(&x.values) * count(&y.values)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::output::rows::Line;

    fn rows(texts: &[&str]) -> Vec<(usize, Scalars)> {
        let line = |(at, text): (usize, &&str)| {
            let text = format!(
                r#"{{"row":1,"rows":4,"key":"","swept":{{{text}}},"free":{{}},"iterations":3,
                   "kkt_error":0,"constraint_violation":0,
                   "seconds":{{"compile":0,"solve":0,"total":0}}"#
            );
            let end = if text.contains("bad") {
                r#""none_found","objective":9}"#
            } else {
                r#""solved","objective":2}"#
            };
            let text = format!("{text},\"status\":{end}").replace("bad", "mu");
            (at + 1, Line::read(text.as_bytes()).expect("it is a line").scalars)
        };
        texts.iter().enumerate().map(line).collect()
    }

    fn page(rows: Vec<(usize, Scalars)>, all: usize) -> String {
        let units = Units::default();
        Page {
            model: "a",
            source: "model <a>",
            command: vec!["sweep".into()],
            units: &units,
            params: &[],
            rows,
            all,
        }
        .html()
    }

    #[test]
    fn rows_that_failed_or_are_missing_are_in_the_headline_and_have_no_value() {
        let rows = rows(&[r#""mu":0.1"#, r#""bad":0.2"#, r#""mu":0.3"#]);
        let html = page(rows, 4);
        assert!(html.contains("2 of 4 rows can be used, 1 not solved, 1 not there yet"), "{html}");
        assert!(html.contains("<h1 class=\"wrong\">") && html.contains("model &lt;a&gt;"));
        assert_eq!(html.matches("<figure>").count(), 1);
        assert_eq!(html.matches("class=\"drawn\"").count(), 1);
    }

    #[test]
    fn lists_side_by_side_are_one_axis_and_a_product_is_two() {
        let side = [r#""mu":0.1,"N":50"#, r#""mu":0.2,"N":100"#];
        let product = [r#""mu":0.1,"N":50"#, r#""mu":0.2,"N":50"#, r#""mu":0.1,"N":80"#];
        assert!(!page(rows(&side), 2).contains("mu and N"));
        assert!(page(rows(&product), 3).contains("mu and N"));
    }

    #[test]
    fn a_sweep_without_a_page_says_so() {
        assert!(too_many(MOST).is_empty() && too_many(MOST + 1).contains("room for 5000 rows"));
    }

    /// A table of cases: neither a line, which says that what is between is known, nor a grid.
    #[test]
    fn columns_that_vary_each_for_itself_are_points_over_each() {
        let cases = [r#""mu":0.1,"N":50"#, r#""mu":0.2,"N":90"#, r#""mu":0.3,"N":60"#];
        let html = page(rows(&[&cases[..], &[r#""mu":0.4,"N":70"#]].concat()), 4);
        assert_eq!(html.matches("<figure>").count(), 2, "{html}");
        assert!(html.contains("over mu</span>") && html.contains("over N</span>"));
        assert!(
            !html.contains("mu and N")
                && !html.contains(r##"fill="none" opacity="1" stroke="#1F5FA8""##)
        );
    }
}
