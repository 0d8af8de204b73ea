//! What was tried besides the answer, and the jumps of the answer.

use super::named::Named;
use serde::Serialize;

/// How the solve from one of several starting points ended.
#[derive(Clone, Debug, Serialize)]
pub struct Ended {
    pub status: &'static str,
    pub objective: f64,
    pub iterations: usize,
}

impl From<&fdcc::Ended> for Ended {
    fn from(it: &fdcc::Ended) -> Self {
        Ended { status: it.status, objective: it.objective, iterations: it.iterations }
    }
}

/// Starts that lead to one optimum of the system that was written.
#[derive(Clone, Debug, Serialize)]
pub struct Family {
    pub objective: f64,
    pub certified: bool,
    pub starts: usize,
}

impl From<&fdcc::Family> for Family {
    fn from(it: &fdcc::Family) -> Self {
        Family { objective: it.objective, certified: it.is_certified, starts: it.starts }
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

impl From<&fdcc::Jump> for Happened {
    fn from(it: &fdcc::Jump) -> Self {
        let (before, after) = (Named(it.before.clone()), Named(it.after.clone()));
        Happened { jump: it.name.clone(), time: it.time, before, after }
    }
}

/// How the solve ended in which exactly these jumps happen, one after the other.
#[derive(Clone, Debug, Serialize)]
pub struct Tried {
    jumps: Vec<String>,
    /// The surfaces that are crossed against the direction of their jumps.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    crosses: Vec<String>,
    #[serde(flatten)]
    ended: Ended,
}

impl From<&fdcc::Sequence> for Tried {
    fn from(it: &fdcc::Sequence) -> Self {
        let (jumps, crosses) = (it.jumps.clone(), it.crosses.clone());
        Tried { jumps, crosses, ended: Ended::from(&it.ended) }
    }
}
