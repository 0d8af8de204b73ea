//! Schedule to machine code. The only file that names `cranelift`.
//!
//! ```text
//! kernel(tables):
//!     compute what does not depend on the point
//!     for pair in 0..tables.pairs:
//!         load columns [2 pair, 2 pair + 1], compute, store
//! ```
//!
//! All numbers are `F64X2`: the same quantity at two neighbouring points. What is called instead of
//! written out is in [`library()`].

mod kernel;
mod library;
mod pairs;

use ::cranelift::codegen::Context;
use ::cranelift::codegen::ir::{BlockArg, ConstantData, Endianness, FuncRef, Function, StackSlot};
use ::cranelift::codegen::isa::{CallConv, OwnedTargetIsa};
use ::cranelift::jit::{JITBuilder, JITModule};
use ::cranelift::module::{Linkage, Module, default_libcall_names};
use ::cranelift::prelude::{
    AbiParam, Block, Configurable, FloatCC, FunctionBuilder, FunctionBuilderContext, InstBuilder,
    IntCC, MemFlagsData, Signature, StackSlotData, StackSlotKind, Type, Value, settings, types,
};

use super::schedule::Schedule;
use crate::expressions::graph::Graph;
use kernel::build_kernel;
use library::{Library, library};
use pairs::Pairs;

/// A good choice of registers compares each value with those that are alive beside it, which takes
/// more than the square of the length. Beyond so many instructions that would be most of the time
/// of a solve, and one pass is enough: its code takes longer for each point, and is there at once.
const LONG: usize = 20_000;

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

/// The machine code of one function; it lives as long as this value.
struct Code {
    module: Option<JITModule>,
    entry: *const u8,
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
            // SAFETY: a kernel is only called while it and its machine, which owns what it calls,
            // are there.
            #[allow(unsafe_code)]
            unsafe {
                module.free_memory();
            }
        }
    }
}

/// A compiled kernel. What it calls belongs to the machine that it was compiled for.
pub(super) struct Kernel(Code);

impl Kernel {
    /// Compiles a schedule.
    pub(super) fn new(machine: &Machine, graph: &Graph, schedule: &Schedule) -> Self {
        let function = built(machine, graph, schedule);
        Kernel(machine.compile(function, |library| machine.trampoline(library)))
    }

    /// What is called, as long as the kernel and its machine are there. All tables that it uses
    /// must have its columns, of the same even stride, which is at least twice the number of pairs.
    pub(super) fn entry(&self) -> unsafe extern "C" fn(*const Tables) {
        // SAFETY: the address is that of a finished function with the signature of all kernels.
        #[allow(unsafe_code)]
        unsafe {
            std::mem::transmute::<*const u8, unsafe extern "C" fn(*const Tables)>(self.0.entry)
        }
    }
}

/// The text of the kernel of a schedule, before Cranelift's own passes.
pub(super) fn text(machine: &Machine, graph: &Graph, schedule: &Schedule) -> String {
    built(machine, graph, schedule).display().to_string()
}

fn built(machine: &Machine, graph: &Graph, schedule: &Schedule) -> Function {
    let signature = machine.signature(&[types::I64], &[]);
    machine
        .function(signature, |builder| build_kernel(graph, schedule, Pairs::new(builder, machine)))
}

/// The machine that code is for, and what the code may call.
pub(super) struct Machine {
    isa: OwnedTargetIsa,
    /// The same machine, for long functions: registers are chosen in one pass.
    hasty: OwnedTargetIsa,
    /// Whether it has a fused multiply-add.
    fused: bool,
    library: Vec<Library>,
}

impl Machine {
    /// The one that this runs on.
    pub(super) fn host() -> Self {
        let [isa, hasty] = ["backtracking", "single_pass"].map(host);
        let has_fma = isa
            .isa_flags()
            .iter()
            .any(|flag| flag.name == "has_fma" && flag.as_bool() == Some(true));
        let fused = !cfg!(feature = "portable") && (!cfg!(target_arch = "x86_64") || has_fma);
        Machine { fused, isa, hasty, library: library() }
    }

    /// Whether it has a fused multiply-add.
    pub(super) fn is_fused(&self) -> bool {
        self.fused
    }

    /// The signature of a function as the host calls it.
    fn signature(&self, takes: &[Type], returns: &[Type]) -> Signature {
        let mut signature = Signature::new(self.isa.default_call_conv());
        signature.params.extend(takes.iter().map(|kind| AbiParam::new(*kind)));
        signature.returns.extend(returns.iter().map(|kind| AbiParam::new(*kind)));
        signature
    }

    fn function(&self, signature: Signature, fill: impl FnOnce(FunctionBuilder)) -> Function {
        let mut function = Function::new();
        function.signature = signature;
        fill(FunctionBuilder::new(&mut function, &mut FunctionBuilderContext::new()));
        function
    }

    /// Compiles a function that calls what stands at `address` for each of the [`Library`] that it
    /// names.
    fn compile(&self, function: Function, address: impl Fn(&Library) -> *const u8) -> Code {
        let isa = if function.dfg.num_insts() > LONG { &self.hasty } else { &self.isa };
        let mut builder = JITBuilder::with_isa(isa.clone(), default_libcall_names());
        for called in function.params.user_named_funcs().values() {
            let library = &self.library[called.index as usize];
            builder.symbol(library.name, address(library));
        }
        let mut module = JITModule::new(builder);
        for library in &self.library {
            let signature = Signature::new(CallConv::PreserveAll);
            module
                .declare_function(library.name, Linkage::Import, &signature)
                .expect("each name is there once");
        }
        let id =
            module.declare_anonymous_function(&function.signature).expect("no name, so no clash");
        module
            .define_function(id, &mut Context::for_function(function))
            .expect("functions are well formed");
        module.finalize_definitions().expect("all functions are defined or imported by address");
        let entry = module.get_finalized_function(id);
        Code { module: Some(module), entry }
    }
}

/// The host, with an algorithm that chooses registers.
fn host(registers: &str) -> OwnedTargetIsa {
    let mut flags = settings::builder();
    let verify = if cfg!(debug_assertions) { "true" } else { "false" };
    for (name, value) in [
        ("opt_level", "none"),
        ("enable_verifier", verify),
        ("unwind_info", "false"),
        ("regalloc_algorithm", registers),
    ] {
        flags.set(name, value).expect("these flags exist");
    }
    let builder = ::cranelift::native::builder().expect("the host is one of Cranelift's targets");
    builder.finish(settings::Flags::new(flags)).expect("the flags agree with the host")
}

/// Memory of tables: never out of reach, not always aligned to 16 bytes.
fn memory() -> MemFlagsData {
    MemFlagsData::new().with_notrap()
}
