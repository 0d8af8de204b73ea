//! What machine code calls instead of writing it out: functions for one point, and the way to them.
//!
//! A kernel calls them through a small function of our own, a trampoline, that takes both points
//! and keeps all registers, so that a call which is rarely made costs nothing to the code around
//! it. A trampoline is compiled when the first kernel needs it, and serves all kernels of a
//! machine.

use std::sync::OnceLock;

use ::cranelift::codegen::ir::{ExtFuncData, ExternalName, UserExternalName};

use super::{
    AbiParam, CallConv, Code, FuncRef, Function, FunctionBuilder, InstBuilder, Machine, Signature,
    Value, memory, types,
};
use crate::expressions::graph::builtins::{self, Lowering};
use crate::generate::schedule::elementary;

/// A function that is called for each point.
pub(super) struct Library {
    pub(super) name: &'static str,
    address: *const u8,
    arity: usize,
    trampoline: OnceLock<Code>,
}

// SAFETY: the address is that of a function of this program.
#[allow(unsafe_code)]
unsafe impl Send for Library {}
// SAFETY: as above.
#[allow(unsafe_code)]
unsafe impl Sync for Library {}

/// Everything that can be called; in machine code a function goes by its place here.
pub(super) fn library() -> Vec<Library> {
    let rows = builtins::ALL.iter().map(|builtin| builtin.row());
    let called = rows.filter_map(|row| match row.lowering {
        Lowering::Call1(function) => Some((row.name, function as *const u8, row.arity)),
        Lowering::Call2(function) => Some((row.name, function as *const u8, row.arity)),
        Lowering::Inline(_) => None,
    });
    let fallback =
        elementary::LIBRARY.iter().map(|&(name, function)| (name, function as *const u8, 1));
    let all = called.chain(fallback);
    all.map(|(name, address, arity)| Library { name, address, arity, trampoline: OnceLock::new() })
        .collect()
}

impl Machine {
    /// Names a function of the library, or its trampoline, in a function that calls it.
    pub(super) fn import(
        &self,
        function: &mut Function,
        name: &str,
        signature: Signature,
    ) -> FuncRef {
        let place = self.library.iter().position(|library| library.name == name);
        let index = place.expect("only functions of the library are called") as u32;
        let name =
            function.declare_imported_user_function(UserExternalName { namespace: 0, index });
        let signature = function.import_signature(signature);
        function.import_function(ExtFuncData {
            name: ExternalName::user(name),
            signature,
            colocated: false,
            patchable: false,
        })
    }

    /// `f(address)`: replaces the pair at the address by the function of it, and of the pair behind
    /// it.
    pub(super) fn trampoline(&self, library: &Library) -> *const u8 {
        let compiled = || {
            let function = self.function(trampoline_signature(), |builder| {
                self.build_trampoline(library, builder)
            });
            self.compile(function, |library| library.address)
        };
        library.trampoline.get_or_init(compiled).entry
    }

    fn build_trampoline(&self, library: &Library, mut builder: FunctionBuilder) {
        let signature = self.signature(&vec![types::F64; library.arity], &[types::F64]);
        let callee = self.import(builder.func, library.name, signature);
        let block = builder.create_block();
        builder.append_block_params_for_function_params(block);
        builder.switch_to_block(block);
        builder.seal_block(block);
        let address = builder.block_params(block)[0];
        for lane in [0, 8] {
            let operands: Vec<Value> = (0..library.arity as i32)
                .map(|operand| {
                    builder.ins().load(types::F64, memory(), address, 16 * operand + lane)
                })
                .collect();
            let call = builder.ins().call(callee, &operands);
            let result = builder.inst_results(call)[0];
            builder.ins().store(memory(), result, address, lane);
        }
        builder.ins().return_(&[]);
        builder.finalize(self.isa.frontend_config());
    }
}

/// It keeps all registers.
pub(super) fn trampoline_signature() -> Signature {
    let mut signature = Signature::new(CallConv::PreserveAll);
    signature.params.push(AbiParam::new(types::I64));
    signature
}
