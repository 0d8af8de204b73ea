//! A chain of phases: problems that are solved at once, and what ties them together.

use super::{Bounds, Function, Method, Parameter, Problem, Surface, Unknown};
use std::sync::Arc;

/// Phases with their links.
///
/// Every phase is a [`Problem`] with states, controls, surfaces, functions, a grid and a scheme of
/// its own. Parameters and unknowns come first in the `p` of each, at the same places; its
/// smoothing widths follow. Phases that follow each other in time stand next to each other.
#[derive(Clone)]
pub struct Chain {
    /// Name of the model.
    pub name: String,
    /// At least one. The [unknowns](Problem::unknowns) of a phase are those that its functions
    /// depend on; the sum of the objectives of all phases and links is minimised.
    pub phases: Vec<Problem>,
    /// All unknowns.
    pub unknowns: Vec<Unknown>,
    /// What ties phases together.
    pub links: Vec<Link>,
}

/// An end of a phase, by its place among the phases.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum End {
    /// Its first time.
    First(usize),
    /// Its last time.
    Last(usize),
}

/// Conditions between ends of phases.
#[derive(Clone)]
pub struct Link {
    /// The ends that it sees.
    pub ends: Vec<End>,
    /// Inputs `[x | p]`: `x` are the states, then the controls, of each end in turn; `p` are the
    /// parameters and unknowns of all phases. A control has its value in the first or last
    /// interval. Output 0 is a part of the objective, the others are conditions. Differentiated by
    /// all of `x` and the unknowns.
    pub function: Arc<dyn Function>,
    /// One per output but the first.
    pub bounds: Vec<Bounds>,
}

impl Chain {
    /// What is said of the solve as a whole: that of the first phase.
    pub fn method(&self) -> &Method {
        &self.phases[0].method
    }

    /// The surfaces of all phases, with the unit of their widths.
    pub fn surfaces(&self) -> impl Iterator<Item = (&Surface, &Parameter)> {
        self.phases
            .iter()
            .flat_map(|phase| phase.surfaces.iter().map(|it| (it, &phase.parameters[it.sigma])))
    }

    /// A problem of one phase.
    pub fn single(problem: Problem) -> Self {
        Chain {
            name: problem.name.clone(),
            unknowns: problem.unknowns.clone(),
            phases: vec![problem],
            links: Vec::new(),
        }
    }
}

impl End {
    /// The phase.
    pub fn phase(self) -> usize {
        match self {
            End::First(phase) | End::Last(phase) => phase,
        }
    }
}
