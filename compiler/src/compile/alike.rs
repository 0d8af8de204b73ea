//! Functions that are alike are compiled once, and share their machine code: those of phases that
//! differ only in which unknowns are the times at their ends.

use crate::expressions::graph::builtins::Builtin;
use crate::expressions::graph::{ById, Expr, ExprId, Graph, Operands};
use crate::lower::VectorFunction;
use fdcc_runtime::problem::{Columns, Degree, Function, Layout, Origin, Pattern};
use std::collections::HashMap;
use std::hash::{DefaultHasher, Hash, Hasher};
use std::sync::Arc;

/// The functions that have been compiled, by what they compute.
#[derive(Default)]
pub struct Alike {
    known: HashMap<Vec<u64>, Known>,
}

/// A compiled function with the entries of `p` that it reads, ascending.
#[derive(Clone)]
struct Known {
    function: Arc<dyn Function>,
    reads: Vec<u32>,
}

impl Alike {
    /// The functions of a graph, with what compiles those that are like none before.
    pub(super) fn compiled(
        &mut self,
        graph: Graph,
        functions: Vec<VectorFunction>,
        compile: impl FnOnce(Graph, Vec<VectorFunction>) -> Vec<Arc<dyn Function>>,
    ) -> Vec<Arc<dyn Function>> {
        let keys: Vec<(Vec<u64>, Vec<u32>)> = functions.iter().map(|it| key(&graph, it)).collect();
        let mut new: Vec<usize> = Vec::new();
        for (at, (key, _)) in keys.iter().enumerate() {
            let is_known = self.known.contains_key(key) || new.iter().any(|it| keys[*it].0 == *key);
            new.extend((!is_known).then_some(at));
        }
        let missing = new.iter().map(|at| functions[*at].clone()).collect();
        let made = if new.is_empty() { Vec::new() } else { compile(graph, missing) };
        for (at, function) in new.into_iter().zip(made) {
            let (key, reads) = keys[at].clone();
            self.known.insert(key, Known { function, reads });
        }
        let all = functions.into_iter().zip(keys);
        all.map(|(function, (key, reads))| self.known[&key].reading(reads, function.origins))
            .collect()
    }
}

impl Known {
    /// The same function of other entries of `p`.
    fn reading(&self, reads: Vec<u32>, origins: Vec<Origin>) -> Arc<dyn Function> {
        let is_same = (0..origins.len()).all(|row| self.function.origin(row) == origins[row]);
        if reads == self.reads && is_same {
            return Arc::clone(&self.function);
        }
        let layout = self.function.layout();
        let moves: Vec<(usize, usize)> = self
            .reads
            .iter()
            .zip(&reads)
            .map(|(to, from)| (*to as usize, *from as usize))
            .collect();
        let first = layout.parameters().start;
        let column = |column: u32| {
            let own = (column as usize).checked_sub(first);
            let moved = own.and_then(|own| moves.iter().find(|it| it.0 == own));
            moved.map_or(column, |it| (first + it.1) as u32)
        };
        let jacobian = moved(self.function.jacobian_pattern(), |(row, it)| (row, column(it)));
        let hessian = moved(self.function.hessian_pattern(), |(a, b)| (column(a), column(b)));
        let function = Arc::clone(&self.function);
        Arc::new(Moved { function, moves, origins, jacobian, hessian })
    }
}

fn moved(pattern: &Pattern, entry: impl Fn((u32, u32)) -> (u32, u32)) -> Pattern {
    Pattern { entries: pattern.entries.iter().copied().map(entry).collect(), ..*pattern }
}

/// What a function computes, and the entries of `p` that it reads: equal keys are equal functions
/// of these, one after the other.
fn key(graph: &Graph, function: &VectorFunction) -> (Vec<u64>, Vec<u32>) {
    let parameters = function.layout.parameters();
    let first = parameters.start as u32;
    let is_parameter = |input: &u32| parameters.contains(&(*input as usize));
    let inputs = graph.inputs_of(&function.outputs).into_iter().filter(is_parameter);
    let reads: Vec<u32> = inputs.map(|it| it - first).collect();
    let place =
        |input: u32| match is_parameter(&input).then(|| reads.binary_search(&(input - first))) {
            Some(Ok(rank)) => u64::from(first) + rank as u64,
            Some(Err(_)) => u64::MAX,
            None => u64::from(input),
        };
    let Layout { t, x, u, p, s } = function.layout;
    let mut key: Vec<u64> = [t, x, u, p, s, function.order as usize].map(|it| it as u64).into();
    // What is differentiated by an entry that is not read is 0.
    let by = function.by.iter().map(|by| place(*by)).filter(|it| *it != u64::MAX);
    push_list(&mut key, by.collect());
    let mut written = Written { graph, place: &place, numbers: ById::default(), text: Vec::new() };
    let outputs = written.numbers_of(&function.outputs);
    push_list(&mut key, outputs);
    key.append(&mut written.text);
    (key, reads)
}

fn push_list(key: &mut Vec<u64>, list: Vec<u64>) {
    key.push(list.len() as u64);
    key.extend(list);
}

/// Expressions in an order that does not depend on when they were made.
struct Written<'g> {
    graph: &'g Graph,
    /// The place of an input.
    place: &'g dyn Fn(u32) -> u64,
    numbers: ById<u64>,
    text: Vec<u64>,
}

impl Written<'_> {
    /// Writes all that some expressions need; the number of each.
    fn numbers_of(&mut self, roots: &[ExprId]) -> Vec<u64> {
        let hashes = self.hashes(roots);
        let mut stack: Vec<ExprId> = roots.iter().rev().copied().collect();
        while let Some(&id) = stack.last() {
            let operands = self.ordered(id, &hashes);
            let before = stack.len();
            let is_open = |it: &&ExprId| !self.numbers.contains_key(it);
            stack.extend(operands.iter().rev().filter(is_open));
            if stack.len() == before {
                stack.pop();
                self.write(id, &operands);
            }
        }
        roots.iter().map(|root| self.numbers[root]).collect()
    }

    fn write(&mut self, id: ExprId, operands: &[ExprId]) {
        if self.numbers.contains_key(&id) {
            return;
        }
        self.numbers.insert(id, self.numbers.len() as u64);
        let head = self.head(id);
        self.text.extend(head);
        self.text.extend(operands.iter().map(|it| self.numbers[it]));
    }

    /// A node without its operands.
    fn head(&self, id: ExprId) -> [u64; 2] {
        match self.graph.expr(id) {
            Expr::Number(bits) => [0, bits.value().to_bits()],
            Expr::Input(input) => [1, (self.place)(*input)],
            Expr::Multiplier(output) => [2, u64::from(*output)],
            Expr::Call(builtin, _) => [3, *builtin as u64],
        }
    }

    /// The operands; of a sum and of a product in the order of their hashes.
    fn ordered(&self, id: ExprId, hashes: &ById<u64>) -> Operands {
        let mut operands = Operands::from_slice(self.graph.operands(id));
        if matches!(self.graph.expr(id), Expr::Call(Builtin::Add | Builtin::Mul, _)) {
            operands.sort_by_key(|it| hashes[it]);
        }
        operands
    }

    fn hashes(&self, roots: &[ExprId]) -> ById<u64> {
        let mut hashes = ById::default();
        for id in self.graph.reachable(roots) {
            let mut hasher = DefaultHasher::new();
            self.head(id).hash(&mut hasher);
            let operands = self.ordered(id, &hashes);
            operands.iter().for_each(|it| hashes[it].hash(&mut hasher));
            hashes.insert(id, hasher.finish());
        }
        hashes
    }
}

/// A function that reads other entries of `p` than the one that was compiled.
struct Moved {
    function: Arc<dyn Function>,
    /// The place that the compiled function reads, and the one that is meant.
    moves: Vec<(usize, usize)>,
    origins: Vec<Origin>,
    jacobian: Pattern,
    hessian: Pattern,
}

impl Moved {
    fn parameters(&self, parameters: &[f64]) -> Vec<f64> {
        let mut moved = parameters.to_vec();
        self.moves.iter().for_each(|(to, from)| moved[*to] = parameters[*from]);
        moved
    }
}

impl Function for Moved {
    fn layout(&self) -> &Layout {
        self.function.layout()
    }
    fn outputs(&self) -> usize {
        self.function.outputs()
    }
    fn jacobian_pattern(&self) -> &Pattern {
        &self.jacobian
    }
    fn hessian_pattern(&self) -> &Pattern {
        &self.hessian
    }
    fn degree(&self, row: usize) -> Degree {
        self.function.degree(row)
    }
    fn origin(&self, row: usize) -> Origin {
        self.origins[row].clone()
    }
    fn prepare(&self, order: usize) {
        self.function.prepare(order);
    }
    fn value(&self, points: &Columns, parameters: &[f64], values: &mut Columns) {
        self.function.value(points, &self.parameters(parameters), values);
    }
    fn jacobian(
        &self,
        points: &Columns,
        parameters: &[f64],
        values: &mut Columns,
        jacobian: &mut Columns,
    ) {
        self.function.jacobian(points, &self.parameters(parameters), values, jacobian);
    }
    fn derivatives(
        &self,
        points: &Columns,
        parameters: &[f64],
        multipliers: &Columns,
        values: &mut Columns,
        jacobian: &mut Columns,
        hessian: &mut Columns,
    ) {
        let own = self.parameters(parameters);
        self.function.derivatives(points, &own, multipliers, values, jacobian, hessian);
    }
}
