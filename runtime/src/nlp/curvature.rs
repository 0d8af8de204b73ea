//! The mean size of the terms of second order of rows of one kind: a square that has to be 0 has no
//! others there.
//!
//! Rows of different phases share no entry of the Hessian, so that one kind of each phase is looked
//! at at the same time.

use super::{Derivatives, Nlp, Quantities};
use crate::linalg::PhaseStages;

/// Of each kind of rows from `first` on; 0 of linear ones.
pub(super) fn curvatures(
    nlp: &mut dyn Nlp,
    quantities: &Quantities,
    v: &[f64],
    magnitudes: &[f64],
    (first, kinds): (usize, usize),
) -> Vec<f64> {
    let phases = nlp.phases();
    let groups = groups(nlp, quantities, &phases, first);
    let mut curvatures = vec![0.0; kinds];
    if groups.is_empty() {
        return curvatures;
    }
    let (mut counts, mut at) = (vec![0.0; kinds], Derivatives::new(nlp));
    quantities.constraints.iter().for_each(|kind| counts[*kind] += 1.0);
    for group in groups {
        let is_its = |kind: &usize| group.iter().any(|it| it.kind == *kind);
        let weight = |kind: &usize| f64::from(u8::from(is_its(kind)));
        let weights: Vec<f64> = quantities.constraints.iter().map(weight).collect();
        nlp.derivatives(v, 0.0, &weights, &mut at);
        let size = |j: usize| magnitudes[quantities.variables[j]];
        for ((i, j), h) in nlp.hessian_structure().entries().zip(&at.hessian) {
            if *h == 0.0 {
                continue;
            }
            let term = if i == j { 0.5 } else { 1.0 } * (h * size(i) * size(j)).abs();
            let phase = phase_of(&phases, i).or_else(|| phase_of(&phases, j));
            let is_of = |it: &&Member| phase.is_none() || it.phase.is_none() || it.phase == phase;
            group.iter().filter(is_of).for_each(|it| curvatures[it.kind] += term);
        }
    }
    curvatures.iter().zip(&counts).map(|(sum, count)| sum / f64::max(*count, 1.0)).collect()
}

/// A kind of rows that are not linear.
struct Member {
    kind: usize,
    /// The phase that they belong to; none of a link or where there is one phase.
    phase: Option<usize>,
}

/// Kinds that may be looked at at the same time: one of each phase.
fn groups(
    nlp: &dyn Nlp,
    quantities: &Quantities,
    phases: &[PhaseStages],
    first: usize,
) -> Vec<Vec<Member>> {
    let mut groups: Vec<Vec<Member>> = Vec::new();
    let mut is_known = vec![false; quantities.constraints.iter().max().map_or(0, |last| last + 1)];
    let mut counts = vec![0; phases.len()];
    let rows = quantities.constraints.iter().enumerate();
    for (row, &kind) in rows.filter(|(_, kind)| **kind >= first) {
        if is_known[kind] || nlp.is_linear(row) {
            continue;
        }
        is_known[kind] = true;
        let phase = phases.iter().position(|it| it.rows.contains(&row));
        let member = Member { kind, phase };
        let Some(phase) = phase else {
            // Behind those of phases: what several phases share has a group of its own.
            groups.push(vec![member]);
            continue;
        };
        let shared = |group: &Vec<Member>| group[0].phase.is_some();
        let slot = groups.iter().enumerate().filter(|it| shared(it.1)).nth(counts[phase]);
        counts[phase] += 1;
        match slot.map(|it| it.0) {
            Some(at) => groups[at].push(member),
            None => groups.push(vec![member]),
        }
    }
    groups
}

fn phase_of(phases: &[PhaseStages], variable: usize) -> Option<usize> {
    let at = phases.partition_point(|phase| phase.variables.end <= variable);
    phases.get(at).filter(|phase| phase.variables.contains(&variable)).map(|_| at)
}
