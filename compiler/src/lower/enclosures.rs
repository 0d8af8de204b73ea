//! Intervals of what a simulation watches along its steps: surfaces, kinks, the rates that keep
//! the state
//! on a surface, guessed controls; and of the right side, by how much it is uncertain.
//!
//! Each is a tape over the inputs of the function that it belongs to, with the derivatives that
//! tell how fast the value can change.

use super::function::VectorFunction;
use super::sudden::sudden;
use crate::expressions::graph::derivative::gradient;
use crate::expressions::graph::{ExprId, Graph};
use crate::expressions::interval::{Interval, Tape};
use fdcc_runtime::problem::Layout;
use fdcc_runtime::simulate::{Enclosure, Enclosures};
use std::ops::Range;
use std::sync::{Arc, Mutex, PoisonError};

/// The functions of a simulation whose values are enclosed.
pub(super) struct Watched<'a> {
    pub flow: &'a VectorFunction,
    pub switching: &'a VectorFunction,
    pub kinks: &'a VectorFunction,
    pub rates: &'a VectorFunction,
    pub path: &'a VectorFunction,
    pub guess: &'a VectorFunction,
}

/// The enclosures of all of them.
pub(super) fn enclosures(graph: &mut Graph, layout: &Layout, watched: &Watched) -> Enclosures {
    let Watched { flow, switching, kinks, rates, path, guess } = watched;
    let along = 0..layout.controls().end;
    let suddens = sudden(graph, layout, flow);
    let mut of = |function: &VectorFunction, by: &Range<usize>| -> Vec<Enclosure> {
        function
            .outputs
            .iter()
            .map(|&output| enclosure(graph, &function.layout, output, by))
            .collect()
    };
    Enclosures {
        flow: of(flow, &(0..0)),
        sudden: suddens,
        switching: of(switching, &along),
        kinks: of(kinks, &along),
        rates: of(rates, &layout.selectors()),
        accelerations: of(rates, &along),
        path: of(path, &along),
        controls: of(guess, &(0..1)).split_off(layout.x),
    }
}

/// Of one output, with its derivatives by those of some inputs that it depends on.
fn enclosure(graph: &mut Graph, layout: &Layout, output: ExprId, by: &Range<usize>) -> Enclosure {
    let read = graph.inputs_of(&[output]);
    let by: Vec<u32> =
        read.iter().copied().filter(|&input| by.contains(&(input as usize))).collect();
    let mut roots = vec![output];
    roots.extend(gradient(graph, output, &by));
    let is_affine = graph.inputs_of(&roots[1..]).iter().all(|input| !by.contains(input));
    let tape = Mutex::new(Tape::new(graph, &roots));
    let inputs = layout.inputs();
    Enclosure {
        reads: read.into_iter().map(|input| input as usize).collect(),
        by: by.into_iter().map(|input| input as usize).collect(),
        is_affine,
        over: Arc::new(move |domain, ranges| {
            assert_eq!(domain.len(), inputs, "intervals of the inputs");
            let mut tape = tape.lock().unwrap_or_else(PoisonError::into_inner);
            let values = tape.evaluate_over(|at| Interval::new(domain[at][0], domain[at][1]));
            ranges
                .iter_mut()
                .zip(values)
                .for_each(|(range, value)| *range = [value.lower, value.upper]);
        }),
    }
}
