//! Other values for parameters and for settings of the method.

use super::Model;
use crate::error::Error;
use std::fmt;
use std::sync::Arc;

/// A value: a number in the declared unit of the name, or a text such as `200[g]`, `radau3`, `0.1,
/// 0.01`.
///
/// ```
/// let text = "param m = 2 [kg]\ntime t in [0, 1]\nstate x start 0\ndynamics { x' = m / 1[kg] }";
/// let model = fdcc::Model::from_text("mass", text)?;
/// let values = |model: fdcc::Model| model.problem().map(|it| it.parameters[0].value);
/// assert_eq!(values(model.with("m", 0.2)?)?, values(model.with("m", "200[g]")?)?);
/// # Ok::<(), fdcc::Error>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub enum Value {
    /// In the declared unit.
    Number(f64),
    /// As the language writes it.
    Text(String),
}

/// As the language writes it; a number without its unit.
impl fmt::Display for Value {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self {
            Value::Number(value) => write!(f, "{value}"),
            Value::Text(text) => f.write_str(text),
        }
    }
}

impl From<f64> for Value {
    fn from(value: f64) -> Self {
        Value::Number(value)
    }
}

impl From<i32> for Value {
    fn from(value: i32) -> Self {
        Value::Number(value.into())
    }
}

impl From<&str> for Value {
    fn from(text: &str) -> Self {
        Value::Text(text.into())
    }
}

impl Model {
    /// The same with another value of a parameter. Nothing is compiled anew: the compiled functions
    /// take parameters as inputs, and bounds, starts and guesses are computed from them again. A
    /// model with jumps compiles its sequences of jumps in each solve, since how many are possible
    /// may depend on values.
    ///
    /// # Errors
    ///
    /// A name that is no parameter; a value out of its range or in another unit.
    pub fn with(&self, name: &str, value: impl Into<Value>) -> Result<Model, Error> {
        let mut model = self.clone();
        model.set(name, &value.into())?;
        Ok(model)
    }

    fn set(&mut self, name: &str, value: &Value) -> Result<(), Error> {
        let meaning = Arc::make_mut(&mut self.meaning);
        let set = match value {
            Value::Number(value) => meaning.set_param_number(name, *value),
            Value::Text(text) => meaning.set_param(name, text),
        };
        set.map_err(Error::Call)
    }

    /// The same with a change of values alone: nothing is compiled anew.
    pub(crate) fn with_values(&self, change: impl FnOnce(&mut fdcc_compiler::Model)) -> Model {
        let mut model = self.clone();
        change(Arc::make_mut(&mut model.meaning));
        model
    }

    /// The same with another value of a key of the `method` block; it is compiled anew, since
    /// schemes and kernels are part of the functions.
    ///
    /// # Errors
    ///
    /// A key or a value that the method does not have; settings that do not fit each other.
    pub fn with_method(&self, key: &str, value: impl Into<Value>) -> Result<Model, Error> {
        self.changed(|meaning| {
            meaning.set_method(key, &value.into().to_string())?;
            meaning.fits_together()
        })
        .map_err(Error::Call)
    }

    /// The same with several other values, each of a parameter or else of a key of the `method`
    /// block. It is compiled anew only if there is one of a key.
    ///
    /// ```
    /// let model = fdcc::Model::from_file("../models/block.fdc")?;
    /// let other = model.with_all(&[("mu", 0.2.into()), ("scheme", "radau3".into())])?;
    /// assert_eq!(other.problem()?.method.scheme.name(), "radau3");
    /// assert!(model.with_all(&[("nu", 0.2.into())]).is_err(), "there is nothing of that name");
    /// # Ok::<(), fdcc::Error>(())
    /// ```
    ///
    /// # Errors
    ///
    /// A name that is neither; a value that does not go with it; settings that do not fit each
    /// other.
    pub fn with_all(&self, values: &[(&str, Value)]) -> Result<Model, Error> {
        let (params, keys): (Vec<_>, Vec<_>) =
            values.iter().partition(|(name, _)| self.has_param(name));
        let mut model = self.clone();
        if !keys.is_empty() {
            let set = self.changed(|meaning| {
                keys.iter().try_for_each(|(key, value)| {
                    let set = meaning.set_method(key, &value.to_string());
                    set.map_err(|message| self.neither(key, message))
                })?;
                meaning.fits_together()
            });
            model = set.map_err(Error::Call)?;
        }
        params.into_iter().try_for_each(|(name, value)| model.set(name, value))?;
        Ok(model)
    }

    /// The same, where names may also be those of unknowns: a simulation takes the guess of an
    /// unknown for its value.
    ///
    /// ```
    /// let model = fdcc::Model::from_text("run", "free T in [1, 9]
    /// time t in [0, T]
    /// state x start 0
    /// dynamics { x' = 2 }
    /// minimize x(end)")?;
    /// let long = model.driven_with(&[("T", 4.0.into())])?;
    /// assert_eq!(long.system()?.interval, [0.0, 4.0]);
    /// assert!(model.driven_with(&[("T", 10.0.into())]).is_err(), "it is out of its bounds");
    /// # Ok::<(), fdcc::Error>(())
    /// ```
    ///
    /// # Errors
    ///
    /// As for [`with_all`](Model::with_all).
    pub fn driven_with(&self, values: &[(&str, Value)]) -> Result<Model, Error> {
        let (unknowns, others): (Vec<_>, Vec<_>) =
            values.iter().cloned().partition(|(name, _)| self.has_unknown(name));
        let mut model = self.with_all(&others)?;
        for (name, value) in unknowns {
            let meaning = Arc::make_mut(&mut model.meaning);
            meaning.set_unknown(name, &value.to_string()).map_err(Error::Call)?;
        }
        Ok(model)
    }

    /// Whether an unknown has this name.
    pub fn has_unknown(&self, name: &str) -> bool {
        self.meaning.frees.iter().any(|it| it.place.name == name)
    }

    /// Whether a parameter has this name.
    pub fn has_param(&self, name: &str) -> bool {
        self.meaning.params.iter().any(|param| param.place.name == name)
    }

    /// What is wrong with a key of the method or its value, where the name is no parameter.
    fn neither(&self, name: &str, message: String) -> String {
        match self.with(name, 0) {
            Err(no_param) if !fdcc_compiler::is_method_key(name) => {
                format!("{no_param}\n      {message}")
            }
            _ => message,
        }
    }

    /// The same with any change of what it means; it is compiled anew.
    ///
    /// # Errors
    ///
    /// Those of the change.
    pub fn changed<E>(
        &self,
        change: impl FnOnce(&mut fdcc_compiler::Model) -> Result<(), E>,
    ) -> Result<Model, E> {
        let mut model = Model { code: Arc::default(), ..self.clone() };
        change(Arc::make_mut(&mut model.meaning))?;
        Ok(model)
    }
}
