//! Gradients of the true system.

use crate::column::Column;
use pyo3::prelude::*;
use std::sync::Arc;

/// The derivatives of an expression.
#[pyclass(frozen, module = "fdcc._fdcc")]
pub struct Gradient {
    of: String,
    gradient: Arc<fdcc::Gradient>,
    model: fdcc::Model,
}

impl Gradient {
    pub fn new(of: String, gradient: fdcc::Gradient, model: fdcc::Model) -> Self {
        Gradient { of, gradient: Arc::new(gradient), model }
    }
}

#[pymethods]
impl Gradient {
    /// What was differentiated, where the trajectory reached the last time.
    #[getter]
    fn value(&self) -> Option<f64> {
        self.gradient.found.as_ref().ok().map(|it| it.found.value)
    }

    /// Whether there is a derivative, and both ways to compute it agree.
    #[getter]
    fn trusted(&self) -> bool {
        self.gradient.is_trusted()
    }

    /// The derivatives by each name, one number or one for each row of a control.
    fn derivatives(&self) -> Vec<(&str, bool, Column)> {
        let column = |name: &str| Column::lent(&self.gradient, |it| it.get(name));
        let by = self.gradient.by.iter();
        by.filter_map(|it| Some((it.name.as_str(), it.is_control, column(&it.name)?))).collect()
    }

    /// The document of `fdcc grad --json`; with second derivatives if they are wanted.
    fn json(&self, py: Python, second: bool) -> String {
        py.detach(|| fdcc_cli::gradient(&self.of, &self.gradient, second, &self.model))
    }
}
