//! The line search along the solution of a subproblem.

use super::curvature::Curvature;
use super::point::Point;
use crate::nlp::{Counts, Nlp};

/// What a line search works with.
pub(super) struct Search<'a> {
    pub(super) nlp: &'a mut dyn Nlp,
    pub(super) at: &'a Point,
    pub(super) d: &'a [f64],
    pub(super) curvature: &'a mut Curvature,
    pub(super) counts: &'a mut Counts,
}

/// An accepted trial point.
pub(super) struct Accepted {
    pub(super) point: Point,
    pub(super) alpha: f64,
    pub(super) trials: usize,
}

impl Search<'_> {
    /// Halves the step until it `is_good`. Where the whole step raises the violation, it is first
    /// corrected for the curvature of the rows. `None` where the step has become shorter than
    /// `smallest`.
    pub(super) fn run(
        mut self,
        smallest: f64,
        mut is_good: impl FnMut(&Point, f64) -> bool,
    ) -> Option<Accepted> {
        let (mut alpha, mut trials) = (1.0, 0);
        while alpha >= smallest || trials == 0 {
            trials += 1;
            let point = self.trial(&self.at.v, self.d, alpha);
            if point.is_finite() && is_good(&point, alpha) {
                return Some(Accepted { point, alpha, trials });
            }
            if trials == 1 && point.is_finite() && point.violation >= self.at.violation {
                let correction = self.curvature.correction(&residuals(&*self.nlp, &point));
                let point = self.trial(&point.v, &correction, 1.0);
                if point.is_finite() && is_good(&point, alpha) {
                    return Some(Accepted { point, alpha, trials: 2 });
                }
            }
            alpha *= 0.5;
        }
        None
    }

    fn trial(&mut self, v: &[f64], d: &[f64], alpha: f64) -> Point {
        Point::new(self.nlp, v.iter().zip(d).map(|(v, d)| v + alpha * d).collect(), self.counts)
    }
}

/// How far each row is outside, with its sign.
fn residuals(nlp: &dyn Nlp, point: &Point) -> Vec<f64> {
    let rows = nlp.row_bounds().iter().zip(&point.rows);
    rows.map(|(bounds, row)| row - row.max(bounds.lower).min(bounds.upper)).collect()
}
