//! What contradicts that an answer is an optimum, in words and as data.

use super::document::Document;
use super::number::short;
use super::verification::Verification;
use fdcc::optimality::{self, Condition};
use serde::Serialize;

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
    pub check: &'static str,
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

impl Optimality {
    /// What some checks found.
    pub fn new(checks: &[optimality::Check]) -> Self {
        let told: Vec<String> = checks.iter().filter(|it| it.contradicts()).map(words).collect();
        let contradicted = !told.is_empty();
        let says = if contradicted { told.join(", ") } else { "nothing contradicts".into() };
        Optimality { says, contradicted, checks: checks.iter().map(Check::new).collect() }
    }
}

impl Check {
    fn new(it: &optimality::Check) -> Self {
        let optimality::Check { condition, control, figure, size, limit } = it.clone();
        let contradicts = it.contradicts();
        Check { check: name(condition), control, figure, size, limit, contradicts }
    }
}

fn name(condition: Condition) -> &'static str {
    match condition {
        Condition::HamiltonianConstant => "hamiltonian_constant",
        Condition::HamiltonianValue => "hamiltonian_value",
        Condition::Pause => "pause",
        Condition::Minimum => "minimum",
        Condition::Curvature => "curvature",
    }
}

fn words(it: &optimality::Check) -> String {
    let percent = short((1000.0 * it.figure / it.size).round() / 10.0);
    match it.condition {
        Condition::HamiltonianConstant => {
            format!("its Hamiltonian has to be constant and is off by {percent} % of its size")
        }
        Condition::HamiltonianValue => {
            format!("its Hamiltonian is known and off by {percent} % of its size")
        }
        Condition::Pause => {
            format!("a pause on a surface gains {percent} % of the size of its Hamiltonian")
        }
        Condition::Minimum => {
            let control = it.control.as_deref().unwrap_or_default();
            format!("`{control}` does not minimise the Hamiltonian on {percent} % of the time")
        }
        Condition::Curvature => "the objective falls to second order along a direction".into(),
    }
}

/// What a replay says of the answer, and what contradicts that it is an optimum, in few words.
pub fn on_the_true_system(document: &Document) -> String {
    let replay = document.verification.as_ref();
    let replay = replay.map_or("not replayed on the true system".into(), Verification::words);
    match document.optimality.as_ref().filter(|it| it.contradicted) {
        Some(optimality) => format!("{replay}, CONTRADICTED as an optimum: {}", optimality.says),
        None => replay,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_off_by_more_than_its_limit_contradicts() {
        let says = |condition, figure, limit| {
            let control = (condition == Condition::Minimum).then(|| "F".to_owned());
            let size = if condition == Condition::Minimum { 1.0 } else { 2.0 };
            let check = optimality::Check { condition, control, figure, size, limit };
            Optimality::new(&[check]).says
        };
        assert_eq!(says(Condition::HamiltonianConstant, 0.4, 0.4), "nothing contradicts");
        let off = "its Hamiltonian has to be constant and is off by 82 % of its size";
        assert_eq!(says(Condition::HamiltonianConstant, 1.64, 0.4), off);
        assert_eq!(says(Condition::HamiltonianConstant, 1.64, 0.9), "nothing contradicts");
        let sign = "`F` does not minimise the Hamiltonian on 50 % of the time";
        assert_eq!(says(Condition::Minimum, 0.5, 0.01), sign);
        let undefined = "a pause on a surface gains NaN % of the size of its Hamiltonian";
        assert_eq!(says(Condition::Pause, f64::NAN, 0.4), undefined);
        assert_eq!(says(Condition::Curvature, 0.0, 0.0), "nothing contradicts");
        let falls = "the objective falls to second order along a direction";
        assert_eq!(says(Condition::Curvature, 1.0, 0.0), falls);
    }
}
