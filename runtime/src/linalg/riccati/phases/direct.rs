//! Entries that belong to no stage: between ends of phases, unknowns and coupling rows.

use super::lifetimes::Item;
use super::phase::is_of_stage;
use crate::linalg::structure::phases::PhaseStages;
use crate::linalg::structure::triplets::{Family, Triplets};

/// `matrix[first, second] += values[from .. from + count]`, and so on the other side of the
/// diagonal.
#[derive(Clone, Copy, Debug)]
pub(super) struct Direct {
    pub is_hessian: bool,
    pub from: usize,
    pub count: usize,
    pub first: Item,
    pub second: Item,
}

/// All of them, and where families of stages touch unknowns: an entry between the unknown and the
/// stages of the phase. Nothing where an entry fits no stage and no end.
pub(super) fn direct_entries(
    phases: &[PhaseStages],
    hessian: &Triplets,
    jacobian: &Triplets,
) -> Option<Vec<Direct>> {
    let mut found = Vec::new();
    let unknown = phases.last().map_or(0, |last| last.variables.end);
    let end = |variable: usize| item(phases, unknown, variable);
    for (is_hessian, matrix) in [(true, hessian), (false, jacobian)] {
        let mut from = 0;
        for family in &matrix.families {
            let is_sum = family.row_step == 0 && family.column_step == 0;
            let in_stage = match is_hessian {
                true => is_stage_entry(phases, unknown, family),
                false => phases.iter().any(|phase| is_of_stage(phase, family.row)),
            };
            if in_stage {
                let stage = phases.iter().position(|phase| {
                    let of_row = !is_hessian && phase.rows.contains(&family.row);
                    of_row
                        || phase.variables.contains(&family.column)
                        || is_hessian && phase.variables.contains(&family.row)
                })?;
                let ends = [family.row, family.column];
                let own = if is_hessian { &ends[..] } else { &ends[1..] };
                for variable in own.iter().filter(|variable| **variable >= unknown) {
                    let (first, second) = (Item::Unknown(*variable), Item::Stages(stage));
                    found.push(Direct { is_hessian, from, count: 0, first, second });
                }
                // Stages of a phase are tied to nothing but themselves and unknowns.
                let is_own = |at: &&usize| **at >= unknown || phases[stage].variables.contains(at);
                if !own.iter().all(|at| is_own(&at)) {
                    return None;
                }
            } else if is_sum {
                let first = if is_hessian { end(family.row)? } else { Item::Row(family.row) };
                let second = end(family.column)?;
                found.push(Direct { is_hessian, from, count: family.count, first, second });
            } else {
                return None;
            }
            from += family.count;
        }
    }
    Some(found)
}

/// Whether an entry of the Hessian belongs to the stages of a phase.
fn is_stage_entry(phases: &[PhaseStages], unknown: usize, family: &Family) -> bool {
    let is_stage = |variable: usize| variable < unknown;
    let repeats = |phase: &PhaseStages| family.count == phase.stages.intervals;
    (family.row_step > 0 || family.column_step > 0)
        && (is_stage(family.row) || is_stage(family.column))
        && phases.iter().any(repeats)
}

/// What a variable is at the ends of phases; nothing where it is inside of one.
fn item(phases: &[PhaseStages], unknown: usize, variable: usize) -> Option<Item> {
    if variable >= unknown {
        return Some(Item::Unknown(variable));
    }
    let phase = phases.iter().position(|phase| phase.variables.contains(&variable))?;
    let (first, last) = (phases[phase].first(), phases[phase].last());
    if first.contains(&variable) {
        Some(Item::First(phase, variable - first.start))
    } else {
        last.contains(&variable).then(|| Item::Last(phase, variable - last.start))
    }
}
