//! Warm starts: where an earlier solution ended, with multipliers and as much room as the change of
//! the problem asks for.

use crate::nlp::{Solution, Start, Warm, constraint_violation, estimate};
use crate::problem::Problem;
use crate::starts::{Earlier, resample};
use crate::transcribe::TranscribedNlp;

/// The earlier solution as a warm start on the grid of the problem. Its multipliers are estimated,
/// with the widths of its layers where the problem names none.
pub fn from_earlier(problem: &Problem, earlier: &Earlier) -> Start {
    let v = resample(problem, earlier);
    let widths: Vec<f64> =
        earlier.widths.iter().copied().collect::<Option<_>>().unwrap_or_default();
    let warm = first_width(problem, &widths).and_then(|(mut nlp, widths)| {
        let multipliers = estimate::multipliers(&mut nlp, &v)?;
        Some(Warm { multipliers, mu: room(&mut nlp, &v), widths })
    });
    Start { v, warm }
}

/// A solution on the same grid, found with these widths, of a problem with other parameters or
/// another width.
pub fn again(problem: &Problem, solution: &Solution, widths: &[f64]) -> Start {
    let mut start = Start::near(solution);
    if let (Some(warm), Some((mut nlp, widths))) = (&mut start.warm, first_width(problem, widths)) {
        (warm.mu, warm.widths) = (room(&mut nlp, &start.v), widths);
    }
    start
}

/// The programme with the width that is solved first, and with it the earlier widths where these
/// are taken, because the problem names none; `None` if there are none either.
fn first_width<'p>(
    problem: &'p Problem,
    earlier: &[f64],
) -> Option<(TranscribedNlp<'p>, Vec<f64>)> {
    let named = problem.method.continuation.first().copied().or(problem.method.sigma);
    let taken = if named.is_none() { earlier } else { &[] };
    if named.is_none() && taken.len() != problem.surfaces.len() {
        return None;
    }
    let mut nlp = TranscribedNlp::new(problem);
    for (i, surface) in problem.surfaces.iter().enumerate() {
        nlp.set_parameter(surface.sigma, named.unwrap_or_else(|| taken[i]));
    }
    Some((nlp, taken.to_vec()))
}

/// The barrier parameter for a start that violates rows by `r`. Distances from bounds and their
/// multipliers will change in proportion to `r`, and their products by its square.
fn room(nlp: &mut TranscribedNlp, v: &[f64]) -> f64 {
    const LEAST: f64 = 1e-6;
    const FACTOR: f64 = 10.0;
    let violation = constraint_violation(nlp, v);
    (FACTOR * violation * violation).clamp(LEAST, Warm::ROOM)
}
