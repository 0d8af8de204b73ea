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
    /// What was measured and what the root is a part of: the root is `factor (signal - measured)`.
    reading: Option<Reading>,
}

/// Both over columns and parameters.
struct Reading {
    measured: ExprId,
    factor: ExprId,
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
        let of_time = graph.inputs_of(&[model.sums[sum].time]);
        if terms.iter().any(|(_, root)| !adds_error(model, &graph, &of_time, *root)) {
            return (graph, Vec::new());
        }
        for (weight, root) in terms {
            let name = name(model, &graph, sum, root);
            let reading = reading(model, &mut graph, root);
            let root = measured::alone(model, &mut graph, &sizes, (sum, root), &dynamics);
            squares.push(Square { weight, root, name, reading });
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
        let weights = self.in_rows(model, graph, numbers, self.weight);
        weights.iter().all(|it| *it >= 0.0).then(|| weights.iter().map(|it| it.sqrt()).collect())
    }

    /// What was measured in each row, and by which factor its difference to the signal is in the
    /// root; none where the root is no such difference.
    pub(crate) fn readings(
        &self,
        model: &Model,
        graph: &Graph,
        numbers: &Numbers,
    ) -> Option<[Vec<f64>; 2]> {
        let Reading { measured, factor } = self.reading.as_ref()?;
        Some([measured, factor].map(|it| self.in_rows(model, graph, numbers, *it)))
    }

    fn in_rows(&self, model: &Model, graph: &Graph, numbers: &Numbers, it: ExprId) -> Vec<f64> {
        let at = model.sums[self.root.sum].table;
        let table = (at, &model.tables[at]);
        by_row(graph, &model.symbols, table, it, numbers.inputs().to_vec())
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

/// Whether an error of what was measured adds to a root, as to `(signal - measured)/deviation`. The
/// square of a root such as `(signal - measured)^2` or `tanh(signal - measured)` is another loss
/// than least squares, and says nothing of standard errors in this way.
fn adds_error(model: &Model, graph: &Graph, of_time: &[u32], root: ExprId) -> bool {
    let is_weight = |id| is_weight(model, graph, id);
    let is_measured = |id| graph.inputs_of(&[id]).iter().any(|it| is_column(model, of_time, *it));
    let adds = |id| adds_error(model, graph, of_time, id);
    if is_weight(root) || !is_measured(root) {
        return true;
    }
    for sum in [Builtin::Add, Builtin::Sub] {
        if let Some(&[a, b]) = graph.as_call(root, sum) {
            let is_reading = |id| is_weight(id) && is_measured(id);
            return is_reading(a) || is_reading(b) || adds(a) && adds(b);
        }
    }
    for same in [Builtin::Neg, Builtin::Abs] {
        if let Some(&[a]) = graph.as_call(root, same) {
            return adds(a);
        }
    }
    // The logarithm of a product is a sum.
    let (root, is_logarithm) = match graph.as_call(root, Builtin::Log) {
        Some(&[of]) => (of, true),
        _ => (root, false),
    };
    // What is 0 but for the error is so by any factor.
    let is_factor = |id| is_weight(id) || !is_measured(id);
    match (graph.as_call(root, Builtin::Mul), graph.as_call(root, Builtin::Div)) {
        (Some(&[a, b]), _) | (_, Some(&[a, b])) if is_logarithm => is_factor(a) && is_factor(b),
        (Some(&[a, b]), _) => is_factor(a) && adds(b) || is_factor(b) && adds(a),
        (_, Some(&[a, b])) => is_factor(b) && adds(a),
        _ => false,
    }
}

/// Whether an input is a column, but for those that say when.
fn is_column(model: &Model, of_time: &[u32], input: u32) -> bool {
    let is_column = matches!(model.symbols[input as usize], Symbol::Column(..));
    is_column && !of_time.contains(&input)
}

/// The measurement in a root such as `(signal - measured)/deviation`.
fn reading(model: &Model, graph: &mut Graph, root: ExprId) -> Option<Reading> {
    let (mut factor, mut rest) = (graph.number(1.0), root);
    loop {
        if let Some(&[a, b]) = graph.as_call(rest, Builtin::Sub) {
            if is_weight(model, graph, b) {
                return Some(Reading { measured: b, factor });
            }
            let factor = graph.neg(factor);
            return is_weight(model, graph, a).then_some(Reading { measured: a, factor });
        }
        if let Some(&[a]) = graph.as_call(rest, Builtin::Neg) {
            (factor, rest) = (graph.neg(factor), a);
        } else if let Some(&[a, b]) = graph.as_call(rest, Builtin::Div) {
            is_weight(model, graph, b).then_some(())?;
            (factor, rest) = (graph.div(factor, b), a);
        } else {
            let &[a, b] = graph.as_call(rest, Builtin::Mul)? else { return None };
            let (own, other) = if is_weight(model, graph, a) { (a, b) } else { (b, a) };
            is_weight(model, graph, own).then_some(())?;
            (factor, rest) = (graph.mul(factor, own), other);
        }
    }
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
