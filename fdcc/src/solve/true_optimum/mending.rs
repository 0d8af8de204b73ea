//! What a located answer asks for: a structure that nothing of it contradicts.

use super::contacts::Contacts;
use super::joined::joined;
use super::range::ranges;
use super::structure::{NewArcs, Structure};
use super::tuning::search::{WORSE, WORSE_IF_FINER};
use super::{Located, Search, polynomials, repair};
use fdcc_compiler::PhaseOfModes;
use fdcc_runtime::solve::Outcome;

/// What is mended first where a control has the wrong sign at a bound and a limit is reached: each
/// may be the reason of the other.
#[derive(Clone, Copy, PartialEq)]
pub(crate) enum First {
    /// Controls are released.
    Controls,
    /// Limits are kept.
    Contacts,
}

impl Search<'_> {
    /// Mends the structure until nothing new can be tried; what cannot be solved is passed over.
    pub(super) fn mended(&mut self, mut located: Located) -> Option<Located> {
        let mut passed = std::mem::take(&mut located.others);
        let mut tried = vec![located.structure.phases.clone()];
        while let Some(structure) = self.other(&located, &tried) {
            tried.push(structure.phases.clone());
            let whole = self.whole(&located);
            let may_rise = structure.conditions() > located.structure.conditions();
            let is_finer = structure.fineness() > located.structure.fineness();
            let is_cut = structure.cuts() > located.structure.cuts();
            let better = self.solve(structure, &whole);
            let is_kept = |it: &Located| match is_cut {
                true => !it.is_worse(&located) && self.is_smoother(it, &located),
                false => {
                    may_rise || !it.rises(&located, if is_finer { WORSE_IF_FINER } else { WORSE })
                }
            };
            if let Some(better) = better.filter(is_kept) {
                passed.push(std::mem::replace(&mut located, better));
            }
        }
        self.turned_back(&mut located, &mut passed);
        located.others = passed;
        Some(located)
    }

    /// A phase that shrank to nothing may have been tried from what there is without it.
    fn turned_back(&self, located: &mut Located, passed: &mut Vec<Located>) {
        let Some(asked) = repair::better(self.model, self.problem, located) else { return };
        if let Some(at) = passed.iter().rposition(|it| it.structure.phases == asked.phases) {
            let last = std::mem::replace(located, passed.remove(at));
            passed.push(last);
        }
    }

    /// What a located answer asks for, and was not tried: a repair, then new arcs and touch points,
    /// then the latter alone, then that a surface is not touched.
    fn other(&self, located: &Located, tried: &[Vec<PhaseOfModes>]) -> Option<Structure> {
        let contacts = Contacts::new(self.model, located);
        let (own, phases) = (&located.structure, &located.outcome.phases);
        let released = repair::released(self.problem, located);
        let touched = own.with_arcs(None, &contacts, phases);
        let arcs = |which| own.with_arcs(Some((self.problem, which)), &contacts, phases);
        let is_first = self.first == First::Contacts && released.is_some();
        let first = is_first.then(|| [arcs(NewArcs::All).without_overlaps(), touched.clone()]);
        let repaired = repair::without_contradiction(self.model, located);
        let repaired = repaired.into_iter().chain([joined(&contacts)]);
        let repaired = repaired.chain(first.into_iter().flatten()).chain(released);
        let new = [arcs(NewArcs::All), arcs(NewArcs::Longest)].into_iter();
        let new = new.chain([touched]);
        let all = repaired
            .chain(new.flat_map(|it| [it.without_overlaps(), it]))
            .chain(repair::without_touches(own))
            .chain(self.cuts(located, &contacts));
        let mut all = all.map(|it| it.without_idle_touches(&contacts.limits));
        all.find(|it| !tried.contains(&it.phases))
    }

    /// The structures in which controls may jump inside of a phase: where they are at a limit that
    /// reads several of them, such as a disc, they may go from one end of it to the other.
    fn cuts(&self, located: &Located, contacts: &Contacts) -> Vec<Structure> {
        let own = &located.structure;
        let ranges = ranges(&self.problem.controls, &located.outcome.phases);
        let is_at_limit = |phase: &PhaseOfModes| {
            let limits = contacts.limits.iter().zip(&phase.contacts);
            limits.into_iter().any(|it| it.0.order == Some(0) && *it.1 != fdcc_compiler::Arc::Free)
        };
        let phases = own.phases.iter().zip(&located.outcome.phases).enumerate();
        let limited = phases.filter(|(_, (phase, _))| is_at_limit(phase));
        let cut = |(j, (_, outcome)): (usize, (&PhaseOfModes, &Outcome))| {
            Some(own.with_cut(j, polynomials::jump(&ranges, &outcome.trajectory)?))
        };
        limited.filter_map(cut).collect()
    }
}
