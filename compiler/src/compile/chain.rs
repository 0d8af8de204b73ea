//! A model with phases as a chain of problems.

use super::alike::Alike;
use super::{ProblemCode, by_parameters_like, machine_code};
use crate::lower::{self, Expected, LoweredLink, LoweredProblem};
use crate::model::Model;
use crate::model::numbers::{Numbers, numbers as numbers_of};
use fdcc_grammar::Diagnostic;
use fdcc_runtime::problem::{
    ByParameters, Chain, ChainByParameters, Function, Link, Measurements, Problem,
};
use std::collections::HashSet;
use std::sync::Arc;

/// Turns a model into a chain of optimal control problems with compiled functions, of one problem
/// if it has no phases; or says what cannot be solved yet.
pub fn compile_chain(model: &Model) -> Result<Chain, Vec<Diagnostic>> {
    compile_chain_like(model, &mut Alike::default())
}

/// The same for one of several models of which phases are alike: these are compiled once.
pub fn compile_chain_like(model: &Model, alike: &mut Alike) -> Result<Chain, Vec<Diagnostic>> {
    ChainCode::like(model, alike)?.chain(model)
}

/// The functions of a chain differentiated by the parameters of the model, for what its optimum is
/// worth to them. The model has phases.
pub fn compile_chain_by_parameters(model: &Model) -> Result<ChainByParameters, Vec<Diagnostic>> {
    let mut alike = Alike::default();
    let phases = model.phases.iter().map(|phase| by_parameters_like(&phase.model, &mut alike));
    let phases: Vec<ByParameters> = phases.collect::<Result<_, _>>()?;
    let lowered: Vec<LoweredProblem> =
        model.phases.iter().map(|phase| lower::lower(&phase.model)).collect();
    let (graph, functions) = lower::links_by_parameters(model, &lowered.iter().collect::<Vec<_>>());
    let mut functions = alike.compiled(graph, functions, machine_code);
    let given = functions.pop().expect("what is given is the last of the functions");
    Ok(ChainByParameters { phases, links: functions, given })
}

/// The compiled functions of a chain, which take parameters as inputs: one for all values.
pub struct ChainCode {
    phases: Vec<ProblemCode>,
    links: Vec<(LoweredLink, Arc<dyn Function>)>,
}

impl ChainCode {
    /// Compiles a model.
    pub fn new(model: &Model) -> Result<Self, Vec<Diagnostic>> {
        Self::like(model, &mut Alike::default())
    }

    fn like(model: &Model, alike: &mut Alike) -> Result<Self, Vec<Diagnostic>> {
        if let Some(first) = model.not_yet.first().cloned() {
            return Err(vec![first]);
        }
        if model.phases.is_empty() {
            return Ok(ChainCode {
                phases: vec![ProblemCode::like(model, alike)?],
                links: Vec::new(),
            });
        }
        let phases = model.phases.iter().map(|phase| ProblemCode::like(&phase.model, alike));
        let phases: Vec<ProblemCode> = phases.collect::<Result<_, _>>()?;
        let lowered: Vec<&LoweredProblem> = phases.iter().map(|code| &code.lowered).collect();
        let (graph, links) = lower::links(model, &lowered);
        let functions = links.iter().map(|link| link.function.clone()).collect();
        let functions = alike.compiled(graph, functions, machine_code);
        Ok(ChainCode { phases, links: links.into_iter().zip(functions).collect() })
    }

    /// The chain of the model, or of one that differs from it in the values of parameters only.
    pub fn chain(&self, model: &Model) -> Result<Chain, Vec<Diagnostic>> {
        if model.phases.is_empty() {
            return Ok(Chain::single(self.phases[0].problem(model)?));
        }
        let numbers = numbers_of(model)?;
        let mut phases = Vec::new();
        for (code, phase) in self.phases.iter().zip(&model.phases) {
            phases.push(phase_of(model, code.problem(&phase.model)?));
        }
        let all = model.phases.iter().map(|phase| numbers_of(&phase.model));
        let all: Vec<Numbers> = all.collect::<Result<_, _>>()?;
        let links = self.links.iter().map(|it| link(model, (&numbers, &all), it)).collect();
        let unknowns = lower::unknowns(model, &numbers);
        Ok(Chain { name: model.name.clone(), phases, unknowns, links })
    }
}

/// A phase with the unknowns on which it depends.
fn phase_of(model: &Model, mut problem: Problem) -> Problem {
    let mut read: HashSet<usize> = HashSet::new();
    let measured = problem.measurements.iter().map(|it| &it.function);
    for function in
        [&problem.dynamics, &problem.path, &problem.boundary].into_iter().chain(measured)
    {
        let first = function.layout().parameters().start;
        let columns = function.jacobian_pattern().entries.iter().map(|it| it.1 as usize);
        read.extend(columns.filter_map(|column| column.checked_sub(first)));
    }
    problem.unknowns.retain(|unknown| read.contains(&unknown.parameter));
    // A free time may end one phase and begin the next.
    problem.last_time = None;
    problem.sense = model.sense;
    let of_phases = model.phases.iter().any(|phase| phase.model.objective.is_some());
    problem.has_objective = of_phases || model.links.iter().any(|it| it.objective.is_some());
    problem
}

fn link(
    model: &Model,
    (numbers, all): (&Numbers, &[Numbers]),
    (link, function): &(LoweredLink, Arc<dyn Function>),
) -> Link {
    let of_phase = link.of_phase.map(|phase| (&model.phases[phase].model, &all[phase]));
    let (model, numbers) = of_phase.unwrap_or((model, numbers));
    Link {
        ends: link.ends.clone(),
        function: function.clone(),
        bounds: link.rows.iter().map(|row| numbers.bounds(model, row.range)).collect(),
    }
}

/// All expectations of a model with phases, compiled.
pub struct ChainExpectations {
    /// In the order of the text.
    pub list: Vec<Expected>,
    /// Inputs `[x | p, integrals]`: for each phase its states at the start, its controls in the
    /// first interval, its states at the end, its controls in the last interval, hidden states left
    /// out; parameters and unknowns; the integrals and the sums over rows of each phase in turn.
    /// Three outputs for each expectation: left side, right side, tolerance; values only.
    pub function: Arc<dyn Function>,
    /// For each phase its sums; values only.
    pub sums: Vec<Vec<Measurements>>,
}

fn sums_of(model: &Model) -> Vec<Measurements> {
    let Ok(numbers) = numbers_of(model) else { return Vec::new() };
    let (graph, sums) = lower::sums(model);
    let terms = machine_code(graph, sums.iter().map(|it| it.term.clone()).collect());
    sums.iter().zip(&terms).map(|(it, term)| it.with_rows(model, &numbers, term)).collect()
}

/// Compiles the expectations of a model with phases.
pub fn chain_expectations(model: &Model) -> ChainExpectations {
    let (graph, function, list) = lower::expectations_of_phases(model);
    let function = machine_code(graph, vec![function]).remove(0);
    ChainExpectations {
        list,
        function,
        sums: model.phases.iter().map(|phase| sums_of(&phase.model)).collect(),
    }
}

/// The integrands of a phase over normalised time `[tau | x | u | p]`, times its duration; values
/// only.
pub fn integrands(model: &Model) -> Arc<dyn Function> {
    let (graph, integrands) = lower::integrands(model);
    machine_code(graph, vec![integrands]).remove(0)
}
