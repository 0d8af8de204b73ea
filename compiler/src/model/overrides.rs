//! What the command line may change: parameters by `--set`, settings of the method by `--method`.

use crate::expressions::graph::evaluate;
use crate::model::numbers::Numbers;
use crate::model::{Free, Model, Param, Place, Range};
use crate::settings::conflicts::misfit;
use crate::settings::{Given, Refused, keys, nearest_key, nearest_word, set};
use crate::syntax::closest;
use crate::syntax::text::number;
use crate::units::{NamedUnit, Quantity, WidthUnit, parse_quantity};
use std::collections::HashMap;

impl Model {
    /// Gives a parameter another value, such as `0.2` or `200[g]`; a plain number is in its
    /// declared unit.
    pub fn set_param(&mut self, name: &str, value: &str) -> Result<(), String> {
        let given = parse_quantity(value)?;
        self.set_param_quantity(name, value, given)
    }

    /// The same with a number in the declared unit.
    pub fn set_param_number(&mut self, name: &str, value: f64) -> Result<(), String> {
        if !value.is_finite() {
            return Err(format!("`{name}` cannot be {value}"));
        }
        self.set_param_quantity(name, "", Quantity { value, dimension: None })
    }

    /// The same in SI, also beyond its range: what is differentiated by is moved to both sides.
    pub fn set_param_in_si(&mut self, name: &str, value: f64) -> Result<(), String> {
        let index = self.params.iter().position(|param| param.place.name == name);
        let index = index.ok_or_else(|| self.no_param(name))?;
        self.give(index, value);
        Ok(())
    }

    fn set_param_quantity(
        &mut self,
        name: &str,
        text: &str,
        given: Quantity,
    ) -> Result<(), String> {
        let Some(index) = self.params.iter().position(|param| param.place.name == name) else {
            return Err(self.no_param(name));
        };
        let Param { place, range, .. } = self.params[index].clone();
        let value = self.limited(&place, range, text, given)?;
        self.give(index, value);
        Ok(())
    }

    /// Gives an unknown the value that a simulation takes for it, such as `2` or `3[min]`; a plain
    /// number is in its declared unit.
    pub fn set_unknown(&mut self, name: &str, value: &str) -> Result<(), String> {
        let Some(at) = self.frees.iter().position(|it| it.place.name == name) else {
            return Err(self.no_param(name));
        };
        let Free { place, range, .. } = self.frees[at].clone();
        let value = self.limited(&place, range, value, parse_quantity(value)?)?;
        self.set_free(name, value);
        Ok(())
    }

    /// A value in SI within the range of a name.
    fn limited(
        &self,
        place: &Place,
        range: Range,
        text: &str,
        given: Quantity,
    ) -> Result<f64, String> {
        let name = &place.name;
        let unit = self.units.iter().find(|own| own.span == place.span);
        let own = unit.cloned().unwrap_or_else(|| plain_number(name));
        if let Some(other) = self.other_unit(&own).filter(|_| given.dimension.is_none()) {
            return Err(format!(
                "`{name}` has no unit of its own, and the model writes {} for what it measures: \
                 write the unit, as in `{name}=1[{}]`",
                other.unit, other.unit
            ));
        }
        let value = in_unit(&own, text, given)?;
        let limits = [range.lower, range.upper].map(|limit| self.of_params(limit));
        if value < limits[0] || value > limits[1] {
            let shown = limits.map(|limit| number(limit / own.scale));
            let unit = if own.unit.is_empty() { String::new() } else { format!(" {}", own.unit) };
            let its = number(rounded(value / own.scale));
            return Err(format!(
                "`{name}` must be in [{}, {}]{unit}, not {its}",
                shown[0], shown[1]
            ));
        }
        Ok(value)
    }

    /// A value for a parameter or a width with the unit in which it is read, if that is not the one
    /// of SI: `3[mm]` for `3`.
    pub fn with_unit(&self, name: &str, value: &str) -> String {
        let index = self.params.iter().position(|param| param.place.name == name);
        let width = self
            .width_unit
            .as_ref()
            .filter(|it| index.is_none() && name == "sigma" && it.takes_numbers);
        let own = index.and_then(|at| self.unit_of_param(at)).or(width.map(|it| &it.unit));
        let own = own.filter(|own| own.scale != 1.0);
        let is_plain = parse_quantity(value).is_ok_and(|it| it.dimension.is_none());
        match own.filter(|_| is_plain) {
            Some(own) => format!("{}[{}]", value.trim(), own.unit),
            None => value.into(),
        }
    }

    /// A value in SI as the command line takes it: in the declared unit, with that unit unless it
    /// is the one of SI.
    pub fn as_given(&self, name: &str, value: &str) -> String {
        let Ok(number) = value.parse::<f64>() else { return value.into() };
        let index = self.params.iter().position(|param| param.place.name == name);
        let width = self.width_unit.as_ref().filter(|_| index.is_none() && name == "sigma");
        let own = index.and_then(|at| self.unit_of_param(at)).or(width.map(|it| &it.unit));
        match own {
            Some(own) if own.scale != 1.0 => {
                format!("{}[{}]", rounded(number / own.scale), own.unit)
            }
            Some(own) if width.is_some_and(|it| !it.takes_numbers) => {
                format!("{value}[{}]", if own.unit.is_empty() { "1" } else { &own.unit })
            }
            _ => value.into(),
        }
    }

    /// The unit in which the text writes what a name measures whose own unit it does not say, if
    /// that is not the one of SI: a plain number could be meant in either.
    fn other_unit(&self, own: &NamedUnit) -> Option<&NamedUnit> {
        let is_like = |it: &&NamedUnit| it.dimension == own.dimension && it.scale != own.scale;
        let is_found = !own.written && !own.unit.is_empty() && own.scale == 1.0;
        self.units.iter().filter(|it| it.written).find(is_like).filter(|_| is_found)
    }

    fn unit_of_param(&self, index: usize) -> Option<&NamedUnit> {
        let span = self.params[index].place.span;
        self.units.iter().find(|own| own.span == span)
    }

    pub(super) fn give(&mut self, index: usize, value: f64) {
        self.phases.iter_mut().for_each(|phase| phase.model.give(index, value));
        let before = self.params[index].value.replace(self.graph.number(value));
        if before.is_none() {
            self.param_order.insert(0, index);
        }
    }

    /// Gives parameters the values that a solution was made with. One that is computed from others
    /// and has that value anyhow stays so.
    pub fn restore_params(&mut self, values: &[(String, f64)]) {
        let given: HashMap<&str, f64> =
            values.iter().rev().map(|(name, value)| (name.as_str(), *value)).collect();
        let waiting = (0..self.params.len()).filter(|&at| self.params[at].value.is_none());
        for index in waiting.collect::<Vec<_>>() {
            if let Some(value) = given.get(self.params[index].place.name.as_str()) {
                self.give(index, *value);
            }
        }
        let mut numbers = Numbers::of_nothing(self);
        for index in self.param_order.clone() {
            let now = numbers.compute_param(self, index);
            let value = given.get(self.params[index].place.name.as_str()).filter(|it| **it != now);
            if let Some(value) = value {
                self.give(index, *value);
                numbers.compute_param(self, index);
            }
        }
    }

    /// Gives an unknown the value that a solution found.
    pub fn set_free(&mut self, name: &str, value: f64) {
        self.phases.iter_mut().for_each(|phase| phase.model.set_free(name, value));
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

    /// Changes a setting, such as `sigma` to `0.01`; several values for `continue` are separated by
    /// commas. A plain number for a width is in the unit of what is smoothed.
    pub fn set_method(&mut self, key: &str, value: &str) -> Result<(), String> {
        let is_width = matches!(key, "sigma" | "continue");
        let width = self.width_unit.clone().filter(|_| is_width);
        let given = given(value, |text, it| match &width {
            Some(own) => as_width(own, text, it),
            None if it.dimension.is_some() && !is_width => {
                Err(format!("`{key}` has no unit, so it cannot be `{}`", text.trim()))
            }
            None => Ok(it.value),
        })?;
        self.set(key, value, &given)
    }

    fn set(&mut self, key: &str, value: &str, given: &Given) -> Result<(), String> {
        match set(&mut self.method, key, given) {
            Ok(()) => {
                self.phases.iter_mut().try_for_each(|phase| phase.model.set(key, value, given))?;
                self.smooth |= matches!(key, "sigma" | "kernel" | "continue");
                Ok(())
            }
            Err(Refused::Removed(instead)) => {
                Err(format!("`{key}` cannot be `{value}`: {instead}"))
            }
            Err(Refused::NotYet) => Err(format!("`{key} = {value}` cannot be solved yet")),
            Err(Refused::Key) => Err(match nearest_key(key) {
                Some(near) => format!("the method has no setting `{key}`; did you mean `{near}`?"),
                None => format!("the method has no setting `{key}`; the settings are {}", keys()),
            }),
            Err(Refused::Value(expected)) => Err(match nearest_word(&expected, value) {
                Some(near) => format!("`{key}` cannot be `{value}`; did you mean `{near}`?"),
                None => format!("`{key}` cannot be `{value}`; it needs {expected}"),
            }),
        }
    }

    /// Whether the settings of the method fit each other.
    pub fn fits_together(&self) -> Result<(), String> {
        misfit(&self.method).map_or(Ok(()), |(_, what, help)| Err(format!("{what}: {help}")))
    }

    /// Why nothing of this name can be set: what there is instead.
    pub fn no_param(&self, name: &str) -> String {
        if self.frees.iter().any(|it| it.place.name == name) {
            return format!(
                "`{name}` is an unknown, which is chosen in its bounds; its `guess` in the model \
                 says where a solve begins"
            );
        }
        let names = || self.params.iter().map(|param| param.place.name.as_str());
        match closest(name, names()) {
            Some(near) => format!("there is no parameter `{name}`; did you mean `{near}`?"),
            None if self.params.is_empty() => {
                format!("there is no parameter `{name}`; the model has none")
            }
            None => {
                format!(
                    "there is no parameter `{name}`; there is {}",
                    names().collect::<Vec<_>>().join(", ")
                )
            }
        }
    }

    /// A number, which may use other parameters; NaN, which limits nothing, if one of them has no
    /// value yet.
    fn of_params(&self, value: crate::expressions::graph::ExprId) -> f64 {
        match crate::model::numbers::numbers(self) {
            Ok(numbers) => numbers.value(self, value),
            Err(_) => evaluate(&self.graph, &[value], &vec![f64::NAN; self.symbols.len()], &[])[0],
        }
    }
}

/// A word, a number or a list of numbers, each as `read` makes it one in SI.
fn given(
    value: &str,
    read: impl Fn(&str, Quantity) -> Result<f64, String>,
) -> Result<Given, String> {
    let quantities: Option<Vec<(&str, Quantity)>> =
        value.split(',').map(|part| Some((part, parse_quantity(part).ok()?))).collect();
    let Some(quantities) = quantities else { return Ok(Given::Word(value.trim().into())) };
    let numbers: Vec<f64> =
        quantities.into_iter().map(|(text, it)| read(text, it)).collect::<Result<_, _>>()?;
    Ok(match numbers[..] {
        [number] => Given::Number(number),
        _ => Given::List(numbers),
    })
}

/// Without the digits that the change of units leaves behind.
fn rounded(value: f64) -> f64 {
    format!("{value:.14e}").parse().unwrap_or(value)
}

/// The unit of a name of which nothing is known: any goes with it.
fn plain_number(name: &str) -> NamedUnit {
    NamedUnit { name: name.into(), scale: 1.0, ..NamedUnit::default() }
}

/// A value in SI, if its unit measures what that of a name does; a number without a unit is in the
/// declared one.
fn in_unit(own: &NamedUnit, text: &str, given: Quantity) -> Result<f64, String> {
    match given.dimension {
        None => Ok(given.value * own.scale),
        Some(dimension) if own.span != Default::default() && own.dimension != dimension => {
            let unit = if own.unit.is_empty() {
                "has no unit".into()
            } else {
                format!("is in {}", own.unit)
            };
            Err(format!("`{}` {unit}, so it cannot be `{}`", own.name, text.trim()))
        }
        Some(_) => Ok(given.value),
    }
}

/// A width in SI.
fn as_width(own: &WidthUnit, text: &str, given: Quantity) -> Result<f64, String> {
    let unit = &own.unit;
    match given.dimension {
        None if own.takes_numbers => Ok(given.value * unit.scale),
        // It is the same in every unit.
        None if given.value == 0.0 => Ok(0.0),
        None => Err(format!(
            "`sigma` needs a unit, such as `{}[{}]`: what is smoothed is made of names in other \
             units than those of SI",
            text.trim(),
            unit.unit
        )),
        Some(dimension) if !unit.name.is_empty() && dimension != unit.dimension => {
            Err(format!("`sigma` is in {}, so it cannot be `{}`", unit.unit, text.trim()))
        }
        Some(_) => Ok(given.value),
    }
}
