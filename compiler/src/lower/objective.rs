//! The objective taken apart: `J = M(x(start), x(end), p) + sum_k c_k integral(e_k)`.
//!
//! Where `c_k` depends on parameters alone the integral is running cost, `sum_k c_k e_k`. Where an
//! integral enters otherwise, or stands in a condition, it becomes one more state `q' = e_k,
//! q(start) = 0`. A sum over rows of measured data is taken apart in the same way; as a state it
//! grows at the times of its rows.

use super::boundary::is_fixed;
use super::origin;
use crate::expressions::graph::derivative::derivative;
use crate::expressions::graph::{ExprId, Graph};
use crate::model::{Model, Place, Symbol};
use fdcc_runtime::problem::Origin;

/// The parts of the objective of the minimisation problem.
pub(crate) struct Objective {
    /// `M`, with the integrals and sums that became states.
    pub mayer: ExprId,
    /// The integrand of the running cost.
    pub running: Option<ExprId>,
    /// The sums of the objective, with their factors.
    pub measured: Vec<(usize, ExprId)>,
    /// The integrals and sums that became states.
    pub hidden: Vec<Hidden>,
    /// Where it stands.
    pub origin: Origin,
}

impl Objective {
    /// The sums that it or a condition needs.
    pub fn sums(&self) -> Vec<usize> {
        let in_states = self.hidden.iter().filter_map(|it| match it {
            Hidden::Sum(sum) => Some(*sum),
            Hidden::Integral(_) => None,
        });
        self.measured.iter().map(|it| it.0).chain(in_states).collect()
    }
}

/// What became a state.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Hidden {
    /// One of [`Model::integrals`].
    Integral(usize),
    /// One of [`Model::sums`].
    Sum(usize),
}

impl Hidden {
    /// What it is the value of at the end.
    pub(crate) fn symbol(self) -> Symbol {
        match self {
            Hidden::Integral(at) => Symbol::Integral(at),
            Hidden::Sum(at) => Symbol::Sum(at),
        }
    }

    /// Where it is written.
    pub(crate) fn place(self, model: &Model) -> &Place {
        match self {
            Hidden::Integral(at) => &model.integrals[at].place,
            Hidden::Sum(at) => &model.sums[at].place,
        }
    }
}

/// Takes the objective apart.
pub(crate) fn split(model: &Model, graph: &mut Graph) -> Objective {
    let zero = graph.number(0.0);
    let (origin, value) = match &model.objective {
        Some((place, value)) => (origin(place), graph.scale(model.sense, *value)),
        None => (Origin::default(), zero),
    };
    let rows: Vec<ExprId> = model.boundary.iter().map(|row| row.value).collect();
    let mut hidden = hidden_in(model, graph, &rows);
    let linked = (0..model.integrals.len()).filter(|&at| model.integrals[at].is_linked);
    hidden.extend(linked.map(Hidden::Integral));
    let mut split = Objective { mayer: value, running: None, measured: Vec::new(), hidden, origin };
    let (mut running, mut apart) = (Vec::new(), Vec::new());
    for it in hidden_in(model, graph, &[value]) {
        let input = model.input_of(it.symbol()).expect("it was found among the inputs");
        let factor = derivative(graph, value, input);
        if !is_fixed(model, graph, factor) {
            split.hidden.push(it);
            continue;
        }
        apart.push(input);
        match it {
            Hidden::Integral(at) => running.push(graph.mul(factor, model.integrals[at].integrand)),
            Hidden::Sum(at) => split.measured.push((at, factor)),
        }
    }
    if !running.is_empty() {
        split.running = Some(graph.sum(&running));
    }
    let without = |input: u32| apart.contains(&input).then_some(zero);
    split.mayer = graph.substitute(&[value], &without)[0];
    split.hidden.sort_unstable();
    split.hidden.dedup();
    split
}

/// The [integrals](Model::integrals) that become states, in the order of these.
pub(crate) fn integrals_in_states(model: &Model) -> Vec<usize> {
    let hidden = split(model, &mut model.graph.clone()).hidden.into_iter();
    let integral = |it| match it {
        Hidden::Integral(at) => Some(at),
        Hidden::Sum(_) => None,
    };
    hidden.filter_map(integral).collect()
}

/// The integrals and sums that some expressions read.
pub(crate) fn hidden_in(model: &Model, graph: &Graph, roots: &[ExprId]) -> Vec<Hidden> {
    let inputs = graph.inputs_of(roots);
    let hidden = |input: u32| match model.symbols[input as usize] {
        Symbol::Integral(index) => Some(Hidden::Integral(index)),
        Symbol::Sum(index) => Some(Hidden::Sum(index)),
        _ => None,
    };
    inputs.into_iter().filter_map(hidden).collect()
}
