//! Warm starts: where an earlier solution ended, with multipliers and as much room as the change of the problem asks for.

use crate::nlp::{Solution, Start, Warm, constraint_violation, estimate};
use crate::problem::Problem;
use crate::starts::{Earlier, resample};
use crate::transcribe::TranscribedNlp;

/// The earlier solution as a warm start on the grid of the problem. Its multipliers are estimated, unless the width of the layer is our choice: then they would be
/// those of another width.
pub fn from_earlier(problem: &Problem, earlier: &Earlier) -> Start {
    let v = resample(problem, earlier);
    let warm = first_width(problem).and_then(|mut nlp| {
        let multipliers = estimate::multipliers(&mut nlp, &v)?;
        Some(Warm { multipliers, mu: room(&mut nlp, &v) })
    });
    Start { v, warm }
}

/// A solution on the same grid, of a problem with other parameters or another width.
pub fn again(problem: &Problem, solution: &Solution) -> Start {
    let mut start = Start::near(solution);
    if let (Some(warm), Some(mut nlp)) = (&mut start.warm, first_width(problem)) {
        warm.mu = room(&mut nlp, &start.v);
    }
    start
}

/// The programme with the width that is solved first; `None` if that is our choice.
fn first_width(problem: &Problem) -> Option<TranscribedNlp<'_>> {
    let width = problem.method.continuation.first().copied().or(problem.method.sigma);
    let mut nlp = TranscribedNlp::new(problem);
    problem.surfaces.iter().zip(width).for_each(|(surface, width)| nlp.set_parameter(surface.sigma, width));
    (width.is_some() || problem.surfaces.is_empty()).then_some(nlp)
}

/// The barrier parameter for a start that violates rows by `r`. Distances from bounds and their multipliers will change in proportion to `r`, and their products
/// by its square.
fn room(nlp: &mut TranscribedNlp, v: &[f64]) -> f64 {
    const LEAST: f64 = 1e-6;
    const FACTOR: f64 = 10.0;
    let violation = constraint_violation(nlp, v);
    (FACTOR * violation * violation).clamp(LEAST, Warm::ROOM)
}
