//! Exact derivatives of the true system through all its events, and what others would compute
//! instead.

mod approximations;
pub(crate) mod exact;
pub(crate) mod quantities;
mod tuning;

pub use approximations::Stepped;
pub use exact::Exact;
pub use quantities::{By, NotBy};

use crate::error::Error;
use crate::model::Model;
use fdcc_runtime::sensitivity::{Quantity, finer, hessian};
use fdcc_runtime::simulate::{
    Controls, Integrator, Options as Accuracy, Simulation, System, simulate,
};
use tuning::second::{MOST_EXPLICIT, MOST_HALVINGS, SETTLED};

/// The derivative of the objective of the true system by parameters, unknowns, starts or controls.
///
/// ```
/// let model = fdcc::Model::from_text("fall", "time t in [0, 2]
/// param g = 2
/// state v start 0
/// dynamics { v' = -g }
/// minimize v(end)^2")?;
/// let gradient = model.gradient(&["g"])?;
/// assert!(gradient.is_trusted());
/// let by_g = gradient.get("g").expect("it was asked for")[0];
/// assert!((by_g - 16.0).abs() < 1e-6, "the derivative of (2 g)^2");
/// # Ok::<(), fdcc::Error>(())
/// ```
pub struct Gradient {
    model: Model,
    /// The true system, compiled for sensitivities.
    pub system: System,
    controls: Controls,
    accuracy: Accuracy,
    /// What the derivatives are taken by.
    pub by: Vec<By>,
    /// The derivatives; nothing but the simulation where that does not reach the end.
    pub found: Result<Exact, Box<Simulation>>,
}

impl Gradient {
    /// Differentiates along the controls; `system` is the one of [`Model::sensitivity_system`].
    pub fn new(
        model: &Model,
        system: System,
        controls: Controls,
        by: Vec<By>,
        accuracy: &Accuracy,
    ) -> Self {
        let found = Exact::new(&system, &controls, accuracy, &quantities(&by));
        let (model, accuracy) = (model.clone(), accuracy.clone());
        Gradient { model, system, controls, accuracy, by, found }
    }

    /// The derivative by a name: one number; of a control one for each row.
    pub fn get(&self, name: &str) -> Option<&[f64]> {
        let exact = self.found.as_ref().ok()?;
        let at = self.by.iter().position(|by| by.name == name)?;
        let before: usize = self.by[..at].iter().map(|by| by.quantities.len()).sum();
        exact.gradient.get(before..before + self.by[at].quantities.len())
    }

    /// Whether there is a derivative, both ways to compute it agree, and the trajectory stays on no
    /// kink.
    pub fn is_trusted(&self) -> bool {
        self.found.as_ref().is_ok_and(Exact::is_trusted)
    }

    /// The second derivatives, a square matrix: by each pair of numbers in the order of `by`; SI.
    ///
    /// # Errors
    ///
    /// Why there are none, in words.
    pub fn second(&self) -> Result<Vec<Vec<f64>>, String> {
        let found = self.resolved_hessian().ok_or(why_none())?;
        found.ok_or_else(|| {
            "steps of half the length lead to other second derivatives: none are known".into()
        })
    }

    /// Along steps that are halved until it stays the same, with the stiff method where it does not
    /// soon; `None` inside where it never does.
    fn resolved_hessian(&self) -> Option<Option<Vec<Vec<f64>>>> {
        let by = quantities(&self.by);
        let of = |it: &Simulation| hessian(&self.system, &self.controls, it, &by);
        let mut found = of(self.simulation())?;
        let mut options = Accuracy { tape: true, ..finer(&self.accuracy, self.simulation()) };
        for halving in 0..MOST_HALVINGS {
            let next = simulate(&self.system, &self.controls, &options);
            let Some(other) = of(&next) else { break };
            if is_same(&found, &other) {
                return Some(Some(other));
            }
            options = finer(&options, &next);
            if halving == MOST_EXPLICIT && options.integrator == Integrator::Automatic {
                options.integrator = Integrator::Stiff;
            }
            found = other;
        }
        Some(None)
    }

    /// The trajectory, as far as it came.
    pub fn simulation(&self) -> &Simulation {
        match &self.found {
            Ok(exact) => &exact.found.simulation,
            Err(simulation) => simulation,
        }
    }
}

/// Where there are no second derivatives.
fn why_none() -> String {
    "there are no second derivatives here: none are known where infinitely many jumps come to \
     rest, where a `Dir` moves, by a start that leaves a surface on which it slides, and where a \
     kink is met together with something else"
        .into()
}

/// Whether two matrices are the same, each entry relative to the largest of its row and column.
fn is_same(one: &[Vec<f64>], other: &[Vec<f64>]) -> bool {
    let size = |at: usize| other[at].iter().fold(0.0, |size: f64, it| size.max(it.abs()));
    let is_near =
        |i: usize, j: usize| (one[i][j] - other[i][j]).abs() <= SETTLED * size(i).min(size(j));
    (0..one.len()).all(|i| (0..one.len()).all(|j| is_near(i, j)))
}

/// All numbers to differentiate by, in the order of their names.
fn quantities(by: &[By]) -> Vec<Quantity> {
    by.iter().flat_map(|by| by.quantities.iter().copied()).collect()
}

/// What some names ask for, each once; everything that the model has where there are none.
///
/// # Errors
///
/// A name that is none of a parameter, unknown, start or control; nothing to differentiate by.
pub fn by_names(
    names: &[&str],
    system: &System,
    controls: &Controls,
    model: &Model,
) -> Result<Vec<By>, NotBy> {
    if names.is_empty() {
        let all = quantities::everything(system, model.meaning());
        return if all.is_empty() { Err(NotBy::Nothing) } else { Ok(all) };
    }
    let mut all: Vec<By> = Vec::new();
    for name in names {
        let found = quantities::named(name, system, controls, model.meaning())?;
        let is_new = |by: &By| all.iter().all(|known| known.name != by.name);
        let new: Vec<By> = found.into_iter().filter(is_new).collect();
        all.extend(new);
    }
    Ok(all)
}

impl Model {
    /// The gradient of the objective of the true system with guessed controls, by the names of
    /// parameters, unknowns or starts such as `x(start)`; by all parameters and unknowns where
    /// there are no names.
    ///
    /// # Errors
    ///
    /// A model that cannot be simulated or has no objective; a name that it does not have.
    pub fn gradient(&self, by: &[&str]) -> Result<Gradient, Error> {
        let (system, controls) = (self.sensitivity_system()?, Controls::Guess);
        if self.meaning().objective.is_none() {
            return Err(Error::Call("the model has no objective".into()));
        }
        let by =
            by_names(by, &system, &controls, self).map_err(|why| Error::Call(why.to_string()))?;
        Ok(Gradient::new(self, system, controls, by, &Accuracy::default()))
    }
}
