//! What a document says of the Hamiltonian.

use super::named::Named;
use fdcc_runtime::problem::Variable;
use fdcc_runtime::solution::Hamiltonian;
use serde::Serialize;

/// Where time itself does not matter the Hamiltonian is constant; where the last time is unknown,
/// its value is known as well.
#[derive(Clone, Debug, Serialize)]
pub struct HamiltonianCheck {
    pub is_constant: bool,
    pub expected: Option<f64>,
    /// The mean difference from what it has to be.
    pub deviation: Option<f64>,
    /// The mean size of its terms.
    pub size: f64,
    /// For each control the part of the time on which it does not minimise the Hamiltonian.
    pub violations: Named<f64>,
    /// What a pause on a surface would gain per time; `null` where none is possible.
    pub pause: Option<f64>,
}

impl HamiltonianCheck {
    pub(super) fn new(controls: &[Variable], it: &Hamiltonian) -> Self {
        let (is_constant, expected) = (it.is_constant, it.expected);
        let names = controls.iter().map(|control| control.name.clone());
        let violations = names.zip(it.violations.iter().copied()).collect();
        let (deviation, size, pause) = (it.deviation(), it.size, it.pause);
        HamiltonianCheck { is_constant, expected, deviation, size, violations, pause }
    }
}
