//! The numbers of a model that its functions need: values and bounds.

use crate::generate::c::Given;
use crate::model::Model;
use fdcc_runtime::problem::{Bounds, Chain, Measurements, Problem, Variable};

/// Those of a phase.
pub(super) fn numbers(name: &str, model: &Model, chain: &Chain, problem: &Problem) -> Given {
    let first = model.params.len();
    let last = first + model.frees.len();
    let values: Vec<f64> = problem.parameters.iter().map(|it| it.value).collect();
    let unknowns = chain.unknowns.iter().map(|it| it.bounds);
    let bounds = |all: &[Variable]| all.iter().map(|it| it.bounds).collect();
    let mut results = vec![
        ("p".into(), [&values[..first], &values[last..]].concat()),
        ("q".into(), values[first..last].to_vec()),
        ("x0".into(), problem.start.iter().map(|it| it.unwrap_or(f64::NAN)).collect()),
    ];
    results.extend(both(["q_lower", "q_upper"], unknowns.collect()));
    results.extend(both(["x_lower", "x_upper"], bounds(&problem.states)));
    results.extend(both(["u_lower", "u_upper"], bounds(&problem.controls)));
    results.extend(both(["path_lower", "path_upper"], problem.path_bounds.clone()));
    results.extend(both(["boundary_lower", "boundary_upper"], problem.boundary_bounds.clone()));
    results.retain(|it| !it.1.is_empty());
    Given { name: format!("{name}_numbers"), results }
}

/// Those of a link.
pub(super) fn bounds(name: &str, bounds: &[Bounds]) -> Given {
    let mut results = both(["g_lower", "g_upper"], bounds.to_vec()).to_vec();
    results.retain(|it| !it.1.is_empty());
    Given { name: format!("{name}_numbers"), results }
}

/// Measured data: the time of each row, and each column.
pub(super) fn rows(name: &str, rows: &Measurements) -> Given {
    let columns = (0..rows.columns.columns())
        .map(|at| (format!("column{}", at + 1), rows.columns.column(at).to_vec()));
    let results = std::iter::once(("times".into(), rows.times.clone())).chain(columns).collect();
    Given { name: format!("{name}_numbers"), results }
}

fn both(names: [&str; 2], bounds: Vec<Bounds>) -> [(String, Vec<f64>); 2] {
    let of = |side: fn(&Bounds) -> f64| bounds.iter().map(side).collect();
    [(names[0].into(), of(|it| it.lower)), (names[1].into(), of(|it| it.upper))]
}
