//! A controller and the true system that it controls.

use crate::error::Error;
use crate::plant::Plant;
use crate::solve::{Controller, Options, Solution};
use fdcc_runtime::simulate::Options as Accuracy;

/// In each step the model of the controller is solved from the state of the plant, and the first
/// value of each control is held for the first interval of its grid.
///
/// ```
/// use fdcc::{Accuracy, ClosedLoop, Options};
///
/// let model = fdcc::Model::from_text("hop", "time t in [0, 1]
/// param goal = 0.5
/// state x start 0
/// control u in [-1, 1]
/// dynamics { x' = u }
/// minimize integral((x - goal)^2 + 0.1 * u^2)")?;
/// let mut closed = ClosedLoop::new(model.controller(20)?, model.plant()?)?;
/// for _ in 0..100 {
///     closed.solve(&Options::default())?;
///     assert!(closed.apply(&Accuracy::default())?, "the plant gets there");
/// }
/// assert!((closed.state()[0] - 0.5).abs() < 1e-2);
/// # Ok::<(), fdcc::Error>(())
/// ```
pub struct ClosedLoop {
    controller: Controller,
    plant: Plant,
    state: Vec<f64>,
}

impl ClosedLoop {
    /// Of a controller and a plant that has all its states.
    ///
    /// # Errors
    ///
    /// A plant without a state that the controller knows.
    pub fn new(controller: Controller, plant: Plant) -> Result<Self, Error> {
        let state = measured(&controller, &plant)?;
        Ok(ClosedLoop { controller, plant, state })
    }

    /// The controller.
    pub fn controller(&self) -> &Controller {
        &self.controller
    }

    /// The time of the plant.
    pub fn time(&self) -> f64 {
        self.plant.time()
    }

    /// The state of the plant, in the order of [`Controller::states`].
    pub fn state(&self) -> &[f64] {
        &self.state
    }

    /// Solves from the state of the plant; the signals of the controller are at its time.
    ///
    /// # Errors
    ///
    /// Those of [`Controller::step`].
    pub fn solve(&mut self, options: &Options) -> Result<&Solution, Error> {
        self.controller.set_time(self.plant.time())?;
        self.controller.step(&self.state, options)
    }

    /// Applies the first controls of the last solution to the plant, for the first interval;
    /// whether it gets there.
    ///
    /// # Errors
    ///
    /// A control of the plant that the controller does not have; nothing was solved yet.
    pub fn apply(&mut self, accuracy: &Accuracy) -> Result<bool, Error> {
        let unsolved = || Error::Call("there is nothing to apply before a solve".into());
        let (values, duration) = self.controller.last().ok_or_else(unsolved)?.first_controls();
        let controls: Vec<(&str, f64)> = self.controller.controls().zip(values).collect();
        let arrives = self.plant.step(&controls, duration, accuracy)?;
        self.state = measured(&self.controller, &self.plant)?;
        Ok(arrives)
    }
}

/// The states of the plant that the controller knows.
fn measured(controller: &Controller, plant: &Plant) -> Result<Vec<f64>, Error> {
    let value = |name: &str| {
        let missing = || Error::Call(format!("the plant has no state `{name}`"));
        plant.state(name).ok_or_else(missing)
    };
    controller.states().map(value).collect()
}
