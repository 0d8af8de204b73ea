//! What the multipliers of a chain do not say of the sensitivity of the optimal cost: parameters
//! that move a surface which is held from the first time on, or until the last.
//!
//! A given start beside the surface is led onto it at once, so that the objective changes by the
//! gradient (`costates.rs`) and not by the multipliers: with `lambda = gradient + sum of c d` by
//! `c dpsi/dp` less. Where the start is chosen `psi = 0` is a row of the chain, whose multiplier
//! says it. An end beside the surface is another motion for each side, so that there the objective
//! has a kink.
//! So it has where the motion begins on a surface that it leaves at once, or ends on one that it
//! reaches at last: beside it that happens a moment earlier, or not at all.

use super::Located;
use super::costates::Hold;
use super::point::point_of;
use super::tuning::costates::{ON_SURFACE, SAME};
use fdcc_compiler::{HoldNormals, Mode, Model, Slopes, is_kink};
use fdcc_runtime::problem::Problem;
use nalgebra::{DMatrix, DVector};

impl Located {
    /// What is to be added to the derivative by each parameter; NaN at a kink. `model` is what
    /// holds between jumps, `problem` what is smoothed of that.
    pub fn sensitivities_of_holds(&self, model: &Model, problem: &Problem) -> Vec<f64> {
        let mut all = vec![0.0; model.params.len()];
        if let Some(hold) = Hold::new(self, (model, problem), 0) {
            let coefficients = hold.at(0).0;
            let slopes = hold.normals.starts_by_parameters(&hold.point(0));
            let of_given = coefficients.iter().zip(slopes).zip(hold.normals.are_starts_given());
            for ((c, slopes), _) in of_given.filter(|it| it.1) {
                all.iter_mut().zip(slopes).for_each(|(sum, slope)| *sum -= c * slope);
            }
        }
        if let Some(hold) = Hold::new(self, (model, problem), self.structure.phases.len() - 1) {
            let last = hold.point(hold.trajectory().time.len() - 1);
            let (psi, ends) = (hold.normals.slopes(&last), hold.normals.slopes_of_ends(&last));
            let kinks = kinks(psi, ends, all.len());
            all.iter_mut().zip(kinks).filter(|it| it.1).for_each(|it| *it.0 = f64::NAN);
        }
        let kinks = self.kinks_at_start(model, problem).into_iter();
        let kinks = kinks.zip(self.kinks_at_end(model, problem)).map(|(a, b)| a || b);
        all.iter_mut().zip(kinks).filter(|it| it.1).for_each(|it| *it.0 = f64::NAN);
        all
    }

    /// For each parameter whether it moves a surface on which the motion begins, and does not stay.
    fn kinks_at_start(&self, model: &Model, problem: &Problem) -> Vec<bool> {
        let mut all = vec![false; model.params.len()];
        let surfaces = self.touched(model, problem, 0);
        let Some(normals) = HoldNormals::new(model, &surfaces) else { return all };
        let first = &self.outcome.phases[0].trajectory;
        let point = point_of(first, (problem, model.states.len()), &|column| column[0]);
        for slopes in normals.starts_by_parameters(&point) {
            all.iter_mut().zip(slopes).for_each(|(is_kink, slope)| *is_kink |= slope != 0.0);
        }
        all
    }

    /// The same of the last time: whether it moves a condition there beside the surface.
    fn kinks_at_end(&self, model: &Model, problem: &Problem) -> Vec<bool> {
        let surfaces = self.touched(model, problem, 1);
        let normals = HoldNormals::new(model, &surfaces).filter(|_| !surfaces.is_empty());
        let Some(normals) = normals else { return vec![false; model.params.len()] };
        let last = &self.outcome.phases[self.outcome.phases.len() - 1].trajectory;
        let end = |column: &[f64]| column[column.len() - 1];
        let point = point_of(last, (problem, model.states.len()), &end);
        kinks(normals.slopes(&point), normals.slopes_of_ends(&point), model.params.len())
    }

    /// The surfaces that are 0 at the first (0) or the last (1) time, and are not held there; all
    /// components of a `Dir`. What is continuous on a kink has none there.
    fn touched(&self, model: &Model, problem: &Problem, end: usize) -> Vec<usize> {
        let whole = self.whole(problem).outcome.trajectory;
        let phases = &self.structure.phases;
        let modes = &phases[end * (phases.len() - 1)].modes;
        let switches = model.switches().into_iter().zip(modes).enumerate();
        let touched = switches.filter(|(at, (switch, mode))| {
            let psi = &whole.switching[*at];
            let largest = psi.iter().fold(0.0, |a: f64, it| a.max(it.abs()));
            let is_zero = psi[end * (psi.len() - 1)].abs() <= ON_SURFACE * largest;
            **mode != Mode::Held && !is_kink(&switch.place.name) && is_zero
        });
        touched.flat_map(|(_, (switch, _))| switch.surfaces).collect()
    }
}

/// For each parameter whether it moves a condition at the end that what is `known` there, and the
/// conditions before it, say already, and does not move these as much.
fn kinks(mut known: Vec<Slopes>, ends: Vec<Slopes>, parameters: usize) -> Vec<bool> {
    let mut all = vec![false; parameters];
    for end in ends {
        let Some(parts) = parts(&known, &end.by_state) else {
            known.push(end);
            continue;
        };
        for (at, is_kink) in all.iter_mut().enumerate() {
            let moved = known.iter().zip(&parts).map(|(it, part)| part * it.by_parameters[at]);
            let (own, moved) = (end.by_parameters[at], moved.sum::<f64>());
            *is_kink |= (own - moved).abs() > SAME * (own.abs() + moved.abs());
        }
    }
    all
}

/// How much of each slope adds up to another one; nothing if they do not.
fn parts(known: &[Slopes], other: &[f64]) -> Option<Vec<f64>> {
    let column = |it: &Slopes| DVector::from_column_slice(&it.by_state);
    let columns: Vec<DVector<f64>> = known.iter().map(column).collect();
    let matrix = DMatrix::from_columns(&columns);
    let other = DVector::from_column_slice(other);
    let decomposed = matrix.clone().svd(true, true);
    let least = SAME * decomposed.singular_values.max();
    let parts = decomposed.solve(&other, least).ok()?;
    let rest = (&matrix * &parts - &other).norm();
    // What rounding leaves is no part.
    let size = SAME * other.norm();
    let part = |(part, column): (&f64, &DVector<f64>)| {
        if part.abs() * column.norm() > size { *part } else { 0.0 }
    };
    (rest <= size).then(|| parts.iter().zip(&columns).map(part).collect())
}
