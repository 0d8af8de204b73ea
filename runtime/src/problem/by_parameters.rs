//! What the sensitivities of an optimum need beside the problem: its functions, differentiated by
//! the parameters.

use super::Function;
use std::sync::Arc;

/// The functions of a problem once more, differentiated by the entries of `p` that are parameters.
pub struct ByParameters {
    /// How many entries of `p` are parameters; they come first.
    pub parameters: usize,
    /// How many are unknowns; they come next.
    pub unknowns: usize,
    /// See [`Problem::dynamics`](super::Problem::dynamics).
    pub dynamics: Arc<dyn Function>,
    /// See [`Problem::path`](super::Problem::path).
    pub path: Arc<dyn Function>,
    /// See [`Problem::boundary`](super::Problem::boundary).
    pub boundary: Arc<dyn Function>,
    /// The functions of [`Problem::measurements`](super::Problem::measurements).
    pub measurements: Vec<Arc<dyn Function>>,
    /// Numbers that the parameters give. Inputs `[p]`; outputs: the parameters themselves, each
    /// over the others; the starts of all states; then lower and upper bounds, in pairs, of states,
    /// controls, unknowns, path constraints and boundary conditions.
    pub given: Arc<dyn Function>,
}

/// The functions of a [`Chain`](super::Chain) once more, differentiated by the parameters.
pub struct ChainByParameters {
    /// Those of each phase.
    pub phases: Vec<ByParameters>,
    /// The functions of the links.
    pub links: Vec<Arc<dyn Function>>,
    /// Inputs `[p]`; outputs: the parameters themselves, each over the others; then lower and upper
    /// bounds, in pairs, of unknowns and of the conditions of all links.
    pub given: Arc<dyn Function>,
}
