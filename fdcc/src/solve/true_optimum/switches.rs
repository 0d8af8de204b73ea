//! Where surfaces change their modes, with the multiplier of `psi = 0` and how far from grazing the
//! true system is there.

use super::Located;
use super::answer::shown;
use super::certificate::Switch;
use super::costates::Hold;
use super::tuning::switches::SAME_TIME;
use crate::verification::Verification;
use fdcc_compiler::{Mode, Model, Switch as Switched};
use fdcc_runtime::problem::Problem;

impl Located {
    /// All changes, in the order of time; `model` is what holds between jumps, `between`
    /// the smoothed problem of that.
    pub fn switches(
        &self,
        model: &Model,
        between: &Problem,
        replay: Option<&Verification>,
    ) -> Vec<Switch> {
        let switches = model.switches();
        let mut all = Vec::new();
        for j in 1..self.structure.phases.len() {
            let pair = [&self.structure.phases[j - 1], &self.structure.phases[j]];
            for (at, switch) in switches.iter().enumerate() {
                let [from, to] = pair.map(|phase| phase.modes[at]);
                if from != to {
                    let time = self.structure.times[j];
                    let margin = replay.and_then(|it| self.margin(it, &switch.place.name, time));
                    all.push(Switch {
                        surface: switch.place.name.clone(),
                        time,
                        from: shown(from),
                        to: shown(to),
                        kappa: self.kappa((model, between), (j, from), switch),
                        margin,
                    });
                }
            }
        }
        all
    }

    /// Nothing for a `Dir`, which has one for each component, and beside a jump. What is held is 0
    /// already: leaving it has no condition, but there the costates are gradients no longer.
    fn kappa(
        &self,
        (model, between): (&Model, &Problem),
        (j, from): (usize, Mode),
        switch: &Switched,
    ) -> Option<f64> {
        if switch.is_ball || self.structure.phases[j].jump.is_some() {
            return None;
        }
        let surface = switch.surfaces.start;
        let taken_off = |phase: usize, end: usize| {
            let hold = Hold::new(self, (model, between), phase);
            hold.map_or(0.0, |it| it.at_end(surface, end))
        };
        let [before, after] = [taken_off(j - 1, 1), taken_off(j, 0)];
        let reached = (from != Mode::Held).then(|| self.link_multiplier(j, &switch.place.name));
        Some(after - before - between.sense * reached.flatten().unwrap_or(0.0))
    }

    /// The derivative of the objective by a condition at the beginning of phase `j`.
    pub(super) fn link_multiplier(&self, j: usize, label: &str) -> Option<f64> {
        let link = &self.chain.links[j - 1];
        let rows = &self.outcome.solution.multipliers.constraints;
        let behind: usize = self.chain.links[j - 1..].iter().map(|it| it.bounds.len()).sum();
        let is_it = |row: &usize| *link.function.origin(row + 1).label == *label;
        let found = (0..link.bounds.len()).find(is_it);
        found.map(|row| -rows[rows.len() - behind + row])
    }

    /// That of the event of the replay that happens at this time.
    fn margin(&self, replay: &Verification, surface: &str, time: f64) -> Option<f64> {
        let duration = self.structure.ends()[1] - self.structure.ends()[0];
        let own = replay.simulation.events.iter();
        let own = own.filter(|it| replay.system.name_of(it.surface) == surface);
        let gap = |time_of: f64| (time_of - time).abs();
        let near = own.min_by(|a, b| gap(a.time).total_cmp(&gap(b.time)))?;
        (gap(near.time) <= SAME_TIME * duration).then_some(near.margin)
    }
}
