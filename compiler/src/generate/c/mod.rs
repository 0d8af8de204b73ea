//! Vector functions as C99 that needs nothing but `<math.h>`: kernels that do what the machine code
//! does, operation by operation, and around them the functions that CasADi calls.

mod blocks;
mod casadi;
mod comment;
mod interface;
mod kernel;
mod prelude;

use crate::differentiate::Differentiated;
use crate::expressions::graph::Graph;
use fdcc_runtime::problem::{Layout, Pattern};
use interface::Tables;
use std::ops::Range;

/// A function that leaves the compiler.
pub(crate) struct Exported<'a> {
    /// What it is called in C.
    pub name: String,
    /// What it does.
    pub symbols: &'a Differentiated,
    /// Its inputs; each position of `[t | x | u | p | s]` is in one of them.
    pub arguments: Vec<Argument>,
    /// Its outputs, one after the other.
    pub results: Vec<Part>,
}

/// An input: one or two ranges of the positions of `[t | x | u | p | s]`.
pub(crate) struct Argument {
    pub name: String,
    pub positions: [Range<usize>; 2],
    /// Whether the function is differentiated by it.
    pub is_active: bool,
    /// The names of its entries.
    pub labels: Vec<String>,
}

/// An output: some of the rows of the function.
pub(crate) struct Part {
    pub name: String,
    pub rows: Range<usize>,
    /// The names of its entries.
    pub labels: Vec<String>,
}

/// Numbers that are given, such as bounds: a function without inputs.
pub(crate) struct Given {
    pub name: String,
    pub results: Vec<(String, Vec<f64>)>,
}

impl Argument {
    fn size(&self) -> usize {
        self.positions.iter().map(|it| it.len()).sum()
    }

    /// Where a position stands in it.
    fn place(&self, position: usize) -> Option<usize> {
        let mut before = 0;
        for range in &self.positions {
            if range.contains(&position) {
                return Some(before + position - range.start);
            }
            before += range.len();
        }
        None
    }
}

impl Exported<'_> {
    fn layout(&self) -> &Layout {
        &self.symbols.function.layout
    }
    fn outputs(&self) -> usize {
        self.symbols.function.outputs.len()
    }
    fn jacobian(&self) -> &Pattern {
        &self.symbols.jacobian.0
    }
    fn hessian(&self) -> &Pattern {
        &self.symbols.hessian.0
    }
    /// Whether it has derivatives at all.
    fn is_active(&self) -> bool {
        !self.symbols.function.by.is_empty()
    }
}

/// A file in the making.
#[derive(Default)]
pub(crate) struct File {
    tables: Tables,
    text: String,
}

impl File {
    /// Writes a function whose expressions are those of a graph.
    pub fn add(&mut self, graph: &Graph, function: &Exported) {
        self.text += &comment::of(function);
        self.text += &kernel::patterns(function);
        let orders = if function.is_active() { 0..3 } else { 0..1 };
        orders.for_each(|order| self.text += &kernel::kernel(graph, function, order));
        self.text += &casadi::value(function, &mut self.tables);
        if function.is_active() {
            self.text += &casadi::jacobian(function, &mut self.tables);
            self.text += &casadi::adjoint(function, &mut self.tables);
            self.text += &casadi::hessian(function, &mut self.tables);
        }
    }

    /// Writes a function that gives numbers.
    pub fn give(&mut self, given: &Given) {
        self.text += &casadi::given(given, &mut self.tables);
    }

    /// The file, with a comment on top.
    pub fn finish(self, head: &str) -> String {
        let text = prelude::helpers(&self.text) + &self.tables.into_text() + &self.text;
        format!("{}{}{text}{}", comment::block(head), prelude::HEAD, prelude::FOOT)
    }
}
