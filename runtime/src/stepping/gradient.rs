//! The gradient of what the steps compute: their exact derivative, step by step backwards.
//!
//! With `y = (x+, s_A)`, where `A` are the selectors that keep their guards at 0 (all others are constant), a step solves
//! `R(y; x, s0, u, p, t, h) = (F, psi_A) = 0`. From `lambda = dJ/dx+` and `rho = dJ/ds_A`
//!
//! ```text
//! R_y^T (mu, nu) = (lambda, rho),      dJ/dq += -(mu, nu) . R_q    for everything q that the step was given
//! ```
//!
//! The cost does not depend on how many parameters and controls there are. Times and the step follow the interval:
//! `t = t0(p) + tau (tf(p) - t0(p))`.

use super::field::{Field, Jacobian};
use super::rule::Grid;
use super::run::{Failure, Stepped, ends};
use super::step::{Step, weighted};
use crate::simulate::{Controls, System};
use nalgebra::{DMatrix, DVector};

/// The derivative of the objective by everything there is.
#[derive(Clone, Debug, PartialEq)]
pub struct Gradient {
    /// By `p`, also through the start, the interval and the guess of the controls.
    pub parameters: Vec<f64>,
    /// By the start of each state, integrals last.
    pub starts: Vec<f64>,
    /// By the rows of held controls.
    pub controls: Vec<Vec<f64>>,
}

/// The gradient of the objective that [`super::step_through`] found; the system must be one for sensitivities.
pub fn gradient(
    system: &System,
    controls: &Controls,
    grid: &Grid,
    stepped: &Stepped,
) -> Result<Gradient, Failure> {
    if system.objective.outputs() == 0 {
        return Err(Failure::NoObjective);
    }
    let field = Field::new(system, controls);
    let ends = ends(&stepped.start, stepped.end());
    let objective = Jacobian::of(&*system.objective, &ends, &field.parameters).by.row(0).transpose();
    let mut back = Adjoint::new(&field, grid, controls, &objective);
    for step in stepped.taken.iter().rev() {
        back.pass(step)?;
    }
    back.state += objective.rows(0, system.layout.x);
    Ok(back.finish())
}

/// Derivatives by what is known so far, from the end on.
struct Adjoint<'a> {
    field: &'a Field<'a>,
    grid: &'a Grid,
    /// `lambda`
    state: DVector<f64>,
    /// `rho`, for all selectors.
    selectors: DVector<f64>,
    parameters: DVector<f64>,
    controls: Vec<Vec<f64>>,
    first_time: f64,
    duration: f64,
}

impl<'a> Adjoint<'a> {
    fn new(field: &'a Field, grid: &'a Grid, controls: &Controls, objective: &DVector<f64>) -> Self {
        let layout = field.system.layout;
        let rows = match controls {
            Controls::Guess => 0,
            Controls::Held { rows, .. } => rows.len(),
        };
        Adjoint {
            field,
            grid,
            state: objective.rows(layout.x, layout.x).into_owned(),
            selectors: DVector::zeros(layout.s),
            parameters: objective.rows(2 * layout.x, layout.p).into_owned(),
            controls: vec![vec![0.0; layout.u]; rows],
            first_time: 0.0,
            duration: 0.0,
        }
    }

    /// From the end of a step to its beginning.
    fn pass(&mut self, step: &Step) -> Result<(), Failure> {
        let (mu, new) = self.implicit_part(step)?;
        let layout = self.field.system.layout;
        let mut old = DVector::zeros(layout.inputs());
        if let Some(weight) = self.grid.explicit {
            let flow = self.field.flow(&step.old);
            old = flow.by.transpose() * &mu * (step.h * weight);
            self.duration += weight * mu.dot(&flow.values) / self.grid.count() as f64;
        }
        self.state = mu + old.rows(1, layout.x);
        if let Some(node) = &self.grid.implicit {
            let stays = |i: usize| (1.0 - node.blend[i]) * new[1 + i];
            self.state += DVector::from_fn(layout.x, |i, _| stays(i));
        }
        let by_selector = old.rows_range(layout.selectors());
        let carried = |i: usize| if step.carried[i] { by_selector[i] } else { 0.0 };
        self.selectors = DVector::from_fn(layout.s, |i, _| carried(i));
        self.add_inputs(step, &(&old + &new));
        self.first_time += old[0] + new[0];
        let part = self.grid.implicit.as_ref().map_or(0.0, |node| node.time);
        self.duration += self.grid.tau(step.index, 0.0) * old[0] + self.grid.tau(step.index, part) * new[0];
        Ok(())
    }

    /// `mu`, and the derivative by all inputs of the implicit part; by the step, too, which is the duration's.
    fn implicit_part(&mut self, step: &Step) -> Result<(DVector<f64>, DVector<f64>), Failure> {
        let layout = self.field.system.layout;
        let Some(node) = &self.grid.implicit else {
            return Ok((self.state.clone(), DVector::zeros(layout.inputs())));
        };
        let (flow, guards) = (self.field.flow(&step.new), self.field.guards(&step.new));
        let weight = step.h * node.weight;
        let by_state = weighted(&flow.by.columns_range(layout.states()).into_owned(), node);
        let normals = weighted(&guards.by.columns_range(layout.states()).into_owned(), node);
        let (size, free) = (layout.x + step.free.len(), &step.free);
        let mut matrix = DMatrix::zeros(size, size);
        matrix
            .view_mut((0, 0), (layout.x, layout.x))
            .copy_from(&(DMatrix::identity(layout.x, layout.x) - weight * by_state));
        let along = flow.by.columns_range(layout.selectors()).select_columns(free) * -weight;
        matrix.view_mut((0, layout.x), (layout.x, free.len())).copy_from(&along);
        matrix.view_mut((layout.x, 0), (free.len(), layout.x)).copy_from(&normals.select_rows(free));
        let known = self.state.iter().copied().chain(free.iter().map(|&i| self.selectors[i]));
        let known = DVector::from_iterator(size, known);
        let singular = Failure::Singular { step: step.index, time: step.new.t };
        let solution = matrix.transpose().lu().solve(&known).ok_or(singular)?;
        let (mu, nu) = (solution.rows(0, layout.x).into_owned(), solution.rows(layout.x, free.len()));
        let new = flow.by.transpose() * &mu * weight - guards.by.select_rows(free).transpose() * nu;
        self.duration += node.weight * mu.dot(&flow.values) / self.grid.count() as f64;
        Ok((mu, new))
    }

    /// Parameters, and controls or what their guess is made of.
    fn add_inputs(&mut self, step: &Step, by: &DVector<f64>) {
        let layout = self.field.system.layout;
        self.parameters += by.rows_range(layout.parameters());
        let by_controls = by.rows_range(layout.controls());
        let middle = self.grid.middle(step.index);
        match self.field.row(middle) {
            _ if layout.u == 0 => {}
            Some(row) => {
                self.controls[row].iter_mut().zip(by_controls.iter()).for_each(|(sum, by)| *sum += by)
            }
            None => {
                let guess = Jacobian::of(&*self.field.system.guess, &[middle], &self.field.parameters).by;
                let guess = guess.view((layout.x, 1), (layout.u, layout.p));
                self.parameters += guess.transpose() * by_controls;
            }
        }
    }

    /// Start and interval are functions of the parameters.
    fn finish(mut self) -> Gradient {
        let Field { system, parameters, .. } = self.field;
        let start = Jacobian::of(&*system.start_of, &[], parameters).by;
        let interval = Jacobian::of(&*system.interval_of, &[], parameters).by.transpose();
        self.parameters += start.transpose() * &self.state;
        self.parameters +=
            interval.column(0) * (self.first_time - self.duration) + interval.column(1) * self.duration;
        Gradient {
            parameters: self.parameters.as_slice().to_vec(),
            starts: self.state.as_slice().to_vec(),
            controls: self.controls,
        }
    }
}
