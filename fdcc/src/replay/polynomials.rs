//! Controls that are polynomials on each interval of a solution, through its nodes.

use super::tuning::ROUNDING;
use crate::record::{NodesRecord, Record, find};
use fdcc_runtime::simulate::{Controls, Polynomials};
use std::ops::Range;

/// A segment for each interval; an interval is between two of the times.
pub(crate) fn polynomials(
    record: &Record,
    nodes: &NodesRecord,
    names: &[&str],
) -> Result<Controls, String> {
    let intervals = record.time.len().saturating_sub(1);
    let knots = nodes.time;
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
    let ranges: Vec<Range<usize>> = (0..intervals).map(stencil).collect();
    let ascends = |range: &Range<usize>| knots[range.clone()].is_sorted_by(|a, b| a < b);
    if let Some(at) = ranges.iter().position(|range| !ascends(range)) {
        return Err(format!("the times of its controls do not ascend in interval {}", at + 1));
    }
    let is_inside = |(at, range): (usize, &Range<usize>)| {
        let [begin, end] = [record.time[at], record.time[at + 1]];
        let slack = ROUNDING * (end - begin);
        knots[range.clone()].iter().all(|knot| begin - slack <= *knot && *knot <= end + slack)
    };
    if let Some(at) = ranges.iter().enumerate().position(|it| !is_inside(it)) {
        return Err(format!("the times of its controls are not all in interval {}", at + 1));
    }
    let row = |at: usize| columns.iter().map(|column| column[at]).collect();
    Ok(Controls::Polynomial(Polynomials {
        times: record.time.to_vec(),
        ranges,
        nodes: knots.to_vec(),
        rows: (0..knots.len()).map(row).collect(),
        is_stretched: true,
    }))
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
fn stencil(knots: usize, intervals: usize) -> Option<impl Fn(usize) -> Range<usize>> {
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

    #[test]
    fn nodes_outside_of_their_interval_are_refused() {
        let nodes = NodesRecord { time: &[0.0, 2.0, 3.0], values: vec![("u", &[0.0; 3])] };
        let record = Record { time: &[0.0, 1.0, 3.0], ..Record::default() };
        let refused = polynomials(&record, &nodes, &["u"]).expect_err("2 is after 1");
        assert_eq!(refused, "the times of its controls are not all in interval 1");
    }

    #[test]
    fn two_nodes_at_one_time_are_refused() {
        let nodes = NodesRecord { time: &[0.0, 1.0, 2.0, 2.0], values: vec![("u", &[0.0; 4])] };
        let record = Record { time: &[0.0, 1.5, 3.0], ..Record::default() };
        let refused = polynomials(&record, &nodes, &["u"]).expect_err("two values at one time");
        assert_eq!(refused, "the times of its controls do not ascend in interval 2");
    }
}
