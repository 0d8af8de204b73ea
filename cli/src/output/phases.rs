//! The phases of a solution: a part of its document for each, and all of them on one axis.

use super::document::{ControlNodes, Document, HamiltonianCheck, Span};
use super::named::Named;
use super::verified::Verification;
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
    path_multipliers: &'d Named<Vec<f64>>,
    end_multipliers: &'d Named<f64>,
    hamiltonian: &'d [f64],
    hamiltonian_check: &'d HamiltonianCheck,
    report: &'d Named<Vec<f64>>,
    surfaces: &'d Named<Vec<Span>>,
    sigmas: &'d Named<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    verification: Option<&'d Verification>,
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
            path_multipliers: &of.path_multipliers,
            end_multipliers: &of.end_multipliers,
            hamiltonian: &of.hamiltonian,
            hamiltonian_check: &of.hamiltonian_check,
            report: &of.report,
            surfaces: &of.surfaces,
            sigmas: &of.method.sigmas,
            verification: of.verification.as_ref(),
        };
        shown.serialize(serializer)
    }
}

/// The document with the signals of all phases one after the other, for the page: at a link the
/// grid has the last time of a phase and the first of the next, and signals have a gap.
pub fn on_one_axis(document: &Document) -> Document {
    let phases: Vec<&Document> = document.phases.0.iter().map(|(_, phase)| &phase.0).collect();
    if phases.is_empty() {
        return document.clone();
    }
    let grids: Vec<usize> = phases.iter().map(|phase| phase.time.len()).collect();
    let of = |signals: fn(&Document) -> &Named<Vec<f64>>| {
        let all: Vec<&Named<Vec<f64>>> = phases.iter().map(|phase| signals(phase)).collect();
        joined(&grids, &all)
    };
    let mut surfaces: Named<Vec<Span>> = Named::default();
    for (name, spans) in phases.iter().flat_map(|phase| &phase.surfaces.0) {
        match surfaces.0.iter_mut().find(|known| known.0 == *name) {
            Some((_, known)) => known.extend_from_slice(spans),
            None => surfaces.0.push((name.clone(), spans.clone())),
        }
    }
    Document {
        time: phases.iter().flat_map(|phase| phase.time.clone()).collect(),
        states: of(|it| &it.states),
        controls: of(|it| &it.controls),
        costates: of(|it| &it.costates),
        report: of(|it| &it.report),
        surfaces,
        ..document.clone()
    }
}

/// Signals of the same name one after the other, NaN where a phase has none. A signal with one
/// value per interval stays one.
fn joined(grids: &[usize], all: &[&Named<Vec<f64>>]) -> Named<Vec<f64>> {
    let mut names: Vec<&String> = Vec::new();
    for (name, _) in all.iter().flat_map(|signals| &signals.0) {
        if !names.contains(&name) {
            names.push(name);
        }
    }
    let column = |name: &String| {
        let mut column = Vec::new();
        let mut is_stepwise = false;
        for (points, signals) in grids.iter().zip(all) {
            let own = signals.get(name).map_or(&[][..], Vec::as_slice);
            is_stepwise |= !own.is_empty() && own.len() < *points;
            let gap = vec![f64::NAN; points - own.len()];
            column.extend(own.iter().copied().chain(gap));
        }
        // The page draws what has a value for each point as a line.
        column.truncate(column.len() - usize::from(is_stepwise));
        (name.clone(), column)
    };
    names.into_iter().map(column).collect()
}
