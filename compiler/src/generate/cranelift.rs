//! Schedule to machine code. The only file that names `cranelift`.
//!
//! ```text
//! kernel(tables):
//!     compute what does not depend on the point
//!     for pair in 0..tables.pairs:
//!         load columns [2 pair, 2 pair + 1], compute, store
//! ```
//!
//! All numbers are `F64X2`: the same quantity at two neighbouring points. Functions that are called instead of
//! written out go through a small function of our own that keeps all registers, so that a call which is rarely
//! made costs nothing to the code around it.

mod elementary;
mod kernel;
mod pairs;

use std::collections::BTreeMap;

use ::cranelift::codegen::Context;
use ::cranelift::codegen::ir::{BlockArg, ConstantData, Endianness, FuncRef, Function, StackSlot};
use ::cranelift::codegen::isa::{CallConv, OwnedTargetIsa};
use ::cranelift::jit::{JITBuilder, JITModule};
use ::cranelift::module::{FuncId, Linkage, Module, default_libcall_names};
use ::cranelift::prelude::{
    AbiParam, Block, Configurable, FloatCC, FunctionBuilder, FunctionBuilderContext, InstBuilder, IntCC,
    MemFlagsData, Signature, StackSlotData, StackSlotKind, Type, Value, settings, types,
};

use super::schedule::Schedule;
use crate::builtins::{self, Lowering};
use crate::graph::Graph;
use kernel::build_kernel;
use pairs::Pairs;

/// What a kernel is called with. The machine code reads the fields by their offsets.
#[repr(C)]
#[allow(missing_docs)] // the tables of `Function::derivatives`
pub(super) struct Tables {
    pub points: *const f64,
    pub parameters: *const f64,
    pub multipliers: *const f64,
    pub values: *mut f64,
    pub jacobian: *mut f64,
    pub hessian: *mut f64,
    /// Pairs of points, the last one filled up with padding.
    pub pairs: u64,
    /// Bytes from column to column.
    pub stride: u64,
}

/// A compiled kernel.
pub(super) type Kernel = unsafe extern "C" fn(*const Tables);

/// Machine code; it lives as long as this value.
pub(super) struct Code {
    module: Option<JITModule>,
}

// SAFETY: the module is not touched between its making and its end; finished code is only read.
#[allow(unsafe_code)]
unsafe impl Send for Code {}
// SAFETY: as above.
#[allow(unsafe_code)]
unsafe impl Sync for Code {}

impl Drop for Code {
    fn drop(&mut self) {
        if let Some(module) = self.module.take() {
            // SAFETY: kernels are only reachable through functions that share ownership of this value.
            #[allow(unsafe_code)]
            unsafe {
                module.free_memory();
            }
        }
    }
}

/// Compiles one kernel for each schedule.
pub(super) fn compile<'a>(
    graph: &Graph,
    schedules: impl Iterator<Item = &'a Schedule>,
) -> (Code, Vec<Kernel>) {
    let mut assembler = Assembler::new();
    let mut context = assembler.module.make_context();
    let ids: Vec<FuncId> = schedules
        .map(|schedule| {
            assembler.build(graph, schedule, &mut context.func);
            let id = assembler
                .module
                .declare_anonymous_function(&context.func.signature)
                .expect("the signature is the one of all kernels");
            assembler.module.define_function(id, &mut context).expect("kernels are well formed");
            assembler.module.clear_context(&mut context);
            id
        })
        .collect();
    assembler.define_trampolines(&mut context);
    assembler.module.finalize_definitions().expect("all functions are defined or imported by address");
    let kernels = ids.iter().map(|&id| kernel_at(assembler.module.get_finalized_function(id))).collect();
    (Code { module: Some(assembler.module) }, kernels)
}

fn kernel_at(address: *const u8) -> Kernel {
    // SAFETY: the address is that of a finished function with the signature of all kernels.
    #[allow(unsafe_code)]
    unsafe {
        std::mem::transmute::<*const u8, Kernel>(address)
    }
}

/// The text of the kernel of a schedule, before Cranelift's own passes.
pub(super) fn text(graph: &Graph, schedule: &Schedule) -> String {
    let mut assembler = Assembler::new();
    let mut context = assembler.module.make_context();
    assembler.build(graph, schedule, &mut context.func);
    context.func.display().to_string()
}

fn host() -> OwnedTargetIsa {
    let mut flags = settings::builder();
    let verify = if cfg!(debug_assertions) { "true" } else { "false" };
    for (name, value) in [("opt_level", "none"), ("enable_verifier", verify), ("unwind_info", "false")] {
        flags.set(name, value).expect("these flags exist");
    }
    let builder = ::cranelift::native::builder().expect("the host is one of Cranelift's targets");
    builder.finish(settings::Flags::new(flags)).expect("the flags agree with the host")
}

/// A module in the making.
struct Assembler {
    module: JITModule,
    /// Whether the machine has a fused multiply-add.
    fused: bool,
    /// Functions that keep all registers around calls of the library, by the name of what they call.
    trampolines: BTreeMap<&'static str, FuncId>,
    library: BTreeMap<&'static str, Library>,
    frontend: FunctionBuilderContext,
}

/// A function that is called for each point.
#[derive(Clone, Copy)]
struct Library {
    address: *const u8,
    arity: usize,
}

/// Everything that can be called, by name.
fn library() -> BTreeMap<&'static str, Library> {
    let rows = builtins::ALL.iter().map(|builtin| builtin.row());
    let called = rows.filter_map(|row| {
        let address = match row.lowering {
            Lowering::Call1(function) => function as *const u8,
            Lowering::Call2(function) => function as *const u8,
            Lowering::Inline(_) => return None,
        };
        Some((row.name, Library { address, arity: row.arity }))
    });
    let fallback = elementary::LIBRARY
        .iter()
        .map(|&(name, function)| (name, Library { address: function as *const u8, arity: 1 }));
    called.chain(fallback).collect()
}

impl Assembler {
    fn new() -> Self {
        let isa = host();
        let fused = !cfg!(target_arch = "x86_64")
            || isa.isa_flags().iter().any(|flag| flag.name == "has_fma" && flag.as_bool() == Some(true));
        let library = library();
        let mut builder = JITBuilder::with_isa(isa, default_libcall_names());
        library.iter().for_each(|(name, function)| {
            builder.symbol(*name, function.address);
        });
        Assembler {
            module: JITModule::new(builder),
            fused,
            trampolines: BTreeMap::new(),
            library,
            frontend: FunctionBuilderContext::new(),
        }
    }

    fn build(&mut self, graph: &Graph, schedule: &Schedule, function: &mut Function) {
        function.signature = self.module.make_signature();
        function.signature.params.push(AbiParam::new(types::I64));
        let mut frontend = std::mem::take(&mut self.frontend);
        let builder = FunctionBuilder::new(function, &mut frontend);
        build_kernel(graph, schedule, Pairs::new(builder, self));
        self.frontend = frontend;
    }

    /// `f(address)`: replaces the pair at the address by the function of it, and of the pair behind it.
    fn trampoline(&mut self, name: &'static str) -> FuncId {
        if let Some(&id) = self.trampolines.get(name) {
            return id;
        }
        let mut signature = Signature::new(CallConv::PreserveAll);
        signature.params.push(AbiParam::new(types::I64));
        let id = self.module.declare_anonymous_function(&signature).expect("no name, so no clash");
        self.trampolines.insert(name, id);
        id
    }

    fn define_trampolines(&mut self, context: &mut Context) {
        for (name, id) in std::mem::take(&mut self.trampolines) {
            self.build_trampoline(name, &mut context.func);
            self.module.define_function(id, context).expect("trampolines are well formed");
            self.module.clear_context(context);
        }
    }

    fn build_trampoline(&mut self, name: &'static str, function: &mut Function) {
        let arity = self.library[name].arity;
        let mut callee = self.module.make_signature();
        callee.params.extend(vec![AbiParam::new(types::F64); arity]);
        callee.returns.push(AbiParam::new(types::F64));
        let callee = self
            .module
            .declare_function(name, Linkage::Import, &callee)
            .expect("a name is always used with the same signature");
        let callee = self.module.declare_func_in_func(callee, function);
        function.signature = Signature::new(CallConv::PreserveAll);
        function.signature.params.push(AbiParam::new(types::I64));
        let mut builder = FunctionBuilder::new(function, &mut self.frontend);
        let block = builder.create_block();
        builder.append_block_params_for_function_params(block);
        builder.switch_to_block(block);
        builder.seal_block(block);
        let address = builder.block_params(block)[0];
        for lane in [0, 8] {
            let operands: Vec<Value> = (0..arity as i32)
                .map(|operand| builder.ins().load(types::F64, memory(), address, 16 * operand + lane))
                .collect();
            let call = builder.ins().call(callee, &operands);
            let result = builder.inst_results(call)[0];
            builder.ins().store(memory(), result, address, lane);
        }
        builder.ins().return_(&[]);
        builder.finalize(self.module.target_config());
    }
}

/// Memory of tables: never out of reach, not always aligned to 16 bytes.
fn memory() -> MemFlagsData {
    MemFlagsData::new().with_notrap()
}
