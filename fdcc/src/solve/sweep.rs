//! One solve for each of several values.

use super::{Options, Solution};
use crate::error::Error;
use crate::executor::Executor;
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
    /// The length of the longest list, and of all others but those of length 1.
    pub rows: usize,
}

impl Grid {
    /// Reads `NAME=V1,V2,...`; a plain number is in the declared unit of the name.
    pub fn read(texts: &[impl AsRef<str>], model: &Model) -> Result<Self, Error> {
        let lists: Vec<List> =
            texts.iter().map(|text| list(text.as_ref())).collect::<Result<_, _>>()?;
        Self::new(in_units(lists, |name, value| model.meaning().with_unit(name, value)))
    }

    /// The lists of the model's own `sweep` block.
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
        Self::new(in_units(lists.collect(), |name, value| model.as_given(name, value)))
    }

    fn new(lists: Vec<List>) -> Result<Self, Error> {
        for (at, (name, _)) in lists.iter().enumerate() {
            if lists[..at].iter().any(|(earlier, _)| earlier == name) {
                return Err(Error::Call(format!(
                    "`{name}` is swept twice; write all its values in one list"
                )));
            }
        }
        let rows = lists.iter().map(|(_, values)| values.len()).max().unwrap_or(0);
        if lists.iter().any(|(_, values)| values.len() != rows && values.len() != 1) {
            return Err(Error::Call(different_lengths(&lists)));
        }
        Ok(Grid { lists, rows })
    }

    /// The names and values of one row.
    pub fn row(&self, index: usize) -> Vec<(&str, &str)> {
        let lists = self.lists.iter();
        lists
            .map(|(name, values)| {
                let at = if values.len() == 1 { 0 } else { index };
                (name.as_str(), values[at].as_str())
            })
            .collect()
    }

    /// The model with the values of one row. A name is a parameter or else a key of the method.
    ///
    /// # Errors
    ///
    /// A name that is neither; a value that does not go with it.
    pub fn apply(&self, index: usize, model: &Model) -> Result<Model, Error> {
        let row = self.row(index);
        let values: Vec<(&str, Value)> =
            row.into_iter().map(|(name, value)| (name, value.into())).collect();
        model.with_all(&values)
    }
}

/// The lists with the unit of each value.
fn in_units(lists: Vec<List>, with_unit: impl Fn(&str, &str) -> String) -> Vec<List> {
    let values = |(name, values): List| {
        let values = values.iter().map(|value| with_unit(&name, value)).collect();
        (name, values)
    };
    lists.into_iter().map(values).collect()
}

fn list(text: &str) -> Result<List, Error> {
    let wrong = || Error::Call(format!("`{text}` is not of the form NAME=V1,V2,..."));
    let (name, values) = text.split_once('=').ok_or_else(wrong)?;
    let values: Vec<String> = values.split(',').map(|value| value.trim().to_string()).collect();
    match values.iter().position(String::is_empty) {
        Some(at) => Err(Error::Call(format!("value {} of `{}` is empty", at + 1, name.trim()))),
        None => Ok((name.trim().to_string(), values)),
    }
}

fn different_lengths(lists: &[List]) -> String {
    let lengths = lists.iter().map(|(name, values)| format!("`{name}` has {}", values.len()));
    let lengths = lengths.collect::<Vec<_>>().join(", ");
    format!(
        "the lists go together row by row, but their lengths differ: {lengths}; give all the same \
         length, or one value"
    )
}

/// The solutions of a [`Grid`], row by row.
///
/// ```
/// use fdcc::{Executor, Grid, Model, Sweep};
///
/// # let text = "time t in [0, 1]\nstate x start 0\ncontrol u in [-1, 1]
/// # dynamics { x' = u }\nend x == 0.5\nminimize integral(u^2)";
/// let model = Model::from_text("hop", text)?;
/// let runs: Sweep = model.sweep(&Grid::read(&["N=20,40"], &model)?, &Executor::serial())?;
/// let intervals: Vec<usize> = runs.solutions().map(|it| it.time().len() - 1).collect();
/// assert_eq!(intervals, [20, 40]);
/// # Ok::<(), fdcc::Error>(())
/// ```
pub struct Sweep {
    grid: Grid,
    solutions: Vec<Solution>,
}

impl Sweep {
    /// How many rows there are.
    pub fn len(&self) -> usize {
        self.solutions.len()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.solutions.is_empty()
    }

    /// The names and values of one row.
    pub fn row(&self, index: usize) -> Vec<(&str, &str)> {
        self.grid.row(index)
    }

    /// What came out of each row.
    pub fn solutions(&self) -> impl Iterator<Item = &Solution> {
        self.solutions.iter()
    }
}

impl Model {
    /// Solves once for each row, side by side; which thread solves it makes no difference.
    ///
    /// # Errors
    ///
    /// Those of the first row that cannot be solved.
    pub fn sweep(&self, grid: &Grid, executor: &Executor) -> Result<Sweep, Error> {
        let models: Result<Vec<Model>, Error> =
            (0..grid.rows).map(|row| grid.apply(row, self)).collect();
        let models = models?;
        let options = Options { executor: Executor::serial(), ..Options::default() };
        let one = |row: usize| models[row].solve(&options);
        let solutions = executor.in_order(models.len(), one, Result::is_err);
        let solutions = solutions.into_iter().collect::<Result<_, _>>()?;
        Ok(Sweep { grid: grid.clone(), solutions })
    }
}
