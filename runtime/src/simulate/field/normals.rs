//! The functions of surfaces and kinks at a point: values, derivatives, and what rounding may make
//! of 0.

use super::Field;
use super::tube::Tube;
use crate::problem::Function;
use crate::simulate::tuning::normals::ROUNDING;
use nalgebra::DMatrix;

/// The functions of the surfaces with their derivatives.
pub(crate) struct Normals {
    pub psi: Vec<f64>,
    /// By time, also through controls that are polynomials in time.
    pub by_time: Vec<f64>,
    /// One row for each surface.
    pub by_state: DMatrix<f64>,
    /// What rounding may make of 0 for each surface, as far as the states have been large or the
    /// terms are.
    floors: Vec<f64>,
}

impl Normals {
    /// `psi'` along a rate.
    pub fn rate(&self, surface: usize, rate: &[f64]) -> f64 {
        let along: f64 = self.by_state.row(surface).iter().zip(rate).map(|(d, f)| d * f).sum();
        along + self.by_time[surface]
    }

    /// The size of the terms of `psi'` along a rate.
    pub fn speed(&self, surface: usize, rate: &[f64]) -> f64 {
        self.size(surface, rate) + self.by_time[surface].abs()
    }

    /// What rounding may make of `psi = 0`.
    pub fn noise(&self, surface: usize, x: &[f64]) -> f64 {
        self.floors[surface] + self.rounding(surface, x)
    }

    /// What rounding of the terms `dpsi/dx x` may make of their sum.
    pub fn rounding(&self, surface: usize, x: &[f64]) -> f64 {
        ROUNDING * self.size(surface, x)
    }

    /// The size of the terms `dpsi/dx x`.
    pub fn size(&self, surface: usize, x: &[f64]) -> f64 {
        self.by_state.row(surface).iter().zip(x).map(|(d, x)| (d * x).abs()).sum()
    }
}

impl Field<'_> {
    /// The functions of the surfaces with their derivatives.
    pub fn normals(&mut self, t: f64, x: &[f64]) -> Normals {
        self.normals_of(&*self.system.switching, 0, (t, x, None))
    }

    /// The same with given selectors: those say on which side of its kinks each function is.
    pub fn normals_with(&mut self, t: f64, x: &[f64], selectors: &[f64]) -> Normals {
        self.normals_of(&*self.system.switching, 0, (t, x, Some(selectors)))
    }

    /// What is 0 at the kinks, with its derivatives.
    pub fn kinks(&mut self, t: f64, x: &[f64]) -> Normals {
        self.normals_of(&*self.system.kinks, self.modes.len(), (t, x, None))
    }

    fn normals_of(
        &mut self,
        function: &dyn Function,
        first: usize,
        (t, x, selectors): (f64, &[f64], Option<&[f64]>),
    ) -> Normals {
        self.set_point(t, x, selectors);
        let controls = self.system.layout.controls();
        let (psi, matrix) = self.jacobian(function, 0..controls.end);
        let mut by_time: Vec<f64> = matrix.column(0).iter().copied().collect();
        if let Some(curve) = &self.curve {
            let by_control = matrix.columns_range(controls);
            let moved = by_control * curve.rates(t);
            by_time.iter_mut().zip(moved.iter()).for_each(|(by_time, moved)| *by_time += moved);
        }
        let floors = self.rounding[first..][..psi.len()].to_vec();
        let by_state = matrix.columns(1, x.len()).into_owned();
        let mut normals = Normals { psi, by_time, by_state, floors };
        for i in 0..normals.psi.len() {
            let of_terms = normals.rounding(i, &self.tolerance.sizes)
                + ROUNDING * (normals.by_time[i] * t).abs();
            let slopes = normals.by_state.row(i);
            let of_states: f64 = slopes
                .iter()
                .enumerate()
                .map(|(state, slope)| slope.abs() * self.tolerance.least(state))
                .sum();
            normals.floors[i] += of_terms + of_states;
        }
        normals
    }

    /// Finds what rounding makes of the surfaces and kinks near a point: the widths of their
    /// enclosures there.
    pub fn find_rounding(&mut self, t: f64, x: &[f64]) {
        let mut tube = Tube::at(self, t, x);
        let enclosures = &self.system.enclosures;
        for (known, of) in
            self.rounding.iter_mut().zip(enclosures.switching.iter().chain(&enclosures.kinks))
        {
            tube.evaluate(of);
            let width = tube.ranges[0][1] - tube.ranges[0][0];
            *known = if width.is_finite() { 2.0 * width } else { *known };
        }
    }
}
