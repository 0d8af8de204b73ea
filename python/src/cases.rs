//! Many solves of one model.

use crate::errors::raised;
use crate::inputs::{Values, values};
use crate::model::Model;
use crate::watch::Watch;
use fdcc::{Error, Executor, Options, Stop, Value};
use pyo3::prelude::*;
use std::ops::ControlFlow;
use std::time::Instant;

/// A model that is solved for many cases.
#[pyclass(frozen, module = "fdcc._fdcc")]
pub struct Cases {
    model: fdcc::Model,
    cases: fdcc::Cases,
}

/// How each of them is solved.
struct How {
    starts: usize,
    time_limit: Option<f64>,
    /// The largest difference to the true system that is called confirmation, if that is asked.
    gap: Option<f64>,
}

#[pymethods]
impl Cases {
    #[new]
    fn new(model: &Model) -> Self {
        let model = model.model().clone();
        Cases { cases: fdcc::Cases::new(&model), model }
    }

    /// Solves some cases, so many at a time; of each what stands in a row of `fdcc sweep --json`.
    #[pyo3(signature = (given, jobs, starts=1, time_limit=None, gap=None))]
    fn solve(
        &self,
        py: Python,
        given: Vec<Values>,
        jobs: Option<usize>,
        starts: usize,
        time_limit: Option<f64>,
        gap: Option<f64>,
    ) -> PyResult<Vec<String>> {
        let watch = Watch::new(None);
        let given: Vec<_> = given.into_iter().map(values).collect();
        let how = How { starts, time_limit, gap };
        let executor = jobs.map_or_else(Executor::default, Executor::threads);
        let one = |at: usize| self.row(&given[at], &how, &watch);
        let rows = watch.aside(py, || executor.in_order(given.len(), one, Result::is_err));
        watch.raised()?;
        let rows: Result<Vec<String>, Error> = rows.into_iter().collect();
        rows.map_err(|error| raised(py, error, self.model.source()))
    }
}

impl Cases {
    fn row(&self, case: &[(String, Value)], how: &How, watch: &Watch) -> Result<String, Error> {
        let begin = Instant::now();
        let seconds = || begin.elapsed().as_secs_f64();
        let case: Vec<(&str, Value)> =
            case.iter().map(|(name, value)| (name.as_str(), value.clone())).collect();
        let case = self.cases.case(&case)?;
        if !case.is_compiled() {
            case.compile()?;
        }
        let compiling = seconds();
        let limited = |from: f64| {
            move || match how.time_limit {
                Some(limit) if seconds() - from >= limit => ControlFlow::Break(Stop::TimeLimit),
                _ => watch.check(),
            }
        };
        let (starts, executor) = (how.starts, Executor::serial());
        // What all cases share has as much time as one of them.
        let stop = limited(compiling);
        case.prepare(&Options { starts, executor, stop: &stop, ..Options::default() });
        let before = seconds();
        let stop = limited(before);
        let options = Options { starts, executor, stop: &stop, ..Options::default() };
        let found = case.solve(&options)?;
        Ok(fdcc_cli::row(&found, [compiling, seconds() - before], how.gap))
    }
}
