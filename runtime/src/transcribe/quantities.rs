//! Which variables and constraints are one quantity of the model at different times.

use super::TranscribedNlp;
use super::interval::Signal;
use crate::nlp::Quantities;

impl TranscribedNlp<'_> {
    /// Variables: states, controls, unknowns. Constraints: steps of states, of controls that go on
    /// from interval to interval, path constraints, boundary conditions.
    pub(super) fn all_quantities(&self) -> Quantities {
        let stages = self.stages;
        let signals = self.problem.layout.x + self.problem.controls.len();
        let slots: Vec<usize> =
            self.interval.slots.iter().map(|slot| self.quantity(slot.signal)).collect();
        let mut variables = slots.repeat(stages.intervals);
        variables.extend_from_slice(&slots[..stages.states]);
        variables.extend((0..stages.globals).map(|unknown| signals + unknown));
        let paths = self.problem.path_bounds.len();
        let defects = (0..stages.defect_rows()).map(|row| self.quantity(self.stepped(row)));
        let local = (0..stages.local_constraints).map(|row| signals + row % paths);
        let mut constraints = defects.chain(local).collect::<Vec<_>>().repeat(stages.intervals);
        constraints.extend((0..stages.coupling_constraints).map(|row| signals + paths + row));
        Quantities { variables, constraints, stepped: signals, units: self.units() }
    }

    fn units(&self) -> Vec<f64> {
        let problem = self.problem;
        let signals = problem.states.iter().chain(&problem.controls).map(|signal| signal.unit);
        let unknowns = problem.unknowns.iter().map(|it| problem.parameters[it.parameter].unit);
        signals.chain(unknowns).collect()
    }

    fn quantity(&self, signal: Signal) -> usize {
        match signal {
            Signal::State(i) => i,
            Signal::Control(i) => self.problem.layout.x + i,
        }
    }

    /// Whose step a defect is.
    fn stepped(&self, row: usize) -> Signal {
        let states = self.problem.layout.x;
        let handed_on = self.stages.states - states;
        match row.checked_sub(self.stages.defect_rows() - handed_on) {
            Some(control) => Signal::Control(control),
            None => Signal::State(row % states),
        }
    }
}
