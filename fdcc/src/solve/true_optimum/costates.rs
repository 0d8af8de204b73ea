//! Costates as gradients where surfaces are held.
//!
//! The multipliers of a chain of phases with `psi' = 0` on holds are costates up to a sum of the
//! normals `dpsi/dx` there. The sum that is taken off makes them the gradient of what is still to
//! come ([`HoldNormals`]), to which the costates of smoothed problems converge.

use super::Located;
use super::point::point_of;
use super::polynomials::polynomials;
use super::tuning::costates::SAME;
use fdcc_compiler::{HoldNormals, Mode, Model, NormalsAt, Point};
use fdcc_runtime::problem::Problem;
use fdcc_runtime::solution::Trajectory;
use nalgebra::{DMatrix, DVector};

/// One phase with what is held in it.
pub(super) struct Hold<'l> {
    located: &'l Located,
    problem: &'l Problem,
    phase: usize,
    /// Those that are held.
    pub surfaces: Vec<usize>,
    pub normals: HoldNormals<'l>,
    /// Of all surfaces; what is held stands for itself.
    sides: Vec<f64>,
    controls: usize,
    states: usize,
}

impl<'l> Hold<'l> {
    /// Nothing where nothing is held, or the weights of the running cost are not known. `model` is
    /// what holds between jumps, `problem` what is smoothed of that.
    pub fn new(
        located: &'l Located,
        (model, problem): (&'l Model, &'l Problem),
        phase: usize,
    ) -> Option<Self> {
        let modes = &located.structure.phases[phase].modes;
        let mut sides = vec![0.0; model.surfaces.len()];
        let mut surfaces = Vec::new();
        for (switch, mode) in model.switches().into_iter().zip(modes) {
            match mode {
                Mode::Held => surfaces.extend(switch.surfaces),
                Mode::Above => sides[switch.surfaces.start] = 1.0,
                Mode::Below => sides[switch.surfaces.start] = -1.0,
            }
        }
        let normals = if surfaces.is_empty() { None } else { HoldNormals::new(model, &surfaces) };
        let (controls, states) = (model.controls.len(), model.states.len());
        normals.map(|normals| Hold {
            located,
            problem,
            phase,
            surfaces,
            normals,
            sides,
            controls,
            states,
        })
    }

    /// Of the phase.
    pub fn trajectory(&self) -> &Trajectory {
        &self.located.outcome.phases[self.phase].trajectory
    }

    /// By how much of the normal of a surface the multipliers differ from the gradient at the first
    /// (0) or the last (1) time; 0 if it is not held.
    pub fn at_end(&self, surface: usize, end: usize) -> f64 {
        let found = self.surfaces.iter().position(|it| *it == surface);
        let point = end * (self.trajectory().time.len() - 1);
        found.map_or(0.0, |k| self.at(point).0[k])
    }

    /// By how much of each normal the multipliers differ from the gradient at a grid point; with
    /// the normals.
    pub fn at(&self, point: usize) -> (Vec<f64>, NormalsAt) {
        let own = self.trajectory();
        let input = |at: usize| match &polynomials(own, at)[..] {
            [] => own.controls[at][point.min(own.controls[at].len() - 1)],
            pieces => pieces[point.min(pieces.len() - 1)].at(own.time[point]),
        };
        let controls: Vec<f64> = (0..self.controls).map(input).collect();
        let mut selectors = self.sides.clone();
        for (k, surface) in self.surfaces.iter().enumerate() {
            selectors[*surface] = input(self.controls + k);
        }
        let place = self.point(point);
        let normals = self.normals.at(&place, &controls, &selectors);
        (coefficients(&normals, &place.costates), normals)
    }

    /// The trajectory at a grid point.
    pub fn point(&self, point: usize) -> Point {
        point_of(self.trajectory(), (self.problem, self.states), &|column| column[point])
    }
}

/// The `c` for which `dL/ds + (lambda - sum of c d) . df/ds = 0` for each selector.
fn coefficients(at: &NormalsAt, costates: &[f64]) -> Vec<f64> {
    let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    let count = at.costs.len();
    let matrix =
        DMatrix::from_fn(count, count, |row, column| dot(&at.directions[row], &at.normals[column]));
    let rest = |row: usize, _| at.costs[row] + dot(&at.directions[row], costates);
    let rest = DVector::from_fn(count, rest);
    let parts = matrix.svd(true, true);
    let least = SAME * parts.singular_values.max();
    let solved = parts.solve(&rest, least);
    solved.map_or_else(|_| vec![0.0; count], |it| it.iter().copied().collect())
}

impl Located {
    /// Makes the costates of all phases gradients; `model` is what holds between jumps, `problem`
    /// what is smoothed of that.
    pub fn with_gradients(&self, model: &Model, problem: &Problem) -> Located {
        let mut own = self.clone();
        for j in 0..self.structure.phases.len() {
            let Some(hold) = Hold::new(self, (model, problem), j) else { continue };
            let trajectory = &mut own.outcome.phases[j].trajectory;
            for point in 0..trajectory.time.len() {
                let (coefficients, at) = hold.at(point);
                for (c, normal) in coefficients.iter().zip(&at.normals) {
                    let columns = trajectory.costates.iter_mut().zip(normal);
                    columns.for_each(|(column, d)| column[point] -= c * d);
                }
            }
        }
        own
    }
}
