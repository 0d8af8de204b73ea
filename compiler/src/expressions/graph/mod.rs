//! Hash-consed expressions: equal expressions have equal ids, and nothing is ever changed or
//! removed.
//!
//! A node refers only to nodes made before it, so ascending ids are an order of evaluation and
//! every pass over a graph is a loop, never a recursion. Each node is simplified as it is made.

pub mod builtins;
pub mod derivative;
pub mod evaluate;
mod power;
pub mod print;
mod products;
mod quick;
mod simplify;
pub mod verify;

use quick::Quick;
use std::collections::HashMap;
use std::hash::BuildHasherDefault;

use smallvec::SmallVec;

use builtins::Builtin;

pub use derivative::derivative;
pub use evaluate::evaluate;
pub(crate) use evaluate::evaluate_with;
pub use print::print;
pub use verify::verify;

/// So many nodes are found faster one by one than by a look at the whole graph.
const FEW: usize = 64;

/// An expression of a [`Graph`].
#[derive(Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Debug)]
pub struct ExprId(u32);

impl ExprId {
    /// Position in the graph: operands have smaller ones.
    pub fn index(self) -> usize {
        self.0 as usize
    }
}

/// What is known of some nodes.
pub(crate) type ById<T> = HashMap<ExprId, T, BuildHasherDefault<Quick>>;

/// A number that can be compared and hashed: its bits, with one zero and one NaN.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub struct OrderedBits(u64);

impl OrderedBits {
    /// The bits of `value`.
    pub fn new(value: f64) -> Self {
        let canonical = if value.is_nan() { f64::NAN } else { value + 0.0 };
        OrderedBits(canonical.to_bits())
    }
    /// The number.
    pub fn value(self) -> f64 {
        f64::from_bits(self.0)
    }
}

/// The operands of a call.
pub type Operands = SmallVec<[ExprId; 2]>;

/// One node.
#[derive(Clone, PartialEq, Eq, Hash, Debug)]
pub enum Expr {
    /// A constant.
    Number(OrderedBits),
    /// An entry of `z = [t | x | u | p | s]`.
    Input(u32),
    /// The multiplier of one output in the Lagrangian.
    Multiplier(u32),
    /// A function of the table applied to operands.
    Call(Builtin, Operands),
}

/// A growing set of expressions.
#[derive(Clone, Default)]
pub struct Graph {
    nodes: Vec<Expr>,
    ids: HashMap<Expr, ExprId, BuildHasherDefault<Quick>>,
}

impl Graph {
    /// No expressions.
    pub fn new() -> Self {
        Self::default()
    }

    /// Number of nodes.
    pub fn len(&self) -> usize {
        self.nodes.len()
    }
    /// Whether nothing has been made yet.
    pub fn is_empty(&self) -> bool {
        self.nodes.is_empty()
    }
    /// The node behind an id.
    pub fn expr(&self, id: ExprId) -> &Expr {
        &self.nodes[id.index()]
    }
    /// The value of a constant.
    pub fn as_number(&self, id: ExprId) -> Option<f64> {
        match self.expr(id) {
            Expr::Number(bits) => Some(bits.value()),
            _ => None,
        }
    }
    /// The operands, if `id` calls `builtin`.
    pub fn as_call(&self, id: ExprId, builtin: Builtin) -> Option<&[ExprId]> {
        match self.expr(id) {
            Expr::Call(called, operands) if *called == builtin => Some(operands),
            _ => None,
        }
    }
    /// The operands; none for leaves.
    pub fn operands(&self, id: ExprId) -> &[ExprId] {
        match self.expr(id) {
            Expr::Call(_, operands) => operands,
            _ => &[],
        }
    }

    /// A constant.
    pub fn number(&mut self, value: f64) -> ExprId {
        self.intern(Expr::Number(OrderedBits::new(value)))
    }
    /// An entry of `z`.
    pub fn input(&mut self, position: u32) -> ExprId {
        self.intern(Expr::Input(position))
    }
    /// The multiplier of an output.
    pub fn multiplier(&mut self, output: u32) -> ExprId {
        self.intern(Expr::Multiplier(output))
    }
    /// A function applied to operands, simplified.
    pub fn call(&mut self, builtin: Builtin, operands: &[ExprId]) -> ExprId {
        assert_eq!(operands.len(), builtin.row().arity, "operands of {}", builtin.row().name);
        simplify::simplify(self, builtin, operands)
    }

    /// The node itself, without simplification.
    fn intern(&mut self, expr: Expr) -> ExprId {
        if let Some(&id) = self.ids.get(&expr) {
            return id;
        }
        let id = ExprId(
            u32::try_from(self.nodes.len()).expect("fewer than 2^32 expressions fit in memory"),
        );
        self.nodes.push(expr.clone());
        self.ids.insert(expr, id);
        id
    }

    /// Everything the roots need, themselves included, operands first. Little of a large graph
    /// costs little.
    pub fn reachable(&self, roots: &[ExprId]) -> Vec<ExprId> {
        self.few_reachable(roots).unwrap_or_else(|| self.all_reachable(roots))
    }

    /// What is reachable, if it is only a few: the last first, so that the operands of a node find
    /// their places behind it.
    fn few_reachable(&self, roots: &[ExprId]) -> Option<Vec<ExprId>> {
        let mut found = roots.to_vec();
        found.sort_unstable_by(|a, b| b.cmp(a));
        found.dedup();
        let mut done = 0;
        while let Some(&next) = found.get(done) {
            done += 1;
            for operand in self.operands(next) {
                if let Err(place) = found[done..].binary_search_by(|it| operand.cmp(it)) {
                    found.insert(done + place, *operand);
                }
            }
            if found.len() > FEW {
                return None;
            }
        }
        found.reverse();
        Some(found)
    }

    fn all_reachable(&self, roots: &[ExprId]) -> Vec<ExprId> {
        let mut needed = vec![false; roots.iter().map(|root| root.index() + 1).max().unwrap_or(0)];
        roots.iter().for_each(|root| needed[root.index()] = true);
        for index in (0..needed.len()).rev().filter(|&index| self.nodes[index].is_call()) {
            if needed[index] {
                self.operands(ExprId(index as u32))
                    .iter()
                    .for_each(|operand| needed[operand.index()] = true);
            }
        }
        (0..needed.len()).filter(|&index| needed[index]).map(|index| ExprId(index as u32)).collect()
    }

    /// The inputs that the roots depend on, ascending.
    pub fn inputs_of(&self, roots: &[ExprId]) -> Vec<u32> {
        let inputs = self.reachable(roots).into_iter().filter_map(|id| match self.expr(id) {
            Expr::Input(position) => Some(*position),
            _ => None,
        });
        let mut inputs: Vec<u32> = inputs.collect();
        inputs.sort_unstable();
        inputs
    }

    /// The roots with some inputs replaced.
    pub fn substitute(
        &mut self,
        roots: &[ExprId],
        inputs: &dyn Fn(u32) -> Option<ExprId>,
    ) -> Vec<ExprId> {
        self.rewrite(roots, |graph, original, rebuilt| match graph.expr(original) {
            Expr::Input(position) => inputs(*position).unwrap_or(rebuilt),
            _ => rebuilt,
        })
    }

    /// Copies expressions of another graph, at a cost that depends on them alone. `inputs` gives
    /// each input its meaning here.
    pub fn import(
        &mut self,
        from: &Graph,
        roots: &[ExprId],
        known: &mut ById<ExprId>,
        inputs: &mut dyn FnMut(&mut Graph, u32) -> ExprId,
    ) -> Vec<ExprId> {
        let mut stack = roots.to_vec();
        while let Some(&id) = stack.last() {
            let before = stack.len();
            stack.extend(from.operands(id).iter().rev().filter(|it| !known.contains_key(it)));
            if stack.len() == before {
                stack.pop();
                known.entry(id).or_insert_with(|| match from.expr(id) {
                    Expr::Input(position) => inputs(self, *position),
                    Expr::Call(..) => id,
                    leaf => self.intern(leaf.clone()),
                });
                if let Expr::Call(builtin, operands) = from.expr(id) {
                    let operands: Operands =
                        operands.iter().map(|operand| known[operand]).collect();
                    let copy = self.call(*builtin, &operands);
                    known.insert(id, copy);
                }
            }
        }
        roots.iter().map(|root| known[root]).collect()
    }

    /// The roots rebuilt bottom up. `replace` is given each node as it was and as it is with its
    /// operands replaced; the latter may have collapsed to something that was replaced already, so
    /// it must ask the former what to do.
    pub fn rewrite(
        &mut self,
        roots: &[ExprId],
        mut replace: impl FnMut(&mut Graph, ExprId, ExprId) -> ExprId,
    ) -> Vec<ExprId> {
        let mut replaced: ById<ExprId> = ById::default();
        for id in self.reachable(roots) {
            let rebuilt = match self.expr(id).clone() {
                Expr::Call(builtin, operands) => {
                    let operands: Operands =
                        operands.iter().map(|operand| replaced[operand]).collect();
                    self.call(builtin, &operands)
                }
                _ => id,
            };
            replaced.insert(id, replace(self, id, rebuilt));
        }
        roots.iter().map(|root| replaced[root]).collect()
    }
}

impl Expr {
    fn is_call(&self) -> bool {
        matches!(self, Expr::Call(..))
    }
}

/// One method per operator and common function, so that formulas can be written down.
macro_rules! helpers {
    ($($name:ident $builtin:ident ($($operand:ident),+);)+) => {
        impl Graph {
            $(
                #[doc = concat!("`", stringify!($name), "` of the table of builtins.")]
                pub fn $name(&mut self, $($operand: ExprId),+) -> ExprId {
                    self.call(Builtin::$builtin, &[$($operand),+])
                }
            )+
        }
    };
}

helpers! {
    add Add (a, b);
    sub Sub (a, b);
    mul Mul (a, b);
    div Div (a, b);
    neg Neg (a);
    pow Pow (a, b);
    sqrt Sqrt (a);
    exp Exp (a);
    log Log (a);
    sin Sin (a);
    cos Cos (a);
    tan Tan (a);
    tanh Tanh (a);
    atan2 Atan2 (a, b);
    abs Abs (a);
    min Min (a, b);
    max Max (a, b);
    select_le SelectLe (a, b, x, y);
}

impl Graph {
    /// `a * a`.
    pub fn square(&mut self, a: ExprId) -> ExprId {
        self.mul(a, a)
    }
    /// `factor * a`.
    pub fn scale(&mut self, factor: f64, a: ExprId) -> ExprId {
        let factor = self.number(factor);
        self.mul(factor, a)
    }
    /// `1 / a`.
    pub fn reciprocal(&mut self, a: ExprId) -> ExprId {
        let one = self.number(1.0);
        self.div(one, a)
    }
    /// The sum of terms, from left to right.
    pub fn sum(&mut self, terms: &[ExprId]) -> ExprId {
        let zero = self.number(0.0);
        terms.iter().fold(zero, |sum, &term| self.add(sum, term))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_substituted_node_that_collapses_to_an_input_is_not_substituted_again() {
        let mut graph = Graph::new();
        let (x, y) = (graph.input(0), graph.input(1));
        let quotient = graph.div(x, y);
        let (seven, product) = (graph.number(7.0), graph.mul(x, y));
        let result = graph
            .substitute(&[quotient], &|position| Some(if position == 0 { product } else { y }));
        let again = graph.substitute(&result, &|position| (position == 0).then_some(seven));
        assert_eq!((result[0], again[0]), (x, seven));
    }
}
