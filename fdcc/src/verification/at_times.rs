//! Conditions at times between the ends, along a replay.

use super::conditions::{Condition, Conditions};
use super::points::Points;
use crate::error::Error;
use crate::record::Record;
use fdcc_compiler::{Model, compile, ends_at};
use fdcc_runtime::simulate::{Simulation, System};

/// Each condition at the point that is nearest to its time. The model has the parameters and
/// unknowns of the record.
pub(super) fn conditions(
    model: &Model,
    record: &Record,
    system: &System,
    simulation: &Simulation,
    points: &Points,
) -> Result<Vec<Condition>, Error> {
    let mut all = Vec::new();
    for (time, ending) in ends_at(model).map_err(Error::Model)? {
        let problem = compile(&ending).map_err(Error::Model)?;
        let distance = |k: &usize| (points.times[*k] - time).abs();
        let nearest = (0..points.times.len()).min_by(|a, b| distance(a).total_cmp(&distance(b)));
        let own = Conditions::new(&problem, record, system, simulation, points);
        if let (Some(own), Some(point)) = (own, nearest) {
            all.extend(own.ending_at(point, true));
        }
    }
    Ok(all)
}
