//! The projection that keeps derivatives on the sliding surfaces, the rule (3.5) with its explicit
//! parameters.
//!
//! ```text
//! S <- S - D (d D)^-1 (d S + psi_p P),     D = f_s,  d = psi_x
//! ```
//!
//! It is oblique, along the directions in which selectors push. Its transpose puts an adjoint into
//! the canonical gauge, `D^T lambda = 0`, the limit of the smoothed adjoints (errata A7):
//! continuous at entries, with a jump at exits.

use super::linearisation::{Jacobian, Lineariser, sliding};
use crate::simulate::{Instant, Regime};
use nalgebra::{DMatrix, DVector, DVectorView};

/// The projection at one state.
pub(crate) struct Projection {
    /// On which the state slides.
    pub surfaces: Vec<usize>,
    /// `D (d D)^-1`.
    along: DMatrix<f64>,
    /// `d`.
    normals: DMatrix<f64>,
    /// `psi_(U, p)`.
    by_inputs: DMatrix<f64>,
}

impl Projection {
    /// Nothing where the regime does not slide.
    pub fn new(lineariser: &Lineariser, regime: &Regime, at: &Instant) -> Option<Self> {
        let sliding = sliding(regime);
        if sliding.is_empty() {
            return None;
        }
        let layout = lineariser.system.layout;
        let x = DVector::from_column_slice(&at.state);
        let point = lineariser.at(regime, &at.selectors, at.time, &x);
        let table = lineariser.table(regime, &point.selectors, at.time, &x);
        let switching = Jacobian::of(&*lineariser.system.switching, &table, &lineariser.parameters);
        let by = lineariser.spread(switching.by.select_rows(&sliding), regime, at.time);
        let normals = by.columns(1, layout.x).into_owned();
        let by_inputs = by.columns(1 + layout.x, lineariser.inputs(regime)).into_owned();
        let directions = point.by_selectors().select_columns(&sliding);
        let inverse = (&normals * &directions).try_inverse()?;
        Some(Projection { surfaces: sliding, along: directions * inverse, normals, by_inputs })
    }

    pub fn forward(&self, s: &DMatrix<f64>, w: &DMatrix<f64>) -> DMatrix<f64> {
        s - &self.along * (&self.normals * s + &self.by_inputs * w)
    }

    /// Moves a second derivative back to the surface, given `psi_zz` of the sliding surfaces along
    /// its pair of directions.
    pub fn correct(&self, x: DVectorView<'_, f64>, curvature: &DVector<f64>) -> DVector<f64> {
        x - &self.along * (&self.normals * x + curvature)
    }

    /// The adjoint before the projection and the derivative by `(U, p)`.
    pub fn adjoint(&self, after: &DVector<f64>) -> (DVector<f64>, DVector<f64>) {
        let along = self.along.tr_mul(after);
        (after - self.normals.tr_mul(&along), -self.by_inputs.tr_mul(&along))
    }
}
