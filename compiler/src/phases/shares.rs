//! The objective of the whole time: which part of it belongs to which phase.
//!
//! An integral is the sum of those of all phases, and so is a sum over rows of measured data. Where
//! its factor in the objective depends on parameters alone, each phase has its own part; otherwise
//! links need the value at the ends.

use crate::expressions::graph::derivative::derivative;
use crate::expressions::graph::{ExprId, Graph};
use crate::model::{Model, Symbol};

/// What is minimised, over the symbols of a model without phases.
pub(super) struct Shares {
    /// What each phase has of it.
    of_each: Option<ExprId>,
    /// What the first phase has of it.
    of_first: Option<ExprId>,
    /// What the last phase has of it.
    of_last: Option<ExprId>,
    /// What reads several phases.
    pub linked: Option<ExprId>,
    /// The integrals whose values links read.
    pub integrals: Vec<usize>,
}

impl Shares {
    pub fn new(model: &Model, graph: &mut Graph) -> Self {
        let rows: Vec<ExprId> = model.boundary.iter().map(|row| row.value).collect();
        let mut shares = Shares {
            of_each: None,
            of_first: None,
            of_last: None,
            linked: None,
            integrals: integrals(model, graph, &rows),
        };
        if let Some((_, value)) = model.objective {
            shares.split(model, graph, value);
        }
        shares
    }

    fn split(&mut self, model: &Model, graph: &mut Graph, value: ExprId) {
        let (mut terms, mut apart) = (Vec::new(), Vec::new());
        for input in over_time(model, graph, value) {
            let factor = derivative(graph, value, input);
            if is_given(model, graph, factor) {
                let part = graph.input(input);
                terms.push(graph.mul(factor, part));
                apart.push(input);
            }
        }
        let zero = graph.number(0.0);
        let rest = graph.substitute(&[value], &|at| apart.contains(&at).then_some(zero))[0];
        self.of_each = (!terms.is_empty()).then(|| graph.sum(&terms));
        let linked = integrals(model, graph, &[rest]);
        let reads = |is_it: &dyn Fn(&Symbol) -> bool| {
            graph.inputs_of(&[rest]).iter().any(|at| is_it(&model.symbols[*at as usize]))
        };
        let at_start = reads(&|it| matches!(it, Symbol::AtStart(_)));
        let at_end = reads(&|it| matches!(it, Symbol::AtEnd(_) | Symbol::ControlAtEnd(_)));
        let place = match (linked.is_empty(), at_start, at_end) {
            (true, false, _) => &mut self.of_last,
            (true, true, false) => &mut self.of_first,
            _ => &mut self.linked,
        };
        *place = Some(rest);
        self.integrals.extend(linked);
    }

    /// What a phase minimises; the last one is known by its number.
    pub fn of_phase(&self, graph: &mut Graph, j: usize, last: usize) -> Option<ExprId> {
        let own =
            [self.of_each, self.of_first.filter(|_| j == 0), self.of_last.filter(|_| j == last)];
        let own: Vec<ExprId> = own.into_iter().flatten().collect();
        (!own.is_empty()).then(|| graph.sum(&own))
    }
}

/// The inputs of an expression that are integrals or sums over rows.
fn over_time(model: &Model, graph: &Graph, value: ExprId) -> Vec<u32> {
    let mut inputs = graph.inputs_of(&[value]);
    inputs.retain(|at| matches!(model.symbols[*at as usize], Symbol::Integral(_) | Symbol::Sum(_)));
    inputs
}

/// The integrals that some expressions read.
fn integrals(model: &Model, graph: &Graph, roots: &[ExprId]) -> Vec<usize> {
    let integral = |at: u32| match model.symbols[at as usize] {
        Symbol::Integral(integral) => Some(integral),
        _ => None,
    };
    graph.inputs_of(roots).into_iter().filter_map(integral).collect()
}

/// Whether a value is a number once the parameters are known.
pub(super) fn is_given(model: &Model, graph: &Graph, value: ExprId) -> bool {
    let inputs = graph.inputs_of(&[value]);
    inputs.iter().all(|at| matches!(model.symbols[*at as usize], Symbol::Param(_)))
}
