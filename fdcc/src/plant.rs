//! The true system in closed loop: it moves on step by step, with controls that are held.

use crate::error::Error;
use crate::model::Model;
use fdcc_runtime::simulate::{Controls, Options as Accuracy, Status, System, simulate};

/// The true system of a model at one time; numbers are in SI.
///
/// ```
/// let model = fdcc::Model::from_text("cart", "time t in [0, 1]
/// state v start 1
/// surface slip = v
/// control F in [-9, 9] guess 0
/// dynamics { v' in F - 2 * Sgn(slip) }")?;
/// let mut plant = model.plant()?;
/// assert!(plant.step(&[("F", 1.0)], 2.0, &fdcc::Accuracy::default())?, "it gets there");
/// assert_eq!((plant.time(), plant.state("v")), (2.0, Some(0.0)), "friction holds it");
/// # Ok::<(), fdcc::Error>(())
/// ```
pub struct Plant {
    system: System,
}

impl Model {
    /// Its true system where it begins.
    ///
    /// # Errors
    ///
    /// A model that cannot be simulated.
    pub fn plant(&self) -> Result<Plant, Error> {
        Ok(Plant { system: self.system()? })
    }
}

impl Plant {
    /// The time that it is.
    pub fn time(&self) -> f64 {
        self.system.interval[0]
    }

    /// The value of a state.
    pub fn state(&self, name: &str) -> Option<f64> {
        let at = self.system.states.iter().position(|it| it.name == name)?;
        self.system.start.get(at).copied()
    }

    /// The names of its controls.
    pub fn controls(&self) -> impl Iterator<Item = &str> {
        self.system.controls.iter().map(|control| control.name.as_str())
    }

    /// Holds controls for so long; whether it gets there. If not it stays where it ended.
    ///
    /// # Errors
    ///
    /// A control that has no value.
    pub fn step(
        &mut self,
        controls: &[(&str, f64)],
        duration: f64,
        accuracy: &Accuracy,
    ) -> Result<bool, Error> {
        let value = |name: &str| {
            let known = controls.iter().find(|(own, _)| *own == name);
            let missing = || Error::Call(format!("nobody controls `{name}`"));
            known.map(|(_, value)| *value).ok_or_else(missing)
        };
        let row = self.controls().map(value).collect::<Result<Vec<f64>, Error>>()?;
        let begin = self.time();
        self.system.interval = [begin, begin + duration];
        let held = Controls::Held { times: vec![begin], rows: vec![row], is_stretched: false };
        let found = simulate(&self.system, &held, accuracy);
        self.system.interval[0] = found.end_time;
        self.system.start = found.end;
        Ok(matches!(found.status, Status::Completed))
    }
}
