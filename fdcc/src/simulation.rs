//! The true system, integrated from event to event.

use crate::error::Error;
use crate::measured::add_objective;
use crate::model::Model;
use fdcc_runtime::simulate::{
    self, Controls, Event, Options as Accuracy, Status, System, simulate,
};

/// A simulation, asked in the words of the model; numbers are in SI.
///
/// ```
/// let model = fdcc::Model::from_text("slide", "time t in [0, 2]
/// state v start 1
/// surface slip = v
/// dynamics { v' in -2 * Sgn(slip) }")?;
/// let simulation = model.simulate(&fdcc::Controls::Guess, &fdcc::Accuracy::default())?;
/// assert_eq!(simulation.events().len(), 1, "it comes to rest");
/// assert!((simulation.events()[0].time - 0.5).abs() < 1e-9);
/// let v = simulation.state("v").expect("it is declared");
/// assert!(v[v.len() - 1].abs() < 1e-12);
/// # Ok::<(), fdcc::Error>(())
/// ```
pub struct Simulation {
    /// What was simulated.
    pub system: System,
    /// What it did.
    pub result: simulate::Simulation,
}

impl Simulation {
    /// Simulates; `system` is the one of [`Model::system`].
    pub fn new(model: &Model, system: System, controls: &Controls, accuracy: &Accuracy) -> Self {
        let mut result = simulate(&system, controls, accuracy);
        add_objective(model.meaning(), &system, controls, accuracy, &mut result);
        Simulation { system, result }
    }

    /// Whether it reached the last time.
    pub fn is_complete(&self) -> bool {
        matches!(self.result.status, Status::Completed)
    }

    /// When the states are reported: at the times that were asked for, else at all steps and, where
    /// the accuracy says so, at points between them.
    pub fn time(&self) -> &[f64] {
        &self.result.time
    }

    /// A state at these times.
    pub fn state(&self, name: &str) -> Option<&[f64]> {
        let at = self.system.states.iter().position(|it| it.name == name)?;
        self.result.states.get(at).map(Vec::as_slice)
    }

    /// What happened, in the order of time.
    pub fn events(&self) -> &[Event] {
        &self.result.events
    }
}

impl Model {
    /// Simulates the true system. That it does not reach the last time is no error: the status of
    /// the result says so.
    ///
    /// # Errors
    ///
    /// A model that cannot be simulated.
    pub fn simulate(&self, controls: &Controls, accuracy: &Accuracy) -> Result<Simulation, Error> {
        Ok(Simulation::new(self, self.system()?, controls, accuracy))
    }
}
