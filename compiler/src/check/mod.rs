//! The checks that need more than names and shapes: one file for each, listed here.

mod conditions;
mod discontinuity;
mod dynamics;
mod names;
mod surfaces;

use crate::resolve::elaborator::{Elaborator, Role};
use fdcc_grammar::ast::{self, Item};
use fdcc_grammar::{Diagnostic, Severity, Span};

/// What a check may look at: the items of a phase and what they turned out to mean.
pub(crate) struct Facts<'a, 'e> {
    /// The items of the phase.
    pub items: Vec<&'a Item>,
    /// What they mean.
    pub meaning: &'e mut Elaborator<'a>,
    /// The whole tree.
    pub tree: &'a ast::Model,
}

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
    discontinuity::smoothness::check,
    surfaces::check,
    conditions::bounds::check,
    conditions::contradictions::check,
    dynamics::finite::check,
    conditions::values::check,
];

/// Checks of what stands outside all phases.
const AROUND_PHASES: &[Check] = &[
    conditions::links::check,
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
pub(crate) use names::unused::check as unused;

impl Facts<'_, '_> {
    /// The mistakes that have been told already.
    pub fn told(&self) -> Told {
        let errors = self.meaning.diagnostics.iter().filter(|it| it.severity == Severity::Error);
        let mut spans: Vec<Span> = errors.map(Diagnostic::span).collect();
        spans.sort_unstable_by_key(|span| span.start);
        Told(spans)
    }
}

/// Where mistakes have been told, in the order of the text.
pub(crate) struct Told(Vec<Span>);

impl Told {
    /// Whether there is one inside a span, so that more about it would be noise.
    pub fn is_within(&self, span: Span) -> bool {
        let first = self.0.partition_point(|it| it.start < span.start);
        self.0[first..].iter().take_while(|it| it.start <= span.end).any(|it| it.end <= span.end)
    }
}

impl Role<'_> {
    /// In the words of a message.
    pub fn describe(&self) -> String {
        match self {
            Role::Equation(_) => "the dynamics".into(),
            Role::Path(Some(name), _) => format!("path constraint `{}`", name.name),
            Role::Path(None, _) => "a path constraint".into(),
            Role::Objective => "the objective".into(),
            Role::Boundary(word) => format!("a condition at the {word}"),
            Role::Surface(name) => format!("surface `{}`", name.name),
            Role::Report(name) => format!("report `{}`", name.name),
            Role::Number(what) => (*what).into(),
        }
    }
}
