//! Where the arc of a limit ends because a control reaches its bound, or begins with it.
//!
//! Of `c <= 0`, with the arc `c^(q)(x, u) = 0` on one side of a junction and a control at its bound
//! on the other, two inequalities hold at the junction: the bound on the side of the arc, and the
//! sign of `c^(q)` on the other one. Where both say the same of the state, one from each side, the
//! time of the junction is given, and the bound is an equation there (two inequalities without an
//! interior are nothing for an interior point method). Nodes alone see neither: the arc ends early,
//! and the multiplier of the limit beside it says so.

use super::contacts::Contacts;
use super::structure::Structure;
use fdcc_compiler::Arc;

/// The structure in which controls are at their bounds on both sides of such junctions.
pub(super) fn joined(contacts: &Contacts) -> Structure {
    let mut other = contacts.located.structure.clone();
    for j in 1..other.phases.len() {
        other.phases[j].is_joined |= is_pressed(contacts, j) && reaches_bound(&other, j);
    }
    other
}

/// Whether a limit whose arc ends or begins with phase `j` is active just beside its arc, too.
fn is_pressed(contacts: &Contacts, j: usize) -> bool {
    let phases = &contacts.located.structure.phases;
    let is_active = |limit: usize| {
        let [before, after] = [phases[j - 1].contacts[limit], phases[j].contacts[limit]];
        match (before, after) {
            (Arc::Free, Arc::Free) => false,
            (arc, Arc::Free) => contacts.is_active_at(j, limit, arc, 0),
            (Arc::Free, arc) => contacts.is_active_at(j - 1, limit, arc, 1),
            _ => false,
        }
    };
    let has_arc = |limit: &usize| contacts.limits[*limit].order.is_some_and(|order| order > 0);
    (0..contacts.limits.len()).filter(has_arc).any(is_active)
}

/// Whether a control is free on one side of the beginning of phase `j` and at a bound on the other.
fn reaches_bound(structure: &Structure, j: usize) -> bool {
    let [before, after] = [&structure.phases[j - 1], &structure.phases[j]];
    let mut arcs = before.arcs.iter().zip(&after.arcs);
    arcs.any(|(a, b)| (*a == Arc::Free) != (*b == Arc::Free))
}
