//! A solved problem, asked in the words of the model.

use fdcc_runtime::nlp::Status;
use fdcc_runtime::problem::Problem;
use fdcc_runtime::solve::Outcome;

use crate::models::{Changes, problem, solve};

/// A problem with its solution.
pub struct Solved {
    /// The problem.
    pub problem: Problem,
    /// What was found.
    pub outcome: Outcome,
}

impl Solved {
    /// Solves the model of a text, and expects that this succeeds.
    pub fn new(text: &str, parameters: Changes, methods: Changes) -> Self {
        Solved::of(problem(text, parameters, methods))
    }

    /// Solves a problem, and expects that this succeeds.
    pub fn of(problem: Problem) -> Self {
        let outcome = solve(&problem);
        let (name, solution) = (&problem.name, &outcome.solution);
        let violation = solution.constraint_violation;
        assert_eq!(
            solution.status,
            Status::Solved,
            "{name}, which violates its rows by {violation:e}"
        );
        Solved { problem, outcome }
    }

    /// The objective as the model writes it.
    pub fn objective(&self) -> f64 {
        self.problem.sense * self.outcome.solution.objective
    }

    /// A state at all grid points.
    pub fn state(&self, name: &str) -> &[f64] {
        &self.outcome.trajectory.states[self.index_of_state(name)]
    }

    /// A state at the end.
    pub fn end(&self, name: &str) -> f64 {
        *self.state(name).last().expect("a grid has points")
    }

    /// A control on all intervals.
    pub fn control(&self, name: &str) -> &[f64] {
        let index = self.problem.controls.iter().position(|control| control.name == name);
        &self.outcome.trajectory.controls[index.expect("a control of the model")]
    }

    /// The derivative of the objective by a state, at all grid points.
    pub fn costate(&self, name: &str) -> &[f64] {
        &self.outcome.trajectory.costates[self.index_of_state(name)]
    }

    /// An unknown or a parameter.
    pub fn value(&self, name: &str) -> f64 {
        let index = self.problem.parameters.iter().position(|parameter| parameter.name == name);
        self.outcome.trajectory.parameters[index.expect("a parameter of the model")]
    }

    /// A quantity by its name: `objective`, `STATE(start)`, `STATE(end)`, an unknown or a
    /// parameter.
    pub fn quantity(&self, name: &str) -> f64 {
        match name.trim_end_matches(')').split_once('(') {
            Some((state, "start")) => self.state(state)[0],
            Some((state, _)) => self.end(state),
            None if name == "objective" => self.objective(),
            None => self.value(name),
        }
    }

    fn index_of_state(&self, name: &str) -> usize {
        self.problem
            .states
            .iter()
            .position(|state| state.name == name)
            .expect("a state of the model")
    }
}
