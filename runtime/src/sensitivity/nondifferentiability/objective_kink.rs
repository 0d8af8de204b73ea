//! An objective that has a kink where a trajectory ends: `max(x(end), 2)` at 2.
//!
//! Along a direction of the quantities the slopes from both sides differ, and do not come together
//! as the distance shrinks: `|J(z + e d) - 2 J(z) + J(z - e d)|` falls like `e` at a kink, like
//! `e^2` where there are two derivatives.

use super::kink::{Kink, KinkMet};
use crate::problem::Columns;
use crate::sensitivity::linearised::linearisation::Lineariser;
use nalgebra::DVector;

/// The distance, as a part of the quantity, and what it is divided by for comparison.
const DISTANCE: f64 = 1e-6;
const NEARER: f64 = 16.0;

/// What falls more slowly than to this part is a kink; without one it falls to 1/256.
const FALLS: f64 = 1.0 / 64.0;

/// What is less than this part of the terms is rounding.
const ROUNDING: f64 = 1e-13;

/// Constants, such as the 1 of `1 - cos(p)`, are no terms that are known here, and are rounded,
/// too. So what is less than this part of the terms is a kink only if it grows with the distance:
/// by these parts of so many times the distance.
const PLAIN: f64 = 1e-6;
const FARTHER: [f64; 2] = [2.0, 3.0];
const GROWS: std::ops::Range<f64> = 0.55..1.5;

/// How the ends of a trajectory move with a quantity.
pub(crate) struct Direction {
    /// The quantity.
    pub value: f64,
    /// `[x(start), x(end), p]` by it.
    pub by: DVector<f64>,
}

/// Whether the objective has a kink at `[x(start), x(end)]` along one of the directions; `slopes`
/// are those by the ends, then the parameters.
pub(crate) fn objective_kink(
    lineariser: &Lineariser,
    slopes: &[f64],
    ends: &DVector<f64>,
    mut directions: impl Iterator<Item = Direction>,
) -> Option<Kink> {
    let inputs = ends.iter().chain(&lineariser.parameters);
    let terms: f64 = slopes.iter().zip(inputs).map(|(by, value)| (by * value).abs()).sum();
    let is_kinked = directions.any(|direction| is_kinked(lineariser, ends, &direction, terms));
    let of = lineariser.system.objective.origin(0);
    is_kinked.then_some(Kink { of, met: KinkMet::AtEnd })
}

fn is_kinked(
    lineariser: &Lineariser,
    ends: &DVector<f64>,
    direction: &Direction,
    terms: f64,
) -> bool {
    has_kink(direction.value, terms, |moved| value(lineariser, ends, &(moved * &direction.by)))
}

/// How far a quantity of this value is moved.
pub(super) fn distance_from(quantity: f64) -> f64 {
    DISTANCE * if quantity == 0.0 { 1.0 } else { quantity.abs() }
}

/// Whether a function of how far a quantity is moved from its value has a kink there; `terms` is
/// the size of what it is a sum of.
pub(super) fn has_kink(quantity: f64, terms: f64, value: impl Fn(f64) -> f64) -> bool {
    let distance = distance_from(quantity);
    let own = value(0.0);
    let bend = |part: f64| {
        let [above, below] = [value(part * distance), value(-part * distance)];
        (above - own) - (own - below)
    };
    let (far, near, size) = (bend(1.0), bend(1.0 / NEARER), terms + own.abs());
    let grows = |by: f64| GROWS.contains(&(bend(by / NEARER) / (by * near)));
    let is_bent = near.abs() > ROUNDING * size && near.abs() > FALLS * far.abs();
    is_bent && (near.abs() > PLAIN * size || FARTHER.into_iter().all(grows))
}

/// The objective at the ends, moved.
fn value(lineariser: &Lineariser, ends: &DVector<f64>, by: &DVector<f64>) -> f64 {
    let objective = &lineariser.system.objective;
    let mut point = Columns::new(ends.len(), 1);
    for (at, end) in ends.iter().enumerate() {
        point.column_mut(at)[0] = end + by[at];
    }
    let moves = by.iter().skip(ends.len());
    let parameters: Vec<f64> =
        lineariser.parameters.iter().zip(moves).map(|(value, by)| value + by).collect();
    let mut values = Columns::new(objective.outputs(), 1);
    objective.value(&point, &parameters, &mut values);
    values.column(0)[0]
}
