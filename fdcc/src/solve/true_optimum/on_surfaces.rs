//! Phases that are said to be on one side of a surface, and are on it all along.
//!
//! There the true system is not the one that the side says: what happens is decided by rounding,
//! or what is best is approached from that side and never reached.

use super::contacts::{Contacts, Run};
use super::path_values::{path_values, points};
use super::tuning::on_surfaces::{FEWEST, NOTHING, ON, PRESSED};
use fdcc_compiler::{Mode, is_kink, may_hold};
use fdcc_runtime::problem::Columns;

impl Contacts<'_> {
    /// Whether a phase that holds no surface stays on one of it: its function is 0, or a multiplier
    /// presses the motion onto it.
    pub fn stays_on_a_surface(&self) -> bool {
        let switches = self.model.switches();
        let phases = self.located.structure.phases.iter().enumerate();
        let all = phases.flat_map(|(j, phase)| (0..phase.modes.len()).map(move |at| (j, at)));
        // On a kink both sides are the same.
        let is_meant = |at: usize| !switches[at].is_ball && !is_kink(&switches[at].place.name);
        let beside = |(j, at): &(usize, usize)| {
            self.located.structure.phases[*j].modes[*at] != Mode::Held && is_meant(*at)
        };
        all.filter(beside).any(|(j, at)| self.is_on(j, at))
    }

    /// What may be held was looked at as a hold (`insertion.rs`, `contacts.rs`).
    fn is_on(&self, j: usize, switch: usize) -> bool {
        let (row, unit) = (self.row_of_switch(j, switch), self.unit_of_switch(j, switch));
        let (problem, outcome) = (&self.located.chain.phases[j], &self.located.outcome.phases[j]);
        let psi = path_values(problem, &outcome.trajectory, row);
        if psi.iter().all(|it| it.abs() <= NOTHING * unit) {
            return true;
        }
        if may_hold(self.model)[switch] {
            return false;
        }
        let range = self.range_of_switch(switch).max(PRESSED * unit);
        let is_on = |run: &Run| psi[run.first..run.behind].iter().all(|it| it.abs() <= ON * range);
        self.runs(j, row, range).iter().any(|it| it.behind - it.first >= FEWEST && is_on(it))
    }

    /// What the function of a surface changes by where each state does by one of its units, at
    /// most.
    fn unit_of_switch(&self, j: usize, switch: usize) -> f64 {
        let (problem, outcome) = (&self.located.chain.phases[j], &self.located.outcome.phases[j]);
        let (path, points) = (&*problem.path, points(problem, &outcome.trajectory));
        let (row, states) = (self.row_of_switch(j, switch) as u32, path.layout().states());
        let pattern = path.jacobian_pattern();
        let mut values = Columns::new(path.outputs(), points.count());
        let mut jacobian = Columns::new(pattern.entries.len(), points.count());
        path.jacobian(&points, &outcome.trajectory.parameters, &mut values, &mut jacobian);
        let entries = pattern.entries.iter().enumerate();
        let own = entries.filter(|it| it.1.0 == row && states.contains(&(it.1.1 as usize)));
        let largest =
            |entry: usize| jacobian.column(entry).iter().fold(0.0, |a: f64, it| a.max(it.abs()));
        own.map(|(entry, place)| {
            largest(entry) * problem.states[place.1 as usize - states.start].unit
        })
        .sum()
    }
}
