//! The equations of the implicit part of a step and their derivatives by its end and its selectors.
//!
//! ```text
//! F_x = 1 - h b f_x w,    F_s = -h b f_s,    psi_x w
//! ```

use super::field::{Field, Point};
use crate::sensitivity::Jacobian;
use crate::transcribe::tableau::Node;
use nalgebra::DMatrix;

/// Derivatives at one point.
pub(super) struct Linearised {
    pub flow: Jacobian,
    pub switching: Jacobian,
    /// `h b`
    pub weight: f64,
    /// `F_x`
    pub by_end: DMatrix<f64>,
    /// `F_s`
    pub by_selectors: DMatrix<f64>,
    /// `psi_x w`
    pub normals: DMatrix<f64>,
}

impl Linearised {
    pub fn new(field: &Field, node: &Node, h: f64, point: &Point) -> Self {
        let (flow, switching) = (field.flow(point), field.switching(point));
        let (layout, weight) = (field.system.layout, h * node.weight);
        let blended = |by: &DMatrix<f64>| {
            DMatrix::from_fn(by.nrows(), layout.x, |i, j| {
                by[(i, layout.states().start + j)] * node.blend[j]
            })
        };
        let by_end = DMatrix::identity(layout.x, layout.x) - weight * blended(&flow.by);
        let by_selectors = -weight * flow.by.columns_range(field.system.surface_selectors());
        let normals = blended(&switching.by);
        Linearised { flow, switching, weight, by_end, by_selectors, normals }
    }

    /// The derivative of `F` and of the switching functions of some selectors by the end and these
    /// selectors.
    pub fn bordered(&self, free: &[usize]) -> DMatrix<f64> {
        let states = self.by_end.nrows();
        let mut matrix = DMatrix::zeros(states + free.len(), states + free.len());
        matrix.view_mut((0, 0), (states, states)).copy_from(&self.by_end);
        matrix
            .view_mut((0, states), (states, free.len()))
            .copy_from(&self.by_selectors.select_columns(free));
        matrix
            .view_mut((states, 0), (free.len(), states))
            .copy_from(&self.normals.select_rows(free));
        matrix
    }
}
