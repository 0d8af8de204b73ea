//! What a solver calls all the time.

use super::{Function, Problem};

/// The functions that a solver calls in every iteration, each with the order of the derivatives
/// that it wants: what is worth [preparing](Function::prepare). What takes longest comes first.
pub fn often_called(problem: &Problem) -> [(&dyn Function, usize); 6] {
    let [dynamics, path, boundary] = [&*problem.dynamics, &*problem.path, &*problem.boundary];
    [(dynamics, 2), (path, 2), (dynamics, 0), (path, 0), (boundary, 2), (boundary, 0)]
}
