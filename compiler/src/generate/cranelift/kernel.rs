//! One kernel: what does not depend on the point, then the loop over pairs of points.

use std::collections::BTreeSet;
use std::mem::offset_of;

use super::pairs::{Pair, Pairs};
use super::{BlockArg, FunctionBuilder, InstBuilder, MemFlagsData, Tables, Value, memory, types};
use crate::expressions::graph::builtins::{Builtin, Inline, Lowering};
use crate::expressions::graph::{ById, ExprId, Graph};
use crate::generate::schedule::arithmetic::{self, Arithmetic};
use crate::generate::schedule::elementary;
use crate::generate::schedule::{Operation, Schedule, Slot, Table};

/// Bytes of a number and of a pair.
const NUMBER: usize = size_of::<f64>();
const PAIR: i64 = 2 * NUMBER as i64;

/// Places in [`Frame::cursors`].
const POINTS: usize = 0;
const MULTIPLIERS: usize = 1;
const VALUES: usize = 2;
const JACOBIAN: usize = 3;
const HESSIAN: usize = 4;

/// Loads may be moved to where they are needed: nobody writes to what a kernel reads.
fn input_memory() -> MemFlagsData {
    memory().with_readonly().with_can_move()
}

/// The body of a kernel, from its first block to its return.
pub(super) fn build_kernel(graph: &Graph, schedule: &Schedule, mut pairs: Pairs) {
    let frame = Frame::load(&mut pairs.builder, schedule);
    let mut emitter =
        Emitter { graph, schedule, frame, pairs, values: ById::default(), angles: ById::default() };
    emitter.steps(&schedule.before);
    emitter.all_points();
    emitter.pairs.finish();
}

/// What the kernel was called with.
struct Frame {
    parameters: Value,
    /// Pairs of points.
    pairs: Value,
    /// Bytes from column to column.
    stride: Value,
    /// Where the points at hand begin in the tables `points, multipliers, values, jacobian,
    /// hessian`.
    cursors: [Value; 5],
    /// Those of them that are used.
    used: Vec<usize>,
}

impl Frame {
    fn load(builder: &mut FunctionBuilder, schedule: &Schedule) -> Self {
        let entry = builder.create_block();
        builder.append_block_params_for_function_params(entry);
        builder.switch_to_block(entry);
        builder.seal_block(entry);
        let tables = builder.block_params(entry)[0];
        let mut field =
            |offset: usize| builder.ins().load(types::I64, memory(), tables, offset as i32);
        let parameters = field(offset_of!(Tables, parameters));
        let pairs = field(offset_of!(Tables, pairs));
        let stride = field(offset_of!(Tables, stride));
        let cursors = [
            field(offset_of!(Tables, points)),
            field(offset_of!(Tables, multipliers)),
            field(offset_of!(Tables, values)),
            field(offset_of!(Tables, jacobian)),
            field(offset_of!(Tables, hessian)),
        ];
        Frame { parameters, pairs, stride, cursors, used: used(schedule) }
    }

    /// A multiplication at every use is as cheap as an offset that is kept on the stack, and sooner
    /// compiled.
    fn address(&self, builder: &mut FunctionBuilder, cursor: usize, column: usize) -> Value {
        let column = builder.ins().iconst(types::I64, column as i64);
        let offset = builder.ins().imul(self.stride, column);
        builder.ins().iadd(self.cursors[cursor], offset)
    }

    /// To the next pair.
    fn advance(&mut self, builder: &mut FunctionBuilder) {
        for &cursor in &self.used {
            self.cursors[cursor] = builder.ins().iadd_imm_s(self.cursors[cursor], PAIR);
        }
        self.pairs = builder.ins().iadd_imm_s(self.pairs, -1);
    }

    /// What changes from pair to pair.
    fn carried(&self) -> Vec<BlockArg> {
        let cursors = self.used.iter().map(|&cursor| self.cursors[cursor]);
        cursors.chain([self.pairs]).map(BlockArg::Value).collect()
    }

    /// Takes over what [`Self::carried`] gave.
    fn carry(&mut self, carried: &[Value]) {
        for (&cursor, &value) in self.used.iter().zip(carried) {
            self.cursors[cursor] = value;
        }
        self.pairs = carried[self.used.len()];
    }
}

/// The tables that a kernel reads or writes, by their places in [`Frame::cursors`].
fn used(schedule: &Schedule) -> Vec<usize> {
    let read = schedule.inside.iter().filter_map(|(_, operation)| match operation {
        Operation::Point(_) => Some(POINTS),
        Operation::Multiplier(_) => Some(MULTIPLIERS),
        _ => None,
    });
    let places =
        schedule.varying.values().flatten().chain(schedule.constant.iter().map(|(_, place)| place));
    let used: BTreeSet<usize> = read.chain(places.map(|place| cursor_of(place.table))).collect();
    used.into_iter().collect()
}

fn cursor_of(table: Table) -> usize {
    match table {
        Table::Values => VALUES,
        Table::Jacobian => JACOBIAN,
        Table::Hessian => HESSIAN,
    }
}

/// Emits the steps of a schedule.
struct Emitter<'a, 'f> {
    graph: &'a Graph,
    schedule: &'a Schedule,
    frame: Frame,
    pairs: Pairs<'f>,
    values: ById<Pair>,
    /// Sine and cosine of the same angle are computed together.
    angles: ById<[Pair; 2]>,
}

impl Emitter<'_, '_> {
    /// There is at least one pair, so the end of the loop is its only test.
    fn all_points(&mut self) {
        let builder = &mut self.pairs.builder;
        let (each, end) = (builder.create_block(), builder.create_block());
        let start = self.frame.carried();
        builder.ins().jump(each, &start);
        start.iter().for_each(|_| {
            builder.append_block_param(each, types::I64);
        });
        builder.switch_to_block(each);
        self.frame.carry(builder.block_params(each));
        self.one_pair();
        let builder = &mut self.pairs.builder;
        self.frame.advance(builder);
        let next = self.frame.carried();
        builder.ins().brif(self.frame.pairs, each, &next, end, &[]);
        builder.seal_block(each);
        builder.switch_to_block(end);
        builder.seal_block(end);
    }

    fn one_pair(&mut self) {
        let schedule = self.schedule;
        self.steps(&schedule.inside);
        for &(id, place) in &schedule.constant {
            self.store(id, place);
        }
    }

    fn steps(&mut self, steps: &[(ExprId, Operation)]) {
        let schedule = self.schedule;
        for (id, operation) in steps {
            let value = self.operation(operation);
            self.values.insert(*id, value);
            for &place in schedule.varying.get(id).into_iter().flatten() {
                self.store(*id, place);
            }
        }
    }

    fn store(&mut self, id: ExprId, place: Slot) {
        let value = self.value(id);
        let cursor = cursor_of(place.table);
        let address = self.frame.address(&mut self.pairs.builder, cursor, place.column);
        self.pairs.store(value, address);
    }

    /// Numbers are written anew at every use: reading one again is as cheap as keeping it on the
    /// stack.
    fn value(&mut self, id: ExprId) -> Pair {
        match self.graph.as_number(id) {
            Some(number) => self.pairs.number(number),
            None => self.values[&id],
        }
    }

    fn operation(&mut self, operation: &Operation) -> Pair {
        match operation {
            Operation::Point(column) => self.load(POINTS, *column),
            Operation::Multiplier(column) => self.load(MULTIPLIERS, *column),
            Operation::Parameter(index) => {
                self.pairs.load_once(self.frame.parameters, (index * NUMBER) as i32)
            }
            Operation::Call(builtin, operands) => self.call(*builtin, operands),
            Operation::MultiplyAdd(operands) => {
                let [a, b, c] = operands.map(|operand| self.value(operand));
                self.pairs.multiply_add(a, b, c)
            }
            Operation::MultiplySubtract(operands) => {
                let [a, b, c] = operands.map(|operand| self.value(operand));
                self.pairs.multiply_subtract(a, b, c)
            }
            Operation::SubtractProduct(operands) => {
                let [a, b, c] = operands.map(|operand| self.value(operand));
                self.pairs.subtract_product(a, b, c)
            }
        }
    }

    fn load(&mut self, cursor: usize, column: usize) -> Pair {
        let address = self.frame.address(&mut self.pairs.builder, cursor, column);
        self.pairs.load(input_memory(), address)
    }

    fn call(&mut self, builtin: Builtin, operands: &[ExprId]) -> Pair {
        let values: Vec<Pair> = operands.iter().map(|&operand| self.value(operand)).collect();
        match builtin.row().lowering {
            Lowering::Inline(Inline::Sin) => self.angle(operands[0])[0],
            Lowering::Inline(Inline::Cos) => self.angle(operands[0])[1],
            _ => arithmetic::call(&mut self.pairs, builtin, &values),
        }
    }

    fn angle(&mut self, operand: ExprId) -> [Pair; 2] {
        if let Some(&both) = self.angles.get(&operand) {
            return both;
        }
        let angle = self.value(operand);
        let both = elementary::sine_and_cosine(&mut self.pairs, angle);
        self.angles.insert(operand, both);
        both
    }
}
