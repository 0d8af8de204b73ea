//! The checks that need more than names and shapes: one file for each, listed here.

mod conditions;
mod discontinuity;
mod dynamics;
mod facts;
mod names;
mod surfaces;

pub(crate) use facts::Facts;
use fdcc_grammar::Diagnostic;

/// A check.
type Check = fn(&mut Facts<'_, '_>, &mut Vec<Diagnostic>);

/// Checks of a model with time and states of its own.
const OF_A_PHASE: &[Check] = &[
    dynamics::needs_time::check,
    dynamics::equations::check,
    conditions::ends::check,
    dynamics::duration::check,
    discontinuity::sets::check,
    discontinuity::hidden_jump::check,
    dynamics::idle_jump::check,
    dynamics::moving_rest::check,
    discontinuity::smoothness::check,
    surfaces::check,
    conditions::bounds::check,
    conditions::contradictions::check,
    conditions::at_times::check,
    dynamics::finite::check,
    conditions::values::check,
];

/// Checks of what stands outside all phases.
const AROUND_PHASES: &[Check] = &[
    conditions::around::check,
    conditions::links::check,
    conditions::at_times::check,
    discontinuity::sets::check,
    discontinuity::hidden_jump::check,
    discontinuity::smoothness::check,
    conditions::bounds::check,
    dynamics::finite::check,
    conditions::values::check,
];

/// All findings about a phase, or about what stands around phases.
pub(crate) fn check(facts: &mut Facts<'_, '_>, is_phase: bool) -> Vec<Diagnostic> {
    let mut found = Vec::new();
    let checks = if is_phase { OF_A_PHASE } else { AROUND_PHASES };
    checks.iter().for_each(|check| check(facts, &mut found));
    found
}

pub(crate) use names::lookalike::check as lookalike;
pub(crate) use names::twice::check as twice;
pub(crate) use names::unused::check as unused;
