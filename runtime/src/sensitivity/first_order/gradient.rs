//! The entry: a simulation, its gradient in both ways, and what they say of each other.

use super::Objective;
use super::one_sided;
use super::quantity::{Directions, Gradient, Quantity};
use crate::sensitivity::linearised::linearisation::Lineariser;
use crate::sensitivity::linearised::variational_equation::LinearTape;
use crate::sensitivity::nondifferentiability::kink::{Kink, first_kink};
use crate::sensitivity::nondifferentiability::objective_kink::{Direction, objective_kink};
use crate::sensitivity::nondifferentiability::parameter_kink::parameter_kink;
use crate::sensitivity::nondifferentiability::pile::moved_by_pile;
use crate::sensitivity::nondifferentiability::reset_kink::{Moved, reset_kink};
use crate::sensitivity::nondifferentiability::surface_kink::{kink_at_the_end, surface_kink};
use crate::sensitivity::nondifferentiability::{Nondifferentiability, nondifferentiabilities};
use crate::simulate::{Controls, Options, Piece, Simulation, Status, System, Tape, simulate};
use nalgebra::DMatrix;

/// With more quantities than this, forward sensitivities are computed along one sum of them only.
const MOST_FORWARD: usize = 64;

/// What decays to this part of the sizes it could have is as good as 0, and so is its rounding.
const FORGOTTEN: f64 = 1e-12;

/// The gradient of the objective of a system.
#[derive(Clone, Debug)]
pub struct Sensitivity {
    /// The simulation, with its tape.
    pub simulation: Simulation,
    /// The objective.
    pub value: f64,
    /// By each quantity, from forward sensitivities; empty if there are more than 64.
    pub forward: Vec<f64>,
    /// By each quantity, from the adjoint.
    pub adjoint: Vec<f64>,
    /// The largest difference between the two, relative to the largest sum of the sizes that a
    /// derivative is made of, at the end or on the way, `sum |lambda_i| |dx_i|`. Where `forward` is
    /// empty, along a sum of the quantities with mixed signs.
    pub agreement: f64,
    /// The largest difference to the derivatives along steps of twice the length, each relative to
    /// what that derivative is made of.
    pub resolution: f64,
    /// The same where the rest of what has decayed counts as all others do.
    pub resolution_of_rests: f64,
    /// Of each quantity the sum of the sizes that its derivative is made of at the end, and the
    /// largest on the way, with what counts as 0 there; of one sum where `forward` is empty.
    pub(crate) sizes: Vec<[f64; 2]>,
    /// The derivative of each state at the end by each quantity; empty like `forward`.
    pub end: Vec<Vec<f64>>,
    /// The adjoint of the objective.
    pub costates: Costates,
    /// Where the trajectory may have no derivative.
    pub nondifferentiabilities: Vec<Nondifferentiability>,
    /// A kink that the trajectory stays on: then the derivatives are those of one side of it.
    pub kink: Option<Kink>,
}

/// `dJ/dx(t)`, in the canonical gauge on sliding arcs (`lambda . df/ds = 0`); two entries at one
/// time where it jumps.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Costates {
    /// Ascending.
    pub time: Vec<f64>,
    /// One column for each state, integrals last.
    pub columns: Vec<Vec<f64>>,
}

impl Costates {
    fn largest(&self) -> f64 {
        self.columns.iter().flatten().fold(0.0, |largest, value| largest.max(value.abs()))
    }

    /// `sum_i |lambda_i| |dx_i|` for each of some directions `dx`.
    fn pairing(&self, at: usize, dx: &DMatrix<f64>) -> impl Iterator<Item = f64> {
        dx.column_iter().map(move |column| {
            self.columns.iter().zip(column.iter()).map(|(lambda, dx)| (lambda[at] * dx).abs()).sum()
        })
    }
}

/// Differentiates along the steps that the state needs; nothing but the simulation where it does
/// not reach the end or there is no objective.
pub(super) fn along_own_steps(
    system: &System,
    controls: &Controls,
    options: &Options,
    quantities: &[Quantity],
) -> Result<Sensitivity, Box<Simulation>> {
    let simulation = simulate(system, controls, &Options { tape: true, ..options.clone() });
    let lineariser = Lineariser::new(system, controls);
    let objective = Objective::new(&lineariser, &simulation);
    let (Some(tape), Some(objective), Status::Completed) =
        (&simulation.tape, objective, &simulation.status)
    else {
        return Err(Box::new(simulation));
    };
    let pieces = LinearTape::new(&lineariser, tape);
    let (whole, costates) = backward(&pieces, &objective, Gradient::zero(system, controls));
    let adjoint: Vec<f64> = quantities.iter().map(|quantity| whole.by(quantity)).collect();
    let is_each = quantities.len() <= MOST_FORWARD;
    let weights = if is_each {
        DMatrix::identity(adjoint.len(), adjoint.len())
    } else {
        signs(adjoint.len())
    };
    let directions = Directions::new(system, controls, quantities, &weights);
    let mut on_the_way = vec![0.0_f64; weights.ncols()];
    let mut largest = on_the_way.clone();
    let mut before_events = Vec::new();
    let end = super::forward(&pieces, &directions, &mut |at, s| {
        before_events.extend(moved_before(tape, at + 1, s));
        widen(&mut on_the_way, costates.pairing(at + 1, s));
        widen(&mut largest, s.column_iter().map(|it| it.amax()));
    });
    let forgotten = FORGOTTEN * costates.largest();
    let last = costates.time.len() - 1;
    let at_end: Vec<f64> = costates.pairing(last, &end).collect();
    widen(&mut on_the_way, largest.into_iter().map(|it| forgotten * it));
    let sizes: Vec<[f64; 2]> = at_end.into_iter().zip(on_the_way).map(Into::into).collect();
    let all = sizes.iter().flatten().copied().fold(0.0, f64::max);
    let forward = super::along(&lineariser, &objective, &directions, &end);
    let along = weights.tr_mul(&DMatrix::from_column_slice(adjoint.len(), 1, &adjoint));
    let size = super::size(&lineariser, &objective, &directions, &end).max(all);
    let kink = kink_of_objective(&pieces, &objective, &simulation, (quantities, &directions, &end));
    Ok(Sensitivity {
        value: objective.value,
        agreement: agreement(&forward, along.as_slice(), size),
        resolution: f64::INFINITY,
        resolution_of_rests: f64::INFINITY,
        sizes,
        end: if is_each { rows(&end) } else { Vec::new() },
        forward: if is_each { forward } else { Vec::new() },
        adjoint,
        costates,
        nondifferentiabilities: nondifferentiabilities(&pieces),
        kink: kink_met(&lineariser, tape, &parameters(quantities), &before_events)
            .or_else(|| kink_at_the_end(&lineariser, tape, &parameters(quantities), &moved(&end)))
            .or(kink),
        simulation,
    })
}

/// A kink of the objective at the end.
fn kink_of_objective(
    pieces: &LinearTape,
    objective: &Objective,
    simulation: &Simulation,
    (quantities, directions, end): (&[Quantity], &Directions, &DMatrix<f64>),
) -> Option<Kink> {
    let (lineariser, system) = (pieces.lineariser, pieces.lineariser.system);
    let starts = super::start(lineariser, directions);
    let along_each = quantities.iter().take(end.ncols()).enumerate().map(|(at, quantity)| {
        let parts = [starts.column(at), end.column(at), directions.parameters.column(at)];
        let by = parts.iter().flat_map(|part| part.iter().copied()).collect::<Vec<f64>>().into();
        Direction { value: one_sided::value(system, lineariser.controls, quantity), by }
    });
    let ends: Vec<f64> = system.start.iter().chain(&simulation.end).copied().collect();
    let slopes = [&objective.by_start, &objective.by_end, &objective.by_parameters];
    let slopes: Vec<f64> = slopes.into_iter().flat_map(|row| row.iter().copied()).collect();
    objective_kink(lineariser, &slopes, &ends.into(), along_each)
}

/// Each is as large as another at least.
fn widen(sizes: &mut [f64], others: impl Iterator<Item = f64>) {
    sizes.iter_mut().zip(others).for_each(|(size, other)| *size = size.max(other));
}

/// The first kink of anything but the objective.
fn kink_met(
    lineariser: &Lineariser,
    tape: &Tape,
    parameters: &[usize],
    events: &[Moved],
) -> Option<Kink> {
    parameter_kink(lineariser, tape, parameters)
        .or_else(|| first_kink(lineariser, tape))
        .or_else(|| moved_by_pile(lineariser, tape))
        .or_else(|| reset_kink(lineariser, tape, parameters, events))
        .or_else(|| surface_kink(lineariser, tape, parameters, events))
}

/// The states that quantities move before a piece, if it is an event.
fn moved_before(tape: &Tape, event: usize, s: &DMatrix<f64>) -> Option<Moved> {
    let piece = tape.pieces.get(event)?;
    matches!(piece, Piece::Event { .. }).then(|| Moved { event, states: moved(s) })
}

/// The states that quantities move.
fn moved(s: &DMatrix<f64>) -> Vec<usize> {
    (0..s.nrows()).filter(|row| s.row(*row).amax() > 0.0).collect()
}

/// Those that are parameters.
fn parameters(quantities: &[Quantity]) -> Vec<usize> {
    let parameter = |it: &Quantity| match *it {
        Quantity::Parameter(at) => Some(at),
        Quantity::Start(_) | Quantity::Control { .. } => None,
    };
    quantities.iter().filter_map(parameter).collect()
}

fn backward(pieces: &LinearTape, objective: &Objective, zero: Gradient) -> (Gradient, Costates) {
    let LinearTape { lineariser, tape, .. } = *pieces;
    let mut seen: Vec<(f64, Vec<f64>)> = Vec::new();
    let first = lineariser.system.interval[0];
    let gradient = super::adjoint(pieces, objective, zero, &mut |at, lambda| {
        let time = at.map_or(first, |at| tape.pieces[at].end_time());
        seen.push((time, lambda.iter().copied().collect()));
    });
    seen.reverse();
    let column = |state: usize| seen.iter().map(|entry| entry.1[state]).collect();
    let columns = (0..lineariser.system.layout.x).map(column).collect();
    (gradient, Costates { time: seen.iter().map(|entry| entry.0).collect(), columns })
}

/// A sum with signs from a fixed sequence of bits (the golden ratio's multiples).
fn signs(count: usize) -> DMatrix<f64> {
    DMatrix::from_fn(count, 1, |row, _| {
        let turn = (row + 1) as f64 * 0.618_033_988_749_894_9;
        if turn.fract() < 0.5 { -1.0 } else { 1.0 }
    })
}

fn rows(matrix: &DMatrix<f64>) -> Vec<Vec<f64>> {
    matrix.row_iter().map(|row| row.iter().copied().collect()).collect()
}

fn agreement(forward: &[f64], adjoint: &[f64], size: f64) -> f64 {
    let differences = forward.iter().zip(adjoint).map(|(a, b)| (a - b).abs());
    let largest = differences
        .fold(0.0, |sum: f64, value| if value.is_nan() { f64::NAN } else { sum.max(value) });
    if size > 0.0 { largest / size } else { largest }
}
