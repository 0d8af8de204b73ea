//! The values of expressions over a box: one pass over the nodes they need, in ascending order.
//!
//! A node that is used twice is computed once, and `a * a` is seen as a square: equal expressions
//! have equal ids.

use super::{Interval, apply};
use crate::expressions::graph::builtins::Builtin;
use crate::expressions::graph::{Expr, ExprId, Graph};
use smallvec::SmallVec;

/// What is computed at one place.
pub(super) enum Instruction {
    Number(f64),
    Input(u32),
    Square(usize),
    Call(Builtin, SmallVec<[usize; 4]>),
}

/// Expressions made ready to be evaluated over many boxes.
pub(crate) struct Tape {
    pub(super) instructions: Vec<Instruction>,
    pub(super) roots: Vec<usize>,
    pub(super) values: Vec<Interval>,
}

impl Tape {
    /// For the values of some expressions.
    pub fn new(graph: &Graph, roots: &[ExprId]) -> Self {
        let needed = graph.reachable(roots);
        let at = |id: &ExprId| needed.binary_search(id).expect("operands are reachable");
        let step = |id: &ExprId| match graph.expr(*id) {
            Expr::Number(bits) => Instruction::Number(bits.value()),
            Expr::Input(position) => Instruction::Input(*position),
            Expr::Multiplier(_) => unreachable!("an expression of a model has no multipliers"),
            Expr::Call(Builtin::Mul, operands) if operands[0] == operands[1] => {
                Instruction::Square(at(&operands[0]))
            }
            Expr::Call(builtin, operands) => {
                Instruction::Call(*builtin, operands.iter().map(at).collect())
            }
        };
        Tape {
            instructions: needed.iter().map(step).collect(),
            roots: roots.iter().map(at).collect(),
            values: vec![Interval::ALL; needed.len()],
        }
    }

    /// How many operations an evaluation takes.
    pub fn cost(&self) -> usize {
        self.instructions.len()
    }

    /// The inputs that are read.
    pub fn inputs(&self) -> impl Iterator<Item = u32> {
        self.instructions.iter().filter_map(|step| match step {
            Instruction::Input(position) => Some(*position),
            _ => None,
        })
    }

    /// Enclosures of all values over a box, which has an interval for each input.
    pub fn evaluate(&mut self, domain: &[Interval]) -> Vec<Interval> {
        self.evaluate_over(|at| domain[at]).collect()
    }

    /// The same over the box with these intervals, by input.
    pub fn evaluate_over(
        &mut self,
        domain: impl Fn(usize) -> Interval,
    ) -> impl Iterator<Item = Interval> {
        for (at, step) in self.instructions.iter().enumerate() {
            self.values[at] = match step {
                Instruction::Number(value) => Interval::point(*value),
                Instruction::Input(position) => domain(*position as usize),
                Instruction::Square(operand) => self.values[*operand].square(),
                Instruction::Call(builtin, operands) => match operands.as_slice() {
                    [one] => apply(*builtin, &[self.values[*one]]),
                    [a, b] => apply(*builtin, &[self.values[*a], self.values[*b]]),
                    all => {
                        let operands: SmallVec<[Interval; 4]> =
                            all.iter().map(|&at| self.values[at]).collect();
                        apply(*builtin, &operands)
                    }
                },
            };
        }
        self.roots.iter().map(|&root| self.values[root])
    }
}
