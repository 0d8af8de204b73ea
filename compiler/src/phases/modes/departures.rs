//! Where a held surface is left: what the selector and the motion are there.
//!
//! With `c = -dpsi'/ds > 0` the rate of `psi` off the surface is `psi' = c (s - 1)` above it, for
//! the selector `s` that would hold it. So the surface is left upwards where `s` gets to 1, unless
//! a control or another selector may jump there.

use super::{Mode, Modes};
use crate::expressions::graph::ExprId;
use crate::model::{Constraint, Model, Place, Range, Switch, Symbol};
use crate::phases::hold::approach;

/// For each of [`Model::switches`] whether its own selector acts on `psi'`: else no choice of it
/// holds the surface.
pub fn may_hold(model: &Model) -> Vec<bool> {
    let acts = |surface: usize| {
        let selector = model.input_of(Symbol::Selector(surface));
        selector.is_some_and(|it| inputs_of_rate(model, surface).contains(&it))
    };
    model.switches().iter().map(|switch| switch.surfaces.clone().all(acts)).collect()
}

/// For each of [`Model::switches`] whether its own selector acts on `psi'`, and neither a control
/// nor another selector does.
pub fn is_uncontrolled(model: &Model) -> Vec<bool> {
    let of = |switch: &Switch| {
        let surface = switch.surfaces.start;
        let is_other = |at: &u32| match model.symbols[*at as usize] {
            Symbol::Control(_) => true,
            Symbol::Selector(other) => other != surface,
            _ => false,
        };
        !switch.is_ball && !inputs_of_rate(model, surface).iter().any(is_other)
    };
    let switches = model.switches();
    switches.iter().map(of).zip(may_hold(model)).map(|(alone, acts)| alone && acts).collect()
}

fn inputs_of_rate(model: &Model, surface: usize) -> Vec<u32> {
    let mut graph = model.graph.clone();
    let rate = approach(model, &mut graph, model.surfaces[surface].psi);
    graph.inputs_of(&[rate])
}

impl Modes<'_> {
    /// Selectors where a hold ends: nodes alone would let it last beyond the time at which the
    /// selector leaves its bounds.
    pub(super) fn departures(&mut self, j: usize) -> Vec<Constraint> {
        let (model, phases) = (self.between.division.model, self.phases);
        let (mut rows, mut next) = (Vec::new(), model.controls.len());
        let switches = model.switches().into_iter().zip(is_uncontrolled(model));
        for (at, (switch, is_uncontrolled)) in switches.enumerate() {
            if phases[j].modes[at] != Mode::Held {
                continue;
            }
            let at_end = (next..next + switch.surfaces.len()).map(Symbol::ControlAtEnd);
            let all: Vec<ExprId> = at_end.map(|it| self.between.division.of_phase(j, it)).collect();
            next += all.len();
            if switch.is_ball {
                rows.push(self.within_ball(switch.place, &all));
                continue;
            }
            let left = self.left(j, &switch, phases[j + 1].modes[at]);
            let bounds = match left.filter(|_| is_uncontrolled) {
                Some(side) => [side, side],
                None => [-1.0, 1.0],
            };
            rows.push(self.selector(switch.place, all[0], bounds));
            if left.is_some() && !is_uncontrolled && phases[j + 1].is_joined {
                rows.push(self.tangent(j, &switch));
            }
        }
        rows
    }

    /// `psi' = 0` where the phase begins that leaves a surface: a control that does not jump there
    /// leaves it along it.
    fn tangent(&mut self, j: usize, switch: &Switch) -> Constraint {
        let (moving, range) =
            (self.moving(&self.phases[j + 1]), self.between.division.exactly_zero());
        let surface = &self.between.division.model.surfaces[switch.surfaces.start];
        let rate = approach(&moving, &mut self.between.division.graph, surface.psi);
        let value = self.between.division.at_start(j + 1, rate);
        let place = Place { name: format!("{} left", surface.place.name), ..surface.place };
        Constraint { place, value, range }
    }

    /// The side to which a surface is left at the end of a phase: 1 or -1.
    fn left(&self, j: usize, switch: &Switch, after: Mode) -> Option<f64> {
        let psi = self.between.division.model.surfaces[switch.surfaces.start].psi;
        let is_moved = self.is_moved(j, psi);
        match after {
            Mode::Above if !is_moved => Some(1.0),
            Mode::Below if !is_moved => Some(-1.0),
            _ => None,
        }
    }

    fn selector(&mut self, place: &Place, value: ExprId, bounds: [f64; 2]) -> Constraint {
        let [lower, upper] = bounds.map(|it| self.between.division.graph.number(it));
        Constraint { place: place.clone(), value, range: Range { lower, upper } }
    }
}
