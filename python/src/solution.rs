//! Solutions, asked by name.

use crate::column::Column;
use fdcc_cli::Answer;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use std::sync::Arc;

/// A solution, or that of one of its phases.
#[pyclass(frozen, module = "fdcc._fdcc")]
pub struct Solution {
    answer: Arc<Answer>,
    phase: Option<usize>,
}

impl Solution {
    /// Of a whole model.
    pub fn new(answer: Answer) -> Self {
        Solution { answer: Arc::new(answer), phase: None }
    }

    /// As the library has it.
    pub fn solution(&self) -> &fdcc::Solution {
        of(&self.answer, self.phase)
    }

    fn lent(
        &self,
        lend: impl for<'o> FnOnce(&'o fdcc::Solution) -> Option<&'o [f64]>,
    ) -> Option<Column> {
        let phase = self.phase;
        Column::lent(&self.answer, |answer| lend(of(answer, phase)))
    }
}

fn of(answer: &Answer, phase: Option<usize>) -> &fdcc::Solution {
    match phase {
        Some(phase) => &answer.solution().phases()[phase],
        None => answer.solution(),
    }
}

/// Pairs of a name and a number.
type Pairs<'s> = Vec<(&'s str, f64)>;

#[pymethods]
impl Solution {
    #[getter]
    fn model(&self) -> &str {
        &self.solution().problem.name
    }

    #[getter]
    fn status(&self) -> &'static str {
        self.solution().status_name()
    }

    #[getter]
    fn is_solved(&self) -> bool {
        self.solution().is_solved()
    }

    #[getter]
    fn objective(&self) -> f64 {
        self.solution().objective()
    }

    #[getter]
    fn free(&self) -> Pairs<'_> {
        self.solution().unknowns().collect()
    }

    #[getter]
    fn params(&self) -> Pairs<'_> {
        self.solution().parameters().collect()
    }

    /// Of each name its unit in SI.
    #[getter]
    fn units(&self) -> Vec<(&str, &str)> {
        let units = self.solution().model().meaning().units.iter();
        units.map(|it| (if it.is_time { "time" } else { &*it.name }, &*it.si)).collect()
    }

    /// The grid points.
    fn time(&self) -> Option<Column> {
        self.lent(|it| Some(it.time()))
    }

    /// The Hamiltonian, one number for each interval.
    fn hamiltonian(&self) -> Option<Column> {
        self.lent(|it| Some(&it.outcome.trajectory.hamiltonian.values))
    }

    /// All states that are shown, at the grid points.
    fn states(&self) -> Vec<(&str, Column)> {
        self.shown(|it| &it.outcome.trajectory.states)
    }

    /// The derivatives of the objective by them.
    fn costates(&self) -> Vec<(&str, Column)> {
        self.shown(|it| &it.outcome.trajectory.costates)
    }

    /// All controls, on the intervals.
    fn controls(&self) -> Vec<(&str, Column)> {
        let controls = self.solution().problem.controls.iter().map(|it| it.name.as_str());
        self.columns(controls.enumerate(), |it| &it.outcome.trajectory.controls)
    }

    /// All reports, at the grid points.
    fn report(&self) -> Vec<(&str, Column)> {
        let names = self.solution().problem.report_names.iter().map(String::as_str);
        self.columns(names.enumerate(), |it| &it.outcome.trajectory.report)
    }

    /// The solutions of its phases.
    fn phases(&self) -> Vec<Solution> {
        let count = self.solution().phases().len();
        let phase = |at| Solution { answer: self.answer.clone(), phase: Some(at) };
        (0..count).map(phase).collect()
    }

    /// Whether the replay confirms the whole and nothing contradicts that it is an optimum.
    fn confirmed(&self, py: Python) -> bool {
        py.detach(|| self.answer.is_confirmed())
    }

    /// What the replay says, as JSON.
    fn verification(&self, py: Python, gap: f64) -> String {
        py.detach(|| self.answer.verification(gap))
    }

    /// How the optimum moves with a parameter, as JSON.
    fn derivative(&self, py: Python, by: &str) -> PyResult<String> {
        py.detach(|| self.answer.derivative(by)).map_err(PyValueError::new_err)
    }

    /// The text of a `.sol.json`.
    fn json(&self, py: Python) -> String {
        py.detach(|| self.answer.json())
    }

    /// A part of an HTML page.
    fn html(&self, py: Python) -> String {
        py.detach(|| self.answer.html())
    }

    /// The verdict.
    fn words(&self, py: Python) -> String {
        py.detach(|| self.answer.words())
    }
}

impl Solution {
    fn shown(&self, of: fn(&fdcc::Solution) -> &Vec<Vec<f64>>) -> Vec<(&str, Column)> {
        let states = self.solution().problem.states.iter().enumerate();
        let shown = states.filter(|(_, state)| !state.hidden);
        self.columns(shown.map(|(at, state)| (at, state.name.as_str())), of)
    }

    fn columns<'s>(
        &'s self,
        names: impl Iterator<Item = (usize, &'s str)>,
        of: fn(&fdcc::Solution) -> &Vec<Vec<f64>>,
    ) -> Vec<(&'s str, Column)> {
        let column = |(at, name)| {
            let column = self.lent(|it| of(it).get(at).map(Vec::as_slice))?;
            Some((name, column))
        };
        names.filter_map(column).collect()
    }
}
