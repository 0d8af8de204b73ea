//! Controls that are not constant on an interval, as many short pieces that are: what a simulation
//! can follow.
//!
//! A piece has the value of its middle, so that what the pieces miss falls with the square of their
//! length.

use crate::record::{NodesRecord, Record, find};
use fdcc_runtime::lagrange;

const PIECES_OF_INTERVAL: usize = 8;
/// Few intervals of a high order are long.
const FEWEST_PIECES: usize = 4000;

/// Pieces in each of so many intervals.
pub(crate) fn pieces_of_one(intervals: usize) -> usize {
    PIECES_OF_INTERVAL.max(FEWEST_PIECES / intervals.max(1))
}

/// When pieces begin, and a row of controls for each; an interval is between two of the times.
pub(crate) fn pieces(
    record: &Record,
    nodes: &NodesRecord,
    names: &[&str],
) -> Result<Pieces, String> {
    let (time, knots) = (record.time, nodes.time);
    let intervals = time.len().saturating_sub(1);
    if knots.iter().any(|knot| !knot.is_finite()) {
        return Err("the time of a control is no number".into());
    }
    let columns: Result<Vec<&[f64]>, String> =
        names.iter().map(|name| column(nodes, name)).collect();
    let columns = columns?;
    let stencil = stencil(knots.len(), intervals).ok_or_else(|| {
        format!(
            "its controls have {} times for {intervals} intervals of {}",
            knots.len(),
            record.model
        )
    })?;
    let count = pieces_of_one(intervals);
    let mut pieces = Pieces::default();
    for (k, ends) in time.windows(2).enumerate() {
        let range = stencil(k);
        for piece in 0..count {
            let at = |part: f64| ends[0] + (ends[1] - ends[0]) * part / count as f64;
            let weights = lagrange::values(&knots[range.clone()], at(piece as f64 + 0.5));
            let value = |column: &&[f64]| {
                weights.iter().zip(&column[range.clone()]).map(|(w, u)| w * u).sum()
            };
            pieces.times.push(at(piece as f64));
            pieces.rows.push(columns.iter().map(value).collect());
        }
    }
    Ok(pieces)
}

/// See [`pieces`].
#[derive(Default)]
pub(crate) struct Pieces {
    pub times: Vec<f64>,
    pub rows: Vec<Vec<f64>>,
}

fn column<'s>(nodes: &NodesRecord<'s>, name: &str) -> Result<&'s [f64], String> {
    let column = find(&nodes.values, name).ok_or(format!("there is no control `{name}`"))?;
    if column.iter().any(|value| !value.is_finite()) {
        return Err(format!("a value of `{name}` is no number"));
    }
    match (column.len(), nodes.time.len()) {
        (own, times) if own == times => Ok(column),
        (own, times) => Err(format!("`{name}` has {own} values for {times} times")),
    }
}

/// Which values an interval sees: of linear controls those at its ends, of polynomials its own.
fn stencil(knots: usize, intervals: usize) -> Option<impl Fn(usize) -> std::ops::Range<usize>> {
    let is_linear = knots == intervals + 1;
    let own = if is_linear { 1 } else { knots.checked_div(intervals)? };
    let fits = is_linear || own > 0 && own * intervals == knots;
    fits.then_some(move |k: usize| k * own..(k + 1) * own + usize::from(is_linear))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_interval_sees_its_ends_or_its_own_nodes() {
        let range = |knots, intervals, k| stencil(knots, intervals).map(|of| of(k));
        assert_eq!(range(5, 4, 3), Some(3..5));
        assert_eq!(range(12, 4, 1), Some(3..6));
        assert_eq!(range(7, 4, 0), None);
        assert_eq!(range(0, 0, 0), None);
    }
}
