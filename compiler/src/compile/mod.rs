//! The pipeline behind the checks: lowering, derivatives, machine code.
//!
//! [`ProblemCode`] is what a solve needs of one phase; [`chain`] puts phases together,
//! [`compile_simulation`] and its neighbours make the true system.

pub(crate) mod alike;
pub(crate) mod chain;
pub(crate) mod dump;
pub(crate) mod emit;
pub(crate) mod residuals;
mod summary;

use crate::differentiate::differentiate;
use crate::expressions::graph::{self, Graph};
use crate::generate;
use crate::lower::{
    self, Expected, LoweredExpectations, LoweredProblem, Purpose, VectorFunction, by_parameters,
    lower, problem,
};
use crate::model::numbers::{Numbers, numbers};
use crate::model::{self, Model, Simulated};
use crate::phases::between_jumps;
use alike::Alike;
use fdcc_grammar::{Diagnostic, Severity};
use fdcc_runtime::problem::{ByParameters, Function, Measurements, Problem};
use fdcc_runtime::simulate::System;
use std::sync::Arc;

/// Turns a model into an optimal control problem with compiled functions; or says what cannot be
/// solved yet. Of a model with jumps it is what holds between them:
/// [`with_phases`](crate::with_phases) makes of it one in which they happen.
pub fn compile(model: &Model) -> Result<Problem, Vec<Diagnostic>> {
    ProblemCode::new(model)?.problem(model)
}

/// The compiled functions of a problem, which take parameters as inputs: one for all values.
pub struct ProblemCode {
    lowered: LoweredProblem,
    functions: Vec<Arc<dyn Function>>,
}

impl ProblemCode {
    /// Compiles a model.
    pub fn new(model: &Model) -> Result<Self, Vec<Diagnostic>> {
        Self::like(model, &mut Alike::default())
    }

    /// Compiles what is not alike to what has been compiled for another phase.
    pub(super) fn like(model: &Model, alike: &mut Alike) -> Result<Self, Vec<Diagnostic>> {
        not_yet(model)?;
        model.rows_beside_jumps().map_or(Ok(()), |found| Err(vec![found]))?;
        let model = &between_jumps(model);
        known(model)?;
        let lowered = lower(model);
        let functions = lowered.functions().into_iter().cloned().collect();
        let functions = alike.compiled(lowered.graph.clone(), functions, machine_code);
        Ok(ProblemCode { lowered, functions })
    }

    /// The problem of the model, or of one that differs from it in the values of parameters only.
    pub fn problem(&self, model: &Model) -> Result<Problem, Vec<Diagnostic>> {
        let model = &between_jumps(model);
        Ok(problem(model, &self.lowered, &known(model)?, self.functions.clone()))
    }
}

/// The functions of a problem differentiated by the parameters of the model, for what its optimum
/// is worth to them.
pub fn compile_by_parameters(model: &Model) -> Result<ByParameters, Vec<Diagnostic>> {
    by_parameters_like(model, &mut Alike::default())
}

/// The same, where some of it may have been compiled.
fn by_parameters_like(model: &Model, alike: &mut Alike) -> Result<ByParameters, Vec<Diagnostic>> {
    not_yet(model)?;
    let mut lowered = lower(model);
    let functions = by_parameters(model, &mut lowered);
    let functions = alike.compiled(lowered.graph, functions, machine_code);
    let Some((first, sums)) = functions.split_first_chunk::<4>() else {
        unreachable!("there are four at least")
    };
    let ([dynamics, path, boundary, given], measurements) = (first.clone(), sums.to_vec());
    let (parameters, unknowns) = (model.params.len(), model.frees.len());
    Ok(ByParameters { parameters, unknowns, dynamics, path, boundary, measurements, given })
}

/// Turns a model into the true system, for simulation; or says what cannot be simulated yet. An
/// objective that reads sums over rows is left out.
pub fn compile_simulation(model: &Model) -> Result<System, Vec<Diagnostic>> {
    match model.objective_reads_sums() {
        true => compile_system(&Model { objective: None, ..model.clone() }, Purpose::Simulation),
        false => compile_system(model, Purpose::Simulation),
    }
}

/// The true system with all its derivatives, to the second order, for sensitivities.
pub fn compile_sensitivities(model: &Model) -> Result<System, Vec<Diagnostic>> {
    compile_system(model, Purpose::Sensitivities)
}

/// The system as a solve smooths it, without surfaces, with all its derivatives; or says that jumps
/// cannot be smoothed.
pub fn compile_smoothed(model: &Model) -> Result<System, Vec<Diagnostic>> {
    if let Some(jump) = model.jumps.first() {
        return Err(vec![model::not_yet(jump.place.span, "a smoothed model with jumps")]);
    }
    compile_system(model, Purpose::Smoothed)
}

fn compile_system(model: &Model, purpose: Purpose) -> Result<System, Vec<Diagnostic>> {
    not_yet(model)?;
    if let Some(sum) = model.sums.first().filter(|_| model.objective_reads_sums()) {
        return Err(vec![model::not_simulated_yet(sum.place.span)]);
    }
    let numbers = known(model)?;
    let (graph, lowered) = lower::simulation(model, purpose);
    let functions = machine_code(graph, lowered.functions.clone());
    Ok(lower::system(model, &lowered, &numbers, functions))
}

/// All expectations of a model, compiled.
pub struct Expectations {
    /// In the order of the text.
    pub list: Vec<Expected>,
    /// What only a simulation can tell.
    pub simulated: Vec<Simulated>,
    /// Over `[x(start), x(end) | p, integrals, sums, simulated]`, the states of
    /// [`Problem`] with the hidden ones; values only.
    pub function: Arc<dyn Function>,
    /// The integrands over normalised time `[tau | x | u | p]`, times the duration; values only.
    pub integrands: Arc<dyn Function>,
    /// Sums over rows of measured data; values only.
    pub sums: Vec<Measurements>,
}

/// Compiles the expectations.
pub fn expectations(model: &Model) -> Expectations {
    let LoweredExpectations { list, graph, functions, sums } = lower::expectations(model);
    let terms = sums.iter().map(|it| it.term.clone());
    let compiled = machine_code(graph, functions.into_iter().chain(terms).collect());
    let Some(([function, integrands], terms)) = compiled.split_first_chunk::<2>() else {
        unreachable!("two functions were given at least")
    };
    let numbers = numbers(model).ok();
    let rows = sums.iter().zip(terms);
    let rows = rows.filter_map(|(it, term)| Some(it.with_rows(model, numbers.as_ref()?, term)));
    Expectations {
        list,
        simulated: model.simulated.clone(),
        function: function.clone(),
        integrands: integrands.clone(),
        sums: rows.collect(),
    }
}

/// The numbers of a model whose rows are all within its time.
fn known(model: &Model) -> Result<Numbers, Vec<Diagnostic>> {
    let numbers = numbers(model)?;
    let mut found = model.misplaced_rows(&numbers);
    found.retain(|it| it.severity == Severity::Error);
    if found.is_empty() { Ok(numbers) } else { Err(found) }
}

/// The first construct that is understood but cannot be solved.
fn not_yet(model: &Model) -> Result<(), Vec<Diagnostic>> {
    model.first_not_yet().map_or(Ok(()), |first| Err(vec![first]))
}

/// Derivatives, then machine code.
fn machine_code(mut graph: Graph, functions: Vec<VectorFunction>) -> Vec<Arc<dyn Function>> {
    let functions =
        functions.into_iter().map(|function| differentiate(&mut graph, function)).collect();
    debug_assert_eq!(graph::verify(&graph), Ok(()));
    generate::generate(graph, functions)
}
