//! A model in closed loop.

use crate::errors::raised;
use crate::inputs::{Values, values};
use crate::model::Model;
use crate::watch::Watch;
use fdcc::{Executor, Options};
use pyo3::prelude::*;
use std::sync::Mutex;

/// Solves a model once for each state that it is told.
#[pyclass(frozen, module = "fdcc._fdcc")]
pub struct Controller {
    model: fdcc::Model,
    inner: Mutex<fdcc::Controller>,
}

/// What came out of a step: the first value of each control, how it ended, and its figures.
type Step = (Vec<f64>, &'static str, bool, f64, f64, f64, usize);

#[pymethods]
impl Controller {
    #[new]
    fn new(py: Python, model: &Model, given: Values, intervals: usize) -> PyResult<Self> {
        let (watch, source) = (Watch::new(None), model.model().source());
        let given = values(given);
        let made = watch.aside(py, || {
            let given: Vec<_> =
                given.iter().map(|(name, it)| (name.as_str(), it.clone())).collect();
            let model = model.model().with_all(&given)?;
            Ok((model.controller(intervals)?, model))
        });
        watch.raised()?;
        let (inner, model) = made.map_err(|error| raised(py, error, source))?;
        Ok(Controller { model, inner: Mutex::new(inner) })
    }

    /// The names of the states, of the controls and of the signals.
    #[getter]
    fn names(&self) -> [Vec<String>; 3] {
        let inner = self.inner.lock().expect("nobody panics with the lock");
        let owned = |names: &mut dyn Iterator<Item = &str>| names.map(str::to_owned).collect();
        [owned(&mut inner.states()), owned(&mut inner.controls()), owned(&mut inner.signals())]
    }

    /// The values of signals, and the time from which on the others have those of the text.
    fn set_signals(
        &self,
        py: Python,
        given: Vec<(String, Vec<f64>)>,
        now: Option<f64>,
    ) -> PyResult<()> {
        let mut inner = self.inner.lock().expect("nobody panics with the lock");
        let set = |(name, values): &(String, Vec<f64>)| inner.set_signal(name, values);
        let set = given.iter().try_for_each(set);
        let set = set.and_then(|()| now.map_or(Ok(()), |now| inner.set_time(now)));
        set.map_err(|error| raised(py, error, self.model.source()))
    }

    /// Other values of parameters, from the next step on.
    fn set(&self, py: Python, given: Values) -> PyResult<()> {
        let mut inner = self.inner.lock().expect("nobody panics with the lock");
        let mut set = values(given).into_iter();
        let set = set.try_for_each(|(name, value)| inner.set(&name, value));
        set.map_err(|error| raised(py, error, self.model.source()))
    }

    /// Solves from a state, for so many seconds at most.
    fn step(&self, py: Python, state: Vec<f64>, budget: Option<f64>) -> PyResult<Step> {
        let watch = Watch::new(budget);
        let stop = || watch.check();
        let options = Options { stop: &stop, executor: Executor::serial(), ..Options::default() };
        let step = py.detach(|| {
            let mut inner = self.inner.lock().expect("nobody panics with the lock");
            let found = inner.step(&state, &options)?;
            let (controls, duration) = found.first_controls();
            let solution = &found.outcome.solution;
            Ok((
                controls,
                found.status_name(),
                found.is_solved(),
                found.objective(),
                duration,
                solution.constraint_violation,
                solution.counts.iterations,
            ))
        });
        watch.raised()?;
        step.map_err(|error| raised(py, error, self.model.source()))
    }
}
