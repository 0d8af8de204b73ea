//! What was tried besides the answer, and the jumps of the answer.

use super::named::Named;
use super::words::status_name;
use fdcc_runtime::problem::Problem;
use fdcc_runtime::solve::Outcome;
use serde::Serialize;

/// How the solve from one of several starting points ended.
#[derive(Clone, Debug, Serialize)]
pub struct Ended {
    pub status: String,
    pub objective: f64,
    pub iterations: usize,
}

impl Ended {
    /// Whether there is an objective worth telling.
    pub fn is_good(&self) -> bool {
        matches!(self.status.as_str(), "solved" | "acceptable")
    }

    pub fn of(problem: &Problem, outcome: &Outcome) -> Self {
        let solution = &outcome.solution;
        Ended {
            status: status_name(outcome).to_string(),
            objective: problem.sense * solution.objective,
            iterations: solution.counts.iterations,
        }
    }
}

/// A jump of the solution.
#[derive(Clone, Debug, Serialize)]
pub struct Happened {
    pub jump: String,
    pub time: f64,
    /// All states before it.
    pub before: Named<f64>,
    /// All states after it.
    pub after: Named<f64>,
}

/// How the solve ended in which exactly these jumps happen, one after the other.
#[derive(Clone, Debug, Serialize)]
pub struct Tried {
    pub jumps: Vec<String>,
    /// The surfaces that are crossed against the direction of their jumps.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub crosses: Vec<String>,
    /// All of them, in their order.
    #[serde(skip)]
    pub words: String,
    /// Whether it is the answer.
    #[serde(skip)]
    pub is_answer: bool,
    pub status: String,
    pub objective: f64,
    pub iterations: usize,
}
