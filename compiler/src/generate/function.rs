//! Machine code as a function of the runtime.

use std::sync::{Arc, OnceLock};

use fdcc_runtime::problem::{Columns, Degree, Function, Layout, Origin, Pattern};

use super::cranelift::{Kernel, Tables};
use super::{Source, highest_order, work};
use crate::program::Differentiated;

/// A vector function and its derivatives, compiled.
pub(super) struct CompiledFunction {
    source: Arc<Source>,
    symbols: Differentiated,
    /// Values; then also the Jacobian; then also the Hessian. Nobody calls all of them: the reports want values, the
    /// interior point values and everything.
    kernels: [OnceLock<Kernel>; 3],
}

impl CompiledFunction {
    pub(super) fn new(source: Arc<Source>, symbols: Differentiated) -> Self {
        CompiledFunction { source, symbols, kernels: Default::default() }
    }

    /// The kernel for derivatives of this order, or the last one: higher derivatives are then empty.
    fn kernel(&self, order: usize) -> &Kernel {
        let order = order.min(highest_order(&self.symbols));
        let Source { graph, machine } = &*self.source;
        self.kernels[order].get_or_init(|| Kernel::new(machine, graph, &work(graph, &self.symbols, order)))
    }

    fn check_inputs(&self, points: &Columns, parameters: &[f64]) {
        assert_eq!(points.columns(), self.layout().point_inputs(), "columns of the points");
        assert_eq!(parameters.len(), self.layout().p, "parameters");
    }

    fn run(&self, order: usize, tables: Tables) {
        if tables.pairs > 0 && self.outputs() > 0 {
            // SAFETY: all tables have been checked to have the columns that the kernel uses, of the same
            // even stride, which is at least twice the number of pairs; the machine is alive in `source`.
            #[allow(unsafe_code)]
            unsafe {
                self.kernel(order).entry()(&tables);
            }
        }
    }
}

/// All tables of a call; those that are not needed stay null.
fn tables(points: &Columns, parameters: &[f64]) -> Tables {
    Tables {
        points: points.as_slice().as_ptr(),
        parameters: parameters.as_ptr(),
        multipliers: std::ptr::null(),
        values: std::ptr::null_mut(),
        jacobian: std::ptr::null_mut(),
        hessian: std::ptr::null_mut(),
        pairs: points.count().div_ceil(2) as u64,
        stride: (points.stride() * size_of::<f64>()) as u64,
    }
}

/// The numbers of a table that must be as long as the points and have `columns` columns.
fn output(table: &mut Columns, columns: usize, points: &Columns, name: &str) -> *mut f64 {
    check_table(table, columns, points, name);
    table.as_mut_slice().as_mut_ptr()
}

fn check_table(table: &Columns, columns: usize, points: &Columns, name: &str) {
    assert_eq!(table.columns(), columns, "columns of {name}");
    assert_eq!(table.count(), points.count(), "points of {name}");
    assert_eq!(table.stride(), points.stride(), "stride of {name}");
}

impl Function for CompiledFunction {
    fn layout(&self) -> &Layout {
        &self.symbols.function.layout
    }
    fn outputs(&self) -> usize {
        self.symbols.function.origins.len()
    }
    fn jacobian_pattern(&self) -> &Pattern {
        &self.symbols.jacobian.0
    }
    fn hessian_pattern(&self) -> &Pattern {
        &self.symbols.hessian.0
    }
    fn degree(&self, row: usize) -> Degree {
        self.symbols.degrees[row]
    }
    fn origin(&self, row: usize) -> Origin {
        self.symbols.function.origins[row].clone()
    }

    fn value(&self, points: &Columns, parameters: &[f64], values: &mut Columns) {
        self.check_inputs(points, parameters);
        let values = output(values, self.outputs(), points, "values");
        self.run(0, Tables { values, ..tables(points, parameters) });
    }

    fn jacobian(&self, points: &Columns, parameters: &[f64], values: &mut Columns, jacobian: &mut Columns) {
        self.check_inputs(points, parameters);
        let values = output(values, self.outputs(), points, "values");
        let jacobian = output(jacobian, self.symbols.jacobian.0.entries.len(), points, "the Jacobian");
        self.run(1, Tables { values, jacobian, ..tables(points, parameters) });
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
        self.check_inputs(points, parameters);
        check_table(multipliers, self.outputs(), points, "multipliers");
        let multipliers = multipliers.as_slice().as_ptr();
        let values = output(values, self.outputs(), points, "values");
        let jacobian = output(jacobian, self.symbols.jacobian.0.entries.len(), points, "the Jacobian");
        let hessian = output(hessian, self.symbols.hessian.0.entries.len(), points, "the Hessian");
        self.run(2, Tables { multipliers, values, jacobian, hessian, ..tables(points, parameters) });
    }
}
