//! Arithmetic on two points at a time, as instructions.

use std::collections::BTreeMap;

use super::{
    Block, ConstantData, Endianness, FloatCC, FuncRef, FunctionBuilder, InstBuilder, IntCC,
    Machine, MemFlagsData, StackSlot, StackSlotData, StackSlotKind, Type, Value,
    library::trampoline_signature, memory, types,
};
use crate::generate::schedule::arithmetic::Arithmetic;

/// A number at two neighbouring points; also a mask or bits in the place of one.
pub(super) type Pair = Value;

const PAIR: Type = types::F64X2;
const BITS: Type = types::I64X2;
const SIGN: u64 = 1 << 63;

/// Writes instructions into one function.
pub(super) struct Pairs<'f> {
    pub(super) builder: FunctionBuilder<'f>,
    machine: &'f Machine,
    /// Where operands of calls are passed.
    slot: Option<StackSlot>,
    called: BTreeMap<&'static str, FuncRef>,
}

impl<'f> Pairs<'f> {
    pub(super) fn new(builder: FunctionBuilder<'f>, machine: &'f Machine) -> Self {
        Pairs { builder, machine, slot: None, called: BTreeMap::new() }
    }

    /// Returns, and ends the function.
    pub(super) fn finish(mut self) {
        self.builder.ins().return_(&[]);
        self.builder.finalize(self.machine.isa.frontend_config());
    }

    /// Both halves with these bits.
    fn constant(&mut self, kind: Type, bits: u64) -> Pair {
        let data: ConstantData = bits.to_le_bytes().repeat(2).into();
        let constant = self.builder.func.dfg.constants.insert(data);
        self.builder.ins().vconst(kind, constant)
    }
    pub(super) fn load(&mut self, flags: MemFlagsData, address: Value) -> Pair {
        self.builder.ins().load(PAIR, flags, address, 0)
    }
    /// The same number from memory for both points.
    pub(super) fn load_once(&mut self, address: Value, offset: i32) -> Pair {
        let number = self.builder.ins().load(types::F64, memory(), address, offset);
        self.builder.ins().splat(PAIR, number)
    }
    pub(super) fn store(&mut self, value: Pair, address: Value) {
        self.builder.ins().store(memory(), value, address, 0);
    }

    fn shift_left(&mut self, bits: Value, by: u32) -> Value {
        let by = self.builder.ins().iconst(types::I32, i64::from(by));
        self.builder.ins().ishl(bits, by)
    }
    fn cast(&mut self, kind: Type, value: Value) -> Value {
        if self.builder.func.dfg.value_type(value) == kind {
            return value;
        }
        let little = MemFlagsData::new().with_endianness(Endianness::Little);
        self.builder.ins().bitcast(kind, little, value)
    }

    fn start(&mut self, block: Block) {
        self.builder.switch_to_block(block);
        self.builder.seal_block(block);
    }

    /// A function of the library, at each of the two points.
    fn call(&mut self, name: &'static str, operands: &[Pair]) -> Pair {
        let function = self.trampoline(name);
        let slot = self.slot();
        for (operand, offset) in operands.iter().zip([0, 16]) {
            let address = self.builder.ins().stack_addr(types::I64, slot, offset);
            self.store(*operand, address);
        }
        let address = self.builder.ins().stack_addr(types::I64, slot, 0);
        self.builder.ins().call(function, &[address]);
        self.load(memory(), address)
    }
    fn trampoline(&mut self, name: &'static str) -> FuncRef {
        if let Some(&function) = self.called.get(name) {
            return function;
        }
        let function = self.machine.import(self.builder.func, name, trampoline_signature());
        self.called.insert(name, function);
        function
    }
    fn slot(&mut self) -> StackSlot {
        *self.slot.get_or_insert_with(|| {
            let data = StackSlotData::new(StackSlotKind::ExplicitSlot, 32, 4);
            self.builder.create_sized_stack_slot(data)
        })
    }
}

impl Arithmetic for Pairs<'_> {
    type Number = Pair;

    fn number(&mut self, value: f64) -> Pair {
        self.constant(PAIR, value.to_bits())
    }
    fn add(&mut self, a: Pair, b: Pair) -> Pair {
        self.builder.ins().fadd(a, b)
    }
    fn subtract(&mut self, a: Pair, b: Pair) -> Pair {
        self.builder.ins().fsub(a, b)
    }
    fn multiply(&mut self, a: Pair, b: Pair) -> Pair {
        self.builder.ins().fmul(a, b)
    }
    fn divide(&mut self, a: Pair, b: Pair) -> Pair {
        self.builder.ins().fdiv(a, b)
    }
    fn negate(&mut self, a: Pair) -> Pair {
        self.builder.ins().fneg(a)
    }
    fn absolute(&mut self, a: Pair) -> Pair {
        self.builder.ins().fabs(a)
    }
    fn square_root(&mut self, a: Pair) -> Pair {
        self.builder.ins().sqrt(a)
    }
    fn multiply_add(&mut self, a: Pair, b: Pair, c: Pair) -> Pair {
        if self.machine.fused {
            return self.builder.ins().fma(a, b, c);
        }
        let product = self.multiply(a, b);
        self.add(product, c)
    }

    fn less_or_equal(&mut self, a: Pair, b: Pair) -> Pair {
        self.builder.ins().fcmp(FloatCC::LessThanOrEqual, a, b)
    }
    fn is_nan(&mut self, a: Pair) -> Pair {
        self.builder.ins().fcmp(FloatCC::Unordered, a, a)
    }
    fn select(&mut self, mask: Pair, yes: Pair, no: Pair) -> Pair {
        let mask = self.cast(PAIR, mask);
        self.builder.ins().bitselect(mask, yes, no)
    }

    fn bit_is_clear(&mut self, a: Pair, bit: u32) -> Pair {
        let bits = self.cast(BITS, a);
        let (chosen, zero) = (self.constant(BITS, 1 << bit), self.constant(BITS, 0));
        let only = self.builder.ins().band(bits, chosen);
        self.builder.ins().icmp(IntCC::Equal, only, zero)
    }
    fn negate_if_bit(&mut self, a: Pair, bits: Pair, bit: u32) -> Pair {
        let bits = self.cast(BITS, bits);
        let shifted = self.shift_left(bits, 63 - bit);
        let sign = self.constant(BITS, SIGN);
        let flip = self.builder.ins().band(shifted, sign);
        let flip = self.cast(PAIR, flip);
        self.builder.ins().bxor(a, flip)
    }
    fn copy_sign(&mut self, a: Pair, b: Pair) -> Pair {
        let sign = self.constant(PAIR, SIGN);
        let sign = self.builder.ins().band(sign, b);
        self.builder.ins().bor(a, sign)
    }
    fn add_to_bits(&mut self, a: Pair, number: u64) -> Pair {
        let bits = self.cast(BITS, a);
        let number = self.constant(BITS, number);
        self.builder.ins().iadd(bits, number)
    }
    fn power_of_two(&mut self, a: Pair) -> Pair {
        const BIAS: u64 = 1023;
        let biased = self.add_to_bits(a, BIAS);
        let exponent = self.shift_left(biased, 52);
        self.cast(PAIR, exponent)
    }

    fn guard<const N: usize>(
        &mut self,
        mask: Pair,
        fast: [Pair; N],
        slow: impl Fn(&mut Self) -> [Pair; N],
    ) -> [Pair; N] {
        let (aside, on) = (self.builder.create_block(), self.builder.create_block());
        fast.iter().for_each(|_| {
            self.builder.append_block_param(on, PAIR);
        });
        let both = self.builder.ins().vall_true(mask);
        self.builder.ins().brif(both, on, &fast.map(Into::into), aside, &[]);
        self.builder.set_cold_block(aside);
        self.start(aside);
        let slow = slow(self);
        self.builder.ins().jump(on, &slow.map(Into::into));
        self.start(on);
        std::array::from_fn(|index| self.builder.block_params(on)[index])
    }

    fn call1(&mut self, name: &'static str, _: extern "C" fn(f64) -> f64, a: Pair) -> Pair {
        self.call(name, &[a])
    }
    fn call2(
        &mut self,
        name: &'static str,
        _: extern "C" fn(f64, f64) -> f64,
        operands: [Pair; 2],
    ) -> Pair {
        self.call(name, &operands)
    }
}
