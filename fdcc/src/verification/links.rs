//! Links between the replays of phases.

use super::Verification;
use fdcc_runtime::problem::{Chain, Columns, End, Link};
use fdcc_runtime::solve::ChainOutcome;

/// How far a condition of a link is violated by the ends of the replays.
///
/// ```
/// let model = fdcc::Model::from_file("../models/twostage.fdc")?;
/// let solution = model.solve(&fdcc::Options::default())?;
/// let (replays, links) = solution.verify_phases()?;
/// assert_eq!((replays.len(), links.len()), (2, 3));
/// assert!(links.iter().all(|link| link.part < 1e-4));
/// # Ok::<(), fdcc::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct LinkGap {
    /// The condition.
    pub label: String,
    /// In SI.
    pub violation: f64,
    /// As a part of the size that its terms have over the phases.
    pub part: f64,
}

/// One for each condition of each link. A phase begins as it does in the solution, and ends where
/// its replay does.
pub(crate) fn gaps_of_links(
    chain: &Chain,
    outcome: &ChainOutcome,
    replays: &[Verification],
) -> Vec<LinkGap> {
    let of = |link: &Link| {
        let ends = || link.ends.iter();
        let inputs: Vec<f64> = ends().flat_map(|end| signals(outcome, replays, *end)).collect();
        let sizes: Vec<f64> = ends().flat_map(|end| sizes(outcome, *end)).collect();
        gaps(link, (&inputs, &sizes), &outcome.phases[0].trajectory.parameters)
    };
    chain.links.iter().flat_map(of).collect()
}

/// States, then controls, at an end of a phase.
fn signals(outcome: &ChainOutcome, replays: &[Verification], end: End) -> Vec<f64> {
    let trajectory = &outcome.phases[end.phase()].trajectory;
    let own = |columns: &[Vec<f64>]| -> Vec<f64> {
        let value = |column: &Vec<f64>| match end {
            End::First(_) => column.first().copied(),
            End::Last(_) => column.last().copied(),
        };
        columns.iter().map(|column| value(column).unwrap_or(f64::NAN)).collect()
    };
    let mut states = own(&trajectory.states);
    if let End::Last(phase) = end {
        let replayed = &replays[phase].simulation.end;
        states.iter_mut().zip(replayed).for_each(|(state, replayed)| *state = *replayed);
    }
    [states, own(&trajectory.controls)].concat()
}

/// The largest size of each state and control of a phase.
fn sizes(outcome: &ChainOutcome, end: End) -> impl Iterator<Item = f64> {
    let trajectory = &outcome.phases[end.phase()].trajectory;
    let size = |column: &Vec<f64>| column.iter().fold(0.0, |size: f64, it| size.max(it.abs()));
    trajectory.states.iter().chain(&trajectory.controls).map(size)
}

fn gaps(link: &Link, (inputs, sizes): (&[f64], &[f64]), parameters: &[f64]) -> Vec<LinkGap> {
    let (function, first) = (&link.function, link.function.layout().states().start);
    let points = Columns::of_point(inputs);
    let entries = &function.jacobian_pattern().entries;
    let mut values = Columns::new(function.outputs(), 1);
    let mut slopes = Columns::new(entries.len(), 1);
    let parameters = &parameters[..function.layout().p];
    function.jacobian(&points, parameters, &mut values, &mut slopes);
    let term = |column: usize, input: usize| {
        let place = input - first;
        let parameter = || parameters.get(place.checked_sub(inputs.len())?);
        let value = sizes.get(place).or_else(parameter);
        (slopes.column(column)[0] * value.copied().unwrap_or(0.0)).abs()
    };
    let gap = |(row, bounds): (usize, &fdcc_runtime::problem::Bounds)| {
        let violation = bounds.violation(values.column(row + 1)[0]);
        let own = entries.iter().enumerate().filter(|(_, entry)| entry.0 as usize == row + 1);
        let size: f64 = own.map(|(column, entry)| term(column, entry.1 as usize)).sum();
        let part = if violation == 0.0 { 0.0 } else { violation / size };
        LinkGap { label: function.origin(row + 1).label.to_string(), violation, part }
    };
    link.bounds.iter().enumerate().map(gap).collect()
}
