//! What contradicts that an answer is an optimum, whatever its replay says: conditions that every
//! optimum meets.
//!
//! A replay shows that a trajectory is possible. That nothing better is near it, only the
//! multipliers say; and where the gradient through a thin layer is lost, they are wrong though all
//! conditions of the discrete problem are met. The measures and their limits are in
//! `docs/method/costate.md`.

use super::document::HamiltonianCheck;
use super::number::short;
use serde::Serialize;

/// The Hamiltonian may be off by so much of the size of its terms.
const OFF: f64 = 0.4;
/// On how much of the time a control may violate the rule of signs.
const VIOLATED: f64 = 0.01;

/// The conditions that were checked.
#[derive(Clone, Debug, Serialize)]
pub struct Optimality {
    /// `nothing contradicts`, or what does.
    pub says: String,
    pub contradicted: bool,
    pub checks: Vec<Check>,
}

/// One condition of an optimum.
#[derive(Clone, Debug, Serialize)]
pub struct Check {
    pub check: Kind,
    /// The control that it is about, if it is about one.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub control: Option<String>,
    /// By how much it is missed, in the unit of `size`.
    pub figure: f64,
    /// What that is compared with.
    pub size: f64,
    /// A larger part of the size contradicts.
    pub limit: f64,
    pub contradicts: bool,
}

/// What is checked.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Kind {
    /// The Hamiltonian is constant over time.
    HamiltonianConstant,
    /// It has the value that a free last time gives it.
    HamiltonianValue,
    /// A pause on a surface does not gain anything.
    Pause,
    /// The control is at the bound that the slope of the Hamiltonian points to, or the slope is 0.
    Minimum,
}

impl Optimality {
    /// Of a solution with this Hamiltonian. `gap` is by how much its replay differs: the states of
    /// a coarse grid excuse as much. Where the optimum of the discrete problem is proved to be
    /// global, what its Hamiltonian misses is the grid alone.
    pub fn new(hamiltonian: &HamiltonianCheck, gap: Option<f64>, is_global: bool) -> Self {
        let constant = hamiltonian.deviation.filter(|_| !is_global);
        let pause = hamiltonian.pause.filter(|_| !is_global).map(|gain| gain.max(0.0));
        let kind =
            hamiltonian.expected.map_or(Kind::HamiltonianConstant, |_| Kind::HamiltonianValue);
        let limit = OFF.max(gap.unwrap_or(0.0));
        let constant =
            constant.map(|figure| Check::new(kind, None, (figure, hamiltonian.size), limit));
        let signs = hamiltonian.violations.0.iter().map(|(name, part)| {
            Check::new(Kind::Minimum, Some(name.clone()), (*part, 1.0), VIOLATED)
        });
        let pause =
            pause.map(|figure| Check::new(Kind::Pause, None, (figure, hamiltonian.size), limit));
        let checks: Vec<Check> = constant.into_iter().chain(pause).chain(signs).collect();
        let told: Vec<String> =
            checks.iter().filter(|it| it.contradicts).map(Check::words).collect();
        let contradicted = !told.is_empty();
        let says = if contradicted { told.join(", ") } else { "nothing contradicts".into() };
        Optimality { says, contradicted, checks }
    }
}

impl Check {
    fn new(check: Kind, control: Option<String>, (figure, size): (f64, f64), limit: f64) -> Self {
        let contradicts = figure.is_nan() || figure > limit * size;
        Check { check, control, figure, size, limit, contradicts }
    }

    fn words(&self) -> String {
        let percent = short((1000.0 * self.figure / self.size).round() / 10.0);
        match (self.check, &self.control) {
            (Kind::HamiltonianConstant, _) => {
                format!("its Hamiltonian has to be constant and is off by {percent} % of its size")
            }
            (Kind::HamiltonianValue, _) => {
                format!("its Hamiltonian is known and off by {percent} % of its size")
            }
            (Kind::Pause, _) => {
                format!("a pause on a surface gains {percent} % of the size of its Hamiltonian")
            }
            (Kind::Minimum, control) => {
                let control = control.as_deref().unwrap_or_default();
                format!("`{control}` does not minimise the Hamiltonian on {percent} % of the time")
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::output::named::Named;

    fn hamiltonian(deviation: f64, violation: f64) -> HamiltonianCheck {
        HamiltonianCheck {
            is_constant: true,
            expected: None,
            deviation: Some(deviation),
            size: 2.0,
            violations: Named(vec![("F".into(), violation)]),
            pause: None,
        }
    }

    #[test]
    fn what_is_off_by_two_fifths_or_has_the_wrong_sign_contradicts() {
        let says = |deviation, violation, gap, is_global| {
            Optimality::new(&hamiltonian(deviation, violation), gap, is_global).says
        };
        assert_eq!(says(0.4, 0.0, None, false), "nothing contradicts");
        let off = "its Hamiltonian has to be constant and is off by 82 % of its size";
        assert_eq!(says(1.64, 0.0, Some(1e-6), false), off);
        assert_eq!(says(1.64, 0.0, Some(0.9), false), "nothing contradicts");
        assert_eq!(says(1.64, 0.0, None, true), "nothing contradicts");
        let sign = "`F` does not minimise the Hamiltonian on 50 % of the time";
        assert_eq!(says(0.0, 0.5, Some(0.9), true), sign);
    }
}
