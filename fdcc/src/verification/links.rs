//! Links between the replays of phases.

use super::Verification;
use super::motion::Motion;
use crate::record::{Record, find};
use fdcc_runtime::problem::{Chain, Columns, End, Link, Problem, Variable};

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

/// What the links read of a phase: it begins as it does in the solution, and ends where its replay
/// does.
pub(crate) struct Ends {
    /// States, then controls, at the first and the last time.
    signals: [Vec<f64>; 2],
    /// The largest size of each in the solution.
    sizes: Vec<f64>,
}

impl Ends {
    pub(super) fn new(problem: &Problem, record: &Record, replay: &Verification) -> Self {
        let columns = |of: &[Variable], own: &[(&str, &[f64])]| -> Vec<Vec<f64>> {
            // Integrals are no signals of a solution; they begin at 0.
            of.iter().map(|it| find(own, &it.name).map_or(vec![0.0], <[f64]>::to_vec)).collect()
        };
        let states = columns(&problem.states, &record.states);
        let controls = columns(&problem.controls, &record.controls);
        let own = |at: fn(&[f64]) -> Option<&f64>| -> Vec<f64> {
            let all = states.iter().chain(&controls);
            all.map(|it| at(it).copied().unwrap_or(f64::NAN)).collect()
        };
        let mut last = own(<[f64]>::last);
        for (state, it) in last.iter_mut().zip(&problem.states) {
            let at = replay.system.states.iter().position(|own| own.name == it.name);
            *state = at.and_then(|at| replay.simulation.end.get(at).copied()).unwrap_or(*state);
        }
        // What stays at 0 but for rounding has the size of that.
        let size = |(column, of): (&Vec<f64>, &Variable)| {
            let least = Motion::still(of.unit).rounding;
            column.iter().fold(least, |size: f64, it| size.max(it.abs()))
        };
        let columns = states.iter().chain(&controls);
        let sizes = columns.zip(problem.states.iter().chain(&problem.controls)).map(size).collect();
        Ends { signals: [own(<[f64]>::first), last], sizes }
    }

    fn at(phases: &[Ends], end: End) -> &[f64] {
        let own = &phases[end.phase()];
        &own.signals[usize::from(matches!(end, End::Last(_)))]
    }
}

/// One for each condition of each link.
pub(super) fn gaps_of_links(chain: &Chain, parameters: &[f64], phases: &[Ends]) -> Vec<LinkGap> {
    let of = |link: &Link| {
        let ends = || link.ends.iter().copied();
        let inputs: Vec<f64> = ends().flat_map(|end| Ends::at(phases, end)).copied().collect();
        let sizes = ends().flat_map(|end| &phases[end.phase()].sizes).copied();
        gaps(link, (&inputs, &sizes.collect::<Vec<_>>()), parameters)
    };
    chain.links.iter().flat_map(of).collect()
}

/// What all links add to the objective of the minimisation problem.
pub(super) fn objectives(chain: &Chain, parameters: &[f64], phases: &[Ends]) -> f64 {
    let of = |link: &Link| {
        let inputs = link.ends.iter().flat_map(|end| Ends::at(phases, *end)).copied();
        let points = Columns::of_point(&inputs.collect::<Vec<f64>>());
        let mut values = Columns::new(link.function.outputs(), 1);
        let parameters = &parameters[..link.function.layout().p];
        link.function.value(&points, parameters, &mut values);
        values.column(0)[0]
    };
    chain.links.iter().map(of).sum()
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
