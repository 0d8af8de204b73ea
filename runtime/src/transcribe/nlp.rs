//! What a solver sees of a transcribed problem: values, derivatives, structure, places of rows.

use super::TranscribedNlp;
use crate::linalg::{Stages, Triplets};
use crate::nlp::{Derivatives, NO_OBJECTIVE, Nlp, Place, Quantities, objective_unit};
use crate::problem::{Bounds, Degree};
use std::sync::Arc;

impl Nlp for TranscribedNlp<'_> {
    fn variable_bounds(&self) -> &[Bounds] {
        &self.variable_bounds
    }
    fn constraint_bounds(&self) -> &[Bounds] {
        &self.constraint_bounds
    }
    fn jacobian_structure(&self) -> &Triplets {
        &self.jacobian
    }
    fn hessian_structure(&self) -> &Triplets {
        &self.hessian
    }
    fn stages(&self) -> Option<Stages> {
        Some(self.stages)
    }
    fn quantities(&self) -> Arc<Quantities> {
        Arc::clone(self.quantities.get_or_init(|| Arc::new(self.all_quantities())))
    }
    /// The unit is at most 1, and takes time to find out.
    fn objective_size(&mut self, terms: f64) -> f64 {
        if terms >= NO_OBJECTIVE { terms } else { terms.max(NO_OBJECTIVE * self.objective_unit()) }
    }
    fn objective_unit(&mut self) -> f64 {
        if self.objective_unit.is_none() {
            let guess = self.guess();
            self.objective_unit = Some(objective_unit(self, &guess));
        }
        self.objective_unit.unwrap_or(1.0)
    }

    fn values(&mut self, v: &[f64], rows: &mut [f64]) -> f64 {
        self.load(v);
        let stages = self.stages;
        let step = stages.variable_step();
        rows.fill(0.0);
        for link in &self.interval.links {
            let rows =
                rows[link.row..].iter_mut().step_by(stages.row_step()).take(stages.intervals);
            rows.zip(v[link.place..].iter().step_by(step))
                .for_each(|(row, x)| *row += link.value * x);
        }
        let mut objective = self.ends.values(stages, &self.parameters, rows);
        for sampled in self.nodes.iter_mut().chain(&mut self.path) {
            objective += sampled.add_values(stages, &self.parameters, rows);
        }
        for measured in &mut self.measured {
            objective += measured.add_values(&self.parameters, rows);
        }
        objective
    }

    fn derivatives(&mut self, v: &[f64], weight: f64, multipliers: &[f64], out: &mut Derivatives) {
        self.load(v);
        let Derivatives { gradient, jacobian, hessian } = out;
        gradient.fill(0.0);
        for (place, value) in &self.constant {
            jacobian[*place..][..self.stages.intervals].fill(*value);
        }
        for sampled in self.nodes.iter_mut().chain(&mut self.path) {
            sampled.differentiate(self.stages, &self.parameters, weight, multipliers);
            sampled.scatter(gradient, jacobian, hessian);
        }
        for measured in &mut self.measured {
            measured.differentiate(&self.parameters, weight, multipliers);
            measured.scatter(gradient, jacobian, hessian);
        }
        self.ends.differentiate(self.stages, &self.parameters, weight, multipliers);
        self.ends.scatter(gradient, jacobian, hessian);
    }

    fn has_kinks(&self) -> bool {
        self.problem.has_kinks
    }

    fn is_linear(&self, row: usize) -> bool {
        let problem = self.problem;
        if let Some(i) = row.checked_sub(self.stages.coupling().start) {
            return problem.boundary.degree(i + 1) == Degree::Affine;
        }
        let path = (row % self.stages.row_step()).checked_sub(self.stages.defect_rows());
        let is_affine = |i| problem.path.degree(i) == Degree::Affine;
        path.is_some_and(|row| is_affine(row % problem.path_bounds.len()))
    }

    fn constraint_place(&self, row: usize) -> Place {
        let stages = self.stages;
        if let Some(i) = row.checked_sub(stages.coupling().start) {
            return Place { origin: self.problem.boundary.origin(i + 1), ..Place::default() };
        }
        let (k, i) = (row / stages.row_step(), row % stages.row_step());
        let origin = match i.checked_sub(stages.defect_rows()) {
            Some(row) => self.problem.path.origin(row % self.problem.path_bounds.len()),
            None => self.defect_origin(i),
        };
        Place { origin, grid_point: Some(k + 1), ..Place::default() }
    }

    fn not_finite(&mut self, v: &[f64]) -> Option<Place> {
        self.load(v);
        let (stages, rows) = (self.stages, self.constraint_bounds.len());
        for node in &mut self.nodes {
            if let Some((output, k)) = node.not_finite(stages, &self.parameters, rows) {
                return Some(Place {
                    origin: self.problem.dynamics.origin(output),
                    grid_point: Some(k),
                    ..Place::default()
                });
            }
        }
        for path in &mut self.path {
            if let Some((output, k)) = path.not_finite(stages, &self.parameters, rows) {
                return Some(Place {
                    origin: self.problem.path.origin(output),
                    grid_point: Some(k + 1),
                    ..Place::default()
                });
            }
        }
        for measured in &mut self.measured {
            if let Some(k) = measured.not_finite(&self.parameters) {
                let origin = measured.origin();
                return Some(Place { origin, grid_point: Some(k), ..Place::default() });
            }
        }
        let output = self.ends.not_finite(stages, &self.parameters, rows)?;
        Some(Place { origin: self.problem.boundary.origin(output), ..Place::default() })
    }
}
