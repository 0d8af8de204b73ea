//! What controls do where one phase of given modes ends and the next begins.
//!
//! A control is *regular* where the Hamiltonian is strictly convex in it: the dynamics are affine
//! in the control, the running cost is not. Then the control is continuous unless the costate jumps
//! (Bryson & Ho, *Applied Optimal Control*, 1975, section 3.7), and it reaches or leaves an arc at
//! the value of its bound. As an equation that determines the time of the junction, which the
//! objective hardly does: it changes with the third power of that time, and Newton's method would
//! be slow.

use super::limits::bounded_states;
use super::{Arc, Modes};
use crate::expressions::graph::ExprId;
use crate::expressions::graph::derivative::derivative;
use crate::lower::objective::integrals_in_states;
use crate::model::{Constraint, Control, Range, Symbol};
use fdcc_runtime::problem::ControlShape;

impl Modes<'_> {
    /// Bounds of free controls on both sides of the end of phase `j`: nodes alone would let a
    /// polynomial go beyond where a control reaches its bound or leaves it continuously, and its
    /// arc with it.
    pub(super) fn ends_of_controls(&mut self, j: usize) -> Vec<Constraint> {
        let (model, phases) = (self.between.division.model, self.phases);
        let mut rows = Vec::new();
        for (phase, beside) in [(j, j + 1), (j + 1, j)] {
            let own = &phases[phase];
            for (at, control) in model.controls.iter().enumerate() {
                let is_free = own.arcs[at] == Arc::Free && own.shape == ControlShape::Polynomial;
                let symbol = if phase == j { Symbol::ControlAtEnd } else { Symbol::ControlAtStart };
                if is_free && self.has_bounds(control.range) {
                    let value = self.between.division.of_phase(phase, symbol(at));
                    let range = match self.is_continuous(j, at) {
                        true => on_arc(control, phases[beside].arcs[at]),
                        false => control.range,
                    };
                    rows.push(Constraint { place: control.place.clone(), value, range });
                }
            }
        }
        rows
    }

    /// Path conditions on which a control acts at once, on both sides of the end of phase `j`,
    /// where they are not met as equations: for the same reason.
    pub(super) fn ends_of_path(&mut self, j: usize) -> Vec<Constraint> {
        let phases = self.phases;
        let states = bounded_states(self.between.division.model).len();
        let mut rows = Vec::new();
        for phase in [j, j + 1] {
            let own = &phases[phase];
            let path = self.moving(own).path.into_iter().zip(&own.contacts[states..]);
            for (row, arc) in path {
                if *arc == Arc::Free && self.reads_control(row.value) {
                    let value = match phase == j {
                        true => self.between.division.at_end(j, row.value),
                        false => self.between.division.at_start(phase, row.value),
                    };
                    rows.push(Constraint { value, ..row });
                }
            }
        }
        rows
    }

    fn reads_control(&self, value: ExprId) -> bool {
        let division = &self.between.division;
        let symbols = &division.symbols;
        let read = division.graph.inputs_of(&[value]).into_iter();
        read.map(|at| symbols[at as usize]).any(|it| matches!(it, Symbol::Control(_)))
    }

    fn has_bounds(&self, range: Range) -> bool {
        let graph = &self.between.division.graph;
        let is_finite = |it| graph.as_number(it).is_none_or(f64::is_finite);
        is_finite(range.lower) || is_finite(range.upper)
    }

    /// Whether a control does not jump at the end of phase `j`: it is regular, and nothing else
    /// happens there.
    fn is_continuous(&mut self, j: usize, control: usize) -> bool {
        let [before, after] = [&self.phases[j], &self.phases[j + 1]];
        let is_untouched = after.touches.iter().all(|it| *it == Arc::Free);
        let is_same = before.contacts == after.contacts;
        before.modes == after.modes
            && (is_same && self.is_regular(j, control) || !is_same && after.is_joined)
            && is_untouched
            && !after.is_cut
            && after.jump.is_none()
    }

    fn is_regular(&mut self, j: usize, control: usize) -> bool {
        let model = self.between.division.model;
        let Some(input) = model.input_of(Symbol::Control(control)) else { return false };
        let meanings = self.selectors(&self.phases[j]);
        let costs = self.running_costs(&meanings, &[]);
        // By how much these count is not known.
        let in_states = integrals_in_states(model).into_iter();
        let unknown = in_states.map(|at| model.integrals[at].integrand);
        let rates = self.moving(&self.phases[j]).states.into_iter().map(|it| it.rate);
        let rates: Vec<ExprId> = rates.chain(unknown).collect();
        let graph = &mut self.between.division.graph;
        let cost = graph.sum(&costs);
        let mut is_affine = |value: ExprId| {
            let slope = derivative(graph, value, input);
            let curvature = derivative(graph, slope, input);
            graph.as_number(curvature) == Some(0.0)
        };
        !is_affine(cost) && rates.into_iter().all(is_affine)
    }
}

/// The values that a control may have on an arc.
pub(super) fn on_arc(control: &Control, arc: Arc) -> Range {
    let Range { lower, upper } = control.range;
    match arc {
        Arc::Free => control.range,
        Arc::Lower => Range { lower, upper: lower },
        Arc::Upper => Range { lower: upper, upper },
    }
}
