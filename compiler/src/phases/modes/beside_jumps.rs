//! Bounds of states, path conditions and sides of surfaces where a jump happens.
//!
//! They hold at the nodes of the collocation, which say nothing of the state that a jump leaves,
//! nor of that which it makes. The level of a substance is lowest just before the next dose.

use super::independent::Independent;
use super::limits::rates;
use super::{Arc, Mode, Modes};
use crate::expressions::graph::ExprId;
use crate::model::{Constraint, Place, Range, Symbol};

/// The two sides of a jump.
const SIDES: [(usize, &str); 2] = [(0, "just before"), (1, "just behind")];

impl Modes<'_> {
    /// What holds just before the jump at the end of phase `j`, and just behind it where that moves
    /// it; nothing where no jump happens, and nothing that its equations say already.
    pub(super) fn beside_jump(&mut self, j: usize) -> Vec<Constraint> {
        if self.phases[j + 1].jump.is_none() {
            return Vec::new();
        }
        let known = self.known_at_jump(j);
        let mut rows = Vec::new();
        for (side, word) in SIDES {
            let mut all = self.limits_beside(j + side);
            all.extend(self.sides_beside(j + side));
            for row in all {
                let is_asked = side == 0 || self.is_moved(j, row.value);
                if is_asked && self.is_open_at_jump(j, side, row.value, &known) {
                    rows.push(self.at_side(j, (side, word), row));
                }
            }
        }
        rows
    }

    fn at_side(&mut self, j: usize, (side, word): (usize, &str), row: Constraint) -> Constraint {
        let value = match side {
            0 => self.between.division.at_end(j, row.value),
            _ => self.between.division.at_start(j + 1, row.value),
        };
        let name = format!("{} {word} {}", row.place.name, self.between.jump(j).place.name);
        Constraint { place: Place { name, ..row.place }, value, ..row }
    }

    /// What is 0 in the end of phase `j`, and a number.
    fn known_at_jump(&mut self, j: usize) -> Independent {
        let mut known = self.zero_between(j);
        let psi = self.between.whole().surfaces[self.between.jump(j).surface].psi;
        let one = self.between.division.graph.number(1.0);
        known.add(self, psi);
        known.add(self, one);
        known
    }

    /// Those that are free in a phase, and on which no control acts at once.
    fn limits_beside(&mut self, j: usize) -> Vec<Constraint> {
        let own = &self.phases[j];
        let (moving, states) = (self.moving(own), self.all_bounds_of_states());
        let limits = states.iter().chain(&moving.path).zip(own.contacts.iter().zip(&own.touches));
        let free = limits.filter(|it| it.1 == (&Arc::Free, &Arc::Free)).map(|it| it.0);
        let mut rows = Vec::new();
        for row in free {
            let is_slow = match rates(&moving, &mut self.between.division.graph, row.value) {
                Some(rates) => rates.len() > 1,
                None => self.is_open(j, &moving, row.value),
            };
            rows.extend(is_slow.then(|| row.clone()));
        }
        rows
    }

    /// The sides of the surfaces that are not held in a phase.
    fn sides_beside(&mut self, j: usize) -> Vec<Constraint> {
        let (model, own) = (self.between.division.model, &self.phases[j]);
        let mut rows = Vec::new();
        for (switch, mode) in model.switches().iter().zip(&own.modes).filter(|it| !it.0.is_ball) {
            let surface = &model.surfaces[switch.surfaces.start];
            let range: Range = match mode {
                Mode::Above => self.between.division.not_below(),
                Mode::Below => self.between.division.not_above(),
                Mode::Held => continue,
            };
            rows.push(Constraint { place: surface.place.clone(), value: surface.psi, range });
        }
        rows
    }

    /// Whether a value just before a jump (0) or just behind it (1) is not given by what is known.
    fn is_open_at_jump(
        &mut self,
        j: usize,
        side: usize,
        value: ExprId,
        known: &Independent,
    ) -> bool {
        let value = if side == 0 { value } else { self.reset(j, value) };
        known.clone().add(self, value)
    }

    /// A value behind a jump as a function of the state before it.
    fn reset(&mut self, j: usize, value: ExprId) -> ExprId {
        let resets = self.between.jump(j).resets.clone();
        self.between.division.with_symbols(value, &mut |_, symbol| match symbol {
            Symbol::State(at) => resets.iter().find(|it| it.0 == at).map(|it| it.1),
            _ => None,
        })
    }
}
