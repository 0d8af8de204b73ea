//! Lists of values, and the rows that they make.

mod range;
mod tuning;

use crate::error::Error;
use crate::model::{Model, Value};

/// A name and its values.
type List = (String, Vec<String>);

/// Names, each with its values: lists of one length go together row by row, and a list of one value
/// holds for all rows.
///
/// ```
/// let text = "time t in [0, 1]\nparam w = 1\nstate x start 0\ncontrol u in [-1, 1]
/// dynamics { x' = u }\nend x == 0.5\nminimize integral(w * u^2)";
/// let model = fdcc::Model::from_text("hop", text)?;
/// let grid = fdcc::Grid::read(&["w=1,2,4", "N=50"], &model)?;
/// let runs = model.sweep(&grid, &fdcc::Executor::default())?;
/// assert_eq!((runs.len(), runs.row(2)[0].1), (3, "4"));
/// assert!(runs.solutions().all(|it| it.is_solved()));
/// # Ok::<(), fdcc::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct Grid {
    lists: Vec<List>,
    /// After so many rows a list goes on to its next value; after its last it begins again.
    strides: Vec<usize>,
    /// The length of the longest list, and of all others but those of length 1; of all combinations
    /// the product of all lengths.
    pub rows: usize,
}

impl Grid {
    /// Reads `NAME=V1,V2,...`; a plain number is in the unit behind the last one, or else in the
    /// declared unit of the name.
    ///
    /// # Errors
    ///
    /// As for [`list`](Grid::list) and [`new`](Grid::new).
    pub fn read(texts: &[impl AsRef<str>], model: &Model) -> Result<Self, Error> {
        let lists = texts.iter().map(|text| Grid::list(text.as_ref()));
        Grid::new(lists.collect::<Result<_, _>>()?, model)
    }

    /// The lists of the model's own `sweep` block.
    ///
    /// # Errors
    ///
    /// A model without one.
    pub fn of(model: &Model) -> Result<Self, Error> {
        let model = model.meaning();
        if model.sweep.is_empty() {
            return Err(Error::Call(
                "nothing is swept: give NAME=V1,V2,... or write a `sweep` block in the model"
                    .into(),
            ));
        }
        let lists =
            model.sweep.iter().map(|swept| (swept.place.name.clone(), swept.values.clone()));
        Self::side_by_side(in_units(lists.collect(), |name, value| model.as_given(name, value)))
    }

    /// Lists of values; a plain number is in the declared unit of its name.
    ///
    /// # Errors
    ///
    /// A name that has two lists; lists of different lengths.
    pub fn new(lists: Vec<(String, Vec<String>)>, model: &Model) -> Result<Self, Error> {
        let with_unit = |name: &str, value: &str| model.meaning().with_unit(name, value);
        Self::side_by_side(in_units(lists, with_unit))
    }

    /// All combinations of the lists `NAME=V1,V2,...`; the last one changes fastest.
    ///
    /// ```
    /// let model = fdcc::Model::from_file("../models/block.fdc")?;
    /// let grid = fdcc::Grid::product(&["m=1,2", "mu=0.1:0.1:0.3"], &model)?;
    /// assert_eq!((grid.rows, grid.row(4)), (6, vec![("m", "2"), ("mu", "0.2")]));
    /// # Ok::<(), fdcc::Error>(())
    /// ```
    ///
    /// # Errors
    ///
    /// As for [`read`](Grid::read), but lengths may differ; more rows than can be counted.
    pub fn product(texts: &[impl AsRef<str>], model: &Model) -> Result<Self, Error> {
        let lists = texts.iter().map(|text| Grid::list(text.as_ref()));
        let with_unit = |name: &str, value: &str| model.meaning().with_unit(name, value);
        let lists = in_units(lists.collect::<Result<_, _>>()?, with_unit);
        unique(&lists)?;
        let (mut strides, mut rows) = (vec![1; lists.len()], 1usize);
        for (at, (_, values)) in lists.iter().enumerate().rev() {
            strides[at] = rows;
            let many = || Error::Call("these are more rows than can be counted".into());
            rows = rows.checked_mul(values.len()).ok_or_else(many)?;
        }
        Ok(Grid { lists, strides, rows })
    }

    /// Reads one list, `NAME=V1,V2,...`. `0.1:0.2:0.7` stands for 0.1, 0.3, 0.5, 0.7; a unit behind
    /// the last value is that of all plain numbers, as in a `sweep` block.
    ///
    /// ```
    /// let (_, values) = fdcc::Grid::list("a=1,2[mm],3[cm]")?;
    /// assert_eq!(values, ["1[cm]", "2[mm]", "3[cm]"]);
    /// # Ok::<(), fdcc::Error>(())
    /// ```
    ///
    /// # Errors
    ///
    /// A text of another form; a value that is empty; a range that does not get to its end.
    pub fn list(text: &str) -> Result<(String, Vec<String>), Error> {
        let wrong = || Error::Call(format!("`{text}` is not of the form NAME=V1,V2,..."));
        let (name, values) = text.split_once('=').ok_or_else(wrong)?;
        let name = name.trim();
        let values: Vec<&str> = values.split(',').map(str::trim).collect();
        if let Some(at) = values.iter().position(|it| it.is_empty()) {
            return Err(Error::Call(format!("value {} of `{name}` is empty", at + 1)));
        }
        let each = values.into_iter().map(|value| {
            let range = range::values(value).map_err(|what| format!("`{name}`: {what}"));
            range.map_err(Error::Call)
        });
        let values = each.collect::<Result<Vec<_>, _>>()?.concat();
        Ok((name.to_owned(), with_last_unit(values)))
    }

    fn side_by_side(lists: Vec<List>) -> Result<Self, Error> {
        unique(&lists)?;
        let rows = lists.iter().map(|(_, values)| values.len()).max().unwrap_or(0);
        if lists.iter().any(|(_, values)| values.len() != rows && values.len() != 1) {
            return Err(Error::Call(different_lengths(&lists)));
        }
        Ok(Grid { strides: vec![1; lists.len()], lists, rows })
    }

    /// The names and values of one row.
    pub fn row(&self, index: usize) -> Vec<(&str, &str)> {
        let lists = self.lists.iter().zip(&self.strides);
        lists
            .map(|((name, values), stride)| {
                (name.as_str(), values[index / stride % values.len()].as_str())
            })
            .collect()
    }

    /// The same, as [`Model::with_all`] takes them.
    pub fn values(&self, index: usize) -> Vec<(&str, Value)> {
        self.row(index).into_iter().map(|(name, value)| (name, value.into())).collect()
    }
}

/// The unit behind the last value behind every plain number.
fn with_last_unit(values: Vec<String>) -> Vec<String> {
    let unit = values.last().and_then(|last| Some(last[last.find('[')?..].to_owned()));
    let Some(unit) = unit else { return values };
    let with_unit = |value: String| match value.parse::<f64>() {
        Ok(_) => format!("{value}{unit}"),
        Err(_) => value,
    };
    values.into_iter().map(with_unit).collect()
}

fn unique(lists: &[List]) -> Result<(), Error> {
    for (at, (name, _)) in lists.iter().enumerate() {
        if lists[..at].iter().any(|(earlier, _)| earlier == name) {
            return Err(Error::Call(format!(
                "`{name}` is swept twice; write all its values in one list"
            )));
        }
    }
    Ok(())
}

/// The lists with the unit of each value.
fn in_units(lists: Vec<List>, with_unit: impl Fn(&str, &str) -> String) -> Vec<List> {
    let values = |(name, values): List| {
        let values = values.iter().map(|value| with_unit(&name, value)).collect();
        (name, values)
    };
    lists.into_iter().map(values).collect()
}

fn different_lengths(lists: &[List]) -> String {
    let lengths = lists.iter().map(|(name, values)| format!("`{name}` has {}", values.len()));
    let lengths = lengths.collect::<Vec<_>>().join(", ");
    format!(
        "the lists go together row by row, but their lengths differ: {lengths}; give all the same \
         length, or one value, or ask for all combinations with --product"
    )
}
