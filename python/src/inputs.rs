//! What Python hands over: values, controls, starts, data files.

use crate::solution::Solution;
use fdcc::{Controls, DataFiles, Error, Replay, Value};
use fdcc_cli::Saved;
use pyo3::exceptions::{PyFileNotFoundError, PyOSError, PyValueError};
use pyo3::prelude::*;
use std::collections::HashMap;
use std::path::PathBuf;

/// A value of a parameter or a setting: a number in the declared unit, or a text.
#[derive(FromPyObject)]
pub enum Given {
    Number(f64),
    Text(String),
}

/// Values under names, in the order in which they were given.
pub type Values = Vec<(String, Given)>;

/// As the library takes them.
pub fn values(given: Values) -> Vec<(String, Value)> {
    let value = |it| match it {
        Given::Number(number) => Value::Number(number),
        Given::Text(text) => Value::Text(text),
    };
    given.into_iter().map(|(name, it)| (name, value(it))).collect()
}

/// The folder of data files, or their texts by name.
#[derive(FromPyObject)]
pub enum Data {
    Texts(HashMap<String, String>),
    Folder(PathBuf),
}

impl Data {
    /// As the library takes them.
    pub fn files(self) -> DataFiles {
        match self {
            Data::Folder(folder) => DataFiles::in_folder(folder),
            Data::Texts(texts) => {
                let names: Vec<String> = texts.keys().cloned().collect();
                let text = move |name: &str| {
                    texts.get(name).cloned().ok_or_else(|| "no text was given for it".to_owned())
                };
                DataFiles::from(text).with_names(move |_| Ok(names.clone()))
            }
        }
    }
}

/// A solution: one in memory, or the path of a `.sol.json`.
#[derive(FromPyObject)]
pub enum Earlier {
    Solution(Py<Solution>),
    File(PathBuf),
}

/// A solution that is at hand.
pub enum Known {
    Solution(Py<Solution>),
    File(Box<Saved>),
}

impl Earlier {
    /// Reads the file, if it is one.
    pub fn read(self) -> PyResult<Known> {
        match self {
            Earlier::Solution(solution) => Ok(Known::Solution(solution)),
            Earlier::File(path) => {
                let missing = !path.exists();
                Saved::read(&path).map(|it| Known::File(Box::new(it))).map_err(
                    |why| match missing {
                        true => PyFileNotFoundError::new_err(why),
                        false => PyOSError::new_err(why),
                    },
                )
            }
        }
    }
}

/// Where controls come from: a solution, or a row of values for each time; for each of equal parts
/// of the time where there are no times.
#[derive(FromPyObject)]
pub enum Driver {
    Solution(Earlier),
    Rows(Option<Vec<f64>>, Vec<Vec<f64>>),
}

/// A model that is driven by controls.
pub struct Driven {
    pub model: fdcc::Model,
    controls: Followed,
}

enum Followed {
    Known(Controls),
    Rows(Vec<Vec<f64>>),
}

impl Driven {
    /// What a solution says of parameters, unknowns and method comes first, so that the values
    /// have the last word.
    pub fn new(
        model: &fdcc::Model,
        driver: Option<Driver>,
        values: &[(String, Value)],
    ) -> PyResult<Result<Driven, Error>> {
        let with = |model: &fdcc::Model, controls| {
            let values: Vec<(&str, Value)> =
                values.iter().map(|(name, value)| (name.as_str(), value.clone())).collect();
            model.driven_with(&values).map(|model| Driven { model, controls })
        };
        Ok(match driver {
            None => with(model, Followed::Known(Controls::Guess)),
            Some(Driver::Rows(times, rows)) => {
                check_rows(model, times.as_deref(), &rows)?;
                let held = |times, rows| Controls::Held { times, rows, is_stretched: false };
                with(
                    model,
                    match times {
                        Some(times) => Followed::Known(held(times, rows)),
                        None => Followed::Rows(rows),
                    },
                )
            }
            Some(Driver::Solution(earlier)) => {
                let replay = Replay::new(&earlier.read()?.record(), model.meaning());
                let replay = replay.and_then(|replay| replay.check().map(|()| replay));
                let replay = replay.map_err(PyValueError::new_err)?;
                let adapted = model.changed(|meaning| {
                    replay.adapt(meaning);
                    Ok::<(), Error>(())
                });
                adapted.and_then(|model| with(&model, Followed::Known(replay.controls)))
            }
        })
    }
}

/// A model with phases, and the solution that drives it.
pub struct DrivenPhases {
    pub model: fdcc::Model,
    solution: Option<Known>,
}

impl DrivenPhases {
    /// What a solution says of parameters and unknowns comes first, so that the values have the
    /// last word.
    pub fn new(
        model: &fdcc::Model,
        driver: Option<Driver>,
        values: &[(String, Value)],
    ) -> PyResult<Result<Self, Error>> {
        let solution = match driver {
            None => None,
            Some(Driver::Solution(earlier)) => Some(earlier.read()?),
            Some(Driver::Rows(..)) => {
                let why = "each phase has controls of its own: `u` takes a solution";
                return Err(PyValueError::new_err(why));
            }
        };
        let values: Vec<(&str, Value)> =
            values.iter().map(|(name, value)| (name.as_str(), value.clone())).collect();
        let own = solution.as_ref().map(|it| model.with_values_of(&it.record()));
        let changed = own.as_ref().unwrap_or(model).driven_with(&values);
        Ok(changed.map(|model| DrivenPhases { model, solution }))
    }

    /// Simulates, phase after phase.
    pub fn simulate(&self, accuracy: &fdcc::Accuracy) -> Result<fdcc::SimulationOfPhases, Error> {
        let record = self.solution.as_ref().map(|it| it.record().without_values());
        self.model.simulate_phases(record.as_ref(), accuracy)
    }
}

impl Known {
    fn record(&self) -> fdcc::Record<'_> {
        match self {
            Known::Solution(it) => it.get().solution().record(),
            Known::File(saved) => saved.record(),
        }
    }
}

impl Driven {
    /// The controls over the interval of time. Equal parts move with its ends.
    pub fn controls(self, [first, last]: [f64; 2]) -> Controls {
        match self.controls {
            Followed::Known(controls) => controls,
            Followed::Rows(rows) => {
                let part = (last - first) / rows.len() as f64;
                let times = (0..rows.len()).map(|row| first + part * row as f64).collect();
                Controls::Held { times, rows, is_stretched: true }
            }
        }
    }
}

fn check_rows(model: &fdcc::Model, times: Option<&[f64]>, rows: &[Vec<f64>]) -> PyResult<()> {
    let wrong = |why: String| Err(PyValueError::new_err(why));
    let count = model.meaning().controls.len();
    if rows.is_empty() || times.is_some_and(|times| times.len() != rows.len()) {
        let times = times.map_or(0, <[f64]>::len);
        return wrong(format!("{times} times for {} rows of controls", rows.len()));
    }
    let ascend = |times: &[f64]| {
        times.iter().all(|time| time.is_finite()) && times.is_sorted_by(|a, b| a < b)
    };
    if !times.is_none_or(ascend) {
        return wrong("the times of controls must be finite and ascend".into());
    }
    match rows.iter().find(|row| row.len() != count || row.iter().any(|it| !it.is_finite())) {
        Some(_) => wrong(format!("a row of controls has {count} finite numbers")),
        None => Ok(()),
    }
}
