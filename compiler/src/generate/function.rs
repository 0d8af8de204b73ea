//! A function of the runtime: step by step at first, by machine code from when it pays.

use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, OnceLock};

use fdcc_runtime::problem::{Columns, Degree, Function, Layout, Origin, Pattern};

use super::bytecode::Bytecode;
use super::cranelift::{Kernel, Tables};
use super::schedule::Slot;
use super::{Source, highest_order, work};
use crate::differentiate::Differentiated;

/// A vector function and its derivatives, ready to be computed.
pub(super) struct CompiledFunction {
    source: Arc<Source>,
    symbols: Differentiated,
    /// For values; then also the Jacobian; then also the Hessian. Nobody calls all of them: the
    /// reports want values, the interior point values and everything.
    ways: [Way; 3],
}

/// How derivatives up to one order are computed.
#[derive(Default)]
struct Way {
    steps: OnceLock<Bytecode>,
    /// Nothing where it would be too long.
    kernel: OnceLock<Option<Kernel>>,
    /// How much has been computed step by step, in points.
    done: AtomicUsize,
}

/// Computing so many points step by step takes as long as making machine code.
const PAYS: usize = 5_000;

/// What a call costs by itself, in points.
const ENTRY: usize = 4;

/// A schedule of more steps is never made machine code. Long functions keep every number on the
/// stack, 16 bytes for each, and a thread may have no more than 2 MB; and the time that Cranelift
/// takes grows faster than their length.
const MOST_STEPS: usize = 60_000;

/// What is read and written.
pub(super) struct Call<'c> {
    pub(super) points: &'c [f64],
    pub(super) parameters: &'c [f64],
    pub(super) multipliers: &'c [f64],
    /// Values, Jacobian, Hessian.
    pub(super) results: [&'c mut [f64]; 3],
    pub(super) count: usize,
    /// From column to column, in all tables.
    pub(super) stride: usize,
}

impl<'c> Call<'c> {
    fn new(points: &'c Columns, parameters: &'c [f64], results: [&'c mut [f64]; 3]) -> Self {
        let (count, stride) = (points.count(), points.stride());
        Call { points: points.as_slice(), parameters, multipliers: &[], results, count, stride }
    }

    /// Writes results of neighbouring points.
    pub(super) fn store(&mut self, place: Slot, first: usize, numbers: &[f64]) {
        let begin = place.column * self.stride + first;
        self.results[place.table as usize][begin..][..numbers.len()].copy_from_slice(numbers);
    }

    fn tables(&mut self) -> Tables {
        let [values, jacobian, hessian] = self.results.each_mut().map(|table| table.as_mut_ptr());
        Tables {
            points: self.points.as_ptr(),
            parameters: self.parameters.as_ptr(),
            multipliers: self.multipliers.as_ptr(),
            values,
            jacobian,
            hessian,
            pairs: self.count.div_ceil(2) as u64,
            stride: (self.stride * size_of::<f64>()) as u64,
        }
    }
}

impl CompiledFunction {
    pub(super) fn new(source: Arc<Source>, symbols: Differentiated) -> Self {
        CompiledFunction { source, symbols, ways: Default::default() }
    }

    /// The way for derivatives of this order, or the last one: higher derivatives are then empty.
    fn order(&self, order: usize) -> usize {
        order.min(highest_order(&self.symbols))
    }

    fn kernel(&self, order: usize) -> Option<&Kernel> {
        let Source { graph, machine } = &*self.source;
        let make = || {
            let schedule = work(graph, &self.symbols, order);
            let is_short = schedule.before.len() + schedule.inside.len() <= MOST_STEPS;
            is_short.then(|| Kernel::new(machine, graph, &schedule))
        };
        self.ways[order].kernel.get_or_init(make).as_ref()
    }

    fn steps(&self, order: usize) -> &Bytecode {
        let Source { graph, machine } = &*self.source;
        let make = || Bytecode::new(graph, &work(graph, &self.symbols, order), machine.is_fused());
        self.ways[order].steps.get_or_init(make)
    }

    /// Whether there is machine code, or it is time to make it.
    fn is_worth_code(&self, order: usize, points: usize) -> bool {
        let Way { kernel, done, .. } = &self.ways[order];
        kernel.get().is_some()
            || done.fetch_add(points + ENTRY, Ordering::Relaxed) + points + ENTRY > PAYS
    }

    fn check_inputs(&self, points: &Columns, parameters: &[f64]) {
        assert_eq!(points.columns(), self.layout().point_inputs(), "columns of the points");
        assert_eq!(parameters.len(), self.layout().p, "parameters");
    }

    fn run(&self, order: usize, mut call: Call) {
        let order = self.order(order);
        if call.count == 0 || self.outputs() == 0 {
            return;
        }
        let is_worth_code = self.is_worth_code(order, call.count);
        let Some(kernel) = is_worth_code.then(|| self.kernel(order)).flatten() else {
            return self.steps(order).run(&mut call);
        };
        // SAFETY: all tables have been checked to have the columns that the kernel uses, of the
        // same even stride, which is at least twice the number of pairs; the machine is alive in
        // `source`.
        #[allow(unsafe_code)]
        unsafe {
            kernel.entry()(&call.tables());
        }
    }
}

/// The numbers of a table that must be as long as the points and have `columns` columns.
fn output<'c>(
    table: &'c mut Columns,
    columns: usize,
    points: &Columns,
    name: &str,
) -> &'c mut [f64] {
    check_table(table, columns, points, name);
    table.as_mut_slice()
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

    fn prepare(&self, order: usize) {
        if self.outputs() > 0 {
            self.kernel(self.order(order));
        }
    }

    fn value(&self, points: &Columns, parameters: &[f64], values: &mut Columns) {
        self.check_inputs(points, parameters);
        let values = output(values, self.outputs(), points, "values");
        self.run(0, Call::new(points, parameters, [values, &mut [], &mut []]));
    }

    fn jacobian(
        &self,
        points: &Columns,
        parameters: &[f64],
        values: &mut Columns,
        jacobian: &mut Columns,
    ) {
        self.check_inputs(points, parameters);
        let values = output(values, self.outputs(), points, "values");
        let jacobian =
            output(jacobian, self.symbols.jacobian.0.entries.len(), points, "the Jacobian");
        self.run(1, Call::new(points, parameters, [values, jacobian, &mut []]));
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
        let multipliers = multipliers.as_slice();
        let values = output(values, self.outputs(), points, "values");
        let jacobian =
            output(jacobian, self.symbols.jacobian.0.entries.len(), points, "the Jacobian");
        let hessian = output(hessian, self.symbols.hessian.0.entries.len(), points, "the Hessian");
        let call = Call::new(points, parameters, [values, jacobian, hessian]);
        self.run(2, Call { multipliers, ..call });
    }
}
