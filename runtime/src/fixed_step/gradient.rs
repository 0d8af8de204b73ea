//! The gradient of what the steps compute: their exact derivative, step by step backwards.
//!
//! With `y = (x+, s_A)`, where `A` are the selectors that keep their switching functions at 0 (all
//! others are constant), a step solves `R(y; x, s0, u, p, t, h) = (F, psi_A) = 0`. From `lambda =
//! dJ/dx+` and `rho = dJ/ds_A`
//!
//! ```text
//! R_y^T (mu, nu) = (lambda, rho),
//! dJ/dq += -(mu, nu) . R_q            for everything q that the step was given
//! ```
//!
//! The cost does not depend on how many parameters and controls there are. Times and the step
//! follow the interval: `t = t0(p) + tau (tf(p) - t0(p))`.

use super::field::{Field, jacobian};
use super::linearised::Linearised;
use super::rule::Grid;
use super::run::{Failure, Stepped, ends};
use super::step::FixedStep;
use crate::simulate::{Controls, System};
use nalgebra::DVector;

/// The derivative of the objective by everything there is.
#[derive(Clone, Debug, PartialEq)]
pub struct Gradient {
    /// By `p`, also through the start, the interval and the guess of the controls.
    pub parameters: Vec<f64>,
    /// By the start of each state, integrals last.
    pub starts: Vec<f64>,
    /// By the rows of the controls.
    pub controls: Vec<Vec<f64>>,
}

/// The gradient of the objective that [`super::run::step_through`] found; the system must be one
/// for sensitivities.
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
    let objective = jacobian(&*system.objective, &ends, &field.parameters).by.row(0).transpose();
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
    fn new(
        field: &'a Field,
        grid: &'a Grid,
        controls: &Controls,
        objective: &DVector<f64>,
    ) -> Self {
        let layout = field.system.layout;
        Adjoint {
            field,
            grid,
            state: objective.rows(layout.x, layout.x).into_owned(),
            selectors: DVector::zeros(field.system.surfaces.len()),
            parameters: objective.rows(2 * layout.x, layout.p).into_owned(),
            controls: vec![vec![0.0; layout.u]; controls.rows().len()],
            first_time: 0.0,
            duration: 0.0,
        }
    }

    /// From the end of a step to its beginning.
    fn pass(&mut self, step: &FixedStep) -> Result<(), Failure> {
        let (mu, new) = self.implicit_part(step)?;
        let old = self.explicit_part(step, &mu);
        let layout = self.field.system.layout;
        self.add_inputs(step, &(&old + &new));
        let by_selector = old.rows_range(self.field.system.surface_selectors());
        let carried = |i: usize| if step.carried[i] { by_selector[i] } else { 0.0 };
        self.selectors = DVector::from_fn(step.carried.len(), |i, _| carried(i));
        self.state = mu + old.rows_range(layout.states());
        if let Some(node) = &self.grid.implicit {
            let by_state = new.rows_range(layout.states());
            self.state += DVector::from_fn(layout.x, |i, _| (1.0 - node.blend[i]) * by_state[i]);
        }
        Ok(())
    }

    /// `mu`, and the derivative by all inputs of the implicit part.
    fn implicit_part(&mut self, step: &FixedStep) -> Result<(DVector<f64>, DVector<f64>), Failure> {
        let (layout, free) = (self.field.system.layout, &step.free);
        let Some(node) = &self.grid.implicit else {
            return Ok((self.state.clone(), DVector::zeros(layout.inputs())));
        };
        let local = Linearised::new(self.field, node, step.h, &step.new);
        let known = self.state.iter().copied().chain(free.iter().map(|&i| self.selectors[i]));
        let known = DVector::from_iterator(layout.x + free.len(), known);
        let solution = local.bordered(free).transpose().lu().solve(&known);
        let solution = solution.filter(|solution| solution.iter().all(|value| value.is_finite()));
        let solution = solution.ok_or(Failure::Singular { step: step.index, time: step.new.t })?;
        let (mu, nu) =
            (solution.rows(0, layout.x).into_owned(), solution.rows(layout.x, free.len()));
        let by_flow = local.flow.by.tr_mul(&mu) * local.weight;
        let by_all = by_flow - local.switching.by.select_rows(free).tr_mul(&nu);
        self.add_times(step, node.time, by_all[0], node.weight * mu.dot(&local.flow.values));
        Ok((mu, by_all))
    }

    /// The derivative by all inputs of the explicit part.
    fn explicit_part(&mut self, step: &FixedStep, mu: &DVector<f64>) -> DVector<f64> {
        let Some(weight) = self.grid.explicit else {
            return DVector::zeros(self.field.system.layout.inputs());
        };
        let flow = self.field.flow(&step.old);
        let by_all = flow.by.tr_mul(mu) * (step.h * weight);
        self.add_times(step, 0.0, by_all[0], weight * mu.dot(&flow.values));
        by_all
    }

    /// Through the time of an evaluation, a part of a step after its beginning, and through the
    /// step.
    fn add_times(&mut self, step: &FixedStep, part: f64, by_time: f64, by_step: f64) {
        self.first_time += by_time;
        self.duration +=
            self.grid.tau(step.index, part) * by_time + by_step / self.grid.count() as f64;
    }

    /// Parameters, and controls or what their guess is made of.
    fn add_inputs(&mut self, step: &FixedStep, by: &DVector<f64>) {
        let layout = self.field.system.layout;
        self.parameters += by.rows_range(layout.parameters());
        let by_controls = by.rows_range(layout.controls());
        let middle = self.grid.middle(step.index);
        for (row, weight) in self.field.rows(middle) {
            let sums = self.controls[row].iter_mut();
            sums.zip(by_controls.iter()).for_each(|(sum, by)| *sum += weight * by);
        }
        if self.field.follows_guess() {
            let guess = jacobian(&*self.field.system.guess, &[middle], &self.field.parameters).by;
            let guess = guess.view((layout.x, 1), (layout.u, layout.p));
            self.parameters += guess.transpose() * by_controls;
        }
    }

    /// Start and interval are functions of the parameters.
    fn finish(mut self) -> Gradient {
        let Field { system, parameters, .. } = self.field;
        let start = jacobian(&*system.start_of, &[], parameters).by;
        let interval = jacobian(&*system.interval_of, &[], parameters).by.transpose();
        self.parameters += start.transpose() * &self.state;
        self.parameters += interval.column(0) * (self.first_time - self.duration)
            + interval.column(1) * self.duration;
        Gradient {
            parameters: self.parameters.as_slice().to_vec(),
            starts: self.state.as_slice().to_vec(),
            controls: self.controls,
        }
    }
}
