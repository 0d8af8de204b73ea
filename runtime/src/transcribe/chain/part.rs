//! A phase as a part of the NLP of a chain.

use crate::linalg::{Family, PhaseStages};
use crate::nlp::{Derivatives, Nlp};
use crate::problem::{Bounds, Chain, Problem};
use crate::transcribe::TranscribedNlp;

/// The NLP of a phase, and where it is in that of the chain.
pub(super) struct Part<'c> {
    pub nlp: TranscribedNlp<'c>,
    pub shape: PhaseStages,
    /// Its own variables: stages, then its unknowns.
    pub v: Vec<f64>,
    pub derivatives: Derivatives,
}

impl<'c> Part<'c> {
    /// All phases, one behind the other.
    pub fn all(chain: &'c Chain) -> Vec<Self> {
        let nlps: Vec<TranscribedNlp> = chain.phases.iter().map(TranscribedNlp::new).collect();
        let stages = |nlp: &TranscribedNlp| nlp.chain().globals().start;
        let first_unknown = nlps.iter().map(stages).sum::<usize>();
        let place = |parameter| {
            let at = chain.unknowns.iter().position(|it| it.parameter == parameter);
            first_unknown + at.expect("the chain has the unknowns of its phases")
        };
        let (mut variables, mut rows) = (0, 0);
        let of = |(nlp, phase): (TranscribedNlp<'c>, &Problem)| {
            let (first, first_row) = (variables, rows);
            variables += stages(&nlp);
            rows += nlp.constraint_bounds().len();
            let shape = PhaseStages {
                stages: nlp.chain(),
                variables: first..variables,
                globals: phase.unknowns.iter().map(|it| place(it.parameter)).collect(),
                rows: first_row..rows,
            };
            let v = vec![0.0; nlp.variable_bounds().len()];
            Part { shape, v, derivatives: Derivatives::new(&nlp), nlp }
        };
        nlps.into_iter().zip(&chain.phases).map(of).collect()
    }

    pub fn stage_bounds(&self) -> &[Bounds] {
        &self.nlp.variable_bounds()[..self.shape.variables.len()]
    }

    /// Takes its own variables out of all of them.
    pub fn load(&mut self, v: &[f64]) {
        let (stages, unknowns) = self.v.split_at_mut(self.shape.variables.len());
        stages.copy_from_slice(&v[self.shape.variables.clone()]);
        for (value, unknown) in unknowns.iter_mut().zip(&self.shape.globals) {
            *value = v[*unknown];
        }
    }

    pub fn differentiate(&mut self, weight: f64, multipliers: &[f64]) {
        self.nlp.derivatives(&self.v, weight, multipliers, &mut self.derivatives);
    }

    /// Adds the gradient of its own objective.
    pub fn add_gradient(&self, gradient: &mut [f64]) {
        let (stages, unknowns) = self.derivatives.gradient.split_at(self.shape.variables.len());
        gradient[self.shape.variables.clone()].copy_from_slice(stages);
        for (value, unknown) in unknowns.iter().zip(&self.shape.globals) {
            gradient[*unknown] += value;
        }
    }

    /// The families of its Jacobian in that of the chain.
    pub fn jacobian(&self) -> impl Iterator<Item = Family> {
        let moved = |it: &Family| Family {
            row: self.shape.rows.start + it.row,
            column: self.shape.place(it.column),
            ..*it
        };
        self.nlp.jacobian_structure().families.iter().map(moved)
    }

    /// The families of its Hessian in that of the chain.
    pub fn hessian(&self) -> impl Iterator<Item = Family> {
        let moved = |it: &Family| Family {
            row: self.shape.place(it.row),
            column: self.shape.place(it.column),
            ..*it
        };
        self.nlp.hessian_structure().families.iter().map(moved)
    }
}
