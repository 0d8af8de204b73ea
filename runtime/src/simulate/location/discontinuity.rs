//! Whether a switching function is 0 where it changes its sign, or jumps there: `atan2` at its
//! branch cut, `tan` at a pole.
//!
//! A function that is continuous falls with the distance to its root, down to rounding. Filippov's
//! theory knows no surface where it does not: such a point has no normal.

use super::search::Signal;
use crate::simulate::tuning::discontinuity::{CLEAR, DISTANCE, FALLS, FARTHER};

/// Whether the values beside a change of sign do not fall towards it.
pub(super) fn jumps(signal: &mut Signal, theta: f64) -> bool {
    let distance = DISTANCE * signal.shortest();
    // A mode that begins on its surface begins at a root.
    if theta <= FARTHER * distance {
        return false;
    }
    [-distance, distance].into_iter().any(|beside| {
        let near = signal.value(theta + beside).abs();
        let far = signal.value(theta + FARTHER * beside).abs();
        // At the jump itself all is rounding.
        let noise = CLEAR * signal.noise(theta + FARTHER * beside);
        near > noise && near > FALLS * far
    })
}
