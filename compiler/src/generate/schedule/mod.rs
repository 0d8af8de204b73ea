//! Which nodes a kernel computes, in which order, and where its results go.
//!
//! What depends on parameters alone is computed once, before the loop over the points. Inside,
//! every result is computed depth first and stored at once, so that few values are alive at a time.
//! A product that is used once, by a sum, becomes part of a fused multiply-add.

pub(crate) mod arithmetic;
pub(crate) mod elementary;

use fdcc_runtime::problem::Layout;

use crate::expressions::graph::builtins::Builtin;
use crate::expressions::graph::{ById, Expr, ExprId, Graph, Operands};

/// The tables that a kernel writes.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) enum Table {
    Values,
    Jacobian,
    Hessian,
}

/// A column of a table.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) struct Slot {
    pub table: Table,
    pub column: usize,
}

/// How a node is computed.
#[derive(Clone, PartialEq, Debug)]
pub(crate) enum Operation {
    /// A column of the points.
    Point(usize),
    Parameter(usize),
    /// A column of the multipliers.
    Multiplier(usize),
    Call(Builtin, Operands),
    /// `a b + c`
    MultiplyAdd([ExprId; 3]),
    /// `a b - c`
    MultiplySubtract([ExprId; 3]),
    /// `c - a b`
    SubtractProduct([ExprId; 3]),
}

impl Operation {
    pub(crate) fn operands(&self) -> &[ExprId] {
        match self {
            Operation::Call(_, operands) => operands,
            Operation::MultiplyAdd(operands)
            | Operation::MultiplySubtract(operands)
            | Operation::SubtractProduct(operands) => operands,
            _ => &[],
        }
    }
}

/// The work of one kernel.
#[derive(Debug, Default)]
pub(crate) struct Schedule {
    /// Once: independent of the point.
    pub before: Vec<(ExprId, Operation)>,
    /// For every pair of points.
    pub inside: Vec<(ExprId, Operation)>,
    /// Where results of these computations are stored.
    pub varying: ById<Vec<Slot>>,
    /// Results that are the same at all points, to be stored for each of them.
    pub constant: Vec<(ExprId, Slot)>,
}

/// The order of work for results and their places.
pub(crate) fn schedule(graph: &Graph, layout: &Layout, results: &[(ExprId, Slot)]) -> Schedule {
    let nodes = Nodes::new(graph, layout, results);
    let mut schedule = Schedule::default();
    let mut done = vec![false; nodes.varying.len()];
    for &(root, place) in results {
        nodes.visit(root, &mut done, &mut schedule);
        if nodes.varying[root.index()] {
            schedule.varying.entry(root).or_default().push(place);
        } else {
            schedule.constant.push((root, place));
        }
    }
    schedule
}

/// What must be known of all needed nodes before they can be put in order; indexed by node.
struct Nodes<'a> {
    graph: &'a Graph,
    layout: &'a Layout,
    uses: Vec<u32>,
    varying: Vec<bool>,
}

impl<'a> Nodes<'a> {
    fn new(graph: &'a Graph, layout: &'a Layout, results: &[(ExprId, Slot)]) -> Self {
        let roots: Vec<ExprId> = results.iter().map(|(root, _)| *root).collect();
        let needed = graph.reachable(&roots);
        let size = needed.last().map_or(0, |last| last.index() + 1);
        let mut nodes = Nodes { graph, layout, uses: vec![0; size], varying: vec![false; size] };
        roots.iter().for_each(|root| nodes.uses[root.index()] += 1);
        for id in needed {
            nodes.varying[id.index()] = nodes.varies(id);
            graph.operands(id).iter().for_each(|operand| nodes.uses[operand.index()] += 1);
        }
        nodes
    }

    fn varies(&self, id: ExprId) -> bool {
        match self.graph.expr(id) {
            Expr::Number(_) => false,
            Expr::Input(position) => !self.layout.parameters().contains(&(*position as usize)),
            Expr::Multiplier(_) => true,
            Expr::Call(_, operands) => operands.iter().any(|operand| self.varying[operand.index()]),
        }
    }

    /// Depth first, without recursion: expressions may be deeper than the stack of a thread.
    fn visit(&self, root: ExprId, done: &mut [bool], schedule: &mut Schedule) {
        let mut stack = vec![(root, false)];
        while let Some((id, operands_done)) = stack.pop() {
            if done[id.index()] {
                continue;
            }
            let Some(operation) = self.operation(id) else { continue };
            if operands_done {
                done[id.index()] = true;
                let list = if self.varying[id.index()] {
                    &mut schedule.inside
                } else {
                    &mut schedule.before
                };
                list.push((id, operation));
            } else {
                stack.push((id, true));
                stack.extend(operation.operands().iter().rev().map(|&operand| (operand, false)));
            }
        }
    }

    /// None for a number: those are written where they are used.
    fn operation(&self, id: ExprId) -> Option<Operation> {
        match self.graph.expr(id) {
            Expr::Number(_) => None,
            Expr::Input(position) => Some(self.input(*position as usize)),
            Expr::Multiplier(output) => Some(Operation::Multiplier(*output as usize)),
            Expr::Call(builtin, operands) => {
                let call = || Operation::Call(*builtin, operands.clone());
                Some(self.fused(id, *builtin, operands).unwrap_or_else(call))
            }
        }
    }

    fn input(&self, position: usize) -> Operation {
        let parameters = self.layout.parameters();
        if parameters.contains(&position) {
            Operation::Parameter(position - parameters.start)
        } else if position < parameters.start {
            Operation::Point(position)
        } else {
            Operation::Point(position - parameters.len())
        }
    }

    fn fused(&self, id: ExprId, builtin: Builtin, operands: &[ExprId]) -> Option<Operation> {
        let &[a, b] = operands else { return None };
        let product = |operand| self.product_of_its_own(id, operand);
        match builtin {
            Builtin::Add => product(a)
                .map(|[x, y]| Operation::MultiplyAdd([x, y, b]))
                .or_else(|| product(b).map(|[x, y]| Operation::MultiplyAdd([x, y, a]))),
            Builtin::Sub => product(b)
                .map(|[x, y]| Operation::SubtractProduct([x, y, a]))
                .or_else(|| product(a).map(|[x, y]| Operation::MultiplySubtract([x, y, b]))),
            _ => None,
        }
    }

    /// The factors of a product that nobody but `user` needs, and that does not belong before the
    /// loop.
    fn product_of_its_own(&self, user: ExprId, id: ExprId) -> Option<[ExprId; 2]> {
        let same_place = self.varying[id.index()] == self.varying[user.index()];
        match *self.graph.as_call(id, Builtin::Mul)? {
            [x, y] if same_place && self.uses[id.index()] == 1 => Some([x, y]),
            _ => None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const LAYOUT: Layout = Layout { t: 0, x: 2, u: 0, p: 1, s: 0 };
    const PLACE: Slot = Slot { table: Table::Values, column: 0 };

    #[test]
    fn what_depends_on_parameters_alone_stands_before_the_loop() {
        let mut graph = Graph::new();
        let (x, p) = (graph.input(0), graph.input(2));
        let sine = graph.sin(p);
        let root = graph.mul(x, sine);
        let schedule = schedule(&graph, &LAYOUT, &[(root, PLACE)]);
        assert!(schedule.before.iter().any(|(id, _)| *id == sine));
        assert!(schedule.inside.iter().all(|(id, _)| *id != sine));
    }

    #[test]
    fn a_product_used_once_by_a_sum_is_fused() {
        let mut graph = Graph::new();
        let (x, y) = (graph.input(0), graph.input(1));
        let product = graph.mul(x, y);
        let root = graph.add(product, x);
        let schedule = schedule(&graph, &LAYOUT, &[(root, PLACE)]);
        let last = &schedule.inside[schedule.inside.len() - 1];
        assert_eq!(last.1, Operation::MultiplyAdd([x, y, x]));
    }

    #[test]
    fn a_product_used_twice_is_not_fused() {
        let mut graph = Graph::new();
        let (x, y) = (graph.input(0), graph.input(1));
        let product = graph.mul(x, y);
        let root = graph.add(product, x);
        let schedule = schedule(&graph, &LAYOUT, &[(root, PLACE), (product, PLACE)]);
        let fused =
            |(_, operation): &_| !matches!(operation, Operation::Point(_) | Operation::Call(..));
        assert!(!schedule.inside.iter().any(fused));
    }

    #[test]
    fn a_product_of_parameters_stays_before_the_loop() {
        let mut graph = Graph::new();
        let (x, p) = (graph.input(0), graph.input(2));
        let square = graph.square(p);
        let root = graph.add(square, x);
        let schedule = schedule(&graph, &LAYOUT, &[(root, PLACE)]);
        assert!(schedule.before.iter().any(|(id, _)| *id == square));
    }
}
