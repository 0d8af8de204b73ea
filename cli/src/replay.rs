//! What the controls of a solution do on the true system, simulated from event to event.

use crate::output::document::{Document, Verification, Worst};
use crate::solver::Solved;
use fdcc_compiler::Model;
use fdcc_runtime::problem::{Columns, Function, Problem};
use fdcc_runtime::simulate::{Controls, Options, Simulation, Status, System, simulate};

/// A replay that needs more steps, of a very stiff system, is given up: nobody waits for it.
const FEWEST_STEPS: usize = 200_000;
const STEPS_PER_INTERVAL: usize = 50;

/// Replays a solution; nothing if its model cannot be simulated.
pub fn replay(model: &Model, solved: &Solved) -> Option<Verification> {
    let system = fdcc_compiler::compile_simulation(&adapted(model, &solved.document)).ok()?;
    let document = &solved.document;
    let times = grid(&document.time, system.interval);
    let intervals = times.len() - 1;
    let row = |k: usize| document.controls.0.iter().map(|(_, column)| column[k]).collect();
    let controls =
        Controls::Held { times: times[..intervals].to_vec(), rows: (0..intervals).map(row).collect() };
    let max_steps = FEWEST_STEPS.max(STEPS_PER_INTERVAL * intervals);
    let simulation = simulate(&system, &controls, &Options { times, max_steps, ..Options::default() });
    let is_whole = matches!(simulation.status, Status::Completed)
        && simulation.states.iter().all(|column| column.len() == intervals + 1);
    let worst = if is_whole { worst(&solved.problem, solved, &system, &simulation) } else { None };
    Some(Verification {
        completed: is_whole,
        objective: simulation.objective,
        state_gap: is_whole.then(|| state_gap(document, &simulation)),
        constraint_violation: is_whole.then(|| worst.as_ref().map_or(0.0, |worst| worst.violation)),
        worst,
        events: simulation.events.len(),
    })
}

/// The model with the unknowns of the solution, and the starts that it left open.
fn adapted(model: &Model, document: &Document) -> Model {
    let mut model = model.clone();
    document.free.0.iter().for_each(|(name, value)| model.set_free(name, *value));
    document.states.0.iter().for_each(|(name, column)| model.set_open_start(name, column[0]));
    model
}

/// The grid of the solution, without rounding at its ends.
fn grid(time: &[f64], [first, last]: [f64; 2]) -> Vec<f64> {
    let mut times = time.to_vec();
    let end = times.len() - 1;
    (times[0], times[end]) = (first, last);
    times
}

/// The largest difference over states and grid points, in units of max(1, |x|).
fn state_gap(document: &Document, simulation: &Simulation) -> f64 {
    let columns = document.states.0.iter().zip(&simulation.states);
    let pairs = columns.flat_map(|((_, own), replayed)| own.iter().zip(replayed));
    pairs.fold(0.0, |gap, (own, replayed)| gap.max((own - replayed).abs() / own.abs().max(1.0)))
}

/// The condition that the replay violates most; bounds of states, path and end conditions.
fn worst(problem: &Problem, solved: &Solved, system: &System, simulation: &Simulation) -> Option<Worst> {
    let time = &simulation.time;
    let states = states(problem, system, simulation)?;
    let parameters = &solved.outcome.trajectory.parameters;
    let mut found: Option<Worst> = None;
    let mut note = |label: &str, at: Option<f64>, violation: f64| {
        if violation > found.as_ref().map_or(0.0, |worst| worst.violation) {
            found = Some(Worst { condition: label.to_owned(), time: at, violation });
        }
    };
    for (variable, column) in problem.states.iter().zip(&states) {
        for (k, value) in column.iter().enumerate().skip(1) {
            note(&variable.name, Some(time[k]), variable.bounds.violation(*value));
        }
    }
    let path = on_grid(problem, &states, &solved.outcome.trajectory.controls, parameters);
    for (row, bounds) in problem.path_bounds.iter().enumerate() {
        for (k, value) in path.column(row).iter().enumerate() {
            note(&problem.path.origin(row).label, Some(time[k + 1]), bounds.violation(*value));
        }
    }
    let ends = at_ends(problem, &states, parameters);
    for (row, bounds) in problem.boundary_bounds.iter().enumerate() {
        note(&problem.boundary.origin(row + 1).label, None, bounds.violation(ends.column(row + 1)[0]));
    }
    found
}

/// The replayed states in the order of the problem; its integrals are found by name.
fn states(problem: &Problem, system: &System, simulation: &Simulation) -> Option<Vec<Vec<f64>>> {
    let column = |name: &str| system.states.iter().position(|state| state.name == name);
    let columns = problem.states.iter().map(|state| Some(simulation.states[column(&state.name)?].clone()));
    columns.collect()
}

/// The path conditions at every grid point after the start, with the control of the interval that ends there.
fn on_grid(problem: &Problem, states: &[Vec<f64>], controls: &[Vec<f64>], parameters: &[f64]) -> Columns {
    let intervals = problem.method.intervals;
    let mut points = Columns::new(problem.path.layout().point_inputs(), intervals);
    for (k, tau) in points.column_mut(0).iter_mut().enumerate() {
        *tau = (k + 1) as f64 / intervals as f64;
    }
    for (at, column) in
        states.iter().map(|column| &column[1..]).chain(controls.iter().map(Vec::as_slice)).enumerate()
    {
        points.column_mut(at + 1).copy_from_slice(column);
    }
    evaluated(&*problem.path, &points, parameters)
}

fn at_ends(problem: &Problem, states: &[Vec<f64>], parameters: &[f64]) -> Columns {
    let mut points = Columns::new(problem.boundary.layout().point_inputs(), 1);
    for (at, column) in states.iter().enumerate() {
        points.column_mut(at)[0] = column[0];
        points.column_mut(states.len() + at)[0] = column[column.len() - 1];
    }
    evaluated(&*problem.boundary, &points, parameters)
}

fn evaluated(function: &dyn Function, points: &Columns, parameters: &[f64]) -> Columns {
    let mut values = Columns::new(function.outputs(), points.count());
    function.value(points, parameters, &mut values);
    values
}
