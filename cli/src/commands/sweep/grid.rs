//! The values of a sweep: lists of one length go together row by row, and a list of one value holds
//! for all rows.

use crate::output::named::Named;
use fdcc_compiler::Model;

/// A name and its values.
type List = (String, Vec<String>);

/// Names, each with its values.
pub struct Grid {
    lists: Vec<List>,
    /// The length of the longest list, and of all others but those of length 1.
    pub rows: usize,
}

impl Grid {
    /// Reads `NAME=V1,V2,...`; a plain number is in the declared unit of the name.
    pub fn read(texts: &[String], model: &Model) -> Result<Self, String> {
        let lists = texts.iter().map(|text| list(text)).collect::<Result<Vec<_>, String>>()?;
        Self::new(in_units(lists, |name, value| model.with_unit(name, value)))
    }

    /// The lists of the model's own `sweep` block.
    pub fn of(model: &Model) -> Result<Self, String> {
        if model.sweep.is_empty() {
            return Err(
                "nothing is swept: give NAME=V1,V2,... or write a `sweep` block in the model"
                    .into(),
            );
        }
        let lists =
            model.sweep.iter().map(|swept| (swept.place.name.clone(), swept.values.clone()));
        Self::new(in_units(lists.collect(), |name, value| model.as_given(name, value)))
    }

    fn new(lists: Vec<List>) -> Result<Self, String> {
        for (at, (name, _)) in lists.iter().enumerate() {
            if lists[..at].iter().any(|(earlier, _)| earlier == name) {
                return Err(format!("`{name}` is swept twice; write all its values in one list"));
            }
        }
        let rows = lists.iter().map(|(_, values)| values.len()).max().unwrap_or(0);
        if lists.iter().any(|(_, values)| values.len() != rows && values.len() != 1) {
            return Err(different_lengths(&lists));
        }
        Ok(Grid { lists, rows })
    }

    /// The values of one row.
    pub fn row(&self, index: usize) -> Named<String> {
        let value =
            |values: &Vec<String>| values[if values.len() == 1 { 0 } else { index }].clone();
        self.lists.iter().map(|(name, values)| (name.clone(), value(values))).collect()
    }

    /// Gives the values of one row to a model. A name is a parameter or else a key of the method.
    pub fn apply(&self, index: usize, model: &mut Model) -> Result<(), String> {
        for (name, value) in &self.row(index).0 {
            let is_param = model.params.iter().any(|param| param.place.name == *name);
            if is_param {
                model.set_param(name, value)?;
            } else if let Err(message) = model.set_method(name, value) {
                let is_key = fdcc_compiler::is_method_key(name);
                let no_param = model.set_param(name, "0").err().filter(|_| !is_key);
                return Err(no_param
                    .map_or(message.clone(), |no_param| format!("{no_param}\n      {message}")));
            }
        }
        model.fits_together()
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

fn list(text: &str) -> Result<List, String> {
    let (name, values) = text
        .split_once('=')
        .ok_or_else(|| format!("`{text}` is not of the form NAME=V1,V2,..."))?;
    let values: Vec<String> = values.split(',').map(|value| value.trim().to_string()).collect();
    match values.iter().position(String::is_empty) {
        Some(at) => Err(format!("value {} of `{}` is empty", at + 1, name.trim())),
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
