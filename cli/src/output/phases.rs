//! The phases of a solution: a part of its document for each.

use super::document::{ControlNodes, Document};
use super::hamiltonian_check::HamiltonianCheck;
use super::modes::Span;
use super::named::Named;
use super::picture::{Before, PathCondition};
use super::plots::Drawn;
use super::tried::Happened;
use super::verification::Verification;
use serde::{Serialize, Serializer};

/// The document of a phase by itself.
#[derive(Clone, Debug)]
pub struct Phase(pub Document);

/// What of it is written in that of the whole.
#[derive(Serialize)]
struct Shown<'d> {
    scheme: &'d str,
    #[serde(rename = "N")]
    n: usize,
    time: &'d [f64],
    states: &'d Named<Vec<f64>>,
    controls: &'d Named<Vec<f64>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    control_nodes: Option<&'d ControlNodes>,
    costates: &'d Named<Vec<f64>>,
    #[serde(skip_serializing_if = "<[_]>::is_empty")]
    costates_before: &'d [Before],
    path_multipliers: &'d Named<Vec<f64>>,
    end_multipliers: &'d Named<f64>,
    hamiltonian: &'d [f64],
    hamiltonian_check: &'d HamiltonianCheck,
    report: &'d Named<Vec<f64>>,
    surfaces: &'d Named<Vec<Span>>,
    #[serde(skip_serializing_if = "<[_]>::is_empty")]
    jumps: &'d [Happened],
    sigmas: &'d Named<f64>,
    bounds: &'d Named<[f64; 2]>,
    #[serde(skip_serializing_if = "Named::is_empty")]
    path: &'d Named<PathCondition>,
    #[serde(skip_serializing_if = "Named::is_empty")]
    plots: &'d Named<Drawn>,
    #[serde(skip_serializing_if = "Option::is_none")]
    verification: Option<&'d Verification>,
}

impl Document {
    /// The jumps and when they happen; those of phases have the name of the phase before theirs.
    pub fn all_jumps(&self) -> Vec<(String, f64)> {
        let of_phases = self.phases.0.iter().flat_map(|(phase, it)| {
            it.0.jumps.iter().map(move |jump| (format!("{phase}.{}", jump.jump), jump.time))
        });
        self.jumps.iter().map(|it| (it.jump.clone(), it.time)).chain(of_phases).collect()
    }
}

impl Serialize for Phase {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let of = &self.0;
        let shown = Shown {
            scheme: &of.method.scheme,
            n: of.method.n,
            time: &of.time,
            states: &of.states,
            controls: &of.controls,
            control_nodes: of.control_nodes.as_ref(),
            costates: &of.costates,
            costates_before: &of.picture.costates_before,
            path_multipliers: &of.path_multipliers,
            end_multipliers: &of.end_multipliers,
            hamiltonian: &of.hamiltonian,
            hamiltonian_check: &of.hamiltonian_check,
            report: &of.report,
            surfaces: &of.surfaces,
            jumps: &of.jumps,
            sigmas: &of.method.sigmas,
            bounds: &of.picture.bounds,
            path: &of.picture.path,
            plots: &of.picture.plots,
            verification: of.verification.as_ref(),
        };
        shown.serialize(serializer)
    }
}
