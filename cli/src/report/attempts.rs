//! What was tried where nothing feasible was found: that is news of these solves, and no verdict on
//! the problem.

use crate::output::number::short;
use crate::output::plural;
use fdcc::{Sequence, Solution};
use fdcc_runtime::solve::Attempt;

/// So many of the sequences of jumps are named.
const SEQUENCES: usize = 6;

/// That no feasible trajectory was found, with what was tried.
pub fn words(solution: &Solution) -> String {
    format!("{}: {}", finding(solution), tried(solution))
}

/// What may be found otherwise.
pub fn advice(solution: &Solution) -> String {
    let more = 2 * solution.starts.len().max(4);
    format!("`--starts {more}` or another `guess` may find one; that there is none is not proved")
}

fn finding(solution: &Solution) -> String {
    match (solution.sequences.as_slice(), solution.starts.len()) {
        ([], 0 | 1) => "found none from this guess".into(),
        ([], many) => {
            format!("found none from this guess and {} of it", plural(many - 1, "variation"))
        }
        (sequences, _) => {
            let named = named(sequences);
            format!(
                "none of the sequences tried ({named}) has a feasible trajectory near the guess"
            )
        }
    }
}

/// `no jump; bounce; bounce, bounce`.
fn named(sequences: &[Sequence]) -> String {
    let names = sequences.iter().map(|it| it.words.clone());
    let others = sequences.len().saturating_sub(SEQUENCES);
    let others = (others > 0).then(|| format!("{others} more"));
    names.take(SEQUENCES).chain(others).collect::<Vec<_>>().join("; ")
}

/// `12 solves with N = 50, 100, sigma 1 to 0.01, from 8 starts`.
fn tried(solution: &Solution) -> String {
    let attempts = &solution.outcome.attempts;
    let mut grids: Vec<usize> = attempts.iter().map(|it| it.intervals).collect();
    grids.sort_unstable();
    grids.dedup();
    let grids: Vec<String> = grids.iter().map(usize::to_string).collect();
    let solves = plural(attempts.len(), "solve");
    let starts = match solution.starts.len() {
        0 | 1 => String::new(),
        many => format!(", from {}", plural(many, "start")),
    };
    format!("{solves} with N = {}{}{starts}", grids.join(", "), widths(attempts))
}

/// The widest and the thinnest layer of the first surface.
fn widths(attempts: &[Attempt]) -> String {
    let widths = attempts.iter().filter_map(|it| it.sigma.first());
    let (thin, wide) = widths.fold((f64::INFINITY, 0.0_f64), |(a, b), it| (a.min(*it), b.max(*it)));
    match (thin, wide) {
        (f64::INFINITY, _) => String::new(),
        (thin, wide) if thin == wide => format!(", sigma {}", short(wide)),
        (thin, wide) => format!(", sigma {} to {}", short(wide), short(thin)),
    }
}
