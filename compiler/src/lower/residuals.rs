//! A sum over rows that is minimised as a sum of squares: the root of each is what remains between
//! a signal and its measurement.

use super::inputs::{self, Sizes};
use super::measured::{self, Measured};
use super::{OverGrid, objective};
use crate::expressions::graph::builtins::Builtin;
use crate::expressions::graph::{ExprId, Graph};
use crate::model::numbers::Numbers;
use crate::model::{Model, Symbol, by_row};

/// One square of a sum, `weight * root^2`.
pub(crate) struct Square {
    /// Over columns and parameters.
    weight: ExprId,
    /// Values only.
    pub(crate) root: Measured,
    /// What the root reads of the row, or else the whole sum.
    pub(crate) name: String,
}

/// All squares of the sums that are minimised; nothing if one of these is no sum of squares.
pub(crate) fn squares(model: &Model) -> (Graph, Vec<Square>) {
    let mut graph = model.graph.clone();
    let objective = objective::split(model, &mut graph);
    let sizes = Sizes::new(model, objective.hidden.len());
    let inputs = inputs::over_grid(model, &mut graph, &sizes);
    let over_grid = OverGrid { model, sizes: &sizes, inputs };
    let dynamics = over_grid.dynamics(&mut graph, &objective);
    let mut squares = Vec::new();
    for &(sum, factor) in &objective.measured {
        let value = graph.mul(factor, model.sums[sum].term);
        let Some(terms) = taken_apart(model, &mut graph, value) else {
            return (graph, Vec::new());
        };
        for (weight, root) in terms {
            let name = name(model, &graph, sum, root);
            let root = measured::alone(model, &mut graph, &sizes, (sum, root), &dynamics);
            squares.push(Square { weight, root, name });
        }
    }
    (graph, squares)
}

impl Square {
    /// The square root of the weight of each row; none if a weight is below 0.
    pub(crate) fn weights(
        &self,
        model: &Model,
        graph: &Graph,
        numbers: &Numbers,
    ) -> Option<Vec<f64>> {
        let at = model.sums[self.root.sum].table;
        let table = (at, &model.tables[at]);
        let inputs = numbers.inputs().to_vec();
        let weights = by_row(graph, &model.symbols, table, self.weight, inputs);
        weights.iter().all(|it| *it >= 0.0).then(|| weights.iter().map(|it| it.sqrt()).collect())
    }
}

/// Weights and roots of a sum of squares.
fn taken_apart(model: &Model, graph: &mut Graph, value: ExprId) -> Option<Vec<(ExprId, ExprId)>> {
    let mut open = vec![(graph.number(1.0), value)];
    let mut squares = Vec::new();
    while let Some((weight, id)) = open.pop() {
        if let Some(&[a, b]) = graph.as_call(id, Builtin::Add) {
            open.extend([(weight, b), (weight, a)]);
            continue;
        }
        let Some(&[a, b]) = graph.as_call(id, Builtin::Mul) else { return None };
        if a == b {
            squares.push((weight, a));
            continue;
        }
        let (factor, rest) = if is_weight(model, graph, a) { (a, b) } else { (b, a) };
        if !is_weight(model, graph, factor) {
            return None;
        }
        open.push((graph.mul(weight, factor), rest));
    }
    Some(squares)
}

fn is_weight(model: &Model, graph: &Graph, id: ExprId) -> bool {
    graph
        .inputs_of(&[id])
        .into_iter()
        .all(|input| matches!(model.symbols[input as usize], Symbol::Column(..) | Symbol::Param(_)))
}

/// The signal of a `fit`; else the only column that the root reads, but for the time.
fn name(model: &Model, graph: &Graph, sum: usize, root: ExprId) -> String {
    let it = &model.sums[sum];
    if it.is_fit {
        return it.place.name.clone();
    }
    let of_time = graph.inputs_of(&[it.time]);
    let columns = graph.inputs_of(&[root]).into_iter().filter(|at| !of_time.contains(at));
    let mut columns = columns.filter_map(|input| match model.symbols[input as usize] {
        Symbol::Column(table, column) => model.tables[table].names.get(column),
        _ => None,
    });
    match (columns.next(), columns.next()) {
        (Some(column), None) => column.clone(),
        _ => it.place.name.clone(),
    }
}
