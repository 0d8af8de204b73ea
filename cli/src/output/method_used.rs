//! What a document says of the method.

use super::named::Named;
use fdcc::Solution;
use fdcc_runtime::problem::{Method, Solver};
use serde::Serialize;

/// The method that was used, defaults and choices included.
#[derive(Clone, Debug, Serialize)]
pub struct MethodUsed {
    pub scheme: String,
    pub controls: String,
    #[serde(rename = "N")]
    pub n: usize,
    pub steps: usize,
    /// The width of the first surface, or nothing where nothing is smoothed.
    pub sigma: Option<f64>,
    /// The width of every surface.
    pub sigmas: Named<f64>,
    /// Whether these were chosen by the solver, as small as it could, because the model names none.
    pub sigma_chosen: bool,
    pub kernel: String,
    pub solver: String,
    pub linear: String,
    pub tol: f64,
    pub seed: u64,
}

impl MethodUsed {
    pub(super) fn new(found: &Solution) -> Self {
        let Solution { problem, outcome, .. } = found;
        let method: &Method = &problem.method;
        let surfaces = problem.surfaces.iter().zip(&outcome.sigma);
        let is_convex = outcome.convex || method.solver == Solver::Convex;
        let solver = if is_convex { Solver::Convex } else { Solver::InteriorPoint };
        MethodUsed {
            scheme: method.scheme.name(),
            controls: method.controls.name().to_string(),
            n: method.intervals(),
            steps: method.steps,
            sigma: outcome.sigma.first().copied(),
            sigmas: surfaces.map(|(surface, sigma)| (surface.name.clone(), *sigma)).collect(),
            sigma_chosen: found.has_chosen_widths(),
            kernel: method.kernel.clone(),
            solver: solver.name().to_string(),
            linear: method.linear.name().to_string(),
            tol: method.tol,
            seed: method.seed,
        }
    }
}
