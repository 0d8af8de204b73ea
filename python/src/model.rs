//! Models: read, with other values, solved, simulated, differentiated.

use crate::errors::{raised, wrong_model};
use crate::gradient::Gradient;
use crate::inputs::{Data, Driven, DrivenPhases, Driver, Earlier, Known, Values, values};
use crate::simulation::Simulation;
use crate::solution::Solution;
use crate::watch::Watch;
use fdcc::{Accuracy, Error, Options, Report, Start, Value, by_names};
use fdcc_cli::Answer;
use fdcc_grammar::{Diagnostic, Severity, SourceFile};
use pyo3::exceptions::{PyOSError, PyValueError};
use pyo3::prelude::*;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex};

/// So many variants of a model with other settings of the method are kept, as they were compiled.
const MOST_VARIANTS: usize = 16;

/// Everything that is known about a text: its diagnostics as JSON, and as they are drawn.
#[pyfunction]
pub fn check(py: Python, name: &str, text: Vec<u8>, data: Option<Data>) -> (String, String) {
    let files = data.map(Data::files);
    let checked = Watch::new(None).aside(py, || fdcc::check_with(name, text, files));
    let (found, source) = (&checked.diagnostics[..], &checked.source);
    (fdcc_cli::diagnostics(found, source), fdcc_cli::drawn(found, source))
}

/// A model without mistakes.
#[pyclass(frozen, module = "fdcc._fdcc")]
pub struct Model {
    model: fdcc::Model,
    variants: Mutex<Vec<(Changes, Arc<Variant>)>>,
}

/// What a model is compiled anew for: another objective, settings of the method.
#[derive(Clone, PartialEq)]
struct Changes {
    of: Option<String>,
    settings: Vec<(String, Value)>,
}

/// A model that is compiled once.
struct Variant {
    model: fdcc::Model,
    is_compiled: AtomicBool,
}

impl Model {
    /// As the library has it.
    pub fn model(&self) -> &fdcc::Model {
        &self.model
    }

    /// The model with an objective and settings of the method, compiled once for all calls.
    fn variant(&self, py: Python, changes: &Changes) -> PyResult<Arc<Variant>> {
        if let Some(variant) = self.known(changes) {
            return Ok(variant);
        }
        let model = self.changed(py, changes)?;
        let variant = Arc::new(Variant { model, is_compiled: AtomicBool::new(false) });
        let mut known = self.variants.lock().expect("nobody panics with the lock");
        if known.len() == MOST_VARIANTS {
            known.remove(0);
        }
        known.push((changes.clone(), variant.clone()));
        Ok(variant)
    }

    /// The lock is not kept while others work, who may wait for that of the interpreter.
    fn known(&self, changes: &Changes) -> Option<Arc<Variant>> {
        let known = self.variants.lock().expect("nobody panics with the lock");
        known.iter().find(|(own, _)| own == changes).map(|(_, variant)| variant.clone())
    }

    fn changed(&self, py: Python, changes: &Changes) -> PyResult<fdcc::Model> {
        let model = match &changes.of {
            Some(of) => self.with_objective(py, of)?,
            None => self.model.clone(),
        };
        with_all(&model, &changes.settings).map_err(|error| self.raised(py, error))
    }

    fn with_objective(&self, py: Python, of: &str) -> PyResult<fdcc::Model> {
        let checked = Watch::new(None).aside(py, || self.model.with_objective(of));
        let is_wrong = |it: &&Diagnostic| it.severity == Severity::Error;
        let wrong: Vec<Diagnostic> = checked.diagnostics.iter().filter(is_wrong).cloned().collect();
        let source = SourceFile::new("of", of);
        checked.model.ok_or_else(|| wrong_model(py, &wrong, &source))
    }

    fn raised(&self, py: Python, error: Error) -> PyErr {
        raised(py, error, self.model.source())
    }

    /// Values of parameters, and those of keys of the method.
    fn sorted(&self, given: Values) -> [Vec<(String, Value)>; 2] {
        let (params, settings) =
            values(given).into_iter().partition(|(name, _)| self.model.has_param(name));
        [params, settings]
    }
}

fn with_all(model: &fdcc::Model, values: &[(String, Value)]) -> Result<fdcc::Model, Error> {
    let values: Vec<(&str, Value)> =
        values.iter().map(|(name, value)| (name.as_str(), value.clone())).collect();
    model.with_all(&values)
}

#[pymethods]
impl Model {
    /// Reads and checks a text; `name` stands in messages.
    #[new]
    #[pyo3(signature = (name, text, data=None))]
    fn new(py: Python, name: &str, text: Vec<u8>, data: Option<Data>) -> PyResult<Self> {
        let watch = Watch::new(None);
        let files = data.map(Data::files);
        let checked = watch.aside(py, || fdcc::check_with(name, text, files));
        watch.raised()?;
        let (diagnostics, source) = (checked.diagnostics.clone(), checked.source.clone());
        match checked.into_model() {
            Ok(model) => Ok(Model { model, variants: Mutex::default() }),
            Err(_) => Err(wrong_model(py, &diagnostics, &source)),
        }
    }

    /// The name that the model gives itself.
    #[getter]
    fn name(&self) -> &str {
        self.model.name()
    }

    /// The name in messages, and the text.
    #[getter]
    fn source(&self) -> (&str, &str) {
        let source = self.model.source();
        (&source.name, &source.text)
    }

    /// The texts of its data files, by the names that it gives them.
    #[getter]
    fn data(&self) -> PyResult<Vec<(String, String)>> {
        self.model.data().map_err(|error| PyOSError::new_err(error.to_string()))
    }

    /// Warnings and advice as JSON, and as they are drawn.
    #[getter]
    fn diagnostics(&self) -> (String, String) {
        let (found, source) = (self.model.diagnostics(), self.model.source());
        (fdcc_cli::diagnostics(found, source), fdcc_cli::drawn(found, source))
    }

    /// The names of states, controls, parameters, unknowns, surfaces and reports.
    #[getter]
    fn names(&self) -> Vec<(&str, Vec<&str>)> {
        let it = self.model.meaning();
        vec![
            ("states", it.states.iter().map(|it| it.place.name.as_str()).collect()),
            ("controls", it.controls.iter().map(|it| it.place.name.as_str()).collect()),
            ("params", it.params.iter().map(|it| it.place.name.as_str()).collect()),
            ("free", it.frees.iter().map(|it| it.place.name.as_str()).collect()),
            ("surfaces", it.surfaces.iter().map(|it| it.place.name.as_str()).collect()),
            ("report", it.report.iter().map(|it| it.place.name.as_str()).collect()),
            ("phases", it.phases.iter().map(|it| it.model.name.as_str()).collect()),
        ]
    }

    /// Of each name its unit in SI, its declared unit, and how many of the first that is.
    #[getter]
    fn units(&self) -> Vec<(&str, &str, &str, f64)> {
        let units = self.model.meaning().units.iter();
        let name = |is_time: bool, name| if is_time { "time" } else { name };
        units.map(|it| (name(it.is_time, it.name.as_str()), &*it.si, &*it.unit, it.scale)).collect()
    }

    /// Solves; `report` is called now and then with the number of the iteration, the objective, the
    /// violation of the constraints and the intervals of the grid.
    #[pyo3(signature = (given, warm=None, starts=1, time_limit=None, report=None))]
    fn solve(
        &self,
        py: Python,
        given: Values,
        warm: Option<Earlier>,
        starts: usize,
        time_limit: Option<f64>,
        report: Option<Py<PyAny>>,
    ) -> PyResult<Solution> {
        let watch = Watch::new(time_limit);
        let [params, settings] = self.sorted(given);
        let variant = self.variant(py, &Changes { of: None, settings })?;
        let model = with_all(&variant.model, &params).map_err(|error| self.raised(py, error))?;
        let warm = warm.map(Earlier::read).transpose()?;
        if !variant.is_compiled.load(Ordering::Relaxed) {
            let compiled = watch.aside(py, || model.compile().map(drop));
            watch.raised()?;
            compiled.map_err(|error| self.raised(py, error))?;
            variant.is_compiled.store(true, Ordering::Relaxed);
        }
        let compiling = watch.seconds();
        if let Some(Known::Solution(it)) = &warm {
            let record = it.get().solution().record();
            let known = model.compile().and_then(|it| it.check_start(Start::Record(&record)));
            known.map_err(|error| self.raised(py, error))?;
        }
        let told = |it: &Report| {
            if let (Report::Iteration(_, progress, level), Some(report)) = (it, &report) {
                let (objective, violation) = (progress.objective, progress.primal_infeasibility);
                let what = (progress.iteration, objective, violation, level.intervals);
                Python::attach(|py| watch.note(report.call1(py, what).map(drop)));
            }
        };
        let record = match &warm {
            Some(Known::File(saved)) => Some(saved.record()),
            _ => None,
        };
        let start = match (&warm, &record) {
            (Some(Known::Solution(it)), _) => Start::Solution(it.get().solution()),
            (_, Some(record)) => Start::Record(record),
            _ => Start::Guess,
        };
        let stop = || watch.check();
        let options = Options { starts, start, report: &told, stop: &stop, ..Options::default() };
        // A thread of its own costs as much as half of a short solve.
        let meaning = model.meaning();
        let mut phases = meaning.phases.iter().map(|it| &it.model);
        let jumps = !meaning.jumps.is_empty() || phases.any(|it| !it.jumps.is_empty());
        let is_short = starts == 1 && !jumps;
        let found = match is_short {
            true => py.detach(|| model.solve(&options)),
            false => watch.aside(py, || model.solve(&options)),
        };
        watch.raised_but_interrupt(py)?;
        let found = found.map_err(|error| self.raised(py, error))?;
        Ok(Solution::new(Answer::new(found, [compiling, watch.seconds() - compiling])))
    }

    /// Simulates the true system; `times` are when states are reported, in SI.
    #[pyo3(signature = (given, controls=None, times=None, rtol=None, time_limit=None))]
    fn simulate(
        &self,
        py: Python,
        given: Values,
        controls: Option<Driver>,
        times: Option<Vec<f64>>,
        rtol: Option<f64>,
        time_limit: Option<f64>,
    ) -> PyResult<Simulation> {
        let watch = Arc::new(Watch::new(time_limit));
        if !self.model.phases().is_empty() {
            return self.simulate_phases(py, given, controls, times, rtol, &watch);
        }
        let driven = Driven::new(&self.model, controls, &values(given))?;
        let driven = driven.map_err(|error| self.raised(py, error))?;
        let (model, accuracy) = (driven.model.clone(), accuracy(times, rtol, &watch)?);
        let accuracy = Accuracy { points_between: true, ..accuracy };
        let simulated = watch.aside(py, || {
            let system = model.system()?;
            fits(&accuracy, system.interval)?;
            let controls = driven.controls(system.interval);
            Ok(fdcc::Simulation::new(&model, system, &controls, &accuracy))
        });
        watch.raised_but_interrupt(py)?;
        let simulation = simulated.map_err(|error| self.raised(py, error))?;
        Ok(Simulation::new(simulation, model))
    }

    /// Differentiates an expression on the true system, or the objective, by names.
    #[pyo3(signature = (given, of, by, controls=None, rtol=None))]
    fn grad(
        &self,
        py: Python,
        given: Values,
        of: Option<String>,
        by: Vec<String>,
        controls: Option<Driver>,
        rtol: Option<f64>,
    ) -> PyResult<Gradient> {
        let watch = Arc::new(Watch::new(None));
        let variant = self.variant(py, &Changes { of: of.clone(), settings: Vec::new() })?;
        let driven = Driven::new(&variant.model, controls, &values(given))?;
        let driven = driven.map_err(|error| self.raised(py, error))?;
        let model = driven.model.clone();
        if model.meaning().objective.is_none() {
            let why = "the model has no objective; say what to differentiate, such as \"x(end)\"";
            return Err(PyValueError::new_err(why));
        }
        let accuracy = accuracy(None, rtol, &watch)?;
        let found = watch.aside(py, || {
            let system = model.sensitivity_system()?;
            let controls = driven.controls(system.interval);
            let names: Vec<&str> = by.iter().map(String::as_str).collect();
            let by = by_names(&names, &system, &controls, &model);
            let by = by.map_err(|why| Error::Call(why.to_string()))?;
            Ok(fdcc::Gradient::new(&model, system, controls, by, &accuracy))
        });
        watch.raised()?;
        let gradient = found.map_err(|error| self.raised(py, error))?;
        Ok(Gradient::new(of.unwrap_or_else(|| "objective".into()), gradient, model))
    }
}

impl Model {
    fn simulate_phases(
        &self,
        py: Python,
        given: Values,
        controls: Option<Driver>,
        times: Option<Vec<f64>>,
        rtol: Option<f64>,
        watch: &Arc<Watch>,
    ) -> PyResult<Simulation> {
        if times.is_some() {
            let why = "`t` needs a model of one piece; phases have times of their own";
            return Err(PyValueError::new_err(why));
        }
        let driven = DrivenPhases::new(&self.model, controls, &values(given))?;
        let driven = driven.map_err(|error| self.raised(py, error))?;
        let accuracy = Accuracy { points_between: true, ..accuracy(None, rtol, watch)? };
        let simulated = watch.aside(py, || driven.simulate(&accuracy));
        watch.raised_but_interrupt(py)?;
        let simulated = simulated.map_err(|error| self.raised(py, error))?;
        Ok(Simulation::of_phases(simulated, driven.model))
    }
}

/// How exactly to simulate, and until when.
fn accuracy(times: Option<Vec<f64>>, rtol: Option<f64>, watch: &Arc<Watch>) -> PyResult<Accuracy> {
    let times = times.unwrap_or_default();
    if times.iter().any(|time| !time.is_finite()) || !times.is_sorted() {
        return Err(PyValueError::new_err("`t` needs numbers in ascending order"));
    }
    let (usual, watch) = (Accuracy::default(), watch.clone());
    let watch = fdcc_runtime::simulate::Watch::new(move || watch.check());
    Ok(Accuracy { times, rtol: rtol.unwrap_or(usual.rtol), watch, ..usual })
}

/// Whether all times of a simulation are in its interval.
fn fits(accuracy: &Accuracy, [first, last]: [f64; 2]) -> Result<(), Error> {
    match accuracy.times.iter().find(|time| **time < first || **time > last) {
        Some(time) => Err(Error::Call(format!("`t`: {time} is not between {first} and {last}"))),
        None => Ok(()),
    }
}
