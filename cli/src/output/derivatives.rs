//! How an optimum moves with parameters, as data and in words.

use super::named::Named;
use super::units::Units;
use fdcc::{Error, ParametricSensitivity, PhaseSensitivity, Solution};
use serde::Serialize;

/// The derivative of an optimum by one parameter, in SI; `null` where it has none.
#[derive(Clone, Debug, Serialize)]
#[serde(untagged)]
pub enum Derivative {
    Found(Found),
    None(#[serde(serialize_with = "as_null")] String),
}

/// What moves.
#[derive(Clone, Debug, Serialize)]
pub struct Found {
    pub free: Named<f64>,
    /// Where the solution switches, or something reaches or leaves a bound.
    pub junctions: Vec<Junction>,
    #[serde(flatten)]
    pub signals: Signals,
}

/// A time with its derivative.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Junction {
    pub time: f64,
    pub derivative: f64,
}

/// Of one phase, or of each.
#[derive(Clone, Debug, Serialize)]
#[serde(untagged)]
pub enum Signals {
    One(OfPhase),
    Several { phases: Named<OfPhase> },
}

/// Of the signals of a phase.
#[derive(Clone, Debug, Serialize)]
pub struct OfPhase {
    pub time: Vec<f64>,
    pub states: Named<Vec<f64>>,
    pub controls: Named<Vec<f64>>,
}

fn as_null<S: serde::Serializer>(_: &String, serializer: S) -> Result<S::Ok, S::Error> {
    serializer.serialize_none()
}

impl Derivative {
    /// By a parameter.
    pub fn new(solution: &Solution, parameter: &str) -> Self {
        match solution.parametric_sensitivity(parameter) {
            Ok(found) => Derivative::Found(found.into()),
            Err(Error::Call(why)) => Derivative::None(why),
            Err(other) => Derivative::None(other.to_string()),
        }
    }

    /// In a line.
    pub fn line(&self, parameter: &str, units: &Units) -> String {
        let found = match self {
            Derivative::Found(found) => found,
            Derivative::None(why) => return format!(" by    {why}"),
        };
        let by = |name: &str, by: f64| match by.is_nan() {
            true => "what the optimum leaves open".into(),
            false => units.per(name, parameter, by, 5),
        };
        let free = found.free.0.iter();
        let free = free.map(|(name, slope)| format!("{name} moves by {}", by(name, *slope)));
        let junction = |it: &Junction| {
            let (at, by) = (units.value("time", it.time, 5), by("time", it.derivative));
            format!("the junction at {at} by {by}")
        };
        let all: Vec<String> = free.chain(found.junctions.iter().map(junction)).collect();
        let told = if all.is_empty() { "states and controls move".into() } else { all.join(", ") };
        format!(" by    {parameter}: {told}")
    }
}

impl From<ParametricSensitivity> for Found {
    fn from(of: ParametricSensitivity) -> Self {
        let junctions = of.junctions.into_iter();
        let junctions = junctions.map(|(time, derivative)| Junction { time, derivative }).collect();
        let named = |it: PhaseSensitivity| (it.phase.clone().unwrap_or_default(), it.into());
        let mut phases: Vec<(String, OfPhase)> = of.phases.into_iter().map(named).collect();
        let signals = match phases.len() {
            1 if phases[0].0.is_empty() => Signals::One(phases.swap_remove(0).1),
            _ => Signals::Several { phases: Named(phases) },
        };
        Found { free: Named(of.unknowns), junctions, signals }
    }
}

impl From<PhaseSensitivity> for OfPhase {
    fn from(of: PhaseSensitivity) -> Self {
        OfPhase { time: of.time, states: Named(of.states), controls: Named(of.controls) }
    }
}
