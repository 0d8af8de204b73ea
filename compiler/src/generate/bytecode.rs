//! A schedule interpreted instruction by instruction, on a few points at once.
//!
//! Machine code is several times as fast, but it takes as long to make as this takes for thousands
//! of points.

use smallvec::SmallVec;

use super::function::Call;
use super::numbers::{Block, Numbers};
use super::schedule::arithmetic::{self, Arithmetic};
use super::schedule::{Operation, Schedule, Slot};
use crate::expressions::graph::{ExprId, Graph};

/// Points side by side, where there are many: so many that finding out what to do is little beside
/// doing it.
const MANY: usize = 16;

/// A schedule whose operands and results are places in one list: constants, then what each
/// instruction computes.
pub(super) struct Bytecode {
    constants: Vec<f64>,
    instructions: Vec<Instruction>,
    /// So many of them, the first, do not depend on the point.
    before: usize,
    /// What is stored where.
    results: Vec<(usize, Slot)>,
    /// Whether the machine has a fused multiply-add.
    fused: bool,
}

struct Instruction {
    operation: Operation,
    operands: SmallVec<[usize; 4]>,
}

impl Bytecode {
    pub(super) fn new(graph: &Graph, schedule: &Schedule, fused: bool) -> Self {
        let all: Vec<&(ExprId, Operation)> =
            schedule.before.iter().chain(&schedule.inside).collect();
        let read = all.iter().flat_map(|(_, operation)| operation.operands());
        let stored = schedule.constant.iter().map(|(id, _)| id);
        let mut list = List { constants: Vec::new(), places: vec![0; graph.len()] };
        read.chain(stored).for_each(|&id| list.enter_constant(graph, id));
        for (at, (id, _)) in all.iter().enumerate() {
            list.places[id.index()] = list.constants.len() + at;
        }
        let place = |id: &ExprId| list.places[id.index()];
        let varying =
            schedule.varying.iter().flat_map(|(id, to)| to.iter().map(move |to| (place(id), *to)));
        let constant = schedule.constant.iter().map(|(id, to)| (place(id), *to));
        let results = varying.chain(constant).collect();
        let step = |(_, operation): &(ExprId, Operation)| Instruction {
            operation: operation.clone(),
            operands: operation.operands().iter().map(place).collect(),
        };
        let instructions = all.into_iter().map(step).collect();
        Bytecode {
            instructions,
            before: schedule.before.len(),
            results,
            constants: list.constants,
            fused,
        }
    }

    /// Fills the tables of a call.
    pub(super) fn run(&self, call: &mut Call) {
        match call.count {
            1 | 2 => self.run_on::<2>(call),
            _ => self.run_on::<MANY>(call),
        }
    }

    fn run_on<const POINTS: usize>(&self, call: &mut Call) {
        let (before, inside) = self.instructions.split_at(self.before);
        let mut list: Vec<Block<POINTS>> =
            Vec::with_capacity(self.constants.len() + self.instructions.len());
        list.extend(self.constants.iter().map(|&number| [number; POINTS]));
        let mut numbers = Numbers { fused: self.fused, points: POINTS };
        before.iter().for_each(|step| list.push(step.value(call, 0, &mut numbers, &list)));
        let points = call.count.next_multiple_of(2);
        for first in (0..points).step_by(POINTS) {
            numbers.points = POINTS.min(points - first);
            list.truncate(self.constants.len() + self.before);
            inside.iter().for_each(|step| list.push(step.value(call, first, &mut numbers, &list)));
            for &(result, place) in &self.results {
                call.store(place, first, &list[result][..numbers.points]);
            }
        }
    }
}

impl Instruction {
    /// What the points from `first` on have, given all that comes before.
    fn value<const POINTS: usize>(
        &self,
        call: &Call,
        first: usize,
        on: &mut Numbers<POINTS>,
        list: &[Block<POINTS>],
    ) -> Block<POINTS> {
        let operand = |which: usize| list[self.operands[which]];
        match &self.operation {
            Operation::Point(column) => on.read(&call.points[column * call.stride + first..]),
            Operation::Multiplier(column) => {
                on.read(&call.multipliers[column * call.stride + first..])
            }
            Operation::Parameter(index) => on.number(call.parameters[*index]),
            Operation::Call(builtin, _) => {
                let operands: SmallVec<[Block<POINTS>; 4]> =
                    (0..self.operands.len()).map(operand).collect();
                arithmetic::call(on, *builtin, &operands)
            }
            Operation::MultiplyAdd(_) => on.multiply_add(operand(0), operand(1), operand(2)),
            Operation::MultiplySubtract(_) => {
                on.multiply_subtract(operand(0), operand(1), operand(2))
            }
            Operation::SubtractProduct(_) => {
                on.subtract_product(operand(0), operand(1), operand(2))
            }
        }
    }
}

/// The list in the making.
struct List {
    constants: Vec<f64>,
    /// By node.
    places: Vec<usize>,
}

impl List {
    /// A number enters once; what is computed comes later.
    fn enter_constant(&mut self, graph: &Graph, id: ExprId) {
        if let Some(number) = graph.as_number(id)
            && self.constants.get(self.places[id.index()]).map(|it| it.to_bits())
                != Some(number.to_bits())
        {
            self.places[id.index()] = self.constants.len();
            self.constants.push(number);
        }
    }
}
