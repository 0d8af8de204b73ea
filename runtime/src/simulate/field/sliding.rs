//! Motion on sliding surfaces: the selectors that keep it there, and the way back.

use super::normals::Normals;
use super::{Field, read};
use crate::simulate::tuning::field::{PROJECTED, SOLVED};
use nalgebra::{DMatrix, DVector};

impl Field<'_> {
    /// Newton's method on the selectors of the sliding surfaces; the rate is not a number where it
    /// does not converge.
    pub(super) fn sliding_rate(&mut self, t: f64, x: &[f64], rate: &mut [f64]) {
        self.set_point(t, x, None);
        let Field { system, point, parameters, memory, .. } = self;
        memory.slide_on(&self.modes);
        system.switching.jacobian(point, parameters, &mut memory.psi, &mut memory.normals);
        let first = system.layout.selectors().start - system.layout.p;
        for _ in 0..30 {
            self.evaluations += 1;
            system.flow.jacobian(point, parameters, &mut memory.flow, &mut memory.by_inputs);
            read(&memory.flow, rate);
            self.held.iter().for_each(|&state| rate[state] = 0.0);
            if !memory.solve(system, rate, &self.held) {
                break;
            }
            let mut is_solved = true;
            for (&surface, change) in memory.sliding.iter().zip(&memory.change) {
                let selector = &mut point.column_mut(first + surface)[0];
                *selector += change;
                is_solved &= change.abs() <= SOLVED * (1.0 + selector.abs());
            }
            if is_solved {
                memory.sliding.iter().for_each(|&i| self.selectors[i] = point.column(first + i)[0]);
                return memory.follow(rate, &self.held);
            }
        }
        rate.fill(f64::NAN);
    }

    /// Newton's steps along `df/ds` back to the sliding surfaces.
    pub fn project(&mut self, t: f64, x: &mut [f64]) {
        let sliding = self.sliding();
        for _ in 0..if sliding.is_empty() { 0 } else { 3 } {
            let normals = self.normals(t, x);
            if sliding.iter().all(|&i| normals.psi[i].abs() <= PROJECTED * normals.noise(i, x)) {
                return;
            }
            let selectors = self.selectors.clone();
            let (_, by_selector) = self.with_selectors(t, x, &selectors);
            let directions = by_selector.select_columns(&sliding);
            let matrix = normals.by_state.select_rows(&sliding) * &directions;
            let psi =
                DVector::from_iterator(sliding.len(), sliding.iter().map(|&i| normals.psi[i]));
            let Some(along) = matrix.lu().solve(&psi) else { return };
            let change = directions * along;
            if !change.iter().all(|value| value.is_finite()) {
                return;
            }
            x.iter_mut().zip(change.iter()).for_each(|(x, change)| *x -= change);
        }
    }
}

/// `r = d f + psi_t` and `B = -d df/ds` of some surfaces.
pub(crate) fn surface_rates(
    normals: &Normals,
    rate: &[f64],
    by_selector: &DMatrix<f64>,
    surfaces: &[usize],
) -> (DVector<f64>, DMatrix<f64>) {
    let r = DVector::from_iterator(surfaces.len(), surfaces.iter().map(|&i| normals.rate(i, rate)));
    let b = -(normals.by_state.select_rows(surfaces) * by_selector.select_columns(surfaces));
    (r, b)
}

/// One Newton step along a gradient.
pub(crate) fn correct(x: &mut [f64], gradient: &[f64], value: f64) {
    let square: f64 = gradient.iter().map(|g| g * g).sum();
    if square > 0.0 {
        x.iter_mut().zip(gradient).for_each(|(x, g)| *x -= value * g / square);
    }
}
