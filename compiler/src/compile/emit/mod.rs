//! The functions of a model as C, for `fdcc emit`.

mod given;
mod ports;

use super::chain::compile_chain;
use super::dump::{differentiated, input_names};
use crate::differentiate::differentiate;
use crate::generate::c::{Exported, File};
use crate::lower::{self, LoweredProblem, lower};
use crate::model::Model;
use crate::phases::with_times;
use fdcc_grammar::{Code, Diagnostic};
use fdcc_runtime::problem::{Chain, Problem, Scheme};
use std::collections::HashSet;

/// What is said on top of every file.
const HEAD: &str = "
The functions of a model as C99, written by fdcc. All numbers are in SI; costs are minimised.

For each function f there are kernels, whose pointers must not overlap:
  f_value(z, p, y), f_jacobian(z, p, y, j), f_hessian(z, p, l, y, j, h)
  z  the inputs t, x, u and row        p  parameters, unknowns, widths of layers
  y  the outputs                       l  a multiplier for each output
  j  entries of the Jacobian           h  of the lower triangle of the Hessian of the sum of l y
f_jacobian_pattern, f_hessian_pattern: rows, columns, entries, then row and column of each entry;
inputs are counted in the order t, x, u, p, row. For CasADi there are f, jac_f, adj1_f, jac_adj1_f.
With -ffp-contract=off, + - * / and sqrt have the bits of fdcc's machine code.

  t         (time - t0) / (tf - t0), between 0 and 1
  q         unknowns that are no functions of time
  p         parameters, then the widths of smoothed layers; for CasADi without the unknowns
  dynamics  (tf - t0) * right side, and (tf - t0) * integrand of the objective
  boundary  the objective at the ends, and what the conditions there bound
  sum1      the term of a row of measured data. With collocation x and u are those at its time,
            and their derivatives by t if the time moves; else those at both ends of a step, and
            row ends with the t at which the step begins and its length
  numbers   values, bounds, rows; NAN for a start that is not given
";

/// The functions of a model, with its bounds, as the text of a C file; or says what cannot be
/// written yet.
///
/// Right sides are those of the differential equation for all schemes, also for `rk4`.
pub fn emit_c(model: &Model) -> Result<String, Vec<Diagnostic>> {
    let model = &written(model)?;
    let chain = compile_chain(model)?;
    let mut file = File::default();
    let name = identifier(&model.name);
    if model.phases.is_empty() {
        write_phase(&mut file, &name, model, (&chain, &chain.phases[0]));
    }
    let phases = phase_names(model);
    for ((phase, problem), own) in model.phases.iter().zip(&chain.phases).zip(&phases) {
        write_phase(&mut file, &format!("{name}_{own}"), &phase.model, (&chain, problem));
    }
    write_links(&mut file, &name, model, &chain);
    Ok(file.finish(&format!("{}\n{HEAD}", model.name)))
}

/// The model whose functions are written: with its phases, and the right side instead of the steps
/// of a composed scheme.
fn written(model: &Model) -> Result<Model, Vec<Diagnostic>> {
    let of_phases = model.phases.iter().flat_map(|it| &it.model.jumps);
    if let Some(jump) = model.jumps.iter().chain(of_phases).next() {
        let message = "a model with jumps cannot be written as C yet";
        let label = "which jumps happen, and when, is found by `solve`";
        return Err(vec![Diagnostic::new(Code::NotYet, message, jump.place.span, label)]);
    }
    let mut model = if model.at_times.is_empty() { model.clone() } else { with_times(model)? };
    let phases = model.phases.iter_mut().map(|phase| &mut phase.model.method);
    for method in phases.chain([&mut model.method]) {
        if method.scheme == Scheme::RungeKutta4 {
            method.scheme = Scheme::Euler;
        }
    }
    Ok(model)
}

/// Letters, digits and single underscores, as CasADi wants the names of functions.
fn identifier(name: &str) -> String {
    let words = name.split(|c: char| !c.is_ascii_alphanumeric()).filter(|word| !word.is_empty());
    let name = words.collect::<Vec<_>>().join("_");
    if name.starts_with(|c: char| c.is_ascii_alphabetic()) { name } else { format!("m{name}") }
}

/// The names of the phases in C, or their numbers where two are alike there.
fn phase_names(model: &Model) -> Vec<String> {
    let names: Vec<String> = model.phases.iter().map(|it| identifier(&it.place.name)).collect();
    let are_apart = names.iter().collect::<HashSet<_>>().len() == names.len();
    if are_apart { names } else { (1..=names.len()).map(|at| format!("phase{at}")).collect() }
}

fn write_phase(file: &mut File, name: &str, model: &Model, (chain, problem): (&Chain, &Problem)) {
    let lowered = lower(model);
    let (graph, functions) = differentiated(&lowered);
    let mut sums = 0;
    for symbols in functions.iter().filter(|it| !it.function.outputs.is_empty()) {
        let function = &symbols.function;
        let is_sum = lowered.measured.iter().any(|it| it.term.name == function.name);
        sums += usize::from(is_sum);
        let own = if is_sum { format!("sum{sums}") } else { function.name.clone() };
        let names = input_names(model, &lowered, &function.layout);
        let exported = Exported {
            name: format!("{name}_{own}"),
            symbols,
            arguments: ports::arguments(function, &names, model),
            results: ports::results(function, &lowered),
        };
        file.add(&graph, &exported);
    }
    file.give(&given::numbers(name, model, chain, problem));
    for (at, rows) in problem.measurements.iter().enumerate() {
        file.give(&given::rows(&format!("{name}_sum{}", at + 1), rows));
    }
}

/// What ties phases together.
fn write_links(file: &mut File, name: &str, model: &Model, chain: &Chain) {
    if model.phases.is_empty() {
        return;
    }
    let phases: Vec<LoweredProblem> = model.phases.iter().map(|it| lower(&it.model)).collect();
    let (mut graph, links) = lower::links(model, &phases.iter().collect::<Vec<_>>());
    let names = phase_names(model);
    let functions: Vec<_> =
        links.iter().map(|it| differentiate(&mut graph, it.function.clone())).collect();
    for (at, (link, symbols)) in links.iter().zip(&functions).enumerate() {
        let name = format!("{name}_link{}", at + 1);
        let exported = Exported {
            arguments: ports::of_ends(model, (&phases, &names), link),
            results: ports::cost_and_conditions(&symbols.function),
            symbols,
            name: name.clone(),
        };
        file.add(&graph, &exported);
        file.give(&given::bounds(&name, &chain.links[at].bounds));
    }
}
