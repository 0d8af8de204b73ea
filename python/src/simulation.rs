//! Simulations of the true system.

use crate::column::Column;
use pyo3::prelude::*;
use std::sync::Arc;

/// What the true system does.
#[pyclass(frozen, module = "fdcc._fdcc")]
pub struct Simulation {
    simulation: Arc<fdcc::Simulation>,
    model: fdcc::Model,
}

impl Simulation {
    pub fn new(simulation: fdcc::Simulation, model: fdcc::Model) -> Self {
        Simulation { simulation: Arc::new(simulation), model }
    }
}

#[pymethods]
impl Simulation {
    /// When states are reported.
    fn time(&self) -> Option<Column> {
        Column::lent(&self.simulation, |it| Some(it.time()))
    }

    /// All states that are shown, at these times.
    fn states(&self) -> Vec<(&str, Column)> {
        let shown = self.simulation.system.states.iter().filter(|state| !state.hidden);
        let column = |name: &str| Column::lent(&self.simulation, |it| it.state(name));
        shown.filter_map(|it| Some((it.name.as_str(), column(&it.name)?))).collect()
    }

    /// The document of `fdcc simulate --json`.
    fn json(&self) -> String {
        fdcc_cli::simulation(&self.simulation, &self.model)
    }
}
