//! What the command line may change: parameters by `--set`, settings of the method by `--method`.

use crate::graph::evaluate;
use crate::model::Model;
use crate::resolve::closest;
use crate::resolve::misfit::misfit;
use crate::resolve::settings::{Given, Refused, is_key, keys, nearest_key, nearest_word, set};
use crate::resolve::text::number;
use crate::units::{Quantity, parse_quantity};

impl Model {
    /// Gives a parameter another value, such as `0.2` or `200[g]`.
    pub fn set_param(&mut self, name: &str, value: &str) -> Result<(), String> {
        let given = parse_quantity(value)?;
        let Some(index) = self.params.iter().position(|param| param.place.name == name) else {
            return Err(self.no_param(name));
        };
        let value = self.fitting(name, value, given)?;
        let range = self.params[index].range;
        let limits = [range.lower, range.upper].map(|limit| self.of_params(limit));
        if value < limits[0] || value > limits[1] {
            return Err(format!("`{name}` must be in [{}, {}]", number(limits[0]), number(limits[1])));
        }
        self.give(index, value);
        Ok(())
    }

    /// The value in SI, if its unit measures what the parameter does; a number without a unit is in SI already.
    fn fitting(&self, name: &str, text: &str, given: Quantity) -> Result<f64, String> {
        let span = self.params.iter().find(|param| param.place.name == name).map(|param| param.place.span);
        let own = self.units.iter().find(|own| Some(own.span) == span);
        match own.zip(given.dimension) {
            Some((own, dimension)) if own.dimension != dimension => {
                let unit =
                    if own.unit.is_empty() { "has no unit".into() } else { format!("is in {}", own.unit) };
                Err(format!("`{name}` {unit}, so it cannot be `{}`", text.trim()))
            }
            _ => Ok(given.value),
        }
    }

    fn give(&mut self, index: usize, value: f64) {
        self.params[index].value = Some(self.graph.number(value));
        if !self.param_order.contains(&index) {
            self.param_order.insert(0, index);
        }
    }

    /// Gives parameters the values that a solution was made with. One that is computed from others and has that value
    /// anyhow stays so.
    pub fn restore_params(&mut self, values: &[(String, f64)]) {
        let given = |name: &str| values.iter().find(|(own, _)| own == name).map(|(_, value)| *value);
        let waiting = (0..self.params.len()).filter(|&at| self.params[at].value.is_none());
        for index in waiting.chain(self.param_order.clone()).collect::<Vec<_>>() {
            let Some(value) = given(&self.params[index].place.name) else { continue };
            let now = self.params[index].value.map_or(f64::NAN, |value| self.of_params(value));
            if now != value {
                self.give(index, value);
            }
        }
    }

    /// Gives an unknown the value that a solution found.
    pub fn set_free(&mut self, name: &str, value: f64) {
        let value = self.graph.number(value);
        for free in self.frees.iter_mut().filter(|free| free.place.name == name) {
            free.guess = Some(value);
        }
    }

    /// Gives a state whose start is open the one that a solution found.
    pub fn set_open_start(&mut self, name: &str, value: f64) {
        let value = self.graph.number(value);
        for state in self.states.iter_mut().filter(|state| state.place.name == name) {
            state.start = state.start.or(Some(value));
        }
    }

    /// Changes a setting, such as `sigma` to `0.01`; several values for `continue` are separated by commas.
    pub fn set_method(&mut self, key: &str, value: &str) -> Result<(), String> {
        match set(&mut self.method, key, &given(value)) {
            Ok(()) => {
                self.smooth |= matches!(key, "sigma" | "kernel" | "continue");
                Ok(())
            }
            Err(Refused::NotYet) => Err(format!("`{key} = {value}` cannot be solved yet")),
            Err(Refused::Key) => Err(match nearest_key(key) {
                Some(near) => format!("the method has no setting `{key}`; did you mean `{near}`?"),
                None => format!("the method has no setting `{key}`; the settings are {}", keys()),
            }),
            Err(Refused::Value(expected)) => Err(match nearest_word(expected, value) {
                Some(near) => format!("`{key}` cannot be `{value}`; did you mean `{near}`?"),
                None => format!("`{key}` cannot be `{value}`; it needs {expected}"),
            }),
        }
    }

    /// Whether the settings of the method fit each other.
    pub fn fits_together(&self) -> Result<(), String> {
        misfit(&self.method).map_or(Ok(()), |(_, what, help)| Err(format!("{what}: {help}")))
    }

    fn no_param(&self, name: &str) -> String {
        let names = || self.params.iter().map(|param| param.place.name.as_str());
        match closest(name, names()) {
            Some(near) => format!("there is no parameter `{name}`; did you mean `{near}`?"),
            None if self.params.is_empty() => format!("there is no parameter `{name}`; the model has none"),
            None => {
                format!("there is no parameter `{name}`; there is {}", names().collect::<Vec<_>>().join(", "))
            }
        }
    }

    /// A number, which may use other parameters; NaN, which limits nothing, if one of them has no value yet.
    fn of_params(&self, value: crate::graph::ExprId) -> f64 {
        match crate::lower::numbers(self) {
            Ok(numbers) => numbers.value(self, value),
            Err(_) => evaluate(&self.graph, &[value], &vec![f64::NAN; self.symbols.len()], &[])[0],
        }
    }
}

/// Whether the `method` block has a setting of this name.
pub fn is_method_key(name: &str) -> bool {
    is_key(name)
}

fn given(value: &str) -> Given {
    let parts: Vec<&str> = value.split(',').collect();
    let numbers: Option<Vec<f64>> =
        parts.iter().map(|part| parse_quantity(part).ok().map(|it| it.value)).collect();
    match numbers.as_deref() {
        Some([number]) => Given::Number(*number),
        Some(numbers) => Given::List(numbers.to_vec()),
        None => Given::Word(value.trim().into()),
    }
}
